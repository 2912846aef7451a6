#include "experiment/setup_places.h"

#include "base/error.h"
#include "contact/contact_cache.h"
#include "experiment/labels.h"
#include "experiment/nearest_region.h"
#include "mesh/between_plates.h"

namespace hapsim {

// The regions and the kinds of features: what must be the same for one solution to be extrapolated
// to another material.
ContentHash SetupPlaces::layout(const MaterialSpec& material) const {
  ContentHash hash;
  if (labels_of(material)) hash.add("labels " + library_->labels_key());
  for (std::size_t k = 0; k < material.key_point.size(); ++k) {
    hash.add(material.key_point[k].x());
    hash.add(material.key_point[k].y());
    hash.add(material.key_region[k]);
  }
  for (const FeatureSpec& f : material.features) hash.add(static_cast<double>(f.feature.kind));
  return hash;
}

// All of the material but a common factor of its moduli, which needs no solution.
std::string SetupPlaces::content(const MaterialSpec& material) const {
  ContentHash hash = layout(material);
  hash.add(material.nu);
  for (const double modulus : material.modulus) hash.add(modulus / material.modulus[0]);
  for (const FeatureSpec& f : material.features)
    for (const double value : f.feature.value) hash.add(value);
  return hash.hex();
}

bool has_moved(const MaterialSpec& material) {
  return material.shift != Vec3::Zero() || material.rotation != Vec3::Zero();
}

MaterialSpec in_place(const MaterialSpec& material) {
  MaterialSpec result = material;
  result.shift.setZero();
  result.rotation.setZero();
  return result;
}

namespace {

bool has_key_regions(const MaterialSpec& material) {
  return !material.key_point.empty() && material.modulus.size() > 1 && !material.local;
}

}  // namespace

std::shared_ptr<const BodyRegions> SetupPlaces::labels_of(const MaterialSpec& material) const {
  return acting_labels(material, library_->labels());
}

bool SetupPlaces::has_regions(const MaterialSpec& material) const {
  return has_key_regions(material) || labels_of(material) != nullptr;
}

bool SetupPlaces::same_regions(const MaterialSpec& a, const MaterialSpec& b) const {
  if (labels_of(a) || labels_of(b))
    return labels_of(a) == labels_of(b) && a.modulus.size() == b.modulus.size();
  if (has_key_regions(a) != has_key_regions(b)) return false;
  if (!has_key_regions(a)) return true;
  if (a.key_region != b.key_region || a.key_point.size() != b.key_point.size()) return false;
  for (std::size_t k = 0; k < a.key_point.size(); ++k)
    if (a.key_point[k].head<2>() != b.key_point[k].head<2>()) return false;
  return true;
}

namespace {

std::size_t held_bytes(const MaterialSpec& m) {
  std::size_t sum = hapsim::held_bytes(m.modulus) + hapsim::held_bytes(m.modulus_column) +
                    hapsim::held_bytes(m.given) + hapsim::held_bytes(m.key_point) +
                    hapsim::held_bytes(m.key_region) + m.features.capacity() * sizeof(FeatureSpec);
  for (const FeatureSpec& f : m.features)
    sum += hapsim::held_bytes(f.feature.value) + hapsim::held_bytes(f.column);
  return sum;
}

}  // namespace

std::size_t held_bytes(const SolvedPlaces& solved) {
  return held_bytes(solved.material) + held_bytes(solved.solutions);
}

std::size_t held_bytes(const PreparedPlaces& prepared) {
  return held_bytes(prepared.positions) + held_bytes(prepared.contacts);
}

std::size_t held_bytes(const TorquePlaces& torques) {
  return held_bytes(torques.material) + hapsim::held_bytes(torques.nu) +
         hapsim::held_bytes(torques.solutions);
}

std::size_t held_bytes(const MarkerPlaces& markers) {
  return held_bytes(markers.material) + hapsim::held_bytes(markers.nu) +
         hapsim::held_bytes(markers.solutions);
}

SetupPlaces::SetupPlaces(std::shared_ptr<const ContactLibrary> library,
                         std::shared_ptr<const PreparedPlaces> prepared, double nu_low,
                         double nu_high)
    : library_(std::move(library)),
      prepared_(std::move(prepared)),
      nu_low_(nu_low),
      nu_high_(nu_high),
      content_(library_->content()) {
  content_.add(nu_low_);
  content_.add(nu_high_);
  for (const Vec3& p : positions()) content_.add(p.data(), 3 * sizeof(double));
}

template <class Value, class Make>
std::shared_ptr<const Value> SetupPlaces::kept(const std::string& about, const Make& make) const {
  ContentHash hash = content_;
  hash.add(about);
  const std::string key = hash.hex();
  if (auto known = library_->memo().find<Value>(key)) return known;
  std::shared_ptr<const Value> made = make();
  library_->memo().put(key, made);
  return made;
}

std::shared_ptr<const SetupPlaces> SetupPlaces::of(
    std::shared_ptr<const PreparedPlaces> prepared) const {
  return std::shared_ptr<const SetupPlaces>(
      new SetupPlaces(library_, std::move(prepared), nu_low_, nu_high_));
}

std::shared_ptr<const SetupPlaces> SetupPlaces::prepare(
    std::shared_ptr<const ContactLibrary> library, const std::vector<Vec3>& positions,
    double nu_low, double nu_high) {
  auto prepared = std::make_shared<const PreparedPlaces>(
      PreparedPlaces{positions, library->prepare(positions, nu_low, nu_high)});
  return std::shared_ptr<const SetupPlaces>(
      new SetupPlaces(std::move(library), std::move(prepared), nu_low, nu_high));
}

std::shared_ptr<const PreparedPlaces> SetupPlaces::prepare_at(
    const std::vector<Vec3>& positions) const {
  PreparedPlaces places{positions, library_->prepare(positions, nu_low_, nu_high_)};
  for (const PreparedContact& contact : places.contacts)
    if (!contact.unfit.empty())
      fail_numerics("where the body has moved", contact.unfit, "leave the place out");
  return std::make_shared<const PreparedPlaces>(std::move(places));
}

ToolStand SetupPlaces::stand(std::size_t place) const {
  const PreparedContact& contact = prepared_->contacts[place];
  return {contact.normal, height_between_plates(library_->surface(), contact.point, contact.normal,
                                                library_->tool_radius())};
}

std::shared_ptr<const SetupPlaces> SetupPlaces::with_positions(
    const std::vector<Vec3>& positions) const {
  return of(prepare_at(positions));
}

std::shared_ptr<const SetupPlaces> SetupPlaces::chosen(
    const std::vector<std::size_t>& places) const {
  PreparedPlaces some;
  for (const std::size_t p : places) {
    some.positions.push_back(positions()[p]);
    some.contacts.push_back(contacts()[p]);
  }
  return of(std::make_shared<const PreparedPlaces>(std::move(some)));
}

std::shared_ptr<const SetupPlaces> SetupPlaces::before_move(const MaterialSpec& m) const {
  if (!has_moved(m)) return shared_from_this();
  ContentHash move;
  move.add(m.shift.data(), 3 * sizeof(double));
  move.add(m.rotation.data(), 3 * sizeof(double));
  return of(kept<PreparedPlaces>(move.hex(), [&] {
    const Vec3 middle = middle_of(positions());
    std::vector<Vec3> there;
    for (const Vec3& p : positions()) there.push_back(moved_back(p, middle, m.shift, m.rotation));
    return prepare_at(there);
  }));
}

Material SetupPlaces::of_elements(const MaterialSpec& material) const {
  Material m;
  m.nu = material.nu;
  m.modulus.clear();
  for (const double modulus : material.modulus) m.modulus.push_back(modulus / material.modulus[0]);
  m.labels = labels_of(material);
  if (has_key_regions(material))
    m.group_of = [&material](const Vec3& p) { return region_at(material, p); };
  for (const FeatureSpec& f : material.features) m.features.push_back(f.feature);
  return m;
}

std::shared_ptr<const SolvedPlaces> SetupPlaces::solve(const MaterialSpec& material) const {
  return kept<SolvedPlaces>(content(material), [&] {
    const Material m = of_elements(material);
    auto solved = std::make_shared<SolvedPlaces>();
    solved->material = material;
    solved->material.modulus = m.modulus;
    solved->solutions = library_->solve(positions(), contacts(), m, layout(material).hex());
    return solved;
  });
}

std::shared_ptr<const TorquePlaces> SetupPlaces::torques(const MaterialSpec& material,
                                                         bool regions) const {
  const bool apart = regions && has_regions(material);
  if (apart) refuse_growth(material, "the tool's torque");
  return kept<TorquePlaces>(apart ? "torque " + content(material) : "torque", [&] {
    auto made = std::make_shared<TorquePlaces>();
    made->material = material;
    if (apart) {
      const Material m = of_elements(material);
      made->material.modulus = m.modulus;
      made->nu = {material.nu};
      made->solutions = {library_->torques(positions(), m, layout(material).hex())};
      return made;
    }
    made->nu = poisson_nodes(nu_low_, nu_high_);
    for (const double nu : made->nu)
      made->solutions.push_back(
          library_->torques(positions(), {nu, {1.0}, nullptr, {}}, "homogeneous"));
    return made;
  });
}

std::shared_ptr<const MarkerPlaces> SetupPlaces::markers(const MaterialSpec& material, bool regions,
                                                         const std::vector<Vec3>& points) const {
  const bool apart = regions && has_regions(material);
  if (apart) refuse_growth(material, "marked points");
  ContentHash where;
  for (const Vec3& point : points) where.add(point.data(), 3 * sizeof(double));
  const std::string about = "markers " + where.hex();
  return kept<MarkerPlaces>(apart ? about + content(material) : about, [&] {
    auto made = std::make_shared<MarkerPlaces>();
    made->material = material;
    if (apart) {
      const Material m = of_elements(material);
      made->material.modulus = m.modulus;
      made->nu = {material.nu};
      made->solutions = {library_->markers(positions(), points, m, layout(material).hex())};
      return made;
    }
    made->nu = poisson_nodes(nu_low_, nu_high_);
    for (const double nu : made->nu)
      made->solutions.push_back(
          library_->markers(positions(), points, {nu, {1.0}, nullptr, {}}, "homogeneous"));
    return made;
  });
}

std::shared_ptr<const RegionShares> SetupPlaces::shares(const MaterialSpec& material) const {
  if (const auto labels = labels_of(material))
    return kept<RegionShares>(
        layout(material).hex() + std::to_string(material.modulus.size()), [&] {
          auto shares = std::make_shared<RegionShares>();
          for (const auto& estimate : *estimates())
            shares->push_back(estimate->shares(*labels, material.modulus.size()));
          return shares;
        });
  return kept<RegionShares>(layout(material).hex(), [&] {
    const PlanGrid grid = library_->grid();
    std::vector<int> region(static_cast<std::size_t>(grid.columns) * grid.rows);
    for (std::size_t c = 0; c < region.size(); ++c)
      region[c] = region_at(material, grid.centre(static_cast<int>(c)));
    auto shares = std::make_shared<RegionShares>();
    for (const PreparedContact& contact : contacts()) {
      std::vector<double> share(material.modulus.size(), 0.0);
      for (std::size_t c = 0; c < region.size(); ++c) share[region[c]] += contact.plan_share[c];
      shares->push_back(share);
    }
    return shares;
  });
}

std::shared_ptr<const FeatureEstimates> SetupPlaces::estimates() const {
  return kept<FeatureEstimates>("", [&] {
    return std::make_shared<const FeatureEstimates>(library_->estimates(positions()));
  });
}

}  // namespace hapsim
