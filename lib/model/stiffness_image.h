// Stiffness imaging: where inside a body the modulus differs, from all presses at once.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "estimate/regularised.h"
#include "fem/field_stiffness.h"
#include "model/forces.h"

namespace hapsim {

// What the presses in one direction at one position ask for.
struct ImageView {
  int position = 0;
  Eigen::Matrix3d B;  // the gain of a stiffness K is tr(K B); B has the model's own K in it
  double gain = 1;    // measured over the model's force
  double error = 0;   // its standard error, of the noise alone
};

struct ImageOptions {
  int threads = 0;
  double step = 0;  // of the finer grid [m]; 0: 0.7 tool radii
  Penalty penalty = Penalty::kTotalVariation;
  double largest_depth = 0;        // [m]; 0: 15 tool radii
  std::function<void()> progress;  // once a position is done
};

// One ball of another modulus that explains the presses better than no ball: its centre with the
// standard errors along x, y, z, its radius and the ratio of its modulus, which trade for each
// other.
struct FoundBall {
  Vec3 centre = Vec3::Zero(), error = Vec3::Zero();
  double depth = 0, depth_error = 0;  // of the centre below the surface [m]
  double radius = 0, ratio = 1;
  double drop = 0;  // of chi^2
};

// Down to which depth of its centre a ball changes the gains by kSeen standard errors.
struct Sight {
  double radius = 0, ratio = 1, depth = 0;  // [m]; depth 0: nowhere
};
constexpr double kSeen = 4;

struct StiffnessImage {
  FieldGrid grid;             // of the field
  Eigen::VectorXd log_ratio;  // log of the modulus over the model's, at the grid's nodes
  double error = 0;           // relative standard error of a gain, with what the fit leaves
  double misfit_before = 0, misfit = 0;      // root mean square of the log gains: none, field
  double held_out_before = 0, held_out = 0;  // the same for positions left out
  double weight = 0;                         // of the penalty
  std::vector<FoundBall> balls;              // strongest first; none: nothing compact is seen
  std::vector<Sight> sight;
  std::size_t views = 0;
};

// Gains by position and direction (presses within 15 degrees are one view) by regression on the
// model's forces; effects of the sensor are kept.
std::vector<ImageView> image_views(const Model& model, const Dataset& dataset,
                                   const BodyStiffness& body, double noise);

// The sensitivities of all gains are the energies of the unit fields in every element: one solution
// a position on the body of `model` with its modulus alone, linear from there on. A ball of ratio q
// counts as (q - 1) / (1 + 0.4 (q - 1)) of its volume, for inside a stiff ball the strain falls
// (Eshelby, Proc. R. Soc. A 241, 1957, nearly incompressible). The field is regularised by
// solve_field(), its penalty drawn down with the sensitivity so that depth is not punished; balls
// are looked for one after the other on the finer grid, each must drop chi^2 by 30 (a further
// one also by what the linear signal of the first may miss) at errors that grow until the best ball
// leaves no misfit, and lies wholly inside the body.
// `noise` [N].
StiffnessImage stiffness_image(const Model& model, const Dataset& dataset,
                               const BodyStiffness& stiffness, const TetMesh& body, double noise,
                               const ImageOptions& options);

// In words: what was found and how deep these presses see.
std::vector<std::string> words_of(const StiffnessImage& image);

// The modulus over the model's at a point: the balls', or where none was found the field's.
double modulus_ratio(const StiffnessImage& image, const Vec3& p);

}  // namespace hapsim
