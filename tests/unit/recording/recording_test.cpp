#include "recording/recording.h"

#include <sstream>

#include "expect_error.h"
#include "recording/contact_points.h"

namespace hapsim {
namespace {

const std::string kHeader = "press,t,x,y,z,ux,uy,uz,fx,fy,fz\n";

Recording recording_of(const std::string& text, bool need_forces = true) {
  Input input = Input::from_bytes(text, "d.csv");
  return read_recording(input, need_forces);
}

std::string failure(const std::string& text) {
  return error_of([&] { recording_of(text); });
}

TEST(Recording, ReadsColumnsInAnyOrder) {
  const Recording r = recording_of(
      "# tool_radius: 0.004\n# force_noise: 0.01\n"
      "fz,fy,fx,uz,uy,ux,z,y,x,press,mood,contact,temp\n"
      "3,2,1,-0.003,0.002,0.001,0.3,0.2,0.1,7,good,1,20\n"
      "3,2,1,-0.003,0.002,0.001,0.3,0.2,0.1,7,bad,0,21\n");
  EXPECT_EQ(r.rows(), 2u);
  EXPECT_EQ(r.f[0], Vec3(1, 2, 3));
  EXPECT_EQ(r.u[0], Vec3(0.001, 0.002, -0.003));
  EXPECT_EQ(r.position[0], Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(r.press[0], 7);
  EXPECT_TRUE(r.t.empty());
  EXPECT_EQ(r.temp, (std::vector<double>{20, 21}));
  EXPECT_FALSE(r.in_air(0));
  EXPECT_TRUE(r.in_air(1));
  EXPECT_EQ(r.extra_header, (std::vector<std::string>{"mood"}));
  EXPECT_EQ(r.extra[0][1], "bad");
  EXPECT_EQ(r.tool_radius(), 0.004);
  EXPECT_EQ(r.force_noise(), 0.01);
}

TEST(Recording, RowsOfAPressMayBeInterleaved) {
  const Recording r = recording_of(kHeader +
                                   "2,0,0,0,0,0,0,0,0,0,0\n1,5,0,0,0,0,0,0,0,0,0\n"
                                   "2,1,0,0,0,0,0,0,0,0,0\n");
  const auto presses = r.presses();
  ASSERT_EQ(presses.size(), 2u);
  EXPECT_EQ(presses[0].id, 2);
  EXPECT_EQ(presses[0].rows, (std::vector<int>{0, 2}));
  EXPECT_EQ(presses[1].rows, (std::vector<int>{1}));
}

TEST(Recording, MayLackForcesWhenItIsAMotion) {
  const std::string motion = "press,x,y,z,ux,uy,uz\n1,0,0,0,0,0,0\n";
  EXPECT_TRUE(recording_of(motion, false).f.empty());
  EXPECT_EQ(failure(motion), "d.csv: column 'fx' is missing; present are: press x y z ux uy uz");
  EXPECT_EQ(recording_of(kHeader + "1,0,0,0,0,0,0,0,1,2,3\n", false).f.size(), 1u);
  const std::string partly = "press,x,y,z,ux,uy,uz,fz\n1,0,0,0,0,0,0,1\n";
  EXPECT_NE(error_of([&] { recording_of(partly, false); }).find("'fx' is missing"),
            std::string::npos);
}

TEST(Recording, RefusesWrongRows) {
  EXPECT_EQ(failure(kHeader), "d.csv: there is a header but no data row; add the recorded rows");
  EXPECT_EQ(failure(kHeader + "1,1,0,0,0,0,0,0,0,0,0\n1,0.5,0,0,0,0,0,0,0,0,0\n"),
            "d.csv:3: time runs backwards in press 1: 0.5 s after 1 s; sort the rows, or begin a "
            "new press");
  EXPECT_EQ(failure(kHeader + "1.5,1,0,0,0,0,0,0,0,0,0\n"),
            "d.csv:2: press is 1.5, not an integer; number the contact episodes 1, 2, 3");
  EXPECT_EQ(failure(kHeader + "1,0,120,0,0,0,0,0,0,0,0\n"),
            "d.csv:2: x is 120 m, beyond 10 m; are these millimetres? divide lengths by 1000");
  EXPECT_EQ(failure(kHeader + "1,0,0,0,0,0,0,-3,0,0,0\n"),
            "d.csv:2: uz is -3 m, beyond 1 m; are these millimetres? divide lengths by 1000");
  EXPECT_EQ(failure(kHeader + "1,0,0,0,0,0,0,0,0,nan,0\n1,0,0,0,0,0,0,0,0,0,abc\n"),
            "d.csv: cells are not finite numbers: fy is 'nan' (line 2), fz is 'abc' (line 3); "
            "correct or remove the rows");
}

TEST(Recording, RefusesWrongMetadata) {
  const std::string row = kHeader + "1,0,0,0,0,0,0,0,0,0,0\n";
  EXPECT_EQ(failure("# tool_radius: 4\n" + row),
            "d.csv: tool_radius 4 is not between 1e-6 and 1 m; give it in metres (4 mm is 0.004)");
  for (const std::string noise : {"-1", "1e-200", "1e+300"})
    EXPECT_EQ(failure("# force_noise: " + noise + "\n" + row),
              "d.csv: force_noise " + noise +
                  " is not between 1e-15 and 1e6 N; give the standard deviation of a component in "
                  "newtons, or remove the line");
  EXPECT_FALSE(recording_of("# force_noise: 0\n" + row).force_noise());
  EXPECT_EQ(failure("# tool: ball\n" + row), "d.csv: tool is 'ball'; known are: flat, sphere");
  EXPECT_EQ(error_of([&] { recording_of(row).tool_radius(); }),
            "d.csv: the tool's radius is not given; add a line '# tool_radius: 0.004' (metres) at "
            "the top");
}

TEST(Recording, RoundTrips) {
  const std::string text =
      "# tool_radius: 0.004\n# recovery: none\n"
      "press,t,x,y,z,ux,uy,uz,fx,fy,fz,temp,contact,mood\n"
      "1,0,0.1,0.2,0.3,0,0,-0.0012345678901234,1e-07,2,3,20,1,\"a,b\"\n"
      "1,0.01,0.1,0.2,0.3,0,0,-0.002,1,2,3,20,0,c\n";
  std::ostringstream out;
  write_recording(out, recording_of(text));
  EXPECT_EQ(out.str(), text);
}

TEST(ContactPoints, AreDistinctAndInOrder) {
  Recording r;
  r.position = {{1, 0, 0}, {0, 2, 0}, {1, 0, 0}, {0, 1, 5}};
  EXPECT_EQ(contact_points(r), (std::vector<Vec3>{{0, 1, 5}, {0, 2, 0}, {1, 0, 0}}));
}

}  // namespace
}  // namespace hapsim
