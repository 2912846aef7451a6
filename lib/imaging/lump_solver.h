// What a ball inside a body does to the presses, by finite elements whose faces lie on it.
#pragma once

#include <vector>

#include "experiment/places.h"
#include "imaging/lump_fit.h"

namespace hapsim {

struct ImageView;

// A ball's surface: 80 triangles, the volume of the ball.
Surface ball_surface(const Vec3& centre, double radius);

class LumpSolver {
 public:
  // All are kept by reference. `places` gives the positions, `base` is of their body.
  LumpSolver(const ContactBase& base, const Places& places, double tool_radius, double nu,
             const std::vector<ImageView>& views, int threads);
  // As BallSolver: one mesh a position, solved without the ball and for each ratio, so that the
  // mesh's own error falls out.
  Eigen::MatrixXd operator()(const Vec3& centre, double radius, const std::vector<double>& ratios,
                             const std::vector<int>& positions) const;

 private:
  // K over that of the body without the ball, as what the views see of it.
  void solve(int position, const Vec3& centre, double radius, const std::vector<double>& ratios,
             Eigen::MatrixXd& gains) const;

  const ContactBase& base_;
  const Places& places_;
  double tool_radius_, nu_;
  const std::vector<ImageView>& views_;
  int threads_;
};

}  // namespace hapsim
