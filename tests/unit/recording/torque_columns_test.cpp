#include "recording/torque_columns.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "base/random.h"
#include "recording/recording_join.h"

namespace hapsim {
namespace {

Recording read_torques(const std::string& text) {
  Input input = Input::from_bytes(text, "r.csv");
  return read_recording(input);
}

// One press to 2 N; `rows` end in the torques of `names`.
Recording pressed(const std::string& metadata, const std::string& names,
                  const std::string& torque) {
  std::string text = "# tool_radius: 0.004\n" + metadata + "press,x,y,z,ux,uy,uz,fx,fy,fz," + names;
  for (int i = 1; i <= 4; ++i)
    text += "\n1,0,0,0,0,0,-0.00" + std::to_string(i) + ",0,0.1," + std::to_string(0.5 * i) + "," +
            torque;
  return read_torques(text + "\n");
}

std::string refusal(const Recording& r) {
  try {
    read_torques(r);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(TorqueColumns, AreTakenAboutTheTip) {
  const Torques torques = read_torques(pressed("", "tqx,tqy,tqz", "1e-4,2e-4,-3e-4"));
  ASSERT_EQ(torques.values.size(), 4u);
  EXPECT_EQ(torques.values[3], Vec3(1e-4, 2e-4, -3e-4));
  EXPECT_EQ(torques.unused, "");
  EXPECT_TRUE(read_torques(pressed("", "note", "a")).values.empty());
}

// The sensor's origin 0.1 m above the tip: its torque is that of the force at the tip.
TEST(TorqueColumns, OfASensorGoToTheTip) {
  const Recording apart = pressed("", "tx,ty,tz", "0.01,0,0");
  EXPECT_TRUE(read_torques(apart).values.empty());
  EXPECT_NE(read_torques(apart).unused.find("torque_at"), std::string::npos);
  // (tip - origin) x f = (0, 0, -0.1) x (0, 0.1, fz) = (0.01, 0, 0).
  const Torques torques = read_torques(pressed("# torque_at: 0 0 0.1\n", "tx,ty,tz", "0.01,0,0"));
  ASSERT_EQ(torques.values.size(), 4u);
  for (const Vec3& torque : torques.values) EXPECT_LT(torque.norm(), 1e-15);
}

TEST(TorqueColumns, InNewtonMillimetresAreRefused) {
  EXPECT_NE(refusal(pressed("", "tqx,tqy,tqz", "0.2,0.1,0")).find("1 N mm is 0.001 N m"),
            std::string::npos);
  EXPECT_NE(refusal(pressed("", "tqx,tqy,tqz", "a,0,0")).find("r.csv"), std::string::npos);
  EXPECT_NE(refusal(pressed("", "tqx,tqy", "0,0")).find("tqz"), std::string::npos);
  EXPECT_NE(refusal(pressed("# torque_at: 0 0\n", "tx,ty,tz", "0,0,0")).find("torque_at"),
            std::string::npos);
}

TEST(TorqueColumns, AreWrittenInTheirPlace) {
  Recording r = pressed("# torque_noise: 1e-5\n", "tqx,tqy,tqz,note", "0,0,0,a");
  set_torques(r, std::vector<Vec3>(4, Vec3(1, 2, 3)));
  EXPECT_EQ(r.extra_header, (std::vector<std::string>{"tqx", "tqy", "tqz", "note"}));
  EXPECT_EQ(r.extra[2][3], "3");
  forget_torques(r);
  EXPECT_EQ(r.extra_header, std::vector<std::string>{"note"});
  EXPECT_FALSE(r.metadata.find("torque_noise"));
}

TEST(TorqueColumns, HaveTheNoiseOfTheirRows) {
  Random random(3);
  Recording r;
  std::vector<Vec3> torques;
  for (int k = 0; k < 20; ++k)
    for (int i = 0; i < 50; ++i) {
      r.press.push_back(k);
      r.u.emplace_back(0, 0, -1e-3 * i / 50);
      const double x = random.normal(), y = random.normal(), z = random.normal();
      torques.push_back(2e-5 * Vec3(x, y, z) + Vec3(1e-3 * i / 50, 0, 0));
    }
  r.f = std::vector<Vec3>(torques.size(), Vec3::UnitZ());
  const Noise noise = torque_noise(r, torques);
  EXPECT_NEAR(noise.value / 2e-5, 1, 0.07);
  EXPECT_TRUE(noise.measured);
  r.metadata.set("torque_noise", "3e-5");
  EXPECT_EQ(torque_noise(r, torques).value, 3e-5);
}

TEST(TorqueColumns, AreJoinedWhereAllHaveThem) {
  const Recording a = pressed("# torque_noise: 1e-5\n", "tqx,tqy,tqz", "1e-4,0,0");
  const Recording b = pressed("# torque_noise: 1e-5\n", "tqx,tqy,tqz", "0,1e-4,0");
  const Recording both = join_recordings({a, b});
  ASSERT_EQ(read_torques(both).values.size(), 8u);
  EXPECT_EQ(read_torques(both).values[4], Vec3(0, 1e-4, 0));
  EXPECT_EQ(both.metadata.find("torque_noise"), "1e-5");
  EXPECT_FALSE(has_torques(join_recordings({a, pressed("", "note", "a")})));
}

TEST(TorqueColumns, OfAToolThatTurnsAreNotJoined) {
  const Recording still = pressed("", "tqx,tqy,tqz", "1e-4,2e-4,-3e-4");
  const Recording turned = pressed("", "tqx,tqy,tqz,thx,thy,thz", "1e-4,2e-4,-3e-4,0,0.1,0");
  EXPECT_FALSE(tool_turns(still));
  EXPECT_TRUE(tool_turns(turned));
  const Torques joined = read_torques(join_recordings({still, turned}));
  EXPECT_TRUE(joined.values.empty());
  EXPECT_NE(joined.unused.find("the tool turns"), std::string::npos) << joined.unused;
  const Recording without = pressed("", "other", "0");
  EXPECT_NE(read_torques(join_recordings({still, without})).unused.find("has none"),
            std::string::npos);
}

// Of a soft body they may be mostly noise, which is declared; all of them zero are none.
TEST(TorqueColumns, MayBeNoiseOrNothing) {
  const std::string noisy = "0.05,-0.06,0.04";
  EXPECT_NE(refusal(pressed("", "tqx,tqy,tqz", noisy)), "");
  EXPECT_EQ(refusal(pressed("# torque_noise: 0.05\n", "tqx,tqy,tqz", noisy)), "");
  const Torques none = read_torques(pressed("", "tqx,tqy,tqz", "0,0,0"));
  EXPECT_TRUE(none.values.empty());
  EXPECT_NE(none.unused.find("all zero"), std::string::npos);
}

}  // namespace
}  // namespace hapsim
