// What every effect must keep, checked over the whole catalogue.
#include "effects/catalogue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/random.h"
#include "effects/effects.h"

namespace hapsim {
namespace {

// The material's modulus and Poisson's ratio, and a body of both; derivatives in columns from
// `first` on, none when negative.
void set_material(PressView& press, double modulus, double nu, int first) {
  Eigen::Matrix3d K;
  K << 95, 5, 10, 5, 100, -8, 10, -8, 240;  // along the normal stiffer than a half-space
  K /= 2e4;
  press.modulus = press.contact.modulus = modulus;
  press.contact.nu = nu;
  press.contact.K = modulus * (1 + 0.5 * (nu - 0.4)) * K;
  press.contact.by_column.clear();
  press.modulus_column = first;
  press.contact.log_modulus_by_column.clear();
  press.contact.nu_column = first < 0 ? -1 : first + 1;
  if (first < 0) return;
  press.contact.log_modulus_by_column = {{first, 1 / modulus}};
  press.contact.by_column.emplace_back(first, press.contact.K / modulus);
  press.contact.by_column.emplace_back(first + 1, 0.5 * modulus * K);
}

// In the air, in, out again, beyond the surface; oblique, over an earlier press, warming up.
PressView example_press() {
  PressView press;
  Random random(3);
  double t = 0;
  for (int i = 0; i < 40; ++i) {
    press.t.push_back(t);
    press.session.push_back(100 + t);
    press.temperature.push_back(21 + 0.1 * i);
    t += 0.01 + 0.02 * random.uniform();
    const double depth = i < 4 ? 0 : 0.003 * std::sin(0.095 * (i - 3));
    press.u.push_back({0.2 * depth, -0.1 * depth, -depth});
    press.in_air.push_back(i < 4 ? 1 : 0);
  }
  press.direction = Vec3(0.2, -0.1, -1).normalized();
  press.past_depth = 0.0025;
  press.radius = 0.004;
  set_material(press, 2e4, 0.4, -1);
  return press;
}

// What an effect makes of a press. Two outside parameters come before it: s scales the force that
// arrives (column 0), r moves the tool (column 1).
Signal pass(const Effect& effect, PressView press, const Values& values, double s, double r,
            Eigen::Index columns) {
  const auto n = 3 * static_cast<Eigen::Index>(press.size());
  Motion motion{press.u, {}, columns};
  motion.make_du();
  for (std::size_t i = 0; i < press.size(); ++i) {
    const Vec3 way = std::sin(0.3 * static_cast<double>(i)) * Vec3(1e-4, 2e-4, 3e-4);
    motion.u[i] += r * way;
    if (columns > 0) motion.du.block<3, 1>(3 * static_cast<Eigen::Index>(i), 1) = way;
  }
  effect.move(press, values, motion);
  press.u = motion.u;
  press.du = motion.du;
  Signal signal{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, columns)};
  for (std::size_t i = 0; i < press.size(); ++i) {
    if (press.in_air[i]) continue;
    const auto row = 3 * static_cast<Eigen::Index>(i);
    signal.f.segment<3>(row) = -150 * (1 + s) * press.u[i];
    if (columns == 0) continue;
    signal.df.middleRows(row, 3) = -150 * (1 + s) * press.du.middleRows(row, 3);
    signal.df.block<3, 1>(row, 0) = -150 * press.u[i];
  }
  effect.apply(press, values, signal);
  return signal;
}

Values values_at(const Effect& effect, const std::vector<double>& numbers, bool columns) {
  Values values;
  for (std::size_t k = 0; k < numbers.size(); ++k)
    values.push_back(
        {0, effect.card().parameters[k].name, numbers[k], columns ? static_cast<int>(k) + 2 : -1});
  return values;
}

class EveryEffect : public ::testing::TestWithParam<const Effect*> {};

TEST_P(EveryEffect, HasACompleteCard) {
  const EffectCard& card = GetParam()->card();
  EXPECT_FALSE(card.title.empty() || card.equation.empty() || card.source.empty() ||
               card.assumptions.empty() || card.signature.empty() || card.separated_by.empty());
  EXPECT_FALSE(card.parameters.empty());
  for (const ParameterCard& p : card.parameters) {
    EXPECT_LE(p.lower, p.start) << p.name;
    EXPECT_LE(p.start, p.upper) << p.name;
    EXPECT_GT(p.scale, 0) << p.name;
    EXPECT_FALSE(p.unit.empty() || p.meaning.empty()) << p.name;
    if (p.logarithmic) {
      EXPECT_GT(p.lower, 0) << p.name;
    }
  }
}

TEST_P(EveryEffect, DoesNothingAtItsIdentity) {
  const Effect& effect = *GetParam();
  if (effect.card().name == "elastic" || effect.card().is_map) return;
  std::vector<double> identity;
  for (const ParameterCard& p : effect.card().parameters) identity.push_back(p.identity);
  const PressView press = example_press();
  const Signal with = pass(effect, press, values_at(effect, identity, false), 0.3, 0.1, 0);
  const Signal without = pass(elastic_effect(), press, {}, 0.3, 0.1, 0);
  EXPECT_EQ(with.f, without.f);
}

TEST_P(EveryEffect, DerivativesAreDifferences) {
  const Effect& effect = *GetParam();
  if (effect.card().stage == Stage::kBody && effect.card().is_map) return;
  PressView press = example_press();
  const auto& cards = effect.card().parameters;
  DataSummary data{true, 0.02, 0.8, 100, 2e4, 1, 1, 1, 300};
  std::vector<std::vector<double>> points;
  for (std::vector<double> start : effect.starts(data, 1)) {
    for (double& x : start)
      if (x == 0) x = 0.1;  // an interior value where the start is the identity
    points.push_back(start);
    for (std::size_t k = 0; k < start.size(); ++k)  // and near the identity, or the bound
      start[k] = cards[k].logarithmic ? 0.3 * start[k] : cards[k].identity + 1e-2 * cards[k].scale;
    points.push_back(start);
  }
  for (const std::vector<double>& point : points) {
    const auto m = static_cast<Eigen::Index>(point.size());
    const double E = 2e4, nu = 0.4;
    set_material(press, E, nu, static_cast<int>(m) + 2);
    const Signal signal = pass(effect, press, values_at(effect, point, true), 0.3, 0.1, m + 4);
    const auto of_material = [&](const std::vector<double>& x, double s, double r, double modulus,
                                 double poisson) {
      PressView other = press;
      set_material(other, modulus, poisson, -1);
      return pass(effect, other, values_at(effect, x, false), s, r, 0).f;
    };
    const auto forces = [&](const std::vector<double>& x, double s, double r, double modulus) {
      return of_material(x, s, r, modulus, nu);
    };
    const double scale = signal.f.norm();
    for (Eigen::Index k = 0; k < m; ++k) {
      // Where a field's places lie, how it is smoothed and where curves have their knots is never
      // fitted.
      if ((effect.card().is_field || effect.card().learned) &&
          cards[static_cast<std::size_t>(k)].fixed)
        continue;
      std::vector<double> up = point, down = point;
      const double step = 1e-5 * std::max(std::abs(point[k]), 1e-3 * cards[k].scale);
      up[k] += step;
      down[k] -= step;
      const Eigen::VectorXd difference =
          (forces(up, 0.3, 0.1, E) - forces(down, 0.3, 0.1, E)) / (2 * step);
      EXPECT_LT((signal.df.col(k + 2) - difference).norm(),
                1e-6 * std::max(difference.norm(), scale))
          << cards[k].name << " at " << point[k];
    }
    const double h = 1e-5;
    const Eigen::VectorXd through =
        (forces(point, 0.3 + h, 0.1, E) - forces(point, 0.3 - h, 0.1, E)) / (2 * h);
    EXPECT_LT((signal.df.col(0) - through).norm(), 1e-6 * scale) << "carried through";
    const Eigen::VectorXd moved =
        (forces(point, 0.3, 0.1 + h, E) - forces(point, 0.3, 0.1 - h, E)) / (2 * h);
    EXPECT_LT((signal.df.col(1) - moved).norm(), 1e-6 * std::max(moved.norm(), scale))
        << "by the motion";
    const Eigen::VectorXd by_modulus =
        (forces(point, 0.3, 0.1, E + 1) - forces(point, 0.3, 0.1, E - 1)) / 2;
    EXPECT_LT((signal.df.col(m + 2) - by_modulus).norm(), 1e-6 * scale) << "by E";
    const Eigen::VectorXd by_nu =
        (of_material(point, 0.3, 0.1, E, nu + h) - of_material(point, 0.3, 0.1, E, nu - h)) /
        (2 * h);
    EXPECT_LT((signal.df.col(m + 3) - by_nu).norm(), 1e-6 * scale) << "by nu";
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryEffect, ::testing::ValuesIn(catalogue()),
                         [](const auto& test) {
                           std::string name = test.param->card().name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Catalogue, NamesAreUniqueAndFound) {
  std::set<std::string> names;
  for (const Effect* effect : catalogue()) {
    EXPECT_TRUE(names.insert(effect->card().name).second) << effect->card().name;
    EXPECT_EQ(find_effect(effect->card().name), effect);
    for (const std::string& other : effect->card().contains)
      EXPECT_NE(find_effect(other), nullptr) << other;
  }
  for (const Effect* effect : catalogue())
    for (const std::string& other : effect->card().confounders) {
      EXPECT_TRUE(names.count(other) > 0) << other;
      EXPECT_NE(other, effect->card().name);
    }
  EXPECT_EQ(find_effect("magic"), nullptr);
  EXPECT_THROW(require_effect("magic"), Error);
}

// As what is left is told (LeftOver::kind).
TEST(Catalogue, EveryEffectThatMayBeMissingHasItsKinds) {
  const std::set<std::string> known{
      "offset",  "drift",     "depth",         "contact-time", "rate",    "phase",  "cycle",
      "history", "body",      "session-time",  "temperature",  "reading", "set-up", "press",
      "event",   "frequency", "zero-of-press", "direction",    "place"};
  for (const Effect* effect : catalogue()) {
    const EffectCard& card = effect->card();
    EXPECT_EQ(card.kinds.empty(), effect == &body_effect()) << card.name;
    for (const std::string& kind : card.kinds) EXPECT_TRUE(known.count(kind) > 0) << kind;
  }
}

TEST(Catalogue, EffectsActInTheOrderOfTheirStages) {
  for (std::size_t k = 1; k < catalogue().size(); ++k)
    EXPECT_LE(catalogue()[k - 1]->card().stage, catalogue()[k]->card().stage)
        << catalogue()[k]->card().name;
  // Offsets by press are solved for as what is added last.
  for (std::size_t k = 0; k + 1 < catalogue().size(); ++k)
    EXPECT_FALSE(catalogue()[k]->card().per_press) << catalogue()[k]->card().name;
}

}  // namespace
}  // namespace hapsim
