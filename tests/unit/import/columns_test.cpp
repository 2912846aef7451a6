// What columns mean by their names, and a nominal block.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "import/block.h"
#include "import/column_synonyms.h"
#include "synthetic.h"
#include "tables/column_name.h"

namespace hapsim::test {
namespace {

TEST(ImportColumns, ScalarNames) {
  const auto role = [](const char* name) {
    const ColumnName parts = take_apart(name);
    return scalar_role(parts.joined(), parts.unit.kind).role;
  };
  for (const char* name : {"t", "Time [s]", "Zeit", "Prüfzeit", "time_ms", "elapsed"})
    EXPECT_EQ(role(name), ScalarRole::kTime) << name;
  for (const char* name : {"Force", "Standardkraft", "Standard force [N]", "F", "load (N)", "fn",
                           "force_mN", "Fz_normalforce"})
    EXPECT_EQ(role(name), ScalarRole::kForce) << name;
  for (const char* name :
       {"depth", "Standardweg", "Travel", "indentation_mm", "Eindringtiefe", "crosshead", "Weg/mm"})
    EXPECT_EQ(role(name), ScalarRole::kDepth) << name;
  EXPECT_EQ(role("Temperatur [°C]"), ScalarRole::kTemperature);
  EXPECT_EQ(role("depth_index"), ScalarRole::kSample);
  for (const char* name : {"strain", "stress [MPa]", "force rate", "comment"})
    EXPECT_EQ(role(name), ScalarRole::kCount) << name;
}

TEST(ImportColumns, VectorNames) {
  const auto role = [](const char* name) {
    VectorRole found = VectorRole::kCount;
    for (const Component& part : components(take_apart(name).words))
      if (found == VectorRole::kCount) found = vector_role(part.base);
    return found;
  };
  EXPECT_EQ(role("x"), VectorRole::kPlain);
  EXPECT_EQ(role("CurrentPos_1"), VectorRole::kTip);
  EXPECT_EQ(role("x_tip"), VectorRole::kTip);
  EXPECT_EQ(role("ContactPointX"), VectorRole::kContact);
  EXPECT_EQ(role("contact_nx"), VectorRole::kNormal);
  EXPECT_EQ(role("surface_normal_x"), VectorRole::kNormal);
  EXPECT_EQ(role("DeformedForce_x"), VectorRole::kForce);
  EXPECT_EQ(role("Fx [N]"), VectorRole::kForce);
  EXPECT_EQ(role("F_x_tool"), VectorRole::kForce);
  EXPECT_EQ(role("ContactForce_x"), VectorRole::kCount);
  EXPECT_EQ(role("contact_fx"), VectorRole::kCount);
  EXPECT_EQ(role("ContactBallCenter_x"), VectorRole::kContactBall);
  EXPECT_EQ(role("ux"), VectorRole::kDisplacement);
  EXPECT_EQ(role("torque_x"), VectorRole::kCount);
}

TEST(ImportColumns, PressesAreNamedByTwoColumns) {
  const ImportResult result =
      import_text(organ("region,point,x_mm,y_mm,z_mm,nx,ny,nz,depth_mm,fx,fy,fz",
                        [](int i, const Site& s, double d, const Vec3& f) {
                          return fmt::format("{},{}", i <= 10 ? "left" : "right", (i - 1) % 10) +
                                 cells(s.point) + cells(s.normal) + fmt::format(",{}", d) +
                                 cells(f);
                        }));
  EXPECT_EQ(result.recording.presses().size(), 20u);
}

TEST(ImportColumns, OverridesAndSplit) {
  ImportOptions options;
  options.columns = {"force=b", "depth=a"};
  options.split_by = "c";
  options.units = {"mm", "mN", ""};
  std::string text = "a,b,c\n";
  for (int c = 0; c < 2; ++c)
    for (int i = 0; i < 10; ++i) text += fmt::format("{},{},{}\n", 0.5 * i, 100 * i, c);
  const ImportResult result = import_text(text, options);
  EXPECT_EQ(result.recording.presses().size(), 2u);
  EXPECT_NEAR(result.recording.f[9].z(), 0.9, 1e-9);
}

TEST(ImportColumns, ListSaysWhatIsMissing) {
  Input input = Input::from_bytes("Zeit;Weg\ns;mm\n0;1\n1;2\n2;3\n", "data.csv");
  const std::string text = describe_columns(read_raw_table(input), {});
  EXPECT_NE(text.find("mm       depth"), std::string::npos) << text;
  EXPECT_NE(text.find("missing: a force"), std::string::npos) << text;
}

TEST(ImportColumns, BlocksAreClosedAndOutward) {
  EXPECT_LT((parse_block("120x80x40mm").size - Vec3(0.12, 0.08, 0.04)).norm(), 1e-12);
  EXPECT_LT((parse_block("0.12,0.08,0.04").size - Vec3(0.12, 0.08, 0.04)).norm(), 1e-12);
  for (const char* wrong : {"120mm", "120x0x4", "1x2x3x4mm", "120x", "x80mm"})
    EXPECT_THROW(parse_block(wrong), Error) << wrong;
  const Block round = parse_block("50x30mm");
  EXPECT_TRUE(round.round);
  EXPECT_TRUE(is_closed(block_surface(round)));
  EXPECT_NEAR(signed_volume(block_surface(round)), M_PI * 0.025 * 0.025 * 0.03, 1e-9);
  const Surface block = block_surface({Vec3(0.12, 0.08, 0.04)});
  EXPECT_TRUE(is_closed(block));
  EXPECT_NEAR(signed_volume(block), 0.12 * 0.08 * 0.04, 1e-12);
}

}  // namespace
}  // namespace hapsim::test
