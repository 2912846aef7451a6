#include "containers/stl.h"

#include <cstring>
#include <limits>
#include <sstream>

#include "expect_error.h"

namespace hapsim {
namespace {

std::string stl_failure(const std::string& bytes) {
  return error_of([&] { parse_stl(bytes, "s.stl"); });
}

const TriangleSoup kSoup{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0.5, 0)},
                         {Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)}};

std::string binary() {
  std::ostringstream out;
  write_stl_binary(out, kSoup);
  return out.str();
}

const std::string kFacet =
    "facet normal nan 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 5e-1 0\n"
    " endloop\nendfacet\n";

TEST(Stl, BinaryRoundTrips) {
  EXPECT_EQ(parse_stl(binary(), "s.stl"), kSoup);
}

TEST(Stl, BinaryMayBeginWithSolid) {
  std::string bytes = binary();
  std::memcpy(bytes.data(), "solid facet", 11);
  EXPECT_EQ(parse_stl(bytes, "s.stl"), kSoup);
}

TEST(Stl, ReadsAscii) {
  const TriangleSoup soup = parse_stl("solid a name\n" + kFacet + "endsolid a name\n", "s.stl");
  ASSERT_EQ(soup.size(), 1u);
  EXPECT_EQ(soup[0], kSoup[0]);
  const std::string two = "solid\n" + kFacet + "endsolid\nsolid b\n" + kFacet + "endsolid b";
  EXPECT_EQ(parse_stl(two, "s.stl").size(), 2u);
}

TEST(Stl, AsciiMayBeUpperCaseWithCarriageReturns) {
  std::string text;
  for (const char c : "solid a\n" + kFacet + "endsolid a\n")
    text += c == '\n' ? std::string("\r\n") : std::string(1, static_cast<char>(std::toupper(c)));
  EXPECT_EQ(parse_stl(text, "s.stl").size(), 1u);
}

TEST(Stl, RefusesWrongFiles) {
  EXPECT_NE(stl_failure("").find("empty"), std::string::npos);
  EXPECT_NE(stl_failure("hello").find("no STL file"), std::string::npos);
  EXPECT_NE(stl_failure("\x1f\x8b" + binary()).find("gzip -dc"), std::string::npos);
  EXPECT_NE(stl_failure("PK\x03\x04" + binary()).find("zip file"), std::string::npos);
  EXPECT_NE(stl_failure("<html><body>404").find("web page"), std::string::npos);
  EXPECT_NE(stl_failure("\xef\xbb\xbfsolid\n" + kFacet).find("byte order mark"), std::string::npos);
  EXPECT_NE(stl_failure(binary().substr(0, 150)).find("claims 2 triangles (184 bytes) and has 150"),
            std::string::npos);
  EXPECT_NE(stl_failure("solid\nendsolid\n").find("no triangle"), std::string::npos);
  EXPECT_NE(stl_failure("solid\n" + kFacet).find("s.stl:9: the file is truncated"),
            std::string::npos);
  EXPECT_NE(stl_failure("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n")
                .find("s.stl:4: 'nan' stands where a finite coordinate should"),
            std::string::npos);
  std::string huge = binary();
  std::memset(huge.data() + 80, 0xff, 4);
  EXPECT_NE(stl_failure(huge).find("claims 4294967295"), std::string::npos);
  std::string bad = binary();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bad.data() + 84 + 50 + 12, &nan, 4);
  EXPECT_NE(stl_failure(bad).find("corner of triangle 1"), std::string::npos);
}

}  // namespace
}  // namespace hapsim
