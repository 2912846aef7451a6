// What each press has of its own, and whether it comes back where a place is pressed the same way.
#include "diagnose/own_laws.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"
#include "diagnose/left_over.h"

namespace hapsim {
namespace {

constexpr int kPlaces = 4, kWays = 3, kTimes = 2, kOfPress = 48;

struct Moment {
  int press, place, way, sample;
};

Vec3 any_vector(Random& random) {
  const double x = random.normal(), y = random.normal(), z = random.normal();
  return {x, y, z};
}

// Each of four places pressed straight and slanted, twice in each of three ways; a force of up to
// 1 N against the way.
struct OwnTrial {
  LawSamples s;
  Eigen::VectorXd residual;

  template <class Left>
  explicit OwnTrial(const Left& left) {
    constexpr Eigen::Index kAll = kPlaces * kWays * kTimes * kOfPress;
    s.timed = true;
    s.depth = LawSamples::Column::Zero(kAll);
    for (LawSamples::Vectors* v : {&s.f, &s.along, &s.across, &s.normal, &s.u, &s.place})
      *v = LawSamples::Vectors::Zero(3, kAll);
    residual.resize(3 * kAll);
    const Vec3 normal = Vec3::UnitZ(), ways[kWays] = {{0, 0, -1}, {0.6, 0, -0.8}, {0, 0.6, -0.8}};
    Random random(7);
    Eigen::Index i = 0;
    for (int press = 0; press < kPlaces * kWays * kTimes; ++press)
      for (int k = 0; k < kOfPress; ++k, ++i) {
        const int place = press % kPlaces, way = press / kPlaces % kWays;
        s.kept.push_back(i);
        s.since.push_back(k);
        s.press.push_back(press);
        s.depth[i] = std::min(1.0, 3.0 * k / kOfPress);
        s.u.col(i) = 0.004 * s.depth[i] * ways[way];
        s.f.col(i) = -s.depth[i] * ways[way];
        s.normal.col(i) = normal;
        s.along.col(i) = s.f.col(i).dot(normal) * normal;
        s.across.col(i) = s.f.col(i) - s.along.col(i);
        s.place.col(i) = Vec3(0.01 * place, 0, 0);
        const Vec3 f = s.f.col(i);
        residual.segment<3>(3 * i) =
            left(Moment{press, place, way, k}, f) + 1e-3 * any_vector(random);
      }
  }

  double share(double left) const { return 1 - left / residual.squaredNorm(); }
  std::vector<std::string> own() const {
    std::vector<std::string> names;
    for (const LeftKind& kind : own_laws(s, residual, [&](double left) { return share(left); }))
      names.push_back(kind.kind);
    return names;
  }
};

std::vector<Vec3> vectors(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> all;
  for (int k = 0; k < count; ++k) all.push_back(0.2 * any_vector(random));
  return all;
}

using Names = std::vector<std::string>;

TEST(OwnLaws, AForceThatComesBackGoesWithPlaceAndWay) {
  const std::vector<Vec3> gain = vectors(kPlaces * kWays, 2);
  const OwnTrial trial([&](const Moment& p, const Vec3& f) {
    return Vec3(f.norm() * gain[static_cast<std::size_t>(kWays * p.place + p.way)]);
  });
  EXPECT_EQ(trial.own(), Names{kPlaceAndWay});
}

TEST(OwnLaws, AForceThatDoesNotComeBackIsThePressesOwn) {
  const std::vector<Vec3> gain = vectors(kPlaces * kWays * kTimes, 3);
  const OwnTrial trial([&](const Moment& p, const Vec3& f) {
    return Vec3(f.norm() * gain[static_cast<std::size_t>(p.press)]);
  });
  EXPECT_EQ(trial.own(), Names{kPress});
}

// One press that has it says nothing of whether it comes back.
TEST(OwnLaws, WhatNoRepeatHasMayBeEither) {
  std::vector<Vec3> gain = vectors(kPlaces * kWays, 4);
  OwnTrial trial([&](const Moment& p, const Vec3& f) {
    return Vec3(f.norm() * gain[static_cast<std::size_t>(kWays * p.place + p.way)]);
  });
  for (Eigen::Index i = 0; i < trial.s.place.cols(); ++i)  // each press at a place of its own
    trial.s.place(1, i) = trial.s.press[static_cast<std::size_t>(i)];
  EXPECT_EQ(trial.own(), (Names{kPress, kPlaceAndWay}));
}

TEST(OwnLaws, AZeroOfEachPressIsNoGain) {
  const std::vector<Vec3> zero = vectors(kPlaces * kWays * kTimes, 5);
  const OwnTrial trial(
      [&](const Moment& p, const Vec3&) { return zero[static_cast<std::size_t>(p.press)]; });
  EXPECT_EQ(trial.own(), Names{kZeroOfPress});
}

// A breath of another rate in each press.
TEST(OwnLaws, AForceThatMovesInEachPressWanders) {
  const OwnTrial trial([&](const Moment& p, const Vec3&) {
    const double rate = 0.09 + 0.003 * p.press;
    return Vec3(0.1 * std::sin(rate * p.sample + 2 * p.press) * Vec3::UnitZ());
  });
  EXPECT_EQ(trial.own(), Names{});
  const auto found =
      wandering(trial.s, trial.residual, [&](double left) { return trial.share(left); });
  ASSERT_EQ(found.size(), 1);
  EXPECT_EQ(found.front().kind, kWander);
}

}  // namespace
}  // namespace hapsim
