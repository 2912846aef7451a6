// Names of columns, units and separators, one by one.
#include <gtest/gtest.h>

#include "tables/column_name.h"
#include "tables/raw_rows.h"

namespace hapsim::test {
namespace {

TEST(Tables, UnitsInNames) {
  const auto unit = [](const char* name) { return take_apart(name).unit.name; };
  EXPECT_EQ(unit("Standardkraft [N]"), "N");
  EXPECT_EQ(unit("Weg in mm"), "mm");
  EXPECT_EQ(unit("Kraft/mN"), "mN");
  EXPECT_EQ(unit("time (sec)"), "s");
  EXPECT_EQ(unit("x_mm"), "mm");
  EXPECT_EQ(unit("Tiefe [µm]"), "um");
  EXPECT_EQ(unit("depth"), "");
  EXPECT_EQ(take_apart("ContactPoint_x [mm]").joined(), "contactpointx");
}

TEST(Tables, PrefixesAndCaseOfUnits) {
  const auto factor = [](const char* name) { return take_apart(name).unit.factor; };
  EXPECT_DOUBLE_EQ(factor("Extend Force(nN)"), 1e-9);
  EXPECT_DOUBLE_EQ(factor("Pd (µm)"), 1e-6);
  EXPECT_DOUBLE_EQ(factor("荷重（ｍＮ）"), 1e-3);
  EXPECT_DOUBLE_EQ(factor("Effort (daN)"), 10);
  EXPECT_DOUBLE_EQ(factor("LOAD(KN)"), 1e3);
  EXPECT_DOUBLE_EQ(factor("载荷 (毫牛)"), 1e-3);
  EXPECT_DOUBLE_EQ(factor("distance_mm"), 1e-3);
  EXPECT_EQ(take_apart("Moment (Nm)").unit.kind, UnitKind::kOther);
  EXPECT_EQ(take_apart("Travel (nm)").unit.kind, UnitKind::kLength);
  EXPECT_EQ(take_apart("LOAD (MN)").unknown, "MN");
  EXPECT_EQ(take_apart("Force (raw)").unknown, "");
  EXPECT_DOUBLE_EQ(take_apart("Temp (K)").unit.offset, -273.15);
}

TEST(Tables, SeparatorsAndDecimalCommas) {
  EXPECT_EQ(find_separator({"0,5;1,5;2", "1,5;2,5;3"}), ';');
  EXPECT_EQ(find_separator({"0,5\t1,5", "1,5\t2,5"}), '\t');
  EXPECT_EQ(find_separator({"0.5, 1.5", "1.5, 2.5"}), ',');
  EXPECT_EQ(find_separator({"  0.5  1.5", "1.5 2.5"}), ' ');
  EXPECT_EQ(find_separator({"only text", "here"}), 0);
}

}  // namespace
}  // namespace hapsim::test
