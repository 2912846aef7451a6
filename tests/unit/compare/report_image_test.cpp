// An image of the stiffness as cells of a report.
#include "compare/report_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "base/error.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

ImageOnBody half_and_half() {
  ImageOnBody image{test::block_mesh({0.04, 0.04, 0.02}, 4, 4, 2, 1), {}};
  image.values.model_modulus = 1e4;
  for (const auto& n : image.body.tets) {
    double x = 0;
    for (int k = 0; k < 4; ++k) x += image.body.nodes[n[k]].x() / 4;
    image.values.modulus.push_back(x < 0.02 ? 1e4 : 3e4);
    image.values.log_std.push_back(x < 0.02 ? 0.1 : 0.2);
    image.values.resolution.push_back(0.012);
  }
  return image;
}

Report with_body(const TetMesh& body) {
  Report report;
  const Surface outside = boundary_surface(body);
  report.body.vertices = outside.vertices;
  report.body.faces = outside.faces;
  report.body.positions = {{0.01, 0.02, 0.02}, {0.03, 0.02, 0.02}};
  report.body.layers.resize(1);
  return report;
}

TEST(ReportImage, CellsHaveWhatTheTetrahedraHave) {
  const ImageOnBody image = half_and_half();
  Report report = with_body(image.body);
  add_image(image, "image.ply", report);
  const ReportInside& inside = report.inside;
  ASSERT_EQ(inside.log_ratio.size(), inside.size());
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const int column = static_cast<int>(i) % inside.count[0];
    const double x = inside.low.x() + inside.cell * (column + 0.5);
    if (x < 0 || x > 0.04 || std::abs(x - 0.02) < 1e-6) continue;
    if (std::isnan(inside.log_ratio[i])) continue;
    EXPECT_NEAR(inside.log_ratio[i], x < 0.02 ? 0 : std::log(3.0), 1e-12);
    EXPECT_NEAR(inside.log_std[i], x < 0.02 ? 0.1 : 0.2, 1e-12);
  }
  ASSERT_EQ(report.body.layers.size(), 3u);
  const BodyLayer& ratio = report.body.layers[inside.ratio_layer];
  EXPECT_NEAR(ratio.top, std::log(3.0), 1e-12);
  EXPECT_NE(ratio.at_position_text[1].find("3.00 (95 % 2 to 4.4)"), std::string::npos)
      << ratio.at_position_text[1];
  EXPECT_NE(inside.words[0].find("as far as"), std::string::npos) << inside.words[0];
}

TEST(ReportImage, OfAnotherBodyIsRefused) {
  const ImageOnBody image = half_and_half();
  Report report = with_body(test::block_mesh({0.05, 0.04, 0.02}, 2, 2, 2, 1));
  try {
    add_image(image, "image.ply", report);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what())
                  .find("image.ply: an image of another body: its bounds "
                        "differ by 10 mm"),
              std::string::npos)
        << error.what();
  }
}

// What a page draws: cells that differ, that do not, and that are open.
TEST(ReportImage, ThePageTellsWhatIsSure) {
  ImageOnBody image = half_and_half();
  for (std::size_t t = 0; t < image.values.log_std.size(); t += 3) image.values.log_std[t] = 2;
  Report report = with_body(image.body);
  report.body.distance.assign(report.body.vertices.size(), 0);
  report.body.layers[0] = {.name = "error",
                           .value = std::vector<double>(report.body.vertices.size(), 0),
                           .at_position = {0, 0},
                           .at_position_text = {"", ""}};
  add_image(image, "image.ply", report);
  std::ostringstream out;
  write_report(out, report);
  for (const char* text :
       {"window.hapsimInside={count:[", "id='flat-at'", "id='upright-at'", "id='cut-axis'",
        "these presses do not tell", "no difference is seen", ">std. error [%]<"})
    EXPECT_NE(out.str().find(text), std::string::npos) << text;
}

}  // namespace
}  // namespace hapsim
