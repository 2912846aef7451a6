#include "volume/volume.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/random.h"
#include "expect_error.h"
#include "unit/robot/robots.h"
#include "unit/volume/volume_files.h"
#include "volume/isosurface.h"

namespace hapsim {
namespace {

const Vec3 kCentre(0.01, -0.02, 0.03);
constexpr double kRadius = 0.0152;

class VolumeTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "hapsim-volume-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string folder_;
};

// Every point within a tenth of a (shortest) voxel of the ball, normals radial, all round.
void expect_ball(const Volume& volume, const std::string& what) {
  IsoReport report;
  const PointCloud cloud = isosurface(volume, {.threshold = 500}, what, report);
  double worst = 0, worst_mm = 0, least_radial = 1;
  Vec3 mean = Vec3::Zero();
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const Vec3 r = cloud.points[i] - kCentre;
    const Vec3 off = r - kRadius * r.normalized();
    worst = std::max(worst, (volume.to_world.linear().inverse() * off).norm());
    worst_mm = std::max(worst_mm, 1e3 * off.norm());
    least_radial = std::min(least_radial, cloud.normals[i].dot(r.normalized()));
    mean += r / static_cast<double>(cloud.points.size());
  }
  std::printf(
      "%s: %zu points, worst %.3f voxel (%.3f mm), mean off %.4f mm, normals within %.1f deg\n",
      what.c_str(), cloud.points.size(), worst, worst_mm, 1e3 * mean.norm(),
      std::acos(least_radial) * 180 / M_PI);
  EXPECT_LT(worst, 0.1) << what;
  EXPECT_GT(least_radial, 0.97) << what;
  EXPECT_GT(cloud.points.size(), 4000u);
  EXPECT_EQ(report.cut, 0u);
  EXPECT_EQ(report.parts, 1u);
}

TEST_F(VolumeTest, ABallComesBackFromEveryFormat) {
  const Volume ball = test::ball_volume(kRadius, kCentre);
  for (const std::string encoding : {"raw", "gzip", "ascii", "hex"}) {
    const std::string path = folder_ + "/" + encoding + ".nrrd";
    test::write_nrrd(ball, path, encoding);
    expect_ball(read_volume(test::file_text(path), path), "NRRD " + encoding);
  }
  for (const std::string& path : {folder_ + "/v.nii", folder_ + "/v.nii.gz"}) {
    test::write_nifti(ball, path);
    expect_ball(read_volume(test::file_text(path), path), "NIfTI");
  }
  test::write_dicom(ball, folder_ + "/dicom", "1.2.3", 0.5, -1000);
  expect_ball(read_dicom_series(folder_ + "/dicom"), "DICOM");
}

