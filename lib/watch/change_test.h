// Whether the residuals of a stream are still what they usually are.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/vec3.h"

namespace hapsim {

struct ChangeTestOptions {
  double rate = 1000;         // samples a second
  double false_alarms = 0.1;  // an hour, while nothing changes
  double block = 0.05;        // samples of this time are taken together [s]
  double learning = 5;        // time in contact in which the usual error is learned [s]
};

struct TestedSample {
  Vec3 model = Vec3::Zero(), measured = Vec3::Zero();  // [N]
  double uncertainty = 0;  // relative standard uncertainty of the model's force at this place
  bool touches = false;
  std::int32_t press = 0;
};

// The limit h of a one-sided cumulative sum of independent values of unit variance, less half a
// standard deviation each, at which false alarms come every `run` values (Siegmund, Sequential
// Analysis, 1985, 2.56). `tail`: the t > 0 at which the mean of exp(t (value - 1/2)) is 1, which is
// 1 for normal values, less where large ones are more frequent, more where they are rarer.
double change_limit(double run, double tail = 1);

// What a press has shown at most, and at most of its usual square by what the model states.
struct PressValue {
  double value = -1;  // < 0: too short
  double stated = 0;
};

// Cumulative sum of what a press has shown at most, press by press: where it lies a model is as
// wrong from the first sample to the last, so a press is one value, however long it lasts.
class PressSum {
 public:
  // Of so many samples each, the mean square of the standardised residuals makes a block.
  explicit PressSum(std::size_t block_length) : block_length_(block_length) {}
  // Presses' values while nothing changes: mean and scatter, to the safe side, and their tail;
  // false alarms every `run` presses. Of one press the scatter is that of a stated error; of none
  // nothing is ever told. From then on the presses that go by unchanged are learned from too, each
  // time that they have doubled, so that the safe side costs less and less; but not where those
  // that are new lie higher than chance allows.
  void learn(std::vector<PressValue> values, double run);
  void restart();
  // The next sample, number `at` of the stream; true when a block has ended with it. `stated`: the
  // share of the usual square that the model states of its error there; presses may scatter as much
  // as what is stated of them beyond those that were learned from.
  bool add(double square, double stated, std::size_t at);
  PressValue end_press();
  double level() const;                    // of the sum, with this press so far
  double limit() const { return limit_; }  // after learning
  bool above() const { return learned_ && level() > limit_; }
  // The sample from which the error is most likely another one: of the presses since the sum was
  // zero those from which on their excess over half its size (its mean, or the last) adds up to
  // most (Hinkley, Biometrika 57, 1970), and in the first of them the block that has half of what
  // it shows at most.
  std::size_t since() const;
  // Times which the usual error must grow for the sum to grow.
  double least_growth() const { return std::pow((mean_ + kReference * deviation_) / seen_, 1.5); }

 private:
  static constexpr double kReference = 0.5;          // standard deviations
  static constexpr std::size_t kWindow = 8;          // blocks whose mean square makes a value
  static constexpr std::size_t kMostLearned = 4096;  // presses
  struct Excess {
    std::size_t at;
    double value;  // over the usual mean, in standard deviations
  };
  double excess() const;      // of this press so far
  Excess this_press() const;  // with the sample at which it shows
  void begin_press();
  void set_usual();  // from values_
  void learn_from_later(const PressValue& value);
  std::size_t block_length_;
  std::array<double, kWindow> window_{};
  std::size_t blocks_ = 0, samples_ = 0;
  double squares_ = 0, stated_ = 0, most_stated_ = 0, most_ = -1, sum_ = 0;
  // Of this press the blocks that showed more than all before, few however long it lasts; presses
  // that ended since the sum was zero.
  std::vector<Excess> rises_, presses_;
  bool learned_ = false;
  std::vector<PressValue> values_, later_;  // learned from; since then
  double run_ = 0;                          // presses
  double mean_ = 1, deviation_ = 1, limit_ = 0;
  double seen_ = 1;          // mean while learning
  double stated_usual_ = 0;  // largest PressValue::stated there
};

// Residuals over their usual size: noise, a share of the force, learned at the start, and beside
// that what the model itself states of its force there. The cube root of their mean square over 0.4
// s is nearly normal (Wilson and Hilferty, 1931); its largest in each press enters a cumulative sum
// (Page, Biometrika 41, 1954), one for what is in contact and one for what is not, each allowed
// half the false alarms.
class ChangeTest {
 public:
  explicit ChangeTest(const ChangeTestOptions& options);

  // The next sample; true when a sum has passed its limit with it.
  bool add(const TestedSample& sample);
  // From here on, with a sum of zero.
  void restart();
  // As at the start: what is usual now. Until then sizes are the former ones.
  void learn_anew();

  bool learned() const { return learned_; }
  double size(const Vec3& force) const;    // usual size of a residual component there [N]
  double share() const { return share_; }  // of the force in that
  // Times which the usual error in contact must grow for an alarm.
  double least_growth() const { return sums_[1].least_growth(); }
  double limit() const { return sums_[1].limit(); }  // of the sum in contact, after learning
  std::size_t since() const { return since_; }

 private:
  struct Usual {
    double force, residual, uncertainty;  // squared; uncertainty relative
    std::int32_t press;
    bool touches;
  };
  double usual_square(double force, double uncertainty) const;
  void learn();

  ChangeTestOptions options_;
  std::size_t block_length_;
  bool learned_ = false;
  double noise_ = 0, share_ = 0;
  double beside_ = 0;             // of share_, squared, beyond what the model states
  std::array<PressSum, 2> sums_;  // in the air; in contact
  std::vector<Usual> usual_;      // while learning
  std::int32_t press_ = 0;
  std::size_t count_ = 0, in_contact_ = 0;
  std::size_t since_ = 0;  // sample at which the change was
};

}  // namespace hapsim
