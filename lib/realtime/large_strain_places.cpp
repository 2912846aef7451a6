// What samples of large strain say of each other, and of the places between them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "estimate/kriging.h"
#include "realtime/large_strain.h"
#include "realtime/least_turn.h"

namespace hapsim {
namespace {

using Coordinates = Eigen::Matrix<double, 9, 1>;

constexpr double kOtherWay = 0.2;  // normals of less cosine have nothing in common
// Of what is beyond the linear force: what its meshes leave (solve_strain_sample()).
constexpr double kStrainMesh = 0.0075;
// Displacements at which places are compared, (d, p, q) over the radius, up to a depth and as far
// aside as strain_side() has it.
std::vector<Vec3> probes(double into, double aside) {
  std::vector<Vec3> all;
  for (const double share : {0.2, 0.4, 0.6, 0.8, 1.0}) {
    const double d = share * into;
    all.emplace_back(d, 0, 0);
    for (int k = 0; k < 6; ++k) {
      const double angle = k * std::numbers::pi / 3,
                   side = strain_side(d, aside) * (k % 2 == 0 ? 1 : 0.5);
      all.emplace_back(d, side * std::cos(angle), side * std::sin(angle));
    }
  }
  return all;
}

// What a sample has beyond the linear force whichever way its frame is turned: along the normal at
// half of and all `into`, and along a way sideways, the mean of six, at the same depths.
Eigen::Vector4d invariants(const StrainSample& s, double into, double aside) {
  Eigen::Vector4d result = Eigen::Vector4d::Zero();
  for (int half = 0; half < 2; ++half) {
    const double d = into * (half == 0 ? 0.5 : 1);
    result[half] = strain_gradient(s.c, {d, 0, 0})[0];
    for (int k = 0; k < 6; ++k) {
      const double angle = k * std::numbers::pi / 3;
      const Vec3 way(0, std::cos(angle), std::sin(angle));
      result[2 + half] +=
          way.dot(strain_gradient(s.c, Vec3(d, 0, 0) + strain_side(d, aside) * way)) / 6;
    }
  }
  return result;
}

// At a share of `into`; none at none.
double mesh_doubt(const StrainMeshError& error, double share) noexcept {
  constexpr double kOfDifference = 0.5;  // so that 95 in 100 are within the difference
  const double at = std::clamp(share, 0.0, 1.0) * kStrainDepths;
  const auto above = std::min<std::size_t>(static_cast<std::size_t>(at), kStrainDepths - 1);
  const double below = above > 0 ? error[above - 1] : 0;
  return kOfDifference * (below + (at - static_cast<double>(above)) * (error[above] - below));
}

}  // namespace

// Place over the radius, normal, and of the stiffness logarithms and how it couples.
Coordinates LargeStrain::coordinates(const StepPlace& place) const noexcept {
  const Eigen::Matrix3d& K = place.contact.K;
  const Vec3& n = place.normal;
  const Vec3 along = K * n;
  const double k = n.dot(along), across = (K.trace() - k) / 2;
  Coordinates c;
  c.segment<3>(0) = place.point / options_.tool_radius;
  c.segment<3>(3) = n;
  c[6] = std::log(k / (place.contact.modulus * options_.tool_radius));
  c[7] = std::log(across / k);
  c[8] = (along - k * n).norm() / k;
  return c;
}

double LargeStrain::covariance(const Coordinates& a, const Coordinates& b) const noexcept {
  double all = 0, last = 0;
  for (int g = 0; g < 3; ++g) {
    last = (a - b).segment<3>(3 * g).squaredNorm();
    all += last / (length_[static_cast<std::size_t>(g)] * length_[static_cast<std::size_t>(g)]);
  }
  return (1 - second_) * matern(all) + second_ * matern(last / (length_[3] * length_[3]));
}

// The process, and what samples say of those left out.
void LargeStrain::relate() {
  const std::size_t n = samples_.size();
  const auto rows = static_cast<Eigen::Index>(n);
  double into = kDeepest, aside = 1;
  mesh_ = {};
  for (const Known& k : samples_) {
    into = std::min(into, k.sample.into);
    aside = std::min(aside, k.sample.aside);
    for (std::size_t d = 0; k.sample.finer && d < kStrainDepths; ++d)
      mesh_[d] = std::max(mesh_[d], (*k.sample.finer)[d]);
  }
  KrigingCoordinates where{Eigen::MatrixXd(rows, 9), {3, 6, 9}};
  Eigen::MatrixXd values(rows, 4);
  for (std::size_t i = 0; i < n; ++i) {
    where.rows.row(static_cast<Eigen::Index>(i)) = samples_[i].at.transpose();
    values.row(static_cast<Eigen::Index>(i)) =
        invariants(samples_[i].sample, into, aside).transpose();
  }
  values.rowwise() -= values.colwise().mean().eval();
  const KrigingScales scales = Kriging(where, values).scales();
  for (std::size_t g = 0; g < 4; ++g) length_[g] = scales.length[g];
  second_ = scales.second;
  nugget_ = scales.nugget;
  inverse_ = Kriging(where, Eigen::MatrixXd::Identity(rows, rows), &scales).weights();

  variance_ = 1;
  double squares = 0, relative = 0, count = 0;
  std::vector<double> weight(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const double own = inverse_(row, row);
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) {
      weight[j] = j == i ? 0 : -inverse_(row, static_cast<Eigen::Index>(j)) / own;
      sum += weight[j];
    }
    for (std::size_t j = 0; j < n; ++j)
      if (j != i) weight[j] += (1 - sum) / static_cast<double>(n - 1);
    const Known& known = samples_[i];
    StepPlace at;
    at.point = known.sample.point;
    at.normal = known.normal;
    at.contact.K = known.sample.K;
    Place place;
    neighbours(weight.data(), at, place);
    Place itself = place;
    itself.count = 1;
    itself.sample[0] = static_cast<int>(i);
    itself.weight[0] = 1;
    itself.A[0] = known.sample.frame / options_.tool_radius;
    const std::vector<Vec3> ways =
        probes(std::min(known.sample.into, place.into / options_.tool_radius),
               std::min(known.sample.aside, place.aside));
    std::vector<Vec3> f;
    double largest = 0;
    for (const Vec3& v : ways) {
      f.push_back(force(itself, options_.tool_radius * known.sample.frame.transpose() * v).f);
      largest = std::max(largest, f.back().norm());
    }
    double off = 0, beyond = 0;
    for (std::size_t k = 0; k < ways.size(); ++k) {
      const Vec3 u = options_.tool_radius * known.sample.frame.transpose() * ways[k];
      const double error = (force(place, u).f - f[k]).norm();
      relative += std::pow(error / std::max(f[k].norm(), 0.05 * largest), 2);
      off += error * error;
      beyond += (f[k] - at.contact.K * u).squaredNorm();
      ++count;
    }
    squares += off / std::max(beyond, 1e-300) * own;
  }
  variance_ = squares / static_cast<double>(n);
  left_out_ = std::sqrt(relative / count);
}