TEST_F(VolumeTest, AxesOriginAndDirectionAreThoseOfTheFile) {
  const Volume ball = test::ball_volume(kRadius, kCentre);
  const std::string nrrd = folder_ + "/v.nrrd", nifti = folder_ + "/v.nii";
  test::write_nrrd(ball, nrrd, "raw");
  test::write_nifti(ball, nifti);
  test::write_dicom(ball, folder_ + "/d", "1.2", 1, 0);
  const Volume back[] = {read_volume(test::file_text(nrrd), nrrd),
                         read_volume(test::file_text(nifti), nifti),
                         read_dicom_series(folder_ + "/d")};
  for (const Volume& volume : back) {
    EXPECT_EQ(volume.size, ball.size);
    // NIfTI-1 holds its matrix in single precision, DICOM in 16 characters.
    EXPECT_LT((volume.to_world.matrix() - ball.to_world.matrix()).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST_F(VolumeTest, FuzzedFilesFailInOneLine) {
  Volume small = test::ball_volume(kRadius, kCentre);
  small.size = {5, 4, 3};
  small.values.resize(60);
  std::vector<std::string> files;
  for (const std::string encoding : {"raw", "gzip", "ascii", "hex"}) {
    test::write_nrrd(small, folder_ + "/v.nrrd", encoding);
    files.push_back(test::file_text(folder_ + "/v.nrrd"));
  }
  for (const std::string name : {"/v.nii", "/v.nii.gz"}) {
    test::write_nifti(small, folder_ + name);
    files.push_back(test::file_text(folder_ + name));
  }
  Random random(3);
  int failed = 0;
  const auto attempt = [&failed](const std::string& bytes) {
    try {
      const Volume volume = read_volume(bytes, "v");
      EXPECT_LT(volume.count(), 1000000u);
    } catch (const Error& error) {
      ++failed;
      EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  };
  for (const std::string& file : files) {
    for (std::size_t n = 0; n < file.size(); n += 3) attempt(file.substr(0, n));
    for (int k = 0; k < 1500; ++k) {
      std::string bytes = file;
      for (int m = 0; m < 3; ++m) {
        bytes[random.integer(std::min<std::size_t>(bytes.size(), 420))] =
            static_cast<char>(random.integer(256));
      }
      attempt(bytes);
    }
  }
  EXPECT_GT(failed, 1000);
}

TEST_F(VolumeTest, DamagedSlicesFailInOneLine) {
  Volume small = test::ball_volume(kRadius, kCentre);
  small.size = {6, 5, 4};
  small.values.resize(120);
  test::write_dicom(small, folder_ + "/d", "1.2", 1, 0);
  const std::string path = folder_ + "/d/037.dcm", good = test::file_text(path);
  Random random(5);
  int failed = 0;
  for (int k = 0; k < 200; ++k) {
    std::string bytes = good;
    if (k % 4 == 0) {
      bytes.resize(random.integer(bytes.size()));
    } else {
      for (int m = 0; m < 3; ++m) {
        bytes[132 + random.integer(bytes.size() - 132)] = static_cast<char>(random.integer(256));
      }
    }
    std::ofstream(path, std::ios::binary) << bytes;
    try {
      EXPECT_LE(read_dicom_series(folder_ + "/d").count(), 120u);
    } catch (const Error& error) {
      ++failed;
      EXPECT_EQ(error.code(), ExitCode::kBadInput) << error.what();
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(failed, 25);
}

TEST_F(VolumeTest, WhatIsWrongIsSaid) {
  const auto message = [](const std::string& bytes) {
    return error_of([&] { read_volume(bytes, "v"); });
  };
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  const std::string head = "NRRD0004\ntype: short\ndimension: 3\nencoding: raw\nendian: little\n";
  has(message(head + "sizes: 2000 2000 2000\n\nabcd"), "which these bytes cannot hold");
  has(message("NRRD0004\ntype: short\ndimension: 2\nencoding: raw\nendian: little\nsizes: 2 2\n\n"
              "abcdefgh"),
      "2 axes, not 3");
  has(message("hello"), "no volume that is known");
  std::string nifti(400, '\0');
  std::memcpy(nifti.data() + 344, "n+1\0", 4);
  has(message(nifti), "wrong length");
  EXPECT_NE(error_of([&] { read_dicom_series(folder_); }).find("no DICOM image"),
            std::string::npos);
  // A slice that is missing.
  Volume small = test::ball_volume(kRadius, kCentre);
  small.size[2] = 9;
  small.values.resize(static_cast<std::size_t>(small.size[0]) * small.size[1] * 9);
  test::write_dicom(small, folder_ + "/gap", "1.2", 1, 0);
  std::filesystem::remove(folder_ + "/gap/047.dcm");  // slice 4
  has(error_of([&] { read_dicom_series(folder_ + "/gap"); }), "one is missing or given twice");
}

TEST(IsoSurface, TakesTheLargestPartAndNoCavities) {
  Volume volume;
  volume.size = {40, 20, 20};
  for (int k = 0; k < 20; ++k) {
    for (int j = 0; j < 20; ++j) {
      for (int i = 0; i < 40; ++i) {
        const double r = (Vec3(i, j, k) - Vec3(10, 10, 10)).norm();
        const double other = (Vec3(i, j, k) - Vec3(30, 10, 10)).norm();
        const bool in = (r < 8 && r > 3) || other < 4;
        volume.values.push_back(in ? 2.f : 1.f);
      }
    }
  }
  IsoReport report;
  const auto reach = [&](const IsoOptions& options) {
    double least = 1e9, far = 0;
    for (const Vec3& p : isosurface(volume, options, "v", report).points) {
      const double r = (p - Vec3(10, 10, 10)).norm();
      least = std::min(least, r);
      far = std::max(far, r);
    }
    return std::pair(least, far);
  };
  auto [least, far] = reach({.threshold = 1.5});
  EXPECT_GT(least, 6.5);
  EXPECT_LT(far, 8.5);
  EXPECT_EQ(report.parts, 2u);
  std::tie(least, far) = reach({.threshold = 1.5, .cavities = true});
  EXPECT_LT(least, 3.5);
  std::tie(least, far) = reach({.threshold = 1.5, .all_parts = true});
  EXPECT_GT(far, 20);
  // Below: the surroundings, cut at the border, with the normals turned round.
  std::tie(least, far) = reach({.threshold = 1.5, .below = true});
  EXPECT_GT(report.cut, 0u);
  const std::string none = error_of([&] { isosurface(volume, {.threshold = 7}, "v", report); });
  EXPECT_NE(none.find("values go from 1 to 2; try --threshold 1.5"), std::string::npos) << none;
}

}  // namespace
}  // namespace hapsim
