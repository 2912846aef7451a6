#include "scan/scan_file.h"

#include <gtest/gtest.h>

#include <cstring>

#include "base/random.h"
#include "expect_error.h"
#include "formats/pcd.h"

namespace hapsim {
namespace {

Scan read(const std::string& bytes, const ScanFileOptions& options = {}) {
  Input input = Input::from_bytes(bytes, "scan");
  return read_scan(input, options);
}

template <class T>
std::string raw(std::initializer_list<T> values) {
  std::string bytes;
  for (const T v : values) bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
  return bytes;
}

const std::string kHead =
    "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 8 8 8 4\nTYPE F F F U\nCOUNT 1 1 1 1\n"
    "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n";

// Three columns of doubles and one of 32 bits, packed by hand: literal runs of at most 32 bytes,
// and a copy of 16 bytes (length 14 = 7 + 7, back 16) for the second column, which equals the
// first.
std::string packed_by_hand() {
  const std::string x = raw({1., 2.}), z = raw({5., 6.}), rgb = raw<std::uint32_t>({7, 8});
  std::string packed;
  packed += '\x0f' + x;
  packed += std::string("\xe0\x07\x0f", 3);
  packed += '\x17' + z + rgb;
  return raw<std::uint32_t>({static_cast<std::uint32_t>(packed.size()), 56}) + packed;
}

void expect_two_points(const Scan& scan, double y0, double y1) {
  ASSERT_EQ(scan.cloud.points.size(), 2u);
  EXPECT_EQ(scan.cloud.points[0], Vec3(1, y0, 5));
  EXPECT_EQ(scan.cloud.points[1], Vec3(2, y1, 6));
}

TEST(Pcd, AsciiBinaryAndCompressed) {
  expect_two_points(read(kHead + "DATA ascii\n1 3 5 7\n2 4 6 8\n"), 3, 4);
  expect_two_points(read(kHead + "DATA binary\n" + raw({1., 3., 5.}) + raw<std::uint32_t>({7}) +
                         raw({2., 4., 6.}) + raw<std::uint32_t>({8})),
                    3, 4);
  expect_two_points(read(kHead + "DATA binary_compressed\n" + packed_by_hand()), 1, 2);
  const Scan lost = read(kHead + "DATA ascii\nnan nan nan 7\n2 4 6 8\n");
  EXPECT_EQ(lost.cloud.points.size(), 1u);
  EXPECT_EQ(lost.notes, std::vector<std::string>{"1 points without a place left out"});
}

TEST(Pcd, DamagedFilesFailInOneLine) {
  const std::string files[] = {kHead + "DATA ascii\n1 3 5 7\n2 4 6 8\n",
                               kHead + "DATA binary_compressed\n" + packed_by_hand(),
                               kHead + "DATA binary\n" + std::string(56, '\0')};
  Random random(2);
  int failed = 0;
  const auto attempt = [&failed](const std::string& bytes) {
    try {
      std::size_t lost = 0;
      EXPECT_LT(read_pcd(bytes, "s.pcd", lost).points.size(), 100u);
    } catch (const Error& error) {
      ++failed;
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
  };
  for (const std::string& file : files) {
    for (std::size_t n = 0; n < file.size(); ++n) attempt(file.substr(0, n));
    for (int k = 0; k < 3000; ++k) {
      std::string bytes = file;
      for (int m = 0; m < 2; ++m) {
        bytes[random.integer(bytes.size())] = static_cast<char>(random.integer(256));
      }
      attempt(bytes);
    }
  }
  EXPECT_GT(failed, 1000);
}

TEST(ScanFile, PlainRowsTablesAndMeshesAreToldByContent) {
  EXPECT_EQ(read("1 2 3\n4 5 6\n", {.unit = 1e-3}).cloud.points[1], Vec3(4e-3, 5e-3, 6e-3));
  EXPECT_EQ(read("# by hand\n1;2;3;0;0;2\n").cloud.normals[0], Vec3(0, 0, 1));
  const Scan zones = read("y,x,zone,z,touch_force\n2,1,left,3,-0.5\n5,4,right,6,0.25\n");
  EXPECT_EQ(zones.cloud.points[1], Vec3(4, 5, 6));
  EXPECT_EQ(zones.zone, (std::vector<int>{0, 1}));
  EXPECT_EQ(zones.touch_force, (std::vector<double>{0.5, 0.25}));
  const Scan mesh = read(
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
      "endfacet\nendsolid a\n");
  EXPECT_EQ(mesh.cloud.points.size(), 3u);
  // A normal that is missing makes all of them worthless.
  EXPECT_TRUE(read("x,y,z,nx,ny,nz\n0,0,0,0,0,1\n1,0,0,0,0,0\n").cloud.normals.empty());
  const std::string empty = error_of([] { read("zone,x,y,z\n,1,2,3\n"); });
  EXPECT_NE(empty.find("scan:2: the zone is empty"), std::string::npos) << empty;
}

TEST(ScanFile, FilesBecomeZonesWithTheirOwnNames) {
  Scan all = read("0 0 0\n");
  append_zone(all, read("1 0 0\n"), "b");
  append_zone(all, read("2 0 0\n"), "b");
  append_zone(all, read("zone,x,y,z\nb,3,0,0\n"), "c");
  EXPECT_EQ(all.zone_names, (std::vector<std::string>{"1", "b", "b-2", "b-3"}));
  EXPECT_EQ(all.zone, (std::vector<int>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace hapsim
