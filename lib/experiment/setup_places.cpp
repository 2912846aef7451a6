#include "experiment/setup_places.h"

#include "base/error.h"
#include "contact/contact_cache.h"
#include "experiment/nearest_region.h"

namespace hapsim {
namespace {

// The regions and the kinds of features: what must be the same for one solution to be extrapolated
// to another material.
ContentHash layout(const MaterialSpec& material) {
  ContentHash hash;
  for (std::size_t k = 0; k < material.key_point.size(); ++k) {
    hash.add(material.key_point[k].x());
    hash.add(material.key_point[k].y());
    hash.add(material.key_region[k]);
  }
  for (const FeatureSpec& f : material.features) hash.add(static_cast<double>(f.feature.kind));
  return hash;
}

// All of the material but a common factor of its moduli, which needs no solution.
std::string content(const MaterialSpec& material) {
  ContentHash hash = layout(material);
  hash.add(material.nu);
  for (const double modulus : material.modulus) hash.add(modulus / material.modulus[0]);
  for (const FeatureSpec& f : material.features)
    for (const double value : f.feature.value) hash.add(value);
  return hash.hex();
}

}  // namespace

bool has_moved(const MaterialSpec& material) {
  return material.shift != Vec3::Zero() || material.rotation != Vec3::Zero();
}

MaterialSpec in_place(const MaterialSpec& material) {
  MaterialSpec result = material;
  result.shift.setZero();
  result.rotation.setZero();
  return result;
}

bool has_regions(const MaterialSpec& material) {
  return !material.key_point.empty() && material.modulus.size() > 1 && !material.local;
}

bool same_regions(const MaterialSpec& a, const MaterialSpec& b) {
  if (has_regions(a) != has_regions(b)) return false;
  if (!has_regions(a)) return true;
  if (a.key_region != b.key_region || a.key_point.size() != b.key_point.size()) return false;
  for (std::size_t k = 0; k < a.key_point.size(); ++k)
    if (a.key_point[k].head<2>() != b.key_point[k].head<2>()) return false;
  return true;
}

SetupPlaces::SetupPlaces(std::shared_ptr<const ContactLibrary> library, std::vector<Vec3> positions,
                         std::vector<PreparedContact> contacts, double nu_low, double nu_high,
                         std::size_t kept)
    : library_(std::move(library)),
      positions_(std::move(positions)),
      contacts_(std::move(contacts)),
      nu_low_(nu_low),
      nu_high_(nu_high),
      kept_(kept),
      moved_(std::make_unique<Memo<std::string, std::shared_ptr<const SetupPlaces>>>(kept)),
      solved_(std::make_unique<Memo<std::string, std::shared_ptr<const SolvedPlaces>>>(kept)),
      shares_(std::make_unique<Memo<std::string, std::shared_ptr<const RegionShares>>>(kept)),
      estimates_(
          std::make_unique<Memo<std::string, std::shared_ptr<const FeatureEstimates>>>(kept)) {}

std::shared_ptr<const SetupPlaces> SetupPlaces::prepare(
    std::shared_ptr<const ContactLibrary> library, const std::vector<Vec3>& positions,
    double nu_low, double nu_high, std::size_t kept) {
  std::vector<PreparedContact> contacts = library->prepare(positions, nu_low, nu_high);
  return std::shared_ptr<const SetupPlaces>(
      new SetupPlaces(std::move(library), positions, std::move(contacts), nu_low, nu_high, kept));
}

std::shared_ptr<const SetupPlaces> SetupPlaces::with_positions(
    const std::vector<Vec3>& positions) const {
  auto places = prepare(library_, positions, nu_low_, nu_high_, kept_);
  for (const PreparedContact& contact : places->contacts())
    if (!contact.unfit.empty())
      fail_numerics("where the body has moved", contact.unfit, "leave the place out");
  return places;
}

std::shared_ptr<const SetupPlaces> SetupPlaces::chosen(
    const std::vector<std::size_t>& places) const {
  std::vector<Vec3> positions;
  std::vector<PreparedContact> contacts;
  for (const std::size_t p : places) {
    positions.push_back(positions_[p]);
    contacts.push_back(contacts_[p]);
  }
  return std::shared_ptr<const SetupPlaces>(new SetupPlaces(
      library_, std::move(positions), std::move(contacts), nu_low_, nu_high_, kept_));
}

std::shared_ptr<const SetupPlaces> SetupPlaces::before_move(const MaterialSpec& m) const {
  if (!has_moved(m)) return shared_from_this();
  ContentHash hash;
  hash.add(m.shift.data(), 3 * sizeof(double));
  hash.add(m.rotation.data(), 3 * sizeof(double));
  const std::string key = hash.hex();
  if (auto known = moved_->find(key)) return known;
  const Vec3 middle = middle_of(positions_);
  std::vector<Vec3> there;
  for (const Vec3& p : positions_) there.push_back(moved_back(p, middle, m.shift, m.rotation));
  auto places = with_positions(there);
  moved_->put(key, places);
  return places;
}

std::shared_ptr<const SolvedPlaces> SetupPlaces::solve(const MaterialSpec& material) const {
  const std::string key = content(material);
  if (auto known = solved_->find(key)) return known;
  Material m;
  m.nu = material.nu;
  m.modulus.clear();
  for (const double modulus : material.modulus) m.modulus.push_back(modulus / material.modulus[0]);
  if (has_regions(material))
    m.group_of = [&material](const Vec3& p) { return region_at(material, p); };
  for (const FeatureSpec& f : material.features) m.features.push_back(f.feature);
  auto solved = std::make_shared<SolvedPlaces>();
  solved->material = material;
  solved->material.modulus = m.modulus;
  solved->solutions = library_->solve(positions_, contacts_, m, layout(material).hex());
  solved_->put(key, solved);
  return solved;
}

std::shared_ptr<const RegionShares> SetupPlaces::shares(const MaterialSpec& material) const {
  const std::string key = layout(material).hex();
  if (auto known = shares_->find(key)) return known;
  const PlanGrid& grid = library_->grid();
  std::vector<int> region(static_cast<std::size_t>(grid.columns) * grid.rows);
  for (std::size_t c = 0; c < region.size(); ++c)
    region[c] = region_at(material, grid.centre(static_cast<int>(c)));
  auto shares = std::make_shared<RegionShares>();
  for (const PreparedContact& contact : contacts_) {
    std::vector<double> share(material.modulus.size(), 0.0);
    for (std::size_t c = 0; c < region.size(); ++c) share[region[c]] += contact.plan_share[c];
    shares->push_back(share);
  }
  shares_->put(key, shares);
  return shares;
}

std::shared_ptr<const FeatureEstimates> SetupPlaces::estimates() const {
  if (auto known = estimates_->find("")) return known;
  auto made = std::make_shared<const FeatureEstimates>(library_->estimates(positions_));
  estimates_->put("", made);
  return made;
}

}  // namespace hapsim
