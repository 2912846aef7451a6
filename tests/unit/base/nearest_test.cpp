#include "base/nearest.h"

#include <gtest/gtest.h>

namespace hapsim {
namespace {

TEST(Nearest, FindsMisspelledWords) {
  EXPECT_EQ(nearest("--efects", {"--unit", "--effects", "--body"}), "--effects");
  EXPECT_EQ(nearest("FX", {"fy", "fx", "fz"}), "fx");
  EXPECT_EQ(nearest("forcex", {"force_x", "force_y"}), "force_x");
}

TEST(Nearest, PrefersTheFirstOfEquals) {
  EXPECT_EQ(nearest("fw", {"fx", "fy"}), "fx");
}

TEST(Nearest, IsSilentWhenNothingIsNear) {
  EXPECT_EQ(nearest("temperature", {"x", "y", "press"}), "");
  EXPECT_EQ(nearest("x", {}), "");
  EXPECT_EQ(nearest(std::string(1000000, 'a'), {std::string(1000000, 'b')}), "");
}

}  // namespace
}  // namespace hapsim
