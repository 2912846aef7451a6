// Whether the residuals of a stream are still what they usually are.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

struct ChangeTestOptions {
  double rate = 1000;         // samples a second
  double false_alarms = 0.1;  // an hour, while nothing changes
  double block = 0.05;        // samples of this time are one step of the test [s]
  double learning = 5;        // time in contact in which the usual error is learned [s]
};

// Residuals over their usual size (noise and a share of the force, learned at the start) make the
// cube root of the mean square of a block, which is nearly normal (Wilson and Hilferty, 1931); its
// cumulative sum above half a standard deviation (Page, Biometrika 41, 1954) raises the alarm at
// the limit that Siegmund's formula gives for the false-alarm rate (Sequential Analysis, 1985,
// 2.56).
class ChangeTest {
 public:
  explicit ChangeTest(const ChangeTestOptions& options);

  // The next sample; true when the sum has passed the limit with it.
  bool add(const Vec3& model, const Vec3& measured, bool touches);
  // From here on, with a sum of zero.
  void restart();
  // As at the start: what is usual now. Until then sizes are the former ones.
  void learn_anew();

  bool learned() const { return learned_; }
  double size(const Vec3& force) const;    // usual size of a residual component there [N]
  double share() const { return share_; }  // of the force in that
  double limit() const { return limit_; }
  // Times which the usual error must grow for the sum to grow.
  double least_growth() const { return std::pow((mean_ + kReference * deviation_) / seen_, 1.5); }
  std::size_t since() const { return since_; }  // sample at which the sum was last zero

 private:
  static constexpr double kReference = 0.5;  // of the cumulative sum, in standard deviations

  void learn();

  ChangeTestOptions options_;
  std::size_t block_length_;
  double limit_ = 0;
  bool learned_ = false;
  double noise_ = 0, share_ = 0, mean_ = 1, deviation_ = 1;
  double seen_ = 1;  // mean while learning; mean_ is to the safe side of it
  std::vector<std::array<double, 2>> usual_;  // squared force and squared residual, while learning
  std::size_t count_ = 0, in_contact_ = 0, since_ = 0;
  double block_squares_ = 0, sum_ = 0;
  std::size_t block_samples_ = 0;
};

}  // namespace hapsim
