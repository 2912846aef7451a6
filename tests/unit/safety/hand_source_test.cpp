// A hand between a motion and a loop that may not answer.
#include "safety/hand_source.h"

#include <gtest/gtest.h>

#include <chrono>
#include <sstream>
#include <string>
#include <thread>

#include "base/random.h"
#include "realtime/motion_lines.h"
#include "realtime/tool_lines.h"
#include "safety/hand_tools.h"

namespace hapsim {
namespace {

using std::chrono::milliseconds;

std::string motion(int lines, bool turns) {
  std::string text =
      turns ? "press,t,tool_id,x,y,z,ux,uy,uz,thx,thy,thz\n" : "press,t,x,y,z,ux,uy,uz\n";
  for (int i = 0; i < lines; ++i)
    for (int k = 0; k < (turns ? 2 : 1); ++k)
      text += "1," + std::to_string(0.001 * i) + (turns ? (k == 0 ? ",a" : ",b") : "") +
              ",0,0,0,0,0,-0.001" + (turns ? ",0,0,0.1" : "") + "\n";
  return text;
}

struct Row {
  double force = 0;
  int safety = 0;
};

std::vector<Row> rows(const std::string& text, std::size_t force, std::size_t safety) {
  std::vector<Row> all;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> fields(1);
    for (const char c : line)
      if (c == ',')
        fields.emplace_back();
      else
        fields.back() += c;
    all.push_back({std::stod(fields[force]), std::stoi(fields[safety])});
  }
  return all;
}

SafetyLimits quick() {
  SafetyLimits limits;
  limits.hold = 0.05;
  limits.ramp = 0.05;
  return limits;
}

// The loop answers ten lines, hangs in the eleventh, and answers the rest.
void answer(HandSource& hand, std::ostream& out, int hang_ms) {
  MotionLine line;
  std::string text;
  for (int i = 0; hand.next(line); ++i) {
    if (i == 10) std::this_thread::sleep_for(milliseconds(hang_ms));
    hand.write_force(text, line, {0, 0, 1});
    out << text;
    out.flush();
    std::this_thread::sleep_for(milliseconds(1));
  }
}

TEST(HandSource, GoesToZeroWhileTheLoopHangs) {
  Input input = Input::from_bytes(motion(200, false), "motion.csv");
  MotionLines lines(input);
  std::ostringstream out;
  {
    HandSource hand(lines, input, quick(), out);
    answer(hand, out, 400);
    hand.end();
  }
  const std::vector<Row> all = rows(out.str(), 10, 13);
  ASSERT_GT(all.size(), 220U) << "answers of its own while it hung";
  EXPECT_EQ(all[9].force, 1);
  EXPECT_EQ(all[9].safety, 0);
  std::size_t zero = 0, late = 0;
  for (std::size_t i = 10; i < all.size(); ++i) {
    if ((all[i].safety & kSafeUnasked) == 0) {
      late = i;  // what it answers at last is not felt
      break;
    }
    EXPECT_LE(all[i].force, all[i - 1].force);
    if (all[i].force == 0) ++zero;
  }
  EXPECT_EQ(zero, 1U) << "once at zero there is nothing to say";
  ASSERT_GT(late, 30U);
  EXPECT_EQ(all[late].force, 0);
  EXPECT_NE(all[late].safety & kSafeRamped, 0);
  EXPECT_GT(all[all.size() - 2].force, 0.9) << "and it goes on";
  EXPECT_EQ(all.back().force, 0);
  EXPECT_EQ(all.back().safety, kSafeEnded);
}

TEST(HandSource, ALoopThatAnswersIsNotTouched) {
  Input input = Input::from_bytes(motion(200, false), "motion.csv");
  MotionLines lines(input);
  std::ostringstream out;
  SafetyLimits limits;
  limits.hold = 5;  // whatever else this machine does
  HandSource hand(lines, input, limits, out);
  answer(hand, out, 0);
  hand.end();
  const std::vector<Row> all = rows(out.str(), 10, 13);
  ASSERT_EQ(all.size(), 201U);
  for (std::size_t i = 0; i < 200; ++i) EXPECT_EQ(all[i].safety & ~kSafeRate, 0) << i;
  EXPECT_FALSE(hand.lost());
}

TEST(HandTools, GoToZeroWhileTheLoopHangs) {
  Input input = Input::from_bytes(motion(200, true), "motion.csv");
  ToolLines lines{CsvReader(input), "motion.csv", 2};
  lines.tell_hand();
  std::ostringstream out;
  {
    HandTools hand(lines, input, quick(), out);
    ToolStep step;
    std::array<ToolFeel, 2> feel;
    for (ToolFeel& f : feel) {
      f.press = 1;
      f.force = {0, 0, 1};
      f.torque = {0, 0.01, 0};
    }
    std::string text;
    for (int i = 0; hand.next(step); ++i) {
      if (i == 10) std::this_thread::sleep_for(milliseconds(300));
      hand.write(text, step, feel);
      out << text;
      std::this_thread::sleep_for(milliseconds(1));
    }
    hand.end();
  }
  // press, t, tool_id, x y z, ux uy uz, thx thy thz, fx fy fz, tqx tqy tqz, contact, beyond, safety
  const std::vector<Row> forces = rows(out.str(), 14, 20), torques = rows(out.str(), 16, 20);
  ASSERT_GT(forces.size(), 440U);
  EXPECT_EQ(forces[19].force, 1);
  EXPECT_EQ(torques[19].force, 0.01);
  long zeros = 0;
  for (std::size_t i = 20; i < forces.size() - 2; ++i)
    zeros += forces[i].force == 0 && torques[i].force == 0 && (forces[i].safety & kSafeRamped) != 0;
  EXPECT_GE(zeros, 2);
  EXPECT_GT(forces[forces.size() - 3].force, 0.9);
  EXPECT_EQ(forces.back().force, 0);
  EXPECT_EQ(forces.back().safety, kSafeEnded);
}

}  // namespace
}  // namespace hapsim
