#include "realtime/motion_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "base/error.h"
#include "realtime/force_loop.h"
#include "realtime/live_session.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

Input text(const std::string& bytes) {
  return Input::from_bytes(bytes, "motion.csv");
}

TEST(MotionLines, ReadsBothKindsByName) {
  Input known =
      text("# tool_radius: 0.004\nt,press,note,x,y,z,ux,uy,uz\n0.5,3,a,1,2,3,0.1,0.2,0.3\n");
  MotionLines lines(known);
  MotionLine line;
  ASSERT_TRUE(lines.next(line));
  EXPECT_TRUE(line.has_contact_point);
  EXPECT_EQ(line.press, 3);
  EXPECT_EQ(line.t, 0.5);
  EXPECT_EQ(line.point, Vec3(1, 2, 3));
  EXPECT_EQ(line.u, Vec3(0.1, 0.2, 0.3));
  EXPECT_FALSE(lines.next(line));
  EXPECT_EQ(lines.metadata().find("tool_radius"), "0.004");
  Input tip = text("t,x,y,z\n1,2,3,4\n");
  MotionLines positions(tip);
  ASSERT_TRUE(positions.next(line));
  EXPECT_FALSE(line.has_contact_point);
  EXPECT_EQ(line.point, Vec3(2, 3, 4));
}

TEST(MotionLines, NamesTheLineOfWhatIsWrong) {
  const std::string header = "press,t,x,y,z,ux,uy,uz\n1,0.2,0,0,0,0,0,0\n";
  const std::pair<const char*, const char*> cases[] = {
      {"1,0.3,0,0,zero,0,0,0\n", "z is 'zero'"},   {"1,0.3,0,0,nan,0,0,0\n", "z is 'nan'"},
      {"1,0.1,0,0,0,0,0,0\n", "runs backwards"},   {"1.5,0.3,0,0,0,0,0,0\n", "not an integer"},
      {"1,0.3,0,0.01,0,0,0,0\n", "contact point"}, {"1,0.3,0,0,0,0,0,5\n", "millimetres"},
      {"1,0.3,0,0,0,0,0\n", "motion.csv:3"}};
  for (const auto& [row, wrong] : cases) {
    Input input = text(header + row);
    MotionLines lines(input);
    MotionLine line;
    ASSERT_TRUE(lines.next(line));
    try {
      lines.next(line);
      ADD_FAILURE() << row;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_NE(std::string(error.what()).find("motion.csv:3"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(wrong), std::string::npos) << error.what();
    }
  }
  Input missing = text("press,t,x,y,z,ux,uy\n");
  EXPECT_ANY_THROW(MotionLines{missing});
}

TEST(WriteForceLine, ReadsBack) {
  MotionLine line;
  line.press = 2;
  line.t = 0.1;
  line.point = {1.0 / 3, 0, 1e-7};
  line.u = {-0.0, 0, -0.002};
  std::string buffer;
  write_force_line(buffer, line, {0.1, -2, 3e-20});
  EXPECT_EQ(buffer, "2,0.1,0.3333333333333333,0,1e-07,0,0,-0.002,0.1,-2,3e-20,1\n");
}

// An output that tells how many whole lines have been flushed.
class Flushes : public std::stringbuf {
 public:
  int count = 0;

 protected:
  int sync() override {
    ++count;
    return 0;
  }
};

TEST(LiveSession, FlushesEachForceAndKeepsThoseBeforeABadLine) {
  Model model;
  for (const Effect* effect : catalogue())
    if (effect->card().name == "elastic") model.parameters = effect_rows(*effect, 1, {2e4, 0.4});
  PreparedBodyOptions options;
  options.tool_radius = 0.004;
  options.most_samples = 16;
  options.rim_edge = 0.5;  // no test of it: quick
  const PreparedBody body(test::block_mesh({0.08, 0.08, 0.04}, 4, 4, 3, 1), model, options);
  Input input = text(
      "t,x,y,z\n0,0.04,0.04,0.041\n0.001,0.04,0.04,0.0405\n0.002,0.04,0.04,0.0395\n0.003,oops,0,"
      "0\n");
  MotionLines lines(input);
  Flushes buffer;
  std::ostream out(&buffer);
  LiveReport report;
  ForceLoop loop(body);
  EXPECT_THROW(run_live(lines, out, loop, {}, report), Error);
  EXPECT_EQ(buffer.count, 3);
  EXPECT_EQ(report.latency.count(), 3);
  const std::string written = buffer.str();
  EXPECT_EQ(std::count(written.begin(), written.end(), '\n'), 3);
  EXPECT_NE(written.find("\n1,0.002,0.04,0.04,0.04,0,0,"), std::string::npos) << written;
}

}  // namespace
}  // namespace hapsim
