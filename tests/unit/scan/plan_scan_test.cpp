// A raster planned over the phantom, driven with noisy joints against the exact ellipsoid, gives
// back the phantom's surface.
#include "scan/plan_scan.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "expect_error.h"
#include "reconstruct/clean_points.h"
#include "reconstruct/normals.h"
#include "reconstruct/reconstruct.h"
#include "scan/orient.h"
#include "unit/robot/robots.h"

namespace hapsim {
namespace {

const Vec3 kAxes(0.055, 0.042, 0.038);  // semi-axes of the shipped phantom [m]

// Points with outward normals on the upper half of the ellipsoid, some 6 mm apart: what a coarse
// model knows.
PointCloud coarse_phantom() {
  PointCloud cloud;
  for (int i = 1; i < 14; ++i) {
    for (int j = 0; j < 40; ++j) {
      const double v = M_PI / 2 * i / 14, u = 2 * M_PI * j / 40;
      const Vec3 p(cos(v) * cos(u), cos(v) * sin(u), sin(v));
      cloud.points.push_back(p.cwiseProduct(kAxes));
      cloud.normals.push_back(p.cwiseQuotient(kAxes).normalized());
    }
  }
  return cloud;
}

// Distance along the ray to the ellipsoid or the plane z = 0, NaN when it misses both.
double look(const Vec3& o, const Vec3& d) {
  const Vec3 a = o.cwiseQuotient(kAxes), b = d.cwiseQuotient(kAxes);
  const double p = b.dot(b), q = a.dot(b), r = a.dot(a) - 1, root = q * q - p * r;
  if (root >= 0 && (-q - sqrt(root)) / p > 0) return (-q - sqrt(root)) / p;
  return NAN;
}

Beam scanner() {
  Beam beam;
  beam.mount = make_pose({0.03, 0.01, 0.02}, {0.1, -0.2, 0.3});
  beam.direction = Vec3(0.05, -0.1, 1).normalized();
  beam.object = make_pose({0.45, 0.05, 0.1}, {0, 0, 0.4});
  return beam;
}

TEST(PlanScan, EveryPlannedBeamHitsItsTarget) {
  const Robot robot(test::arm_urdf(), "arm.urdf", "", "");
  const Beam beam = scanner();
  const auto targets = raster_on_surface(coarse_phantom(), 0.012, {}, 1.2);
  ASSERT_GT(targets.size(), 50u);
  const ScanPlan plan = plan_scan(robot, beam, 0.1, targets);
  EXPECT_TRUE(plan.unreachable.empty()) << plan.unreachable.size() << " of " << targets.size();
  Eigen::Matrix4d mount = beam.mount.matrix(), object = beam.object.matrix();
  for (const PlannedPose& pose : plan.poses) {
    const Eigen::Matrix4d sensor = object.inverse() * test::arm_product(pose.q) * mount;
    const Vec3 o = sensor.topRightCorner<3, 1>(), d = sensor.topLeftCorner<3, 3>() * beam.direction;
    const Target& target = targets[static_cast<std::size_t>(pose.target)];
    EXPECT_LT((o + 0.1 * d - target.point).norm(), 1e-9);
    EXPECT_LT((d + target.normal).norm(), 1e-9);
  }
}

TEST(PlanScan, ARasterDrivenWithNoiseGivesThePhantomBack) {
  const Robot robot(test::arm_urdf(), "arm.urdf", "", "");
  const Beam beam = scanner();
  const auto targets = raster_on_surface(coarse_phantom(), 0.004, {}, 1.45);
  const ScanPlan plan = plan_scan(robot, beam, 0.1, targets);
  EXPECT_LT(plan.unreachable.size(), targets.size() / 100);

  // Driven: the joints stand 0.1 mrad off what the encoders say, the laser has 0.1 mm of noise.
  Random random(4);
  std::string csv = "q1,q2,q3,q4,q5,q6,d\n";
  const Eigen::Matrix4d mount = beam.mount.matrix(), object = beam.object.matrix();
  for (const PlannedPose& pose : plan.poses) {
    Eigen::VectorXd q = pose.q;
    for (double& v : q) v += 1e-4 * random.normal();
    const Eigen::Matrix4d sensor = object.inverse() * test::arm_product(q) * mount;
    const Vec3 o = sensor.topRightCorner<3, 1>(), d = sensor.topLeftCorner<3, 3>() * beam.direction;
    const double distance = look(o, d) + 1e-4 * random.normal();
    for (const double v : pose.q) csv += format_number(v) + ",";
    csv += format_number(distance) + "\n";
  }
  Input input = Input::from_bytes(csv, "driven.csv");
  Beam with_range = beam;
  with_range.range = {{0.01, 0.3}};
  const Scan scan = robot_scan(read_csv(input), robot, with_range);
  CleanReport removed;
  PointCloud cloud = clean_points(scan.cloud, {}, "driven.csv", removed);
  NormalsReport normals;
  std::vector<Vec3> to_sensor;
  for (const int i : removed.index)
    to_sensor.push_back(scan.to_sensor[static_cast<std::size_t>(i)]);
  estimate_normals(cloud, Vec3::UnitZ(), normals);
  EXPECT_EQ(face_sensor(cloud, to_sensor), 0u);

  ReconstructReport report;
  const Surface surface = reconstruct(cloud, {}, "driven.csv", report);
  EXPECT_TRUE(is_closed(surface));
  const double wanted = 2. / 3 * M_PI * kAxes.prod();
  EXPECT_NEAR(signed_volume(surface), wanted, 0.02 * wanted);
  double worst = 0, squares = 0;
  int count = 0;
  for (const Vec3& p : surface.vertices) {
    if (p.z() < 0.002) continue;
    // First-order distance to the ellipsoid.
    const Vec3 s = p.cwiseQuotient(kAxes);
    const double off = std::abs(s.squaredNorm() - 1) / (2 * s.cwiseQuotient(kAxes).norm());
    worst = std::max(worst, off);
    squares += off * off;
    ++count;
  }
  RecordProperty("rms_um", static_cast<int>(1e6 * sqrt(squares / count)));
  std::printf("phantom: %zu points, rms %.3f mm, worst %.3f mm, volume %+.2f %%\n",
              cloud.points.size(), 1e3 * sqrt(squares / count), 1e3 * worst,
              100 * (signed_volume(surface) / wanted - 1));
  EXPECT_LT(sqrt(squares / count), 2e-4);
  EXPECT_LT(worst, 1e-3);
}

TEST(PlanScan, NamesWhatIsOutOfReach) {
  const Robot robot(test::arm_urdf(), "arm.urdf", "", "");
  const auto targets = raster_on_grid({0.5, -0.2, 1.5, 0.2}, 0.1, 0.05);
  EXPECT_EQ(targets.size(), 55u);
  const ScanPlan plan = plan_scan(robot, {}, 0.1, targets);
  EXPECT_EQ(plan.poses.size() + plan.unreachable.size(), targets.size());
  for (const int t : plan.unreachable)
    EXPECT_GT(targets[static_cast<std::size_t>(t)].point.x(), 0.6);
  for (const Target& t : targets) {
    if (t.point.x() < 1.05) continue;  // shoulder 0.05 + 0.44 + 0.42 + 0.09 of reach
    EXPECT_TRUE(std::any_of(plan.unreachable.begin(), plan.unreachable.end(),
                            [&](int k) { return &targets[static_cast<std::size_t>(k)] == &t; }));
  }
}

TEST(RobotScan, PointsAreOriginPlusDistanceAlongTheBeam) {
  const Robot robot(test::arm_urdf(), "arm.urdf", "", "");
  Beam beam;
  beam.angle_factor = M_PI / 180;
  beam.length_factor = 1e-3;
  Input input = Input::from_bytes(
      "zone,waist,q2,Joint_3,theta4,j5,q6,Distance,touch_force\na,10,20,30,40,50,60,70,-0.5\n",
      "scan.csv");
  const Scan scan = robot_scan(read_csv(input), robot, beam);
  Eigen::VectorXd q(6);
  q << 10, 20, 30, 40, 50, 60;
  const Eigen::Matrix4d pose = test::arm_product(q * M_PI / 180);
  const Vec3 wanted = (pose * Eigen::Vector4d(0, 0, 0.07, 1)).head<3>();
  ASSERT_EQ(scan.cloud.points.size(), 1u);
  EXPECT_LT((scan.cloud.points[0] - wanted).norm(), 1e-12);
  EXPECT_EQ(scan.zone_names, std::vector<std::string>{"a"});
  EXPECT_DOUBLE_EQ(scan.touch_force[0], 0.5);
}

TEST(RobotScan, RefusesWithTheLine) {
  const Robot robot(test::arm_urdf(), "arm.urdf", "", "");
  const auto message = [&](const std::string& csv) {
    return error_of([&] {
      Input input = Input::from_bytes(csv, "scan.csv");
      robot_scan(read_csv(input), robot, {});
    });
  };
  const std::string header = "q1,q2,q3,q4,q5,q6,d\n";
  EXPECT_NE(message(header + "0,0,0,0,0,0,0.1\n0,0,0,0,nan,0,0.1\n").find("line 3"),
            std::string::npos);
  EXPECT_NE(message(header + "0,0,0,0,0,0,-0.1\n").find("scan.csv:2: the distance is negative"),
            std::string::npos);
  EXPECT_NE(message(header + "0,40,0,0,0,0,0.1\n").find("--angle-unit deg"), std::string::npos);
  EXPECT_NE(message("q1,q2,q3,q4,q5,q6\n0,0,0,0,0,0\n").find("'d' is missing"), std::string::npos);
  EXPECT_NE(message("q1,q2,q3,q4,q5,d\n0,0,0,0,0,0\n").find("'q6' is missing"), std::string::npos);
  EXPECT_NE(message("q1,q2,q3,q4,q5,q6,q7,d\n0,0,0,0,0,0,0,1\n").find("moves only 6 joints"),
            std::string::npos);
}

}  // namespace
}  // namespace hapsim
