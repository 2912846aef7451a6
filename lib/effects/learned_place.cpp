// A stiffness that changes smoothly from place to place, as learned from the pressed ones.
#include <array>
#include <cmath>

#include "effects/effect_step.h"
#include "effects/effects.h"
#include "effects/place_field.h"

namespace hapsim {
namespace {

constexpr double kFar = PlaceField::kFar;

class LearnedPlaceStep : public EffectStep {
 public:
  explicit LearnedPlaceStep(const Values& values) : field_(values) {}
  void take_place(const StepPlace& place) noexcept override {
    here_ = field_.at(place.point);
    normal_ = place.normal;
  }
  void apply(const StepSample& sample, double*, Vec3& f) noexcept override {
    if (sample.in_air) return;
    f *= std::exp(here_[0] + here_[1] * field_.log_depth(-sample.u.dot(normal_))[0]);
  }

 private:
  PlaceField field_;
  std::array<double, 2> here_{0, 0};
  Vec3 normal_ = Vec3::UnitZ();
};

class LearnedPlace : public Effect {
 public:
  const EffectCard& card() const override {
    static const EffectCard card{
        .name = "learned-place",
        .stage = Stage::kContact,
        .title = "the stiffness, and how it grows with depth, change smoothly from place to place",
        .equation =
            "f = f_before exp(G(x) + H(x) ln(d/depth)), G(x) = sum_i g_i k(|x - x_i|), H(x) = "
            "mean_power + sum_i h_i k(|x - x_i|), k = (1 - share) m(r/range) + share m(r/fine) + "
            "nugget (r < 0.1 mm), m Matern's correlation of order 5/2, d the depth along the "
            "normal (of a flat tool that is as deep)",
        .source =
            "Gaussian process (Rasmussen and Williams, Gaussian Processes for Machine Learning, "
            "2006), its scales those under which each place is likeliest given the others",
        .assumptions =
            "no law is assumed but smoothness; what the places differ by at random is theirs alone "
            "(nugget) and foretells no other place; far from all of them the body's own stiffness "
            "holds; learned within every fit from the presses that the fit may see",
        .parameters = {{"depth", "m", "depth at which G is the logarithm of the factor", 1e-3, 1e-3,
                        1e-9, 10, 1e-3, false, kNoLimit, true},
                       {"range", "m", "length over which the factor changes", kFar, kFar, 1e-6,
                        kFar, 0.01, false, kNoLimit, true},
                       {"fine", "m", "length of a second, finer part of it", kFar, kFar, 1e-6, kFar,
                        0.01, false, kNoLimit, true},
                       {"share", "1", "variance of the finer part over both", 0, 0, 0, 1, 0.1,
                        false, kNoLimit, true},
                       {"nugget", "1", "variance of what is each place's own, over both", 0, 0, 0,
                        10, 0.1, false, kNoLimit, true},
                       {"sd", "1", "standard deviation of the logarithm of the factor", 0, 0, 0,
                        1e3, 0.1, false, kNoLimit, true},
                       {"h_range", "m", "as range, of the power", kFar, kFar, 1e-6, kFar, 0.01,
                        false, kNoLimit, true},
                       {"h_fine", "m", "as fine", kFar, kFar, 1e-6, kFar, 0.01, false, kNoLimit,
                        true},
                       {"h_share", "1", "as share", 0, 0, 0, 1, 0.1, false, kNoLimit, true},
                       {"h_nugget", "1", "as nugget", 0, 0, 0, 10, 0.1, false, kNoLimit, true},
                       {"h_sd", "1", "standard deviation of the power", 0, 0, 0, 1e3, 0.1, false,
                        kNoLimit, true},
                       {"mean_power", "1", "power of the depth that all places share", 0, 0, -10,
                        10, 0.1, false, kNoLimit, true},
                       {"x1", "m", "place", 0, 0, -10, 10, 0.01, false, kNoLimit, true},
                       {"y1", "m", "place", 0, 0, -10, 10, 0.01, false, kNoLimit, true},
                       {"z1", "m", "place", 0, 0, -10, 10, 0.01, false, kNoLimit, true},
                       {"g1", "1", "weight of the place in the logarithm of the factor", 0, 0, -1e9,
                        1e9, 0.1, false},
                       {"h1", "1", "weight of the place in the power of the depth", 0, 0, -1e9, 1e9,
                        0.1, false}},
        .needs_positions = true,
        .one_body = true,
        .like_shape = true,
        .is_field = true,
        .signature = "too stiff at some places and too soft at others, alike at neighbours",
        .confounders = {"regions", "layer", "inclusion", "base", "shift"},
        .separated_by = "new places between the pressed ones, and a tool of another radius",
        .contains = {"regions"},
        .kinds = {"body", "place"}};
    return card;
  }

  void apply(const PressView& press, const Values& values, Signal& signal) const override {
    const PlaceField field(values);
    const auto [G, H] = field.at(press.point);
    const bool derivatives = signal.df.cols() > 0;
    for (std::size_t i = 0; i < press.size(); ++i) {
      if (press.in_air[i]) continue;
      const Eigen::Index row = 3 * static_cast<Eigen::Index>(i);
      const auto [power, slope] = field.log_depth(-press.u[i].dot(press.normal));
      const double factor = std::exp(G + H * power);
      signal.f.segment<3>(row) *= factor;
      if (!derivatives) continue;
      const Vec3 f = signal.f.segment<3>(row);
      signal.df.middleRows(row, 3) *= factor;
      if (press.du.cols() > 0)
        signal.df.middleRows(row, 3) -=
            H * slope * f * (press.normal.transpose() * press.du.middleRows(row, 3));
      for (std::size_t k = 0; k < field.place.size(); ++k) {
        const double square = (field.place[k] - press.point).squaredNorm();
        const auto [g, h] = PlaceField::columns(values, k);
        if (g >= 0) signal.df.block<3, 1>(row, g) += field.factor.at(square) * f;
        if (h >= 0) signal.df.block<3, 1>(row, h) += power * field.power.at(square) * f;
      }
    }
  }

  std::unique_ptr<EffectStep> step(const Values& values, const StepContext&) const override {
    return std::make_unique<LearnedPlaceStep>(values);
  }

 private:
  static constexpr double kNoLimit = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace

const Effect& learned_place_effect() {
  static const LearnedPlace effect;
  return effect;
}

}  // namespace hapsim
