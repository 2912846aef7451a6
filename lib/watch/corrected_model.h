// The forces of a model whose body has changed since: corrected, not solved again.
#pragma once

#include <vector>

#include "realtime/force_loop.h"
#include "realtime/motion_source.h"
#include "watch/surface_offsets.h"

namespace hapsim {

// What the model is corrected by.
struct Correction {
  double stiffness = 1;       // of all moduli
  double relaxation = 1;      // of the Maxwell elements' moduli, beside that
  double slowness = 1;        // of their times
  Vec3 bias = Vec3::Zero();   // of the sensor [N]
  Vec3 shift = Vec3::Zero();  // of the body [m]
  bool gone = false;
};

class CorrectedModel {
 public:
  // Both outlive it.
  CorrectedModel(const PreparedBody& body, const SurfaceOffsets& offsets);
  // Force on the tool [N]; `fresh`: the first sample of a press. Of a body that has moved the
  // contact is found anew, by the tip's position against the body's.
  // `gap`: the surface lies so much further out than known, at this press [m].
  Vec3 step(const MotionLine& line, bool fresh, const Correction& c, double gap = 0);
  void take_state(const CorrectedModel& other);
  // Relative standard uncertainty of the force that the place leaves.
  double uncertainty() const { return loop_.uncertainty(); }

 private:
  void touch_between(double t, const Vec3& tool);

  const PreparedBody& body_;
  ForceLoop loop_;
  const SurfaceOffsets& offsets_;
  double last_t_ = 0;
  Vec3 last_tool_ = Vec3::Zero();
  Vec3 offset_ = Vec3::Zero();  // where this press touches
};

// A row of the stream, as explanations of a change are tried on it.
struct WatchedSample {
  MotionLine line;
  Vec3 measured = Vec3::Zero(), model = Vec3::Zero();
  double size = 1;      // usual size of a residual component for such a measured force [N]
  bool counted = true;  // false: before the change, for what the body remembers
};

// `gaps`: one a press of the window, or empty.
std::vector<Vec3> corrected_forces(const PreparedBody& body, const SurfaceOffsets& offsets,
                                   const std::vector<WatchedSample>& window, const Correction& c,
                                   const std::vector<double>& gaps = {});
// The press, counted from 0, of each sample.
std::vector<std::size_t> press_indices(const std::vector<WatchedSample>& window);
// Of the counted samples; error_of: root mean square of a residual component [N].
double error_of(const std::vector<WatchedSample>& window, const std::vector<Vec3>& forces);
double chi_square(const std::vector<WatchedSample>& window, const std::vector<Vec3>& forces);

}  // namespace hapsim
