#include "recording/thinning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <sstream>

#include "base/random.h"

namespace hapsim {
namespace {

// Presses of a ramp in, a hold and a ramp out, `rows` each, and forces of 200 N/m.
Recording noisy_presses(int count, int rows, const std::function<Vec3()>& noise) {
  Recording r;
  r.name = "made.csv";
  for (int p = 1; p <= count; ++p)
    for (int i = 0; i < rows; ++i) {
      const double time = static_cast<double>(i) / rows;
      const double depth = 3e-3 * std::min({1.0, 3 * time, 3 * (1 - time)});
      r.line.push_back(static_cast<long>(r.line.size()) + 2);
      r.press.push_back(p);
      r.t.push_back(10 * p + 2 * time);
      r.position.emplace_back(0.01 * p, 0, 0.05);
      r.u.emplace_back(0, 0, -depth);
      r.f.push_back(Vec3(0, 0, 200 * depth) + noise());
    }
  return r;
}

Recording read_at_most(const Recording& recording, std::size_t most, Thinning& thinning,
                       double noise = 0) {
  std::ostringstream text;
  write_recording(text, recording);
  Input input = Input::from_bytes(text.str(), "made.csv");
  return read_thinned(input, true, most, noise, thinning);
}

std::function<Vec3()> white_noise(Random& random, double sigma) {
  return [&random, sigma] {
    const double x = random.normal(), y = random.normal(), z = random.normal();
    return Vec3(sigma * Vec3(x, y, z));
  };
}

// Noise that each sample has from the one before, with the same variance.
std::function<Vec3()> wandering(Random& random, double sigma, double kept) {
  auto last = std::make_shared<Vec3>(white_noise(random, sigma)());
  return [&random, sigma, kept, last] {
    *last = kept * *last + std::sqrt(1 - kept * kept) * white_noise(random, sigma)();
    return *last;
  };
}

// As the noise of a mean is: the scatter of what is left of the force of its displacement.
double scatter(const Recording& r) {
  double sum = 0;
  for (std::size_t i = 0; i < r.rows(); ++i) sum += (r.f[i] + 200 * r.u[i]).squaredNorm();
  return std::sqrt(sum / (3.0 * static_cast<double>(r.rows())));
}

TEST(Thinning, FewRowsStayAsTheyAre) {
  Random random(1);
  const Recording whole = noisy_presses(3, 50, white_noise(random, 0.01));
  for (const std::size_t most : {std::size_t{0}, std::size_t{150}}) {
    Thinning t;
    const Recording same = read_at_most(whole, most, t);
    EXPECT_FALSE(t.thinned());
    EXPECT_EQ(thinning_words(t), "");
    std::ostringstream a, b;
    write_recording(a, whole);
    write_recording(b, same);
    EXPECT_EQ(a.str(), b.str());
  }
}

TEST(Thinning, MeansKeepForcesInProportionAndWhiteNoiseFalls) {
  Random random(2);
  Recording whole = noisy_presses(10, 3001, white_noise(random, 0.02));
  whole.metadata.set("force_noise", "0.02");
  Thinning t;
  const Recording r = read_at_most(whole, 2000, t);
  EXPECT_EQ(t.recorded, 30010u);
  EXPECT_EQ(t.kept, r.rows());
  EXPECT_LE(r.rows(), 2000u);
  EXPECT_EQ(t.block, 16);
  EXPECT_NEAR(t.span, 15 * 2.0 / 3001, 1e-9);
  EXPECT_GT(t.displacement, 0.999);
  EXPECT_LE(t.displacement, 1);
  EXPECT_GT(t.rate, 0.95);
  EXPECT_NEAR(t.noise_after, 0.02 / 4, 0.0005);
  EXPECT_NEAR(scatter(r) / t.noise_after, 1, 0.1);
  EXPECT_NEAR(*r.force_noise(), t.noise_after, 1e-6);
  EXPECT_EQ(r.presses().size(), 10u);
  EXPECT_EQ(r.line.front(), 3);  // after the metadata and the header
}

// What differences of neighbours do not show is not averaged away.
TEST(Thinning, NoiseThatWandersIsNotThoughtToBeAveraged) {
  for (const double kept : {0.8, 0.98, 0.995}) {
    Random random(3);
    Recording whole = noisy_presses(10, 3000, wandering(random, 0.02, kept));
    whole.metadata.set("force_noise", "0.02");
    Thinning t;
    const Recording r = read_at_most(whole, 2000, t);
    EXPECT_GT(t.noise_after / scatter(r), 0.9) << kept;
    EXPECT_LE(t.noise_after, 0.02) << kept;
  }
}

TEST(Thinning, MeansStayWithinPressPlaceAndContact) {
  Random random(4);
  Recording whole = noisy_presses(2, 999, white_noise(random, 0.01));
  for (std::size_t i = 0; i < whole.rows(); ++i) whole.contact.push_back(i % 999 < 100 ? 0 : 1);
  for (std::size_t i = 1500; i < whole.rows(); ++i) whole.position[i].x() += 0.02;
  Thinning t;
  const Recording r = read_at_most(whole, 100, t);
  for (std::size_t i = 0; i < r.rows(); ++i) {
    const auto at = static_cast<std::size_t>(r.line[i] - whole.line.front());
    EXPECT_EQ(r.press[i], whole.press[at]);
    EXPECT_EQ(r.position[i], whole.position[at]);
    EXPECT_EQ(r.contact[i], whole.contact[at]);
    const bool goes_on = i > 0 && r.press[i] == r.press[i - 1];
    EXPECT_TRUE(!goes_on || r.t[i] > r.t[i - 1]) << i;
  }
}

TEST(Thinning, ShortPressesAreNotMadeShorter) {
  Random random(5);
  Recording whole = noisy_presses(100, 25, white_noise(random, 0.01));
  Thinning t;
  EXPECT_EQ(read_at_most(whole, 200, t).rows(), 2500u);
  EXPECT_FALSE(t.thinned());
  whole = noisy_presses(50, 100, white_noise(random, 0.01));
  EXPECT_EQ(read_at_most(whole, 200, t).rows(), 50u * 25);
  EXPECT_EQ(t.block, 4);
}

// Readings at a sensor's end stay exactly equal, or nobody would see it.
TEST(Thinning, EqualReadingsStayEqual) {
  Recording whole = noisy_presses(1, 3000, [] { return Vec3(Vec3::Zero()); });
  for (Vec3& f : whole.f) f.z() = std::min(f.z(), 0.1 + 0.2);
  Thinning t;
  const Recording r = read_at_most(whole, 300, t);
  const auto at_end =
      std::count_if(r.f.begin(), r.f.end(), [](const Vec3& f) { return f.z() == 0.1 + 0.2; });
  EXPECT_GT(at_end, static_cast<std::ptrdiff_t>(r.rows()) / 2);
}

TEST(Thinning, IsToldWithWhatItLoses) {
  Thinning t{1000000, 31250, 32};
  t.span = 0.031;
  t.displacement = 0.99996;
  t.rate = 0.97151;
  t.noise_before = 0.02;
  t.noise_after = 0.0036;
  EXPECT_EQ(
      thinning_words(t),
      "1000000 rows are fitted as 31250 means of 32, over 0.031 s each: what is faster is not "
      "seen; they keep 99.99 % of what the rows tell of displacements, 97.15 % of rates; noise "
      "0.02 N a row, 0.0036 N a mean (--most-rows 0 fits all)");
}

}  // namespace
}  // namespace hapsim
