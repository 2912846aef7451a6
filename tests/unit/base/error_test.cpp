#include "base/error.h"

#include "expect_error.h"

namespace hapsim {
namespace {

TEST(Error, SaysWhereWhatAndMendInOneLine) {
  EXPECT_EQ(error_of([] { fail_input("data.csv:17", "force is nan", "remove the row"); }),
            "data.csv:17: force is nan; remove the row");
}

TEST(Error, StaysOneLine) {
  EXPECT_EQ(error_of([] { fail_input("a\nb", "c\r\nd", "e"); }), "a b: c  d; e");
}

TEST(Error, LeavesOutWhatIsEmpty) {
  EXPECT_EQ(error_of([] { fail_usage("wrong", ""); }, ExitCode::kUsage), "wrong");
}

TEST(Error, HasTheExitCodeOfItsKind) {
  error_of([] { fail_numerics("", "a", "b"); }, ExitCode::kNoConvergence);
  error_of([] { fail_io("", "a", "b"); }, ExitCode::kIo);
}

}  // namespace
}  // namespace hapsim
