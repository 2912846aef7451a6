// What is told where a caller and the recording differ.
#include "recording/contradictions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "expect_error.h"

namespace hapsim {
namespace {

TEST(Contradictions, AnotherRadiusIsToldWithItsFactor) {
  Metadata metadata;
  EXPECT_EQ(other_radius_words(metadata, 0.008, "a.csv"), "");
  metadata.set("tool_radius", "0.004");
  EXPECT_EQ(other_radius_words(metadata, 0.004, "a.csv"), "");
  const std::string words = other_radius_words(metadata, 0.008, "a.csv");
  EXPECT_EQ(words.rfind("a.csv says tool_radius 0.004 m, and 0.008 m is taken instead, 2 times", 0),
            0u)
      << words;
}

// A ramp of 1 N with white noise of 0.01 N.
Recording noisy() {
  Recording r;
  r.name = "a.csv";
  Random random(1);
  for (int i = 0; i < 400; ++i) {
    r.press.push_back(i / 200);
    r.t.push_back(0.01 * i);
    r.position.push_back(Vec3::Zero());
    r.u.push_back(Vec3(0, 0, -1e-5 * (i % 200)));
    r.f.push_back(Vec3(0, 0, 0.005 * (i % 200)) +
                  0.01 * Vec3(random.normal(), random.normal(), random.normal()));
  }
  return r;
}

TEST(Contradictions, NoiseFarFromTheScatterIsTold) {
  const Recording r = noisy();
  EXPECT_EQ(other_noise_words(r, 0.02, "--noise"), "");
  EXPECT_EQ(other_noise_words(r, 0.005, "--noise"), "");
  EXPECT_EQ(other_noise_words(r, 0.15, "--noise").rfind("--noise is 0.15 N, 1", 0), 0u);
  EXPECT_NE(other_noise_words(r, 1e-4, "--noise"), "");
}

TEST(Contradictions, NoiseLargerThanTheForcesIsRefused) {
  EXPECT_EQ(error_of([] { other_noise_words(noisy(), 10, "--noise"); }, ExitCode::kUsage)
                .rfind("--noise is 10 N, and the forces of a.csv are 0.33", 0),
            0u);
  Recording motion = noisy();
  motion.f.clear();
  EXPECT_EQ(other_noise_words(motion, 10, "--noise"), "");
}

}  // namespace
}  // namespace hapsim
