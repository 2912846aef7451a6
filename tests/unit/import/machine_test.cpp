// A testing machine on a block: ramps and holds, one or several recordings, in English and German.
#include <gtest/gtest.h>

#include "formats/surface_io.h"
#include "recording/force_noise.h"
#include "synthetic.h"

namespace hapsim::test {
namespace {

std::string table(const std::string& header, const std::vector<RampRow>& rows, double travel = 1,
                  double force = 1, double time = 1, const std::string& id = "") {
  std::string text = header + "\n";
  for (const RampRow& row : rows)
    text += id + fmt::format("{:.4f},{:.5f},{:.5f}\n", time * row.t, travel * row.travel,
                             force * row.force);
  return text;
}

// Deepest displacement and the number of samples in the air, of one press.
struct Shape {
  double deepest = 0;
  std::size_t air = 0;
};

Shape shape_of(const Recording& recording, int press) {
  Shape shape;
  for (std::size_t i = 0; i < recording.rows(); ++i)
    if (recording.press[i] == press) {
      shape.deepest = std::max(shape.deepest, -recording.u[i].z());
      shape.air += recording.in_air(i);
    }
  return shape;
}

TEST(ImportMachine, ApproachIsFoundAndKept) {
  for (const double power : {1.0, 1.3, 1.5}) {
    const ImportResult result = import_text(table(
        "Time [s],Standard travel [mm],Standard force [N]", ramp({.bias = 0.05, .power = power})));
    const Shape shape = shape_of(result.recording, 1);
    EXPECT_NEAR(shape.deepest, 6e-3, 0.15e-3) << power;
    EXPECT_NEAR(static_cast<double>(shape.air), 60, 4) << power;
    EXPECT_GT(result.recording.u[0].z(), 2.8e-3);  // away from the body
    EXPECT_GT(result.recording.f.back().z(), 1);
    EXPECT_NEAR(*result.recording.metadata.number("force_noise", ""), 0.01, 0.003);
  }
}

TEST(ImportMachine, ForceNoiseIsThatOfTheTableWritten) {
  for (const double sigma : {0.002, 0.01, 0.05}) {
    Recording written =
        import_text(table("t_s,travel_mm,force_N", ramp({.sigma = sigma}))).recording;
    const double declared = *written.metadata.number("force_noise", "");
    written.metadata.remove("force_noise");
    EXPECT_NEAR(force_noise(written).value / declared, 1, 0.006) << sigma;
    EXPECT_NEAR(declared / sigma, 1, 0.15) << sigma;
  }
}

TEST(ImportMachine, GermanSemicolonsCommasAndUnitRow) {
  std::string text =
      "\"Pr\xfc"
      "fung\";Fleisch\nPr\xfc"
      "fzeit;Standardweg;Standardkraft;\ns;mm;mN;\n";
  for (const RampRow& row : ramp({}))
    text += replaced(fmt::format("{:.3f};{:.4f};{:.2f};\n", row.t, row.travel, -1000 * row.force),
                     '.', ',');
  ImportOptions options;
  options.at = Vec3(0, 0, 0.04);
  options.tool_radius = 0.004;
  const ImportResult result = import_text(text, options);
  EXPECT_NEAR(shape_of(result.recording, 1).deepest, 6e-3, 0.1e-3);
  EXPECT_EQ(result.recording.position[0], Vec3(0, 0, 0.04));
  EXPECT_NEAR(result.recording.f[200].z(), 2, 0.4);
  EXPECT_EQ(*result.recording.metadata.find("tool_radius"), "0.004");
  EXPECT_TRUE(mentions(result.notes.facts, "forces pointed into the body"));
}

TEST(ImportMachine, Utf16IsRead) {
  std::string text = table("Zeit (s),Weg (mm),Kraft (N)", ramp({}));
  std::string wide = "\xff\xfe";
  for (const char c : text) wide += std::string{c, '\0'};
  EXPECT_NEAR(shape_of(import_text(wide).recording, 1).deepest, 6e-3, 0.1e-3);
}

TEST(ImportMachine, RecordingsByColumn) {
  std::string text = "recording,time_s,indentation_mm,force_N\n";
  for (int r = 0; r < 3; ++r) {
    const std::string part = table("", ramp({.air = 1.0 + r, .speed = 0.5 * (1 + r)}), 1, 1, 1,
                                   fmt::format("steak_{},", r));
    text += part.substr(1);
  }
  const ImportResult result = import_text(text);
  ASSERT_EQ(result.recording.presses().size(), 3u);
  for (int p = 1; p <= 3; ++p) EXPECT_NEAR(shape_of(result.recording, p).deepest, 6e-3, 0.1e-3);
  ASSERT_EQ(result.recording.extra_header, std::vector<std::string>{"recording"});
  EXPECT_FALSE(result.recording.metadata.find("recovery"));
}

TEST(ImportMachine, RepeatedHeadersAndTitlesBetween) {
  std::string text;
  for (int r = 0; r < 2; ++r)
    text += fmt::format("Specimen {}\n", r) + table("Zeit,Weg,Kraft\ns,mm,N", ramp({.air = 1}), -1);
  const ImportResult result = import_text(text);
  ASSERT_EQ(result.recording.presses().size(), 2u);
  EXPECT_NEAR(shape_of(result.recording, 2).deepest, 6e-3, 0.1e-3);
  EXPECT_TRUE(mentions(result.notes.facts, "grows outward"));
}

TEST(ImportMachine, IndentationThatBeginsInContactKeepsItsZero) {
  const ImportResult result = import_text(table("t_s,indentation_mm,force_N", ramp({.air = 0})));
  EXPECT_DOUBLE_EQ(result.recording.u[0].z(), 0);
  EXPECT_TRUE(result.recording.contact.empty());
}

TEST(ImportMachine, AHoldAloneKeepsItsDepth) {
  std::vector<RampRow> rows = ramp({.air = 0, .speed = 6});
  rows.erase(rows.begin(), rows.begin() + 21);  // the ramp ends after 1 s
  const ImportResult result = import_text(table("t_s,indentation_mm,force_N", rows));
  EXPECT_NEAR(shape_of(result.recording, 1).deepest, 6e-3, 1e-9);
  EXPECT_EQ(result.recording.rows(), rows.size());
}

TEST(ImportMachine, TravelThatBeginsInContactIsExtrapolated) {
  std::vector<RampRow> rows = ramp({.air = 2});
  rows.erase(rows.begin(), rows.begin() + 46);  // starts 0.3 mm deep
  const ImportResult result = import_text(table("t_s,travel_mm,force_N", rows));
  EXPECT_NEAR(shape_of(result.recording, 1).deepest, 6e-3, 0.2e-3);
}

TEST(ImportMachine, CyclesOfOneRecordingShareTheirZero) {
  std::string text = "t,travel_mm,force\n";
  Random random(2);
  for (int i = 0; i < 1200; ++i) {
    const double t = 0.05 * i, s = 2.5 - 2.5 * std::cos(2 * 3.14159265 * t / 15);
    text += fmt::format("{:.3f},{:.5f},{:.5f}\n", t, s,
                        0.5 * std::max(s - 1, 0.0) + 0.01 * random.normal());
  }
  const ImportResult result = import_text(text);
  ASSERT_EQ(result.recording.presses().size(), 4u);
  for (int p = 1; p <= 4; ++p) EXPECT_NEAR(shape_of(result.recording, p).deepest, 4e-3, 0.1e-3);
  EXPECT_EQ(*result.recording.metadata.find("recovery"), "none");
  ImportOptions options;
  options.split_by = "none";
  EXPECT_EQ(import_text(text, options).recording.presses().size(), 1u);
}

TEST(ImportMachine, DirectionTurnsTheAxes) {
  ImportOptions options;
  options.direction = Vec3(1, 0, 0);
  const ImportResult result = import_text(table("t_s,depth_mm,force_N", ramp({.air = 0})), options);
  EXPECT_GT(result.recording.u.back().x(), 5e-3);
  EXPECT_LT(result.recording.f.back().x(), -1);
}

TEST(ImportMachine, PlacesOnAPlaneNeedNoHeight) {
  std::string text = "site,x_mm,y_mm,time_s,travel_mm,force_N\n";
  for (int site = 1; site <= 3; ++site)
    text +=
        table("", ramp({.hold = 2}), 1, 1, 1, fmt::format("{},{},5,", site, 10 * site)).substr(1);
  ImportOptions options;
  options.at = Vec3(0, 0, 0.05);
  const ImportResult result = import_text(text, options);
  ASSERT_EQ(result.recording.presses().size(), 3u);
  EXPECT_EQ(result.recording.position.back(), Vec3(0.03, 0.005, 0.05));
  EXPECT_NEAR(shape_of(result.recording, 2).deepest, 6e-3, 0.1e-3);
}

TEST(ImportMachine, RateThinsTheSamples) {
  ImportOptions options;
  options.rate = 5;
  const ImportResult result =
      import_text(table("t_s,travel_mm,force_N", ramp({.step = 0.05})), options);
  EXPECT_NEAR(static_cast<double>(result.recording.rows()), 29 * 5, 3);
  EXPECT_NEAR(*result.recording.metadata.number("force_noise", ""), 0.01, 0.003);
}

TEST(ImportMachine, MillisecondsAndEpochs) {
  const ImportResult by_flag = import_text(table("time_ms,travel_mm,force", ramp({}), 1, 1, 1000));
  EXPECT_NEAR(by_flag.recording.t[20], 1, 1e-9);
  std::string text = "time,travel_mm,force\n";
  for (const RampRow& row : ramp({}))
    text += fmt::format("{:.0f},{:.5f},{:.5f}\n", 1.7e12 + 1000 * row.t, row.travel, row.force);
  EXPECT_NEAR(import_text(text).recording.t[20], 1, 1e-6);
}

TEST(ImportMachine, NoiseFloorAloneIsRefused) {
  try {
    import_text(table("t_s,travel_mm,force_N", ramp({.stiffness = 0})));
    FAIL() << "a recording without contact was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("ever touches"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace hapsim::test
