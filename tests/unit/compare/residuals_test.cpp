#include "compare/residuals.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "synthetic_recording.h"

namespace hapsim {
namespace {

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  return "no error";
}

TEST(Residuals, SizePoolsTheComponents) {
  const std::vector<Vec3> measured{{3, 2, 0}, {0, 0, 4}}, simulated{{0, 0, 0}, {0, 0, 0}};
  const ErrorSize size = error_size(measured, simulated);
  EXPECT_DOUBLE_EQ(size.rmse, std::sqrt(29.0 / 6));
  EXPECT_DOUBLE_EQ(size.force_rms, size.rmse);
  EXPECT_DOUBLE_EQ(size.force_peak, 4);
  EXPECT_DOUBLE_EQ(size.rmse_axis[2], std::sqrt(8.0));
}

// A load cell of one axis: the zeros of the others are no measurements, and dilute nothing.
TEST(Residuals, AxesThatWereNotMeasuredDoNotCount) {
  Synthetic s = synthetic(12, 4, 0.02, 1);
  const std::vector<Vec3> all = s.measured.f;
  std::vector<Vec3> simulated;
  for (Vec3& f : s.measured.f) f = Vec3(0, 0, f.z());
  for (const Vec3& f : s.simulated) simulated.emplace_back(0, 0, f.z());
  ASSERT_EQ(measured_axes(all), 3);
  ASSERT_EQ(measured_axes(s.measured.f), 1);
  const ErrorSize size = error_size(s.measured.f, simulated);
  EXPECT_DOUBLE_EQ(size.rmse, size.rmse_axis[2]);
  s.measured.metadata.remove("force_noise");
  EXPECT_NEAR(noise_level(s.measured).value, 0.02, 0.002);
}

TEST(Residuals, NoiseIsDeclaredOrEstimated) {
  Synthetic s = synthetic(12, 4, 0.02, 1);
  EXPECT_FALSE(noise_level(s.measured).estimated);
  EXPECT_NEAR(noise_level(s.measured).value, 0.02, 1e-9);
  s.measured.metadata.remove("force_noise");
  EXPECT_TRUE(noise_level(s.measured).estimated);
  EXPECT_NEAR(noise_level(s.measured).value, 0.02, 0.001);
}

TEST(Residuals, NoiseOfTooFewRowsIsUnknown) {
  Recording r;
  r.press = {1, 1};
  r.f = {Vec3(0, 0, 1), Vec3(0, 0, 2)};
  EXPECT_EQ(noise_level(r).value, 0);
}

TEST(Residuals, MismatchNamesTheRow) {
  const Synthetic s = synthetic(2, 1, 0.01, 1);
  Recording other = s.measured;
  other.name = "forces.csv";
  EXPECT_NO_THROW(check_match(s.measured, other));
  other.u[5][2] += 2e-5;
  EXPECT_NE(message_of([&] { check_match(s.measured, other); }).find("forces.csv:8: displacement"),
            std::string::npos);
  other = s.measured;
  other.name = "forces.csv";
  other.press[0] = 9;
  EXPECT_NE(message_of([&] { check_match(s.measured, other); }).find("press 9"), std::string::npos);
  other = s.measured;
  for (auto* column : {&other.position, &other.u, &other.f}) column->pop_back();
  other.press.pop_back();
  EXPECT_NE(message_of([&] { check_match(s.measured, other); }).find("225 rows of forces for 226"),
            std::string::npos);
  other.f.clear();
  EXPECT_NE(message_of([&] { check_match(s.measured, other); }).find("no force columns"),
            std::string::npos);
}

TEST(Residuals, ColumnsReplaceOlderOnes) {
  Synthetic s = synthetic(1, 1, 0.01, 1);
  s.measured.extra_header = {"note", "rx"};
  s.measured.extra.assign(2, std::vector<std::string>(s.measured.rows(), "old"));
  const Recording r = with_residuals(s.measured, s.simulated);
  EXPECT_EQ(r.extra_header, (std::vector<std::string>{"note", "sx", "sy", "sz", "rx", "ry", "rz"}));
  EXPECT_EQ(r.extra[0][0], "old");
  EXPECT_NE(r.extra[4][0], "old");
}

TEST(RowFacts, PhasesPositionsAndAges) {
  const Synthetic s = synthetic(8, 4, 0.01, 1);
  const RowFacts facts = row_facts(s.measured);
  EXPECT_EQ(facts.positions.size(), 4u);
  EXPECT_EQ(facts.press_ids.size(), 8u);
  EXPECT_EQ(facts.phase[10], Phase::kLoading);
  EXPECT_EQ(facts.phase[60], Phase::kHold);
  EXPECT_EQ(facts.phase[106], Phase::kUnloading);
  EXPECT_NEAR(facts.contact_age[113 + 50], 1.0, 1e-9);
  EXPECT_NEAR(facts.normal[1].dot(s.measured.position[113].normalized()), 1, 1e-12);
  for (const char sideways : facts.sideways) EXPECT_EQ(sideways, 0);
}

TEST(RowFacts, RestartedClocksAreLaidEndToEnd) {
  Synthetic s = synthetic(3, 1, 0.01, 1);
  for (std::size_t i = 0; i < s.measured.rows(); ++i)
    s.measured.t[i] = 0.02 * static_cast<double>(i % 113);
  const RowFacts facts = row_facts(s.measured);
  EXPECT_NEAR(facts.session[2 * 113], 2 * 2.24, 1e-9);
}

TEST(RowFacts, AirIsToldByTheContactColumn) {
  Synthetic s = synthetic(1, 1, 0.01, 1);
  s.measured.contact.assign(s.measured.rows(), 1);
  for (int i = 0; i < 20; ++i) s.measured.contact[i] = 0;
  const RowFacts facts = row_facts(s.measured);
  EXPECT_EQ(facts.phase[0], Phase::kAir);
  EXPECT_NEAR(facts.contact_age[20], 0, 1e-12);
}

TEST(RowFacts, QuasiStaticRecordingsHaveNoTimes) {
  Synthetic s = synthetic(2, 1, 0.01, 1);
  s.measured.t.clear();
  const RowFacts facts = row_facts(s.measured);
  EXPECT_TRUE(facts.rate.empty() && facts.session.empty() && facts.contact_age.empty());
  EXPECT_EQ(facts.phase[10], Phase::kLoading);
}

}  // namespace
}  // namespace hapsim
