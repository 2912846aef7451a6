// Motions of several tools as lines and as versioned records.
#include "realtime/tool_records.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "expect_error.h"
#include "realtime/tool_lines.h"

namespace hapsim {
namespace {

template <class T>
void put(std::string& to, T value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  to.append(bytes, sizeof value);
}

std::string header(std::uint32_t version, std::uint32_t size, std::uint32_t tools,
                   std::uint32_t kind) {
  std::string bytes = "hapsimIO";
  for (const std::uint32_t number : {version, size, tools, kind}) put(bytes, number);
  bytes.resize(32, '\0');
  return bytes;
}

void put_pose(std::string& bytes, int press, int contact, double first) {
  put(bytes, static_cast<std::int32_t>(press));
  put(bytes, static_cast<std::int32_t>(contact));
  for (int k = 0; k < 9; ++k) put(bytes, first + 0.001 * k);
}

Input bytes_of(const std::string& bytes) {
  return Input::from_bytes(bytes, "motion.bin");
}

TEST(ToolRecords, AreReadWhateverALaterVersionAddsAtTheirEnd) {
  // Someone who knows version 7, with 24 bytes more a record.
  std::string bytes = header(7, 16 + 2 * 80 + 24, 2, 1);
  for (int i = 0; i < 3; ++i) {
    put(bytes, 0.25 * i);
    put(bytes, std::nan(""));
    put_pose(bytes, 1, 1, 0.1);
    put_pose(bytes, 2, i == 2 ? 0 : 1, 0.2);
    bytes.append(24, 'x');
  }
  Input input = bytes_of(bytes);
  ToolRecords records(input);
  EXPECT_EQ(records.tools(), 2U);
  EXPECT_TRUE(records.has_contact_point());
  const std::string answer = records.header();
  ASSERT_EQ(answer.size(), 32U);
  std::uint32_t spoken[4];
  std::memcpy(spoken, answer.data() + 8, sizeof spoken);
  EXPECT_EQ(spoken[0], 4U);
  EXPECT_EQ(spoken[1], 16U + 2 * 192U);
  EXPECT_EQ(spoken[2], 2U);
  EXPECT_EQ(spoken[3], 1U);
  ToolStep step;
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(records.next(step));
    EXPECT_EQ(step.t, 0.25 * i);
    EXPECT_TRUE(std::isnan(step.temperature));
    EXPECT_LT((step.pose[0].turn - Vec3(0.106, 0.107, 0.108)).norm(), 1e-15);
    EXPECT_LT((step.pose[1].u - Vec3(0.203, 0.204, 0.205)).norm(), 1e-15);
    EXPECT_EQ(step.pose[1].press, 2);
    EXPECT_EQ(step.pose[1].in_air, i == 2);
  }
  EXPECT_FALSE(records.next(step));
  std::array<ToolFeel, 2> feel;
  feel[1].force = {1, 2, 3};
  feel[1].torque = {4, 5, 6};
  feel[1].beyond = 3 | kBeyondLaw;
  feel[1].safety = 257;
  feel[1].asked_torque = {7, 8, 9};
  std::string out;
  records.write(out, step, feel);
  ASSERT_EQ(out.size(), 16U + 2 * 192U);
  double torque = 0;
  std::memcpy(&torque, out.data() + 16 + 144 + 16 + 12 * 8, 8);
  EXPECT_EQ(torque, 4);
  std::int32_t beyond = 0;
  std::memcpy(&beyond, out.data() + 16 + 144 + 8, 4);
  EXPECT_EQ(beyond, 3 | kBeyondLaw);
  std::int32_t safety = 0;
  std::memcpy(&safety, out.data() + 16 + 144 + 12, 4);
  EXPECT_EQ(safety, 257);
  std::memcpy(&torque, out.data() + 16 + 2 * 144 + 48 + 24, 8);
  EXPECT_EQ(torque, 7) << "after all of version 2";
}

TEST(ToolRecords, SpeakTheVersionThatIsAsked) {
  Input input = bytes_of(header(2, 96, 1, 0));
  const ToolRecords records(input);
  const std::string answer = records.header();
  std::uint32_t spoken[2];
  std::memcpy(spoken, answer.data() + 8, sizeof spoken);
  EXPECT_EQ(spoken[0], 2U);
  EXPECT_EQ(spoken[1], 160U);
  EXPECT_FALSE(records.takes_unasked());
  std::string out;
  records.write(out, {}, std::array<ToolFeel, 1>());
  EXPECT_EQ(out.size(), 160U);
  // Who asks for an older version is told nothing that it does not know.
  Input older_input = bytes_of(header(3, 96, 1, 0));
  const ToolRecords older(older_input);
  std::array<ToolFeel, 1> feel;
  feel[0].beyond = kBeyondDepth | kBeyondFitted | kBeyondSpeed | kBeyondLaw | kBeyondClose;
  older.write(out, {}, feel);
  EXPECT_EQ(out.size(), 208U);
  std::int32_t beyond = 0;
  std::memcpy(&beyond, out.data() + 16 + 8, 4);
  EXPECT_EQ(beyond, kBeyondDepth | kBeyondClose);
}

TEST(ToolRecords, RefuseWhatTheyCannotServe) {
  const std::pair<std::string, const char*> cases[] = {{"hapsim", "no header"},
                                                       {std::string(32, 'x'), "no header"},
                                                       {header(1, 96, 1, 0), "version 1"},
                                                       {header(2, 96, 0, 0), "0 tools"},
                                                       {header(2, 96, 5, 0), "5 tools"},
                                                       {header(2, 95, 1, 0), "95 bytes"},
                                                       {header(2, 96, 1, 2), "kind is 2"}};
  for (const auto& [bytes, wrong] : cases) {
    Input input = bytes_of(bytes);
    EXPECT_NE(error_of([&] { ToolRecords records(input); }, ExitCode::kBadInput).find(wrong),
              std::string::npos)
        << wrong;
  }
  std::string bytes = header(2, 96, 1, 0);
  put(bytes, 0.0);
  put(bytes, std::nan(""));
  put_pose(bytes, 1, 1, std::nan(""));
  put(bytes, 1.0);
  Input input = bytes_of(bytes);
  ToolRecords records(input);
  ToolStep step;
  EXPECT_NE(error_of([&] { records.next(step); }, ExitCode::kBadInput).find("record 1"),
            std::string::npos);
  EXPECT_NE(error_of([&] { records.next(step); }, ExitCode::kBadInput).find("8 bytes of 96"),
            std::string::npos);
}

ToolLines lines_of(Input& input, std::size_t tools = 0) {
  return {CsvReader(input), input.name(), tools};
}

TEST(ToolLines, LinesOfOneTimeAreAStep) {
  const std::string text =
      "t,tool_id,x,y,z,thx,thy,thz\n"
      "0,left,0,0,1,0,0,0\n0,right,1,0,1,0,0,0.5\n1,right,1,0,1,0,0,0.5\n1,left,0,0,1,0,0,0\n"
      "2,left,0,0,1,0,0,0\n";
  Input input = bytes_of(text);
  ToolLines lines = lines_of(input);
  ToolStep step;
  ASSERT_TRUE(lines.next(step));
  EXPECT_EQ(step.t, 0);
  EXPECT_EQ(step.pose[1].turn.z(), 0.5);
  ASSERT_TRUE(lines.next(step));
  EXPECT_TRUE(step.present[0] && step.present[1] && !step.present[2]);
  std::string out;
  std::array<ToolFeel, kMostTools> feel;
  feel[0].press = 7;
  lines.write(out, step, feel);
  // In the order of the lines.
  EXPECT_EQ(out.substr(0, 10), "0,1,right,");
  EXPECT_NE(out.find("\n7,1,left,"), std::string::npos);
  feel[0].uncertainty = 0.125;
  lines.tell_uncertainty();
  EXPECT_EQ(lines.columns().back(), "uncertainty");
  lines.write(out, step, feel);
  EXPECT_EQ(out.substr(out.size() - 7), ",0.125\n");
  ASSERT_TRUE(lines.next(step));
  EXPECT_FALSE(step.present[1]);
  EXPECT_FALSE(lines.next(step));
  const std::vector<std::string> columns = lines.columns();
  EXPECT_EQ(std::count(out.begin(), out.begin() + static_cast<long>(out.find('\n')), ',') + 1,
            static_cast<long>(columns.size()));
  Input counted = bytes_of(text);
  ToolLines two = lines_of(counted, 2);
  ASSERT_TRUE(two.next(step));
  ASSERT_TRUE(two.next(step));
  EXPECT_FALSE(two.next(step));  // the last one is not whole
}

TEST(ToolLines, SayWhatIsWrong) {
  const auto wrong = [](const std::string& text, std::size_t tools, int steps) {
    Input input = bytes_of(text);
    return error_of(
        [&] {
          ToolLines lines = lines_of(input, tools);
          ToolStep step;
          for (int i = 0; i < steps; ++i) lines.next(step);
        },
        ExitCode::kBadInput);
  };
  EXPECT_NE(wrong("t,tool_id,x,y,z,thx,thy\n", 0, 0).find("thz"), std::string::npos);
  EXPECT_NE(wrong("# tools: 5\nt,tool_id,x,y,z\n", 0, 0).find("tools is 5"), std::string::npos);
  EXPECT_NE(wrong("t,tool_id,x,y,z\n0,a,0,0,1\n1,a,0,0,1\n", 2, 2).find("motion.bin:3"),
            std::string::npos);
  EXPECT_NE(wrong("t,tool_id,x,y,z\n0,a,0,0,1\n0,b,0,0,1\n0,c,0,0,1\n", 2, 2).find("one tool more"),
            std::string::npos);
  EXPECT_NE(wrong("t,tool_id,x,y,z\n1,a,0,0,1\n1,b,0,0,1\n0,a,0,0,1\n0,b,0,0,1\n", 2, 2)
                .find("runs backwards"),
            std::string::npos);
}

}  // namespace
}  // namespace hapsim
