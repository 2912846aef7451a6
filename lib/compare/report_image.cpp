#include "compare/report_image.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "compare/report_body.h"
#include "imaging/image_sight.h"
#include "mesh/tet_tree.h"
#include "model/interval.h"

namespace hapsim {
namespace {

using Box = Eigen::AlignedBox3d;

Box box_of(const std::vector<Vec3>& points) {
  Box box;
  for (const Vec3& p : points) box.extend(p);
  return box;
}

void require_same_body(const Box& image, const Box& body, const std::string& name) {
  constexpr double kAlike = 0.02;  // of the diagonal, that surface and mesh may differ by
  const double off = std::max((image.min() - body.min()).cwiseAbs().maxCoeff(),
                              (image.max() - body.max()).cwiseAbs().maxCoeff());
  if (off > kAlike * body.diagonal().norm())
    fail_input(name,
               fmt::format("an image of another body: its bounds differ by {:.3g} mm", 1e3 * off),
               "give the image and the --body of one identification");
}

// Some 60,000 cubes over the body, at most 96 along a side.
void set_cells(const Box& box, ReportInside& inside) {
  constexpr double kCells = 60000, kMost = 96;
  const Vec3 size = box.sizes();
  inside.cell = std::max(std::cbrt(size.prod() / kCells), size.maxCoeff() / kMost);
  for (int k = 0; k < 3; ++k)
    inside.count[static_cast<std::size_t>(k)] =
        std::max(1, static_cast<int>(std::ceil(size[k] / inside.cell - 1e-6)));
  const Vec3 whole(inside.count[0], inside.count[1], inside.count[2]);
  inside.low = box.center() - 0.5 * inside.cell * whole;
}

void fill_cells(const ImageOnBody& image, ReportInside& inside) {
  const TetTree tree(image.body);
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (int k = 0; k < inside.count[2]; ++k)
    for (int j = 0; j < inside.count[1]; ++j)
      for (int i = 0; i < inside.count[0]; ++i) {
        const int tet = tree.find(inside.low + inside.cell * (Vec3(i, j, k) + Vec3::Constant(0.5)));
        const auto t = static_cast<std::size_t>(tet);
        inside.log_ratio.push_back(
            tet < 0 ? none : std::log(image.values.modulus[t] / image.values.model_modulus));
        inside.log_std.push_back(tet < 0 ? none : image.values.log_std[t]);
        inside.resolution.push_back(tet < 0 ? none : image.values.resolution[t]);
      }
}

// The tetrahedron whose middle is nearest.
std::size_t nearest(const TetMesh& body, const Vec3& p) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    const Vec3 middle = tet_centroid(body, t);
    if ((middle - p).squaredNorm() < least) least = (middle - p).squaredNorm(), best = t;
  }
  return best;
}

}  // namespace

void add_image(const ImageOnBody& image, const std::string& name, Report& report) {
  const Box box = box_of(image.body.nodes);
  if (!report.body.faces.empty()) require_same_body(box, box_of(report.body.vertices), name);
  ReportInside& inside = report.inside;
  inside.top = box.max().z();
  inside.half95 = kHalf95;
  set_cells(box, inside);
  fill_cells(image, inside);
  // The scale is of what is told to differ; what is not may be anything.
  double top = std::log(1.25);
  for (std::size_t i = 0; i < inside.size(); ++i)
    if (std::abs(inside.log_ratio[i]) > kHalf95 * inside.log_std[i])
      top = std::max(top, std::abs(inside.log_ratio[i]));
  BodyLayer ratio{.name = "inside",
                  .title = "times the model",
                  .note =
                      "The modulus of the image over the model's. Pale: 1 lies within its 95 % "
                      "interval; hatched: half and double both do.",
                  .scale = BodyLayer::Scale::kFactor,
                  .top = top,
                  .local = false};
  BodyLayer error{.name = "its error",
                  .title = "std. error [%]",
                  .note =
                      "Standard error of the logarithm of the image's modulus; from the mark on "
                      "a factor of 2 either way lies within the 95 %.",
                  .top = 60,
                  .mark = 100 * unresolved_log_std(),
                  .mark_name = "factor 2",
                  .local = false};
  for (const Vec3& p : report.body.positions) {
    const std::size_t t = nearest(image.body, p);
    const double log_ratio = std::log(image.values.modulus[t] / image.values.model_modulus),
                 half = kHalf95 * image.values.log_std[t];
    ratio.at_position.push_back(log_ratio);
    ratio.at_position_text.push_back(
        fmt::format("image below it \u00d7 {:.2f} (95 % {:.2g} to {:.2g})", std::exp(log_ratio),
                    std::exp(log_ratio - half), std::exp(log_ratio + half)));
    error.at_position.push_back(100 * image.values.log_std[t]);
    error.at_position_text.push_back(
        fmt::format("standard error {:.0f} %", 100 * image.values.log_std[t]));
  }
  inside.ratio_layer = report.body.layers.size();
  inside.error_layer = inside.ratio_layer + 1;
  report.body.layers.push_back(std::move(ratio));
  report.body.layers.push_back(std::move(error));
  std::string sight = sight_words(image_sight(image.body, image.values, report.body.positions));
  sight[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(sight[0])));
  inside.words.push_back(sight + ".");
  inside.words.push_back(
      "The image is the simplest that explains all presses together, and its errors are what the "
      "presses leave open of it. Lumps that were found are drawn as balls, with the errors of "
      "their place, size and stiffness.");
}

}  // namespace hapsim
