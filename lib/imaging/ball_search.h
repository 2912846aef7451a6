// Balls of another modulus inside a body that explain what each press asks for.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "contact/contact_library.h"
#include "contact/field_stiffness.h"

namespace hapsim {

// One ball of another modulus that explains the presses better than no ball: its centre with the
// standard errors along x, y, z, its radius and the ratio of its modulus, which trade for each
// other.
struct FoundBall {
  Vec3 centre = Vec3::Zero(), error = Vec3::Zero();
  double depth = 0, depth_error = 0;  // of the centre below the surface [m]
  double radius = 0, ratio = 1;
  double drop = 0;  // of chi^2
};

// Down to which depth of its centre a ball changes the gains by kSeen standard errors: four, since
// hundreds of places of a ball are asked, of which chance gives some three.
struct Sight {
  double radius = 0, ratio = 1, depth = 0;  // [m]; depth 0: nowhere
};
constexpr double kSeen = 4;

struct BallSearch {
  std::vector<FoundBall> balls;  // strongest first; none: nothing compact is seen
  std::vector<Sight> sight;
  Eigen::VectorXd errors;  // relative standard error of each gain, with what the best ball leaves
  double error = 0;        // their root mean square
  double misfit_before = 0, held_out_before = 0;  // of the log gains without balls or field
};

struct BallScene {
  const std::vector<PreparedContact>& contacts;
  const Surface& surface;    // of the body
  double tool_radius = 0;    // [m]
  double largest_depth = 0;  // [m]
};

// `J`: derivatives of the log gains `data` by log E at the nodes of the grid; `noise`: their
// standard errors. A ball of ratio q counts as (q - 1) / (1 + 0.4 (q - 1)) of its volume, for
// inside a stiff ball the strain falls (Eshelby, Proc. R. Soc. A 241, 1957, nearly incompressible).
// Balls are looked for one after the other under the presses; each must drop chi^2 by 30 (a further
// one also by what the linear signal of the first may miss) at errors that grow until the best ball
// leaves no misfit, and lies wholly inside the body.
BallSearch search_balls(const Eigen::MatrixXd& J, const FieldGrid& grid,
                        const Eigen::VectorXd& data, const Eigen::VectorXd& noise,
                        const BallScene& scene);

}  // namespace hapsim