// The largest weights, made to sum to one, of samples that face nearly that way.
void LargeStrain::neighbours(const double* weight, const StepPlace& at,
                             Place& place) const noexcept {
  place.count = 0;
  place.K = at.contact.K;
  place.normal = at.normal;
  place.stiffness = at.normal.dot(at.contact.K * at.normal);
  double sum = 0;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (weight[i] == 0 || samples_[i].normal.dot(at.normal) < kOtherWay) continue;
    int slot = place.count;
    if (slot == kMostNeighbours) {
      slot = 0;
      for (int k = 1; k < kMostNeighbours; ++k)
        if (std::abs(place.weight[k]) < std::abs(place.weight[slot])) slot = k;
      if (std::abs(weight[i]) <= std::abs(place.weight[slot])) continue;
      sum -= place.weight[slot];
    } else {
      ++place.count;
    }
    place.sample[slot] = static_cast<int>(i);
    place.weight[slot] = weight[i];
    sum += weight[i];
  }
  if (!(std::abs(sum) > 0.1)) place.count = 0;  // nothing is known: the linear law
  place.into = place.count > 0 ? kDeepest : 0;
  place.fit = place.memory = 0;
  place.aside = 1;
  for (int k = 0; k < place.count; ++k) {
    place.weight[k] /= sum;
    const Known& known = samples_[static_cast<std::size_t>(place.sample[k])];
    place.A[k] = known.sample.frame * least_turn(at.normal, known.normal) / options_.tool_radius;
    place.fit += std::abs(place.weight[k]) * known.sample.fit;
    place.memory += std::abs(place.weight[k]) * known.sample.memory_fit;
    if (std::abs(place.weight[k]) <= 0.05) continue;
    place.into = std::min(place.into, known.sample.into);
    place.aside = std::min(place.aside, known.sample.aside);
  }
  place.into *= options_.tool_radius;
}

