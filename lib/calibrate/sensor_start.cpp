#include "calibrate/sensor_start.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace hapsim {
namespace {

struct Alignment {
  SensorState state;
  double misfit = 0;  // sum of squares [N2]
};

// For a tool of one kilogram, or of `mass` beside loads or where it is known.
Alignment aligned(const StaticPoses& poses, double mass, bool gain_is_free,
                  const SensorState& start) {
  const auto n = static_cast<double>(poses.poses.size());
  Vec3 mean_f = Vec3::Zero(), mean_w = Vec3::Zero();
  std::vector<Vec3> weight;
  for (const StaticPose& p : poses.poses) {
    weight.push_back((mass + p.load) * (p.orientation.transpose() * start.gravity));
    mean_w += weight.back() / n;
    mean_f += p.force / n;
  }
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  double ff = 0, ww = 0;
  for (std::size_t i = 0; i < weight.size(); ++i) {
    const Vec3 f = poses.poses[i].force - mean_f, w = weight[i] - mean_w;
    H += f * w.transpose();
    ff += f.squaredNorm();
    ww += w.squaredNorm();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3 s = svd.singularValues();
  const double hand = svd.matrixU().determinant() * svd.matrixV().determinant();
  // Mirrored in space, not by the noise of poses in a plane.
  constexpr double kPlane = 0.02;
  const bool mirrored = hand < 0 && s[2] > kPlane * s[0];
  Vec3 d(1, 1, mirrored ? 1 : hand);
  Alignment result{start, 0};
  SensorState& state = result.state;
  state.sign = mirrored ? -1 : 1;
  state.rotation = state.sign * svd.matrixU() * d.asDiagonal() * svd.matrixV().transpose();
  const double gain = ww > 0 ? s.dot(d) / ww : 1;
  state.mass = gain_is_free ? mass : gain * mass;
  const double kept = gain_is_free ? gain : 1;
  state.crosstalk = state.sign * kept * Eigen::Matrix3d::Identity();
  state.offset = mean_f - state.sign * gain * (state.rotation * mean_w);
  result.misfit = ff - gain * gain * ww;
  return result;
}

}  // namespace

SensorState closed_form(const StaticPoses& poses, Scale scale, const SensorState& start) {
  if (scale == Scale::kMeanGain) return aligned(poses, 1, false, start).state;
  if (scale == Scale::kKnownMass) return aligned(poses, start.mass, true, start).state;
  double largest = 0;
  for (const StaticPose& p : poses.poses) largest = std::max(largest, p.load);
  Alignment best{start, std::numeric_limits<double>::infinity()};
  for (double mass = 1e-3 * largest; mass < 1e3 * largest; mass *= 1.1)
    if (const Alignment a = aligned(poses, mass, true, start); a.misfit < best.misfit) best = a;
  return best.state;
}

}  // namespace hapsim
