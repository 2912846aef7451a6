#include "io/metadata.h"

#include "expect_error.h"

namespace hapsim {
namespace {

TEST(Metadata, TellsPairsFromComments) {
  Metadata m;
  m.add_line(" tool_radius: 0.004");
  m.add_line("temp_ref:21");
  m.add_line(" measured at 12:30: cold");
  m.add_line(" https://example.org");
  m.add_line("empty:");
  ASSERT_EQ(m.lines().size(), 5u);
  EXPECT_EQ(m.find("tool_radius"), "0.004");
  EXPECT_EQ(m.lines()[1].key, "");
  EXPECT_EQ(m.lines()[1].value, "temp_ref:21");
  EXPECT_EQ(m.lines()[2].key, "");
  EXPECT_EQ(m.lines()[3].key, "");
  EXPECT_EQ(m.find("empty"), "");
  EXPECT_FALSE(m.find("absent"));
}

TEST(Metadata, SetReplacesAllAndAppendKeeps) {
  Metadata m;
  m.append("command", "a");
  m.add_comment("between");
  m.append("command", "b");
  EXPECT_EQ(m.find("command"), "b");
  EXPECT_EQ(m.lines().size(), 3u);
  m.set("command", "c");
  ASSERT_EQ(m.lines().size(), 2u);
  EXPECT_EQ(m.lines()[0].value, "c");
  m.remove("command");
  EXPECT_EQ(m.lines().size(), 1u);
}

TEST(Metadata, StaysOnOneLine) {
  Metadata m;
  m.set("note", "a\nb");
  EXPECT_EQ(m.find("note"), "a b");
}

TEST(Metadata, NumbersAreChecked) {
  Metadata m;
  m.set("force_noise", "0.01 N");
  EXPECT_EQ(error_of([&] { m.number("force_noise", "d.csv"); }),
            "d.csv: metadata 'force_noise' is '0.01 N', not a number; write it as "
            "'# force_noise: 0.5'");
  EXPECT_FALSE(m.number("absent", "d.csv"));
}

}  // namespace
}  // namespace hapsim
