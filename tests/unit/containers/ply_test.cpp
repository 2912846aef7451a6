#include "containers/ply.h"

#include <cmath>
#include <sstream>

#include "expect_error.h"

namespace hapsim {
namespace {

std::string ply_failure(const std::string& bytes) {
  return error_of([&] { parse_ply(bytes, "m.ply"); });
}

std::string ascii(const std::string& header, const std::string& body) {
  return "ply\nformat ascii 1.0\n" + header + "end_header\n" + body;
}

const std::string kVertex =
    "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n";

PlyFile sample(PlyFormat format) {
  PlyFile file;
  file.format = format;
  file.comments = {"made by hand"};
  PlyElement vertex{"vertex", 3, {}};
  vertex.properties.push_back(
      {"x", PlyType::kFloat64, false, PlyType::kUint8, {0.1, -1e-7, 3}, {}});
  vertex.properties.push_back(
      {"y", PlyType::kFloat32, false, PlyType::kUint8, {0.5, 0.25, -2}, {}});
  vertex.properties.push_back({"fixed", PlyType::kUint8, false, PlyType::kUint8, {0, 255, 1}, {}});
  vertex.properties.push_back({"a", PlyType::kInt8, false, PlyType::kUint8, {-128, 127, 0}, {}});
  vertex.properties.push_back({"b", PlyType::kInt16, false, PlyType::kUint8, {-32768, 1, 2}, {}});
  vertex.properties.push_back({"c", PlyType::kUint16, false, PlyType::kUint8, {65535, 1, 2}, {}});
  vertex.properties.push_back(
      {"d", PlyType::kUint32, false, PlyType::kUint8, {4294967295.0, 1, 2}, {}});
  PlyElement face{"face", 2, {}};
  face.properties.push_back({"vertex_indices",
                             PlyType::kInt32,
                             true,
                             PlyType::kUint8,
                             {0, 1, 2, -2147483648.0},
                             {0, 3, 4}});
  face.properties.push_back(
      {"weights", PlyType::kFloat64, true, PlyType::kUint16, {0.1}, {0, 0, 1}});
  file.elements = {vertex, face, {"nothing", 0, {}}};
  return file;
}

class PlyRoundTrip : public testing::TestWithParam<PlyFormat> {};

TEST_P(PlyRoundTrip, KeepsEverything) {
  const PlyFile file = sample(GetParam());
  std::ostringstream out;
  write_ply(out, file);
  const PlyFile again = parse_ply(out.str(), "m.ply");
  EXPECT_EQ(again.format, file.format);
  EXPECT_EQ(again.comments, file.comments);
  ASSERT_EQ(again.elements.size(), file.elements.size());
  for (std::size_t e = 0; e < file.elements.size(); ++e) {
    EXPECT_EQ(again.elements[e].name, file.elements[e].name);
    EXPECT_EQ(again.elements[e].count, file.elements[e].count);
    ASSERT_EQ(again.elements[e].properties.size(), file.elements[e].properties.size());
    for (std::size_t p = 0; p < file.elements[e].properties.size(); ++p) {
      const PlyProperty &a = again.elements[e].properties[p], &b = file.elements[e].properties[p];
      EXPECT_EQ(a.name, b.name);
      EXPECT_EQ(a.type, b.type);
      EXPECT_EQ(a.is_list, b.is_list);
      EXPECT_EQ(a.values, b.values) << a.name;
      EXPECT_EQ(a.offset, b.offset) << a.name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, PlyRoundTrip,
                         testing::Values(PlyFormat::kAscii, PlyFormat::kBinaryLittle,
                                         PlyFormat::kBinaryBig));

TEST(Ply, FindsElementsAndProperties) {
  const PlyFile file = parse_ply(ascii(kVertex, "1 2 3\n4 5 6"), "m.ply");
  ASSERT_NE(file.find("vertex"), nullptr);
  EXPECT_EQ(file.find("vertex")->find("y")->values, (std::vector<double>{2, 5}));
  EXPECT_EQ(file.find("face"), nullptr);
  EXPECT_EQ(file.find("vertex")->find("q"), nullptr);
}

TEST(Ply, KnowsBothNamesOfTypesAndCarriageReturns) {
  const PlyFile file = parse_ply(
      "ply\r\nformat ascii 1.0\r\ncomment c\r\nobj_info o\r\nelement vertex 1\r\n"
      "property float64 x\r\nproperty int8 y\r\nproperty list uint8 int32 z\r\nend_header\r\n"
      "1.5 -3 2 7 8\r\n",
      "m.ply");
  EXPECT_EQ(file.comments, (std::vector<std::string>{"c"}));
  EXPECT_EQ(file.elements[0].properties[2].values, (std::vector<double>{7, 8}));
}

TEST(Ply, RefusesWrongHeaders) {
  EXPECT_NE(ply_failure("solid").find("truncated"), std::string::npos);
  EXPECT_NE(ply_failure("obj\n").find("does not begin with 'ply'"), std::string::npos);
  EXPECT_NE(ply_failure("ply\nformat ascii 1.0\n").find("no 'end_header'"), std::string::npos);
  EXPECT_NE(ply_failure("ply\nend_header\n").find("no format line"), std::string::npos);
  EXPECT_NE(ply_failure(ascii("property int x\n", "")).find("precedes"), std::string::npos);
  EXPECT_NE(ply_failure(ascii("element vertex -1\n", "")).find("m.ply:3: the count"),
            std::string::npos);
  EXPECT_NE(ply_failure(ascii("element v 1\nproperty half x\n", "")).find("unknown type 'half'"),
            std::string::npos);
  EXPECT_NE(ply_failure(ascii("element v 1\nproperty list float int x\n", "")).find("counted by"),
            std::string::npos);
  EXPECT_NE(
      ply_failure(ascii("element v 1\nproperty int x\nproperty int x\n", "1 1")).find("twice"),
      std::string::npos);
  EXPECT_NE(ply_failure(ascii("element v 1\n", "1")).find("no property"), std::string::npos);
}

TEST(Ply, ChecksCountsBeforeItTakesMemory) {
  EXPECT_NE(ply_failure(ascii("element vertex 18446744073709551615\nproperty double x\n", "1\n"))
                .find("truncated"),
            std::string::npos);
  const std::string little =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1000000000000\nproperty double x\n"
      "end_header\n12345678";
  EXPECT_EQ(ply_failure(little),
            "m.ply: byte 94: the file is truncated: 8 bytes are left for 1000000000000 items of "
            "element 'vertex'; copy or write the file again");
  const std::string list =
      "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list uint double x\n"
      "end_header\n\xff\xff\xff\xff"
      "12345678";
  EXPECT_NE(ply_failure(list).find("for 4294967295 entries"), std::string::npos);
}

TEST(Ply, RefusesWrongBodies) {
  EXPECT_EQ(ply_failure(ascii(kVertex, "1 2 3\n4 nan 6\n")),
            "m.ply:9: y of vertex 1 (counted from 0) is nan; remove the vertex or give it a finite "
            "coordinate");
  EXPECT_NE(ply_failure(ascii(kVertex, "1 2 3\n4 1e999 6\n")).find("is inf"), std::string::npos);
  EXPECT_NE(ply_failure(ascii(kVertex, "1 2 3\n4 5\n")).find("truncated"), std::string::npos);
  EXPECT_NE(ply_failure(ascii(kVertex, "1 2 3\n4 5 6\n7\n")).find("follow the last element"),
            std::string::npos);
  EXPECT_NE(ply_failure(ascii(kVertex, "1 2 3\n4 x 6\n")).find("m.ply:9: 'x' is not a number"),
            std::string::npos);
  const std::string byte = "element v 1\nproperty uchar b\n";
  EXPECT_NE(ply_failure(ascii(byte, "256\n")).find("no value of the type 'uchar'"),
            std::string::npos);
  EXPECT_NE(ply_failure(ascii(byte, "1.5\n")).find("no value of the type 'uchar'"),
            std::string::npos);
  EXPECT_NE(
      ply_failure(ascii("element f 1\nproperty list int int i\n", "-1 2\n")).find("-1 entries"),
      std::string::npos);
}

TEST(Ply, LetsOtherValuesBeNan) {
  const PlyFile file = parse_ply(ascii("element vertex 1\nproperty float quality\n", "nan\n"), "m");
  EXPECT_TRUE(std::isnan(file.elements[0].properties[0].values[0]));
}

}  // namespace
}  // namespace hapsim