LargeStrain::Place LargeStrain::at(const StepPlace& at) const noexcept {
  const Coordinates c = coordinates(at);
  std::array<double, kMostSamples> with, weight;
  const std::size_t n = samples_.size();
  for (std::size_t i = 0; i < n; ++i) with[i] = covariance(c, samples_[i].at);
  double sum = 0, known = 0;
  const Eigen::Map<const Eigen::VectorXd> vector(with.data(), static_cast<Eigen::Index>(n));
  for (std::size_t i = 0; i < n; ++i) {
    weight[i] = inverse_.row(static_cast<Eigen::Index>(i)).dot(vector);
    sum += weight[i];
    known += weight[i] * with[i];
  }
  for (std::size_t i = 0; i < n; ++i) weight[i] += (1 - sum) / static_cast<double>(n);
  Place place;
  neighbours(weight.data(), at, place);
  place.doubt =
      std::sqrt(variance_ * std::max(1 - known + nugget_, nugget_) + kStrainMesh * kStrainMesh);
  return place;
}

LargeStrain::Held LargeStrain::hold(const Place& place, const Vec3& u) const noexcept {
  const double a = options_.tool_radius, d = -u.dot(place.normal);
  const double into = std::clamp(d, 0.0, place.into);
  const Vec3 along = u + d * place.normal;
  const double side = along.norm(), most = a * strain_side(into / a, place.aside);
  const Vec3 near = side > most ? Vec3(along * (most / side)) : along;
  const Vec3 held = near - into * place.normal;
  return {held, u - held, d, into, side, most};
}

LargeStrain::Force LargeStrain::force(const Place& place, const Vec3& u) const noexcept {
  const double a = options_.tool_radius;
  const auto [held, rest, d, into, side, most] = hold(place, u);
  Force result;
  // Pulls were not sampled: the linear force holds for small ones.
  result.within =
      rest.squaredNorm() <= 1e-20 * a * a || (d < 0 && -d <= kLinearPull * a && side <= most);
  const Vec3 linear = place.K * u;
  Vec3 beyond = Vec3::Zero();
  for (int k = 0; k < place.count; ++k) {
    const StrainCoefficients& c = samples_[static_cast<std::size_t>(place.sample[k])].sample.c;
    const Vec3 v = place.A[k] * held;
    Vec3 g = strain_gradient(c, v);
    if (!rest.isZero(0)) g += strain_hessian(c, v) * (place.A[k] * rest);
    beyond += place.weight[k] * (place.A[k].transpose() * g);
  }
  beyond *= place.stiffness * a * a;
  result.f = linear + beyond;
  result.beyond = beyond;
  const double size = result.f.norm();
  const double mesh = place.into > 0 ? mesh_doubt(mesh_, into / place.into) : 0;
  if (size > 0) result.doubt = std::hypot(place.fit, place.doubt * beyond.norm() / size, mesh);
  if (size > 0 && (d < 0 || !result.within)) {  // the tangent may be off by all of what it adds
    const double share = d < 0 && side <= most ? std::min(1.0, -d / a) : 1;
    result.doubt = std::hypot(result.doubt, share * (place.K * rest).norm() / size);
  }
  return result;
}

Eigen::Matrix3d LargeStrain::tangent(const Place& place, const Vec3& u) const noexcept {
  const Held at = hold(place, u);
  Eigen::Matrix3d beyond = Eigen::Matrix3d::Zero();
  for (int k = 0; k < place.count; ++k) {
    const StrainCoefficients& c = samples_[static_cast<std::size_t>(place.sample[k])].sample.c;
    beyond += place.weight[k] *
              (place.A[k].transpose() * strain_hessian(c, place.A[k] * at.held) * place.A[k]);
  }
  return place.K + place.stiffness * options_.tool_radius * options_.tool_radius * beyond;
}

double LargeStrain::energy(const Place& place, const Vec3& u) const noexcept {
  // The line from no displacement, by Gauss-Legendre: exact for the polynomials' degree.
  constexpr std::array<double, 5> x{0, -0.5384693101056831, 0.5384693101056831, -0.9061798459386640,
                                    0.9061798459386640};
  constexpr std::array<double, 5> w{0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                    0.2369268850561891, 0.2369268850561891};
  double sum = 0;
  for (std::size_t k = 0; k < x.size(); ++k)
    sum += w[k] / 2 * force(place, (0.5 + x[k] / 2) * u).f.dot(u);
  return sum;
}

}  // namespace hapsim
