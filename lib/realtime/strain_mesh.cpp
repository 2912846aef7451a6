#include "realtime/strain_mesh.h"

#include <algorithm>

#include "base/error.h"

namespace hapsim {

FullOptions strain_elements(const ContactBase& base, double finer) {
  constexpr double kStrainRim = 0.5, kStrainGrowth = 0.6;
  FullOptions options;
  options.rim_edge = finer * kStrainRim;
  options.growth = finer * kStrainGrowth;
  options.quarter_points = false;
  options.solve.past_instability = true;
  options.base = &base;
  return options;
}

StrainMeshError strain_mesh_error(const TetMesh& body, const ContactBase& base, const Model& model,
                                  const StrainSample& sample, double tool_radius) {
  constexpr double kFiner = 2.0 / 3, kUnknown = 0.2, kLeastStep = 1.0 / 32;
  FullOptions options = strain_elements(base, kFiner);
  options.solve.least_step = kLeastStep;
  StrainMeshError error{};
  const Eigen::Matrix3d own = sample.frame * sample.K * sample.frame.transpose();
  for (const double share : {0.0, 0.5}) {
    int step = 0;
    try {
      FullPress press(body, model, sample.point, tool_radius, options);
      const std::optional<Eigen::Matrix3d> K = press.stiffness();
      for (; K && step < kStrainDepths; ++step) {
        const double d = sample.into * (step + 1) / kStrainDepths;
        const Vec3 v(d, share * strain_side(d, sample.aside), 0);
        const Vec3 f = own * v / own(0, 0) + strain_gradient(sample.c, v),
                   finer = -sample.frame *
                           press.step(tool_radius * sample.frame.transpose() * v, 0) /
                           (press.normal().dot(*K * press.normal()) * tool_radius);
        double& worst = error[static_cast<std::size_t>(step)];
        worst = std::max(worst, (finer - f).norm() / f.norm());
      }
    } catch (const Error& failed) {  // finer elements do not hold, or do not fit there
      if (failed.code() != ExitCode::kNoConvergence && failed.code() != ExitCode::kBadInput) throw;
    }
    for (; step < kStrainDepths; ++step) {
      double& worst = error[static_cast<std::size_t>(step)];
      worst = std::max(worst, kUnknown);
    }
  }
  return error;
}

}  // namespace hapsim
