#include "model/body_stiffness.h"

#include <algorithm>
#include <cmath>

#include "model/nearest_region.h"

namespace hapsim {
namespace {

std::string layout(const MaterialSpec& material) {
  ContentHash hash;
  for (std::size_t k = 0; k < material.key_point.size(); ++k) {
    hash.add(material.key_point[k].x());
    hash.add(material.key_point[k].y());
    hash.add(material.key_region[k]);
  }
  return hash.hex();
}

bool homogeneous(const MaterialSpec& material) {
  return material.key_point.empty() || material.modulus.size() == 1;
}

}  // namespace

BodyStiffness::BodyStiffness(const ContactLibrary& library, const std::vector<Vec3>& positions,
                             double nu_low, double nu_high)
    : library_(library),
      positions_(positions),
      contacts_(library.prepare(positions, nu_low, nu_high)) {}

PositionStiffness BodyStiffness::at(std::size_t position, const MaterialSpec& material) const {
  PositionStiffness result;
  const std::size_t regions = material.modulus.size();
  result.dK_dmodulus.assign(regions, Eigen::Matrix3d::Zero());
  if (!homogeneous(material) && !material.local && layout(material) == solved_layout_) {
    const StiffnessSolution& s = solutions_[position];
    result.dK_dnu = s.dK_dnu;
    result.K = (material.nu - solved_.nu) * s.dK_dnu;
    for (std::size_t g = 0; g < regions; ++g) {
      result.dK_dmodulus[g] = s.dK_dmodulus[g];
      result.K += material.modulus[g] * s.dK_dmodulus[g];
    }
    return result;
  }
  Eigen::Matrix3d unit, by_nu;
  contacts_[position].stiffness.evaluate(material.nu, unit, by_nu);
  double modulus = material.modulus[0];
  std::vector<double> share(regions, 0.0);
  share[0] = 1;
  if (material.local) {
    const auto region = static_cast<std::size_t>(region_at(material, positions_[position]));
    share[0] = 0;
    share[region] = 1;
    modulus = material.modulus[region];
  } else if (!homogeneous(material)) {
    share = shares(material)[position];
    double log_modulus = 0;
    for (std::size_t g = 0; g < regions; ++g)
      log_modulus += share[g] * std::log(material.modulus[g]);
    modulus = std::exp(log_modulus);
  }
  result.K = modulus * unit;
  result.dK_dnu = modulus * by_nu;
  for (std::size_t g = 0; g < regions; ++g)
    result.dK_dmodulus[g] = share[g] / material.modulus[g] * result.K;
  return result;
}

void BodyStiffness::solve(const MaterialSpec& material) {
  if (homogeneous(material) || material.local) return;
  Material m;
  m.nu = material.nu;
  m.modulus = material.modulus;
  m.group_of = [&material](const Vec3& p) { return region_at(material, p); };
  solutions_ = library_.solve(positions_, contacts_, m, layout(material));
  solved_ = material;
  solved_layout_ = layout(material);
}

const BodyStiffness::Shares& BodyStiffness::shares(const MaterialSpec& material) const {
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

std::vector<Vec3> BodyStiffness::normals() const {
  std::vector<Vec3> normals;
  for (const PreparedContact& c : contacts_) normals.push_back(c.normal);
  return normals;
}

double BodyStiffness::mesh_uncertainty() const {
  std::vector<double> values;
  for (const PreparedContact& c : contacts_) values.push_back(c.mesh_uncertainty);
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

}  // namespace hapsim
