// What every effect must keep, checked over the whole catalogue.
#include "effects/catalogue.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/random.h"

namespace hapsim {
namespace {

PressView example_press() {
  PressView press;
  Random random(3);
  double t = 0;
  for (int i = 0; i < 40; ++i) {
    press.t.push_back(t);
    press.session.push_back(100 + t);
    t += 0.01 + 0.02 * random.uniform();
    const double depth = i < 4 ? 0 : 0.003 * std::sin(0.08 * (i - 3));
    press.u.push_back({0.2 * depth, -0.1 * depth, -depth});
    press.in_air.push_back(i < 4 ? 1 : 0);
  }
  press.radius = 0.004;
  press.modulus = 2e4;
  return press;
}

// A force that depends on an outside parameter s, with its derivative in column 0.
Signal incoming(const PressView& press, double s, Eigen::Index columns) {
  Signal signal;
  const auto n = 3 * static_cast<Eigen::Index>(press.size());
  signal.f.resize(n);
  signal.df = Eigen::MatrixXd::Zero(n, columns);
  for (std::size_t i = 0; i < press.size(); ++i) {
    const auto row = 3 * static_cast<Eigen::Index>(i);
    const Vec3 slope = press.in_air[i] ? Vec3(0, 0, 0) : Vec3(-150 * press.u[i]);
    signal.f.segment<3>(row) = (1 + s) * slope;
    if (columns > 0) signal.df.block<3, 1>(row, 0) = slope;
  }
  return signal;
}

Values values_at(const Effect& effect, const std::vector<double>& numbers, bool columns) {
  Values values;
  for (std::size_t k = 0; k < numbers.size(); ++k)
    values.push_back(
        {0, effect.card().parameters[k].name, numbers[k], columns ? static_cast<int>(k) + 1 : -1});
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
  if (effect.card().name == "elastic" || effect.card().from_locations) return;
  std::vector<double> identity;
  for (const ParameterCard& p : effect.card().parameters) identity.push_back(p.identity);
  const PressView press = example_press();
  Signal signal = incoming(press, 0.3, 0);
  const Eigen::VectorXd before = signal.f;
  effect.apply(press, values_at(effect, identity, false), signal);
  EXPECT_EQ(signal.f, before);
}

TEST_P(EveryEffect, DerivativesAreDifferences) {
  const Effect& effect = *GetParam();
  PressView press = example_press();
  DataSummary data{true, 0.02, 0.8, 100, 2e4, 1, 300};
  for (std::vector<double> start : effect.starts(data, 1)) {
    for (std::size_t k = 0; k < start.size(); ++k)
      if (start[k] == 0) start[k] = 0.1;  // an interior value where the start is the identity
    const auto m = static_cast<Eigen::Index>(start.size());
    press.modulus_column = static_cast<int>(m) + 1;
    Signal signal = incoming(press, 0.3, m + 2);
    effect.apply(press, values_at(effect, start, true), signal);
    const auto forces = [&](const std::vector<double>& x, double s, double modulus) {
      PressView other = press;
      other.modulus = modulus;
      other.modulus_column = -1;
      Signal result = incoming(other, s, 0);
      effect.apply(other, values_at(effect, x, false), result);
      return result.f;
    };
    const double scale = signal.f.norm();
    for (Eigen::Index k = 0; k < m; ++k) {
      std::vector<double> up = start, down = start;
      const double step = 1e-5 * std::max(std::abs(start[k]), 1e-3);
      up[k] += step;
      down[k] -= step;
      const Eigen::VectorXd difference =
          (forces(up, 0.3, press.modulus) - forces(down, 0.3, press.modulus)) / (2 * step);
      EXPECT_LT((signal.df.col(k + 1) - difference).norm(),
                1e-6 * std::max(difference.norm(), scale))
          << effect.card().parameters[k].name;
    }
    const Eigen::VectorXd through =
        (forces(start, 0.301, press.modulus) - forces(start, 0.299, press.modulus)) / 0.002;
    EXPECT_LT((signal.df.col(0) - through).norm(), 1e-6 * scale) << "carried through";
    const Eigen::VectorXd by_modulus =
        (forces(start, 0.3, press.modulus + 1) - forces(start, 0.3, press.modulus - 1)) / 2;
    EXPECT_LT((signal.df.col(m + 1) - by_modulus).norm(), 1e-6 * scale) << "by E";
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
  EXPECT_EQ(find_effect("magic"), nullptr);
  EXPECT_THROW(require_effect("magic"), Error);
}

}  // namespace
}  // namespace hapsim
