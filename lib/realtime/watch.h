// A model that notices that the world has changed, says how, and goes on with what it has learned.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "realtime/force_loop.h"
#include "realtime/motion_source.h"

namespace hapsim {

enum class Change { kNone, kMoved, kGone, kMaterial, kSensor, kUnexplained };
std::string change_name(Change change);  // "moved", "gone", "material", "sensor", "unexplained"

struct WatchOptions {
  double rate = 1000;         // samples a second
  double false_alarms = 0.1;  // an hour, while nothing changes
  double block = 0.05;        // samples of this time are one step of the test [s]
  double learning = 5;        // time in contact in which the usual error is learned [s]
  double evidence = 0.5;      // time in contact from the change on before it is named [s]
  double blend = 0.05;        // over which the new model takes over [s]
  bool adapts = true;         // false: alarms are told, the model stays
};

// What the model is corrected by.
struct Correction {
  double stiffness = 1;       // of all moduli
  Vec3 bias = Vec3::Zero();   // of the sensor [N]
  Vec3 shift = Vec3::Zero();  // of the body [m]
  bool gone = false;
};

struct WatchEvent {
  double begun = 0, alarm = 0, named = 0;  // times [s] of the stream: change, alarm, verdict
  Change change = Change::kNone;
  Correction correction;    // in all, from now on
  double error_before = 0;  // usual error [N]
  double error_with = 0;    // of the samples since the change, corrected [N]
};

// Forces of a model beside measured ones, sample by sample (thesis 5.6, Algorithm 5.9). Residuals
// over their usual size (noise and a share of the force, learned at the start) make the cube root
// of the mean square of a block, which is nearly normal (Wilson and Hilferty, 1931); its cumulative
// sum above half a standard deviation (Page, Biometrika 41, 1954) raises the alarm at the limit
// that Siegmund's formula gives for the false-alarm rate (Sequential Analysis, 1985, 2.56). The
// samples since the change are then explained by each hypothesis: body moved, gone, all moduli
// changed, sensor's zero changed; the one with the least chi-square plus log n a parameter is
// believed, as in the diagnosis of whole recordings. Not real-time where it names (some 50 ms, in
// that step alone).
class ModelWatch {
 public:
  // `body` outlives it.
  ModelWatch(const PreparedBody& body, const WatchOptions& options);

  // The next sample with its measured force. The model's force for it, by what is known so far [N].
  Vec3 step(const MotionLine& line, const Vec3& measured);
  const std::vector<WatchEvent>& events() const { return events_; }
  bool learned() const { return learned_; }
  double usual_error() const;  // root mean square of a component in contact [N]; after learning
  double limit() const { return limit_; }

 private:
  struct Sample {
    MotionLine line;
    Vec3 measured = Vec3::Zero(), model = Vec3::Zero();
    bool counted = true;  // false: before the change, for what the body remembers
  };
  // The model under a correction along a motion.
  class Model;

  double size(const Vec3& force) const;  // usual size of a residual component there [N]
  void learn();
  void end_block(double t);
  void name();
  std::vector<Vec3> forces(const std::vector<Sample>& window, const Correction& c) const;
  double chi_square(const std::vector<Sample>& window, const Correction& c) const;
  Correction fit_moved(const std::vector<Sample>& window) const;

  const PreparedBody& body_;
  WatchOptions options_;
  double limit_ = 0;
  ForceLoop loop_, before_;
  Correction correction_, old_;
  double share_ = 1;  // of the new correction in the model's force
  std::int32_t press_ = 0;
  bool first_ = true;
  double noise_ = 0, floor_ = 0, mean_ = 1, deviation_ = 1;  // learned
  bool learned_ = false;
  std::vector<Sample> kept_;                  // ring
  std::size_t count_ = 0;                     // samples so far
  std::vector<std::array<double, 2>> usual_;  // squared force and squared residual, while learning
  std::vector<double> blocks_;
  double block_squares_ = 0;
  long block_samples_ = 0, in_contact_ = 0;
  double sum_ = 0;          // of the test
  std::size_t change_ = 0;  // sample at which the sum was last zero
  double alarm_ = -1;
  std::size_t waits_until_ = 0;
  std::vector<WatchEvent> events_;
};

}  // namespace hapsim
