#include "experiment/setup_stiffness.h"

#include <algorithm>
#include <cmath>

#include "experiment/extrapolate.h"
#include "experiment/nearest_region.h"

namespace hapsim {
namespace {

// What must be the same for one solution to be extrapolated to another material.
std::string layout(const MaterialSpec& material) {
  ContentHash hash;
  for (std::size_t k = 0; k < material.key_point.size(); ++k) {
    hash.add(material.key_point[k].x());
    hash.add(material.key_point[k].y());
    hash.add(material.key_region[k]);
  }
  for (const FeatureSpec& f : material.features) hash.add(static_cast<double>(f.feature.kind));
  return hash.hex();
}

bool has_regions(const MaterialSpec& material) {
  return !material.key_point.empty() && material.modulus.size() > 1 && !material.local;
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

// But for a common factor of the moduli, which needs no solution.
bool same(const MaterialSpec& a, const MaterialSpec& b) {
  bool equal = a.nu == b.nu && a.modulus.size() == b.modulus.size();
  for (std::size_t g = 0; equal && g < a.modulus.size(); ++g)
    equal = a.modulus[g] * b.modulus[0] == b.modulus[g] * a.modulus[0];
  for (std::size_t f = 0; f < a.features.size(); ++f)
    equal = equal && a.features[f].feature.value == b.features[f].feature.value;
  return equal;
}

}  // namespace

SetupStiffness::SetupStiffness(const ContactLibrary& library, const std::vector<Vec3>& positions,
                               double nu_low, double nu_high)
    : library_(library),
      positions_(positions),
      contacts_(library.prepare(positions, nu_low, nu_high)),
      nu_low_(nu_low),
      nu_high_(nu_high) {}

std::unique_ptr<SetupStiffness> SetupStiffness::with_positions(
    const std::vector<Vec3>& positions) const {
  return std::make_unique<SetupStiffness>(library_, positions, nu_low_, nu_high_);
}

const SetupStiffness& SetupStiffness::before_move(const MaterialSpec& m) const {
  const std::lock_guard lock(mutex_);
  std::unique_ptr<SetupStiffness>& body = moved_[{m.shift.x(), m.shift.y(), m.shift.z(),
                                                  m.rotation.x(), m.rotation.y(), m.rotation.z()}];
  if (!body) {
    const Vec3 middle = middle_of(positions_);
    std::vector<Vec3> there;
    for (const Vec3& p : positions_) there.push_back(moved_back(p, middle, m.shift, m.rotation));
    body = with_positions(there);
  }
  return *body;
}

SetupStiffness::ReferencePointer SetupStiffness::reference_for(const MaterialSpec& material) const {
  const std::lock_guard lock(mutex_);
  const auto found = references_.find(layout(material));
  if (found == references_.end()) return nullptr;
  for (const ReferencePointer& r : found->second)
    if (same(r->material, material)) return r;
  return found->second.back();
}

PositionStiffness SetupStiffness::at(std::size_t position, const MaterialSpec& material) const {
  if (has_moved(material)) {
    PositionStiffness s = before_move(material).at(position, in_place(material));
    const Eigen::Matrix3d R = rotation_matrix(material.rotation);
    s.K = (R * s.K * R.transpose()).eval();
    for (auto& [column, dK] : s.by_column) dK = (R * dK * R.transpose()).eval();
    return s;
  }
  if (material.local) {
    // As if all of the body had the contact's own modulus, to which all forces are proportional.
    const LocalModulus local = local_modulus(material, positions_[position]);
    MaterialSpec own = material;
    own.local = false;
    own.key_point.clear();
    own.key_region.clear();
    own.modulus = {local.value};
    own.modulus_column = {-1};
    PositionStiffness result = at(position, own);
    const Eigen::Matrix3d K = result.K;
    for (const auto& [region, share] : local.share) {
      const auto r = static_cast<std::size_t>(region);
      result.add(material.modulus_column[r], share / material.modulus[r] * K);
    }
    return result;
  }
  if (has_regions(material) || !material.features.empty()) {
    if (const ReferencePointer reference = reference_for(material))
      return extrapolated(reference->solutions[position], contacts_[position].stiffness,
                          reference->material, material);
    return estimated(position, material);
  }
  PositionStiffness result;
  Eigen::Matrix3d unit, by_nu;
  contacts_[position].stiffness.evaluate(material.nu, unit, by_nu);
  const double modulus = material.modulus.front();
  result.K = modulus * unit;
  result.add(material.nu_column, modulus * by_nu);
  result.add(material.modulus_column.front(), unit);
  return result;
}

PositionStiffness SetupStiffness::estimated(std::size_t position,
                                            const MaterialSpec& material) const {
  MaterialSpec known = material;
  while (!known.features.empty() && !reference_for(known)) known.features.pop_back();
  // Regions that nothing was solved for are the last thing to add.
  if (has_regions(material) && !reference_for(known)) return by_shares(position, material);
  {
    const std::lock_guard lock(mutex_);
    if (estimates_.empty()) estimates_ = library_.estimates(positions_);
  }
  PositionStiffness result = at(position, known);
  for (std::size_t f = known.features.size(); f < material.features.size(); ++f) {
    const FeatureSpec& feature = material.features[f];
    result = with_estimate(result, estimates_[position]->at(feature.feature), feature.column);
  }
  return result;
}

PositionStiffness SetupStiffness::by_shares(std::size_t position,
                                            const MaterialSpec& material) const {
  MaterialSpec plain = material;
  plain.key_point.clear();
  plain.key_region.clear();
  plain.modulus = {1.0};
  plain.modulus_column = {-1};
  PositionStiffness result = at(position, plain);
  const std::vector<double>& share = shares(material)[position];
  double log_modulus = 0;
  for (std::size_t g = 0; g < share.size(); ++g)
    log_modulus += share[g] * std::log(material.modulus[g]);
  const double modulus = std::exp(log_modulus);
  result.K *= modulus;
  for (auto& [column, dK] : result.by_column) dK *= modulus;
  for (std::size_t g = 0; g < share.size(); ++g)
    result.add(material.modulus_column[g], share[g] / material.modulus[g] * result.K);
  return result;
}

bool SetupStiffness::is_solved(const MaterialSpec& material) const {
  if (has_moved(material)) return before_move(material).is_solved(in_place(material));
  return reference_for(material) != nullptr;
}

void SetupStiffness::forget(const MaterialSpec& material) const {
  if (has_moved(material)) return before_move(material).forget(in_place(material));
  const std::lock_guard lock(mutex_);
  references_.erase(layout(material));
}

void SetupStiffness::solve(const MaterialSpec& material) const {
  if (has_moved(material)) return before_move(material).solve(in_place(material));
  if (!has_regions(material) && material.features.empty()) return;
  if (const ReferencePointer known = reference_for(material);
      known && same(known->material, material)) {
    const std::lock_guard lock(mutex_);
    references_[layout(material)].push_back(known);
    return;
  }
  Material m;
  m.nu = material.nu;
  m.modulus.clear();
  for (const double modulus : material.modulus) m.modulus.push_back(modulus / material.modulus[0]);
  if (has_regions(material))
    m.group_of = [&material](const Vec3& p) { return region_at(material, p); };
  for (const FeatureSpec& f : material.features) m.features.push_back(f.feature);
  auto reference = std::make_shared<Reference>();
  reference->material = material;
  reference->material.modulus = m.modulus;
  reference->solutions = library_.solve(positions_, contacts_, m, layout(material));
  const std::lock_guard lock(mutex_);
  references_[layout(material)].push_back(std::move(reference));
}

const SetupStiffness::Shares& SetupStiffness::shares(const MaterialSpec& material) const {
  const std::lock_guard lock(mutex_);
  const auto [entry, fresh] = shares_.try_emplace(layout(material));
  if (fresh) {
    const PlanGrid& grid = library_.grid();
    std::vector<int> region(static_cast<std::size_t>(grid.columns) * grid.rows);
    for (std::size_t c = 0; c < region.size(); ++c)
      region[c] = region_at(material, grid.centre(static_cast<int>(c)));
    for (const PreparedContact& contact : contacts_) {
      std::vector<double> share(material.modulus.size(), 0.0);
      for (std::size_t c = 0; c < region.size(); ++c) share[region[c]] += contact.plan_share[c];
      entry->second.push_back(share);
    }
  }
  return entry->second;
}

}  // namespace hapsim
