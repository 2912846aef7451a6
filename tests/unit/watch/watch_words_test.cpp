#include "watch/watch_words.h"

#include <gtest/gtest.h>

#include <sstream>

#include "expect_error.h"
#include "io/csv.h"
#include "watch/rate_check.h"

namespace hapsim {
namespace {

WatchEvent moved() {
  WatchEvent e;
  e.begun = 1;
  e.alarm = 1.5;
  e.named = 2;
  e.change = Change::kMoved;
  e.correction.shift = Vec3(0.001, 0, -0.002);
  e.correction.bias = Vec3(0, 0.25, 0);
  e.shift_error = Vec3(1e-4, 1e-4, 2e-4);
  e.error_before = 0.01;
  e.error_with = 0.015;
  e.presses = 4;
  return e;
}

TEST(WatchWords, SayHowWellAChangeExplains) {
  EXPECT_EQ(refined_words(moved(), 3),
            "3.000 s: shift by (1.00, 0.00, -2.00) mm after 4 presses, standard error (0.1, 0.1, "
            "0.2) mm; the usual error is learned anew");
  WatchEvent e = moved();
  e.error_with = 0.03;  // three times the usual
  EXPECT_NE(refined_words(e, 3).find("the error stays 3 times the usual"), std::string::npos);
  e.change = Change::kSensor;  // is not refined
  EXPECT_EQ(refined_words(e, 3), "");
  e.change = Change::kMaterial;
  EXPECT_NE(refined_words(e, 3), "");
  e.presses = 0;
  EXPECT_EQ(refined_words(e, 3), "");
}

TEST(WatchWords, EventsAreRows) {
  std::vector<WatchEvent> events{moved(), moved()};
  events[0].updated = 2.5;
  events[1].change = Change::kGone;
  events[1].correction.gone = true;
  std::ostringstream out;
  write_events(out, {{"left", {events[0]}}, {"right", {events[1]}}});
  Input input = Input::from_bytes(out.str(), "events.csv");
  const CsvTable table = read_csv(input);
  ASSERT_EQ(table.rows(), 2u);
  const auto cell = [&](const std::string& column, std::size_t row) {
    return table.columns[static_cast<std::size_t>(table.find(column))][row];
  };
  EXPECT_EQ(cell("change", 0), "moved");
  EXPECT_EQ(cell("stiffness", 0), "1");
  EXPECT_EQ(cell("stiffness", 1), "0");  // gone
  EXPECT_EQ(cell("updated", 0), "2.5");
  EXPECT_EQ(cell("updated", 1), "");  // not yet
  EXPECT_EQ(cell("bias_y", 0), "0.25");
  EXPECT_EQ(cell("shift_z", 0), "-0.002");
  EXPECT_EQ(cell("shift_error_z", 0), "0.0002");
  EXPECT_EQ(cell("tool_id", 1), "right");
  std::ostringstream of_one;
  write_events(of_one, {{"", events}});
  EXPECT_EQ(of_one.str().find("tool_id"), std::string::npos);
}

// Rows of presses of a second each at `rate`, checked against what is said.
void check(double said, double rate) {
  RateCheck check(said);
  MotionLine line;
  for (int i = 0; i < 300; ++i) {
    line.t = i / rate;
    line.press = 1 + static_cast<int>(line.t);
    check.add(line, "stream");
  }
}

TEST(RateCheck, CountsStepsWithinPresses) {
  check(100, 100);
  check(100, 60);  // within a factor of two
  check(100, 190);
  const std::string slow = error_of([] { check(1000, 100); });
  EXPECT_NE(slow.find("stream: the rows come at some 100 Hz by their t, not 1000 Hz"),
            std::string::npos)
      << slow;
  EXPECT_NE(error_of([] { check(100, 1000); }), "");
}

TEST(RateCheck, PausesBetweenPressesAreNoRate) {
  RateCheck check(1000);
  MotionLine line;
  for (int i = 0; i < 300; ++i) {
    line.t = 0.001 * i + 10 * (i / 3);  // three rows a press, then ten seconds
    line.press = i / 3;
    EXPECT_NO_THROW(check.add(line, "stream"));
  }
}

}  // namespace
}  // namespace hapsim
