#include "io/extension.h"

#include <gtest/gtest.h>

namespace hapsim {
namespace {

TEST(Extension, IsTheEndOfANameInLowerCase) {
  EXPECT_EQ(extension_of("a/b.c/surface.STL"), "stl");
  EXPECT_EQ(extension_of("body.tar.gz"), "gz");
  for (const char* none : {"-", "", "surface", "a.b/surface", ".ply", "run.2", "end."})
    EXPECT_EQ(extension_of(none), "") << none;
}

}  // namespace
}  // namespace hapsim
