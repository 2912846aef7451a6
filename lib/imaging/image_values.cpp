#include "imaging/image_values.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

bool beyond(const FieldGrid& grid, const Vec3& p) {
  for (int c = 0; c < 3; ++c) {
    const double along = (p[c] - grid.low[c]) / grid.step;
    if (along < -1e-6 || along > grid.count[static_cast<std::size_t>(c)] - 1 + 1e-6) return true;
  }
  return false;
}

// Mean square of what the log ratio of a draw differs by from that of the lump itself.
double lump_variance(const Lump& lump, const Vec3& p) {
  if (lump.draws.empty()) return 0;
  const double own = (p - lump.centre).norm() < lump.radius ? std::log(lump.ratio) : 0;
  double sum = 0;
  for (const LumpDraw& d : lump.draws) {
    const double log_ratio = (p - d.centre).norm() < d.radius ? std::log(d.ratio) : 0;
    sum += (log_ratio - own) * (log_ratio - own);
  }
  return sum / static_cast<double>(lump.draws.size());
}

}  // namespace

double modulus_ratio(const StiffnessImage& image, const Vec3& p) {
  if (image.lumps.empty()) return std::exp(image.field.grid.value(image.field.log_ratio, p));
  double ratio = 1;
  for (const Lump& b : image.lumps)
    if ((p - b.centre).norm() < b.radius) ratio *= b.ratio;
  return ratio;
}

double log_std_error(const StiffnessImage& image, const Vec3& p) {
  const ImageField& field = image.field;
  const double of_field =
      beyond(field.grid, p) ? field.std_error.maxCoeff() : field.grid.value(field.std_error, p);
  double variance = of_field * of_field;
  for (const Lump& lump : image.lumps) variance += lump_variance(lump, p);
  return std::sqrt(variance);
}

ImageValues image_values(const StiffnessImage& image, const TetMesh& body, double modulus) {
  ImageValues values;
  values.model_modulus = modulus;
  Eigen::AlignedBox3d box;
  for (const Vec3& p : body.nodes) box.extend(p);
  const double diagonal = box.diagonal().norm();
  // What no press reaches would make its neighbours' means infinite.
  const Eigen::VectorXd field_resolution = image.field.resolution.cwiseMin(diagonal);
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    const Vec3 p = tet_centroid(body, t);
    values.modulus.push_back(modulus * modulus_ratio(image, p));
    values.log_std.push_back(log_std_error(image, p));
    values.resolution.push_back(std::min(diagonal, image.field.grid.value(field_resolution, p)));
  }
  return values;
}

}  // namespace hapsim
