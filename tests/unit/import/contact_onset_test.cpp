#include "import/contact_onset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace hapsim {
namespace {

struct Ramp {
  std::vector<double> travel, force;
};

// A steady approach from `from` to `to` [m]; `law` of the travel, with white noise [N].
Ramp ramp(double from, double to, double noise, const std::function<double(double)>& law,
          unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Ramp r;
  constexpr int kRows = 600;
  for (int i = 0; i <= kRows; ++i) {
    const double s = from + (to - from) * i / kRows;
    r.travel.push_back(s);
    r.force.push_back(law(s) + noise * normal(random));
  }
  return r;
}

// Hertz's ball, contact at 0.
double ball(double s) {
  return s > 0 ? 4000 * std::pow(s, 1.5) : 0;
}

// A cylinder of neo-Hookean rubber between platens, 30 mm high, contact at 0.
double cylinder(double s) {
  const double stretch = 1 - std::max(0.0, s) / 0.03;
  return 30 * (1 / (stretch * stretch) - stretch);
}

TEST(ContactOnset, OfABallAfterAir) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Ramp r = ramp(-2e-3, 3e-3, 0.003, ball, seed);
    const ContactOnset onset = find_contact_onset(r.travel, r.force);
    ASSERT_TRUE(onset.found);
    EXPECT_NEAR(onset.depth, 0, 0.02 * 3e-3) << seed;
    EXPECT_NEAR(onset.baseline, 0, 0.001) << seed;
  }
}

// The force grows a hundredfold on the way: what is small beside its end is no air.
TEST(ContactOnset, OfAStiffeningBodyIsAtTheFirstForce) {
  for (const double air : {0.0, 1e-3})
    for (unsigned seed = 1; seed <= 20; ++seed) {
      const Ramp r = ramp(-air, 20e-3, 0.02, cylinder, seed);
      const ContactOnset onset = find_contact_onset(r.travel, r.force);
      ASSERT_TRUE(onset.found);
      EXPECT_NEAR(onset.depth, 0, 0.01 * 20e-3) << air << " " << seed;
    }
}

TEST(ContactOnset, IsExtrapolatedWhereTheRecordingBeginsInContact) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Ramp r = ramp(0.5e-3, 3e-3, 0.002, ball, seed);
    const ContactOnset onset = find_contact_onset(r.travel, r.force);
    ASSERT_TRUE(onset.found);
    EXPECT_NEAR(onset.depth, 0, 0.06 * 3e-3) << seed;
  }
}

// Waves of the base line, thirty times its white noise, are no contact.
TEST(ContactOnset, IsNotInTheWavesOfTheAir) {
  const auto wavy = [](double s) { return ball(s) + 0.006 * std::sin(2e3 * s * 2 * M_PI / 3); };
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Ramp r = ramp(-4e-3, 3e-3, 0.0002, wavy, seed);
    const ContactOnset onset = find_contact_onset(r.travel, r.force);
    ASSERT_TRUE(onset.found);
    EXPECT_NEAR(onset.depth, 0, 0.05 * 3e-3) << seed;
  }
}

TEST(ContactOnset, IsNotFoundInNoise) {
  const Ramp r = ramp(0, 1e-3, 0.01, [](double) { return 0.0; });
  EXPECT_FALSE(find_contact_onset(r.travel, r.force).found);
}

}  // namespace
}  // namespace hapsim
