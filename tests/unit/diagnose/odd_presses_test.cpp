// Presses that are unlike all others, wherever and however the tool moved.
#include "diagnose/odd_presses.h"

#include <gtest/gtest.h>

#include <functional>

#include "support/synthetic.h"

namespace hapsim {
namespace {

const Model kLinear = test::elastic(1.5e4, 0.42);

// change(press, episode, force) is what is measured of a force of that press.
OddPresses odd_of(const std::function<Vec3(int, const Episode&, const Vec3&)>& change,
                  const std::function<void(std::vector<Episode>&)>& otherwise = {}) {
  Experiment w = test::experiment();
  test::measure_finer(w, kLinear, 0.01, 3);
  if (otherwise) otherwise(w.dataset.episodes);
  const Selection all = all_episodes(w.dataset);
  for (const int e : all)
    for (const int row : w.dataset.episodes[e].rows) {
      Vec3& f = w.dataset.recording.f[row];
      f = change(e, w.dataset.episodes[e], f);
    }
  const Fit fitted = fit(kLinear, w, all, {0.01, 0.01, true});
  return find_odd_presses(fitted, {w, {0.01, 0.01}});
}

TEST(OddPresses, AreThoseThatOthersLikeThemSpeakAgainst) {
  const OddPresses odd = odd_of([](int press, const Episode&, const Vec3& f) {
    return Vec3((press == 4 || press == 12 ? 0.5 : 1.0) * f);
  });
  EXPECT_EQ(odd.ids, (std::vector<int>{4, 12}));
  EXPECT_NEAR(odd.beside, 1, 0.15);
  EXPECT_GT(odd.off, 5);
  EXPECT_NE(odd.words().find("Presses 4, 12 are unlike all others"), std::string::npos)
      << odd.words();
}

// A zero that jumps in the middle of a press, until its end.
TEST(OddPresses, OneIsEnough) {
  int sample = 0;
  const OddPresses odd = odd_of([&](int press, const Episode&, const Vec3& f) {
    ++sample;
    return press == 7 && sample % 41 > 20 ? Vec3(f + Vec3(0.05, -0.03, 0.1)) : f;
  });
  EXPECT_EQ(odd.ids, std::vector<int>{7});
}

// Straight presses take 0.2 or 1 s to their depth. A law of the speed that makes one of 0.45 s odd
// would make those odd, one of 0.05 s not.
TEST(OddPresses, AreSpokenAgainstBySlowerAndFasterOnes) {
  for (const double reached : {0.45, 0.05}) {
    const OddPresses odd =
        odd_of([](int press, const Episode&,
                  const Vec3& f) { return Vec3((press == 10 ? 0.5 : 1.0) * f); },
               [&](std::vector<Episode>& presses) {
                 for (double& t : presses[10].view.t)
                   t = t < 0.2 ? t * reached / 0.2 : reached + (t - 0.2) * (2 - reached) / 1.8;
               });
    EXPECT_EQ(odd.ids, reached > 0.2 ? std::vector<int>{10} : std::vector<int>{});
  }
}

TEST(OddPresses, AreNoneWhereNothingIsHidden) {
  EXPECT_TRUE(odd_of([](int, const Episode&, const Vec3& f) { return f; }).ids.empty());
}

TEST(OddPresses, AreNoneWhereItIsThePlaceOrTheMotion) {
  const auto place = [](int, const Episode& e, const Vec3& f) {
    return Vec3((e.position == 2 ? 1.3 : 1) * f);
  };
  EXPECT_TRUE(odd_of(place).ids.empty());
  const auto depth = [](int, const Episode& e, const Vec3& f) {
    double deepest = 0;
    for (const Vec3& u : e.view.u) deepest = std::max(deepest, u.norm());
    return Vec3((deepest > 3.3e-3 ? 1.4 : 1) * f);
  };
  EXPECT_TRUE(odd_of(depth).ids.empty());
}

// Too many of them to say which ones are.
TEST(OddPresses, AreNoneWhereEveryThirdIs) {
  const auto third = [](int press, const Episode&, const Vec3& f) {
    return Vec3((press % 3 == 1 ? 0.5 : 1.0) * f);
  };
  EXPECT_TRUE(odd_of(third).ids.empty());
}

}  // namespace
}  // namespace hapsim
