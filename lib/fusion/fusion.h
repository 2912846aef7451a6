// Forces of a fast source put right by those of a slow one that come late.
#pragma once

#include <array>
#include <vector>

#include "base/vec3.h"
#include "estimate/delayed_filter.h"
#include "fusion/correction_worth.h"
#include "fusion/taught_correction.h"

namespace hapsim {

// What the fast source may err by, and the slow one. Each force component by itself:
//   slow = fast + b + c f |f| / F + noise,   db = g df + r dt + w,   f the fast force:
// an offset b that goes on with the fast force by the local gain g and with time by the drift r,
// and wanders; g wanders along the way that the force goes; b and r decay; c, a stiffening, stays.
// In SI and the frame of the forces; every component has its own.
struct AxisFusion {
  double offset_walk = 0.1;  // of b at rest [N/s^0.5]
  double offset_time = 10;   // in which b decays [s]
  double walk_rate = 1;      // rate at which that has fallen to its floor, a tenth [m/s]
  double drift_walk = 0.1;   // of r at rest, falling with the rate as that of b [N/s^1.5]
  double drift_time = 0.3;   // in which r decays [s]
  double gain_walk = 0.1;    // of g along a way of F of the fast force
  double gain_spread = 0.1;  // standard deviation of g and c at the start
  double noise = 0.01;       // of the slow source at rest [N]
  double noise_rise = 0.1;   // and how it grows with the rate [N s/m]
  double force_scale = 1;    // F [N]
};
struct FusionParameters {
  std::array<AxisFusion, 3> axis;
  double blend = 0.01;      // time over which a correction is let in [s]; 0: at once
  bool weighs = true;       // false: all that the filter adds is let in, whatever it has been worth
  TaughtCorrection taught;  // added to the fast force before all else
  CorrectionShares share;   // of what the filter adds, until it has shown its worth
  double share_known = 2;   // observations that this is worth
};

struct FusionReport {
  long observations = 0, refused = 0;  // refused: before the contact, or too late
  long judged = 0;                     // observations but those before any motion, which are zero
  // Of what was given out for the time of a slow force, when that was not there yet: sum over those
  // judged and components of (slow - given)^2 / variance, the variance as the filter stated
  // it and of the slow source's noise.
  double nis = 0;
  Vec3 deviance = Vec3::Zero();  // by component: sum of log variance + (slow - given)^2 / variance
  long within = 0;         // observations whose nis is below the 95 % point of chi-square of three
  double lag_product = 0;  // sum of products of successive normalised differences: how white

  double mean_nis() const;     // per component: 1 when the filter knows its own error
  double correlation() const;  // of a difference with the one before it
  // 95 % of mean_nis() when it does. Forecasts over a delay share what happens in it, so as many
  // count as independent as the squares' correlation leaves (Bartlett, Suppl. J. R. Statist. Soc.
  // 8, 1946): (1 - rho^2) / (1 + rho^2) of them.
  std::array<double, 2> band() const;
};

// A Kalman filter whose input is the fast force (thesis 4.4, its errata put right), after what it
// was taught to miss.
//
// Weights. The magnitude of the tool's rate decides: the faster the motion, the less b may walk and
// the noisier the slow source counts, so the fast source gains weight. The noise includes what half
// a sample of time makes in the fast force. Slow forces are put in at their own time, by Joseph's
// form of the update. A new contact begins with b = 0, because there is no force yet; g and c stay.
//
// Size of the variances. It changes no force, only the stated uncertainty. Each component has one
// scale a band of rates (a factor 2 wide). A band is chosen by the sample's rate, or by the mean
// rate since the newest slow force known at that time, whichever is larger: what was forecast since
// then is what may be wrong. After each slow force the scale's logarithm rises by kScaleStep (the
// first ones: by more) times the excess of the normalised squared difference over one, so that its
// mean becomes one on any motion. Neighbouring bands learn nearly as much.
//
// Share. The correction is a forecast over the slow source's lateness, and may be worse than
// nothing where that is long beside the motion. Therefore only a share of it is added, by the way
// and the time since the newest slow force, at first as learned; those of the ways are put right by
// what the slow forces later show to have been missing, as CorrectionWorth has it.
//
// step() and observe() allocate nothing and lock nothing.
class Fusion {
 public:
  static constexpr double kScaleStep = 0.2;
  // `history`: steps that a slow force may be late.
  explicit Fusion(const FusionParameters& parameters, std::size_t history = 4096);

  // A new contact, where it is [m]: away from the lessons' places nothing that they taught is
  // added.
  void begin(double t, const Vec3& contact) noexcept;
  // The next sample: displacement u [m] and fast force [N] at t [s]. The fused force now [N].
  Vec3 step(double t, const Vec3& u, const Vec3& fast) noexcept;
  // A slow force of time t that has just come. Taken: whether it was of use.
  bool observe(double t, const Vec3& slow) noexcept;

  Vec3 deviation() const noexcept;  // standard deviation of the last fused force [N]
  const CorrectionWorth& worth() const { return worth_; }
  const FusionReport& report() const { return report_; }

 private:
  using Filter = DelayedFilter<4>;  // b, g, c, r
  struct Sample {
    double t = 0;
    Vec3 fast = Vec3::Zero();
    double rate = 0;            // [m/s]
    double way = 0;             // of u since the contact began [m]
    double ahead = 0;           // mean rate since the newest slow force that was there [m/s]
    double moved = -1;          // and the way since then [m]; negative: there was none
    double age = 0;             // and the time [s]
    Vec3 added = Vec3::Zero();  // by the filter, before its share is taken
    Vec3 given = Vec3::Zero(), variance = Vec3::Zero();  // as it was given out, before blending
  };
  const Sample& sample(std::size_t k) const { return ring_[k % ring_.size()]; }
  Filter::Vector features(int axis, double force) const noexcept;
  static std::size_t rate_class(double rate) noexcept;
  double share_now(const Sample& now) const noexcept;
  Vec3 added() const noexcept;     // by the filter to the last sample
  Vec3 estimate() const noexcept;  // of the last sample, before blending
  Vec3 variance() const noexcept;  // of it

  FusionParameters parameters_;
  TaughtForce taught_;
  std::array<Filter, 3> filter_;
  std::vector<Sample> ring_;
  std::size_t first_ = 0, next_ = 0;
  std::array<double, 8> scale_{};  // of all variances by what was seen, one a factor 2 of the rate
  // Sums of what was added times what was missing, and squared, over the variance.
  std::array<double, kWayBands> agreed_{}, added_{};
  CorrectionWorth worth_;
  double newest_t_ = 0, newest_way_ = 0;  // of the newest slow force in this contact
  bool any_slow_ = false;                 // there was one
  double share_ = 1;                      // of the filter's in what is given out
  Vec3 u_ = Vec3::Zero(), pending_ = Vec3::Zero(), last_ = Vec3::Zero();
  FusionReport report_;
  bool known_ = false, taught_here_ = false;
};

}  // namespace hapsim
