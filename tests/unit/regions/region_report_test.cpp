#include "regions/region_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "io/csv.h"

namespace hapsim {
namespace {

CsvTable table(const std::string& text) {
  Input input = Input::from_bytes(text, "t.csv");
  return read_csv(input);
}

// Samples 0 and 1 of one region, 2 of another: merged at 1 and at 8 standard errors.
RegionEstimate two_regions() {
  RegionEstimate r;
  r.correlation = 0.9;
  r.tree = {3, {{0, 1, 1, 2}, {3, 2, 8, 3}}};
  r.label = {0, 0, 1};
  r.value = {{1000, 10, 0.4, 0.01, 2}, {5000, 50, 0.4, 0, 1}};
  return r;
}

bool tells(const std::vector<std::string>& lines, const std::string& text) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& l) { return l.find(text) != std::string::npos; });
}

TEST(RegionReport, BoundariesAreKeyPointsAlongTheLine) {
  std::ostringstream out;
  write_boundary(out, {{0, 2, {{0, 0}, {1, 0}}}, {1, 2, {{0, 0}, {0, 3}}}}, 3);
  const CsvTable t = table(out.str());
  EXPECT_EQ(t.numbers("line"), (std::vector<double>{0, 0, 0, 1, 1, 1}));
  EXPECT_EQ(t.numbers("x"), (std::vector<double>{0, 0.5, 1, 0, 0, 0}));
  EXPECT_EQ(t.numbers("y"), (std::vector<double>{0, 0, 0, 0, 1.5, 3}));
  EXPECT_EQ(t.numbers("region_b"), (std::vector<double>{2, 2, 2, 2, 2, 2}));
}

TEST(RegionReport, TheTreeIsItsMerges) {
  std::ostringstream out;
  write_dendrogram(out, two_regions().tree);
  const CsvTable t = table(out.str());
  EXPECT_EQ(t.numbers("node"), (std::vector<double>{3, 4}));
  EXPECT_EQ(t.numbers("left"), (std::vector<double>{0, 3}));
  EXPECT_EQ(t.numbers("height"), (std::vector<double>{1, 8}));
  EXPECT_EQ(t.numbers("size"), (std::vector<double>{2, 3}));
}

TEST(RegionReport, BranchesOfARegionAreNamedOnce) {
  const std::string svg = dendrogram_svg(two_regions());
  EXPECT_EQ(svg.rfind("<svg xmlns=", 0), 0u);
  EXPECT_NE(svg.find("region 0"), std::string::npos);
  EXPECT_EQ(svg.find("region 0"), svg.rfind("region 0"));
  EXPECT_EQ(svg.find("region 1"), std::string::npos);  // a sample alone has no branch
}

TEST(RegionReport, SaysWhyThereIsOneRegionOrMore) {
  RegionEstimate r = two_regions();
  EXPECT_TRUE(tells(region_lines(r, 3), "2 regions, as asked"));
  EXPECT_TRUE(tells(region_lines(r, 3), "region 0: 2 samples, E = 1000 ± 10 Pa, nu = 0.4 ± 0.01"));
  EXPECT_TRUE(tells(region_lines(r, 3), "region 1: 1 sample, E = 5000 ± 50 Pa, nu = 0.4 (held)"));
  EXPECT_FALSE(tells(region_lines(r, 3), "keeps the distances badly"));
  r.correlation = 0.5;
  EXPECT_TRUE(tells(region_lines(r, 3), "keeps the distances badly"));
  r.tests = {{{0, 1, 2}, 3, 0.001, 0.004, 0.05, true}};
  EXPECT_TRUE(
      tells(region_lines(r, 3), "2 regions (chance of such clusters in one region: 0.004)"));
  r.tests[0].divided = false;
  r.tests[0].p_gaps = 0.4;
  EXPECT_TRUE(tells(region_lines(r, 3), "scatter 3 times as widely"));
  r.tests[0].p_scatter = 0.3;
  EXPECT_TRUE(tells(region_lines(r, 3), "as their standard errors say (p = 0.3)"));
}

}  // namespace
}  // namespace hapsim
