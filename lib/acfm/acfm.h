// The analytical contact force model: springs and dashpots at known positions, interpolated
// between.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "base/vec3.h"
#include "io/metadata.h"
#include "io/stream.h"

namespace hapsim {

// One direction: f = -(ks q + sum_i h_i), dh_i/dt = k_i dq/dt - h_i / tau_i, a spring beside
// Maxwell elements (thesis (4.37) put right; its dashpots are d_i = k_i tau_i). q = u (e^(s |u|) -
// 1) / (s |u|), |u| of the whole displacement: u for s = 0, else quasi-linear viscoelasticity with
// the exponential response of tissue (Fung, Biomechanics, 1993, 7.5 and 7.6).
struct AcfmAxis {
  static constexpr int kMostTerms = 8;
  static constexpr std::size_t kStiffening = 1 + 2 * kMostTerms;
  // ks, k1, tau1, k2, tau2, ... [N/m], [s], at the end s [1/m]; standard errors (NaN: none).
  std::array<double, kStiffening + 1> value{}, error{};
  bool derived = false;  // the data did not move this way: put together from the other axes

  double spring() const { return value[0]; }
  double stiffening() const { return value[kStiffening]; }
  double k(int term) const { return value[static_cast<std::size_t>(2 * term + 1)]; }
  double tau(int term) const { return value[static_cast<std::size_t>(2 * term + 2)]; }
};

// Axes along two tangents and the normal: those of acfm_frame().
struct SubModel {
  Vec3 point = Vec3::Zero();     // [m]
  Vec3 normal = Vec3::UnitZ();   // outward, unit
  std::array<AcfmAxis, 3> axis;  // t1, t2, n
};

// q over u, and its derivative by s, at a displacement of size r = |u|.
struct Stiffening {
  double factor = 1, slope = 0;
};
Stiffening stiffening_at(double s, double r);

// Columns t1, t2, n: the global axes turned by the shortest way that takes z to the normal.
Eigen::Matrix3d acfm_frame(const Vec3& normal);

struct Acfm {
  Metadata metadata;
  int terms = 0;
  std::vector<SubModel> positions;  // at least one

  // The sub-model anywhere: springs, stiffening and normals averaged, relaxation times
  // geometrically, over the nearest kNeighbours positions by weights (1/d - 1/R)^2, R the distance
  // of the next one: thesis (4.19) with weights that fall with the distance, to zero where a
  // position drops out, so that the force is continuous (Franke and Nielson, Int. J. Numer. Methods
  // Eng. 15, 1980). Exact at the positions. Allocates nothing.
  SubModel at(const Vec3& point) const noexcept;
  static constexpr int kNeighbours = 6;
};

// Table position,x,y,z,nx,ny,nz,axis,parameter,value,unit,std_error,state: one row a parameter (ks,
// k1, tau1, ..., and s where it is not 0) of an axis (t1, t2, n) at a position; state free or
// derived. Error(kBadInput) with line: a row twice, missing or out of bounds, positions that differ
// in their terms.
Acfm read_acfm(Input& input);
void write_acfm(std::ostream& out, const Acfm& model);
// Whether a table is one of these and not a model.csv, by its columns.
bool is_acfm(const std::string& bytes);

}  // namespace hapsim
