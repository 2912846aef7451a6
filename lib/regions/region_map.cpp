#include "regions/region_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "cluster/qda.h"
#include "effects/catalogue.h"
#include "model/body_parameters.h"

namespace hapsim {
namespace {

using PlanPoint = Eigen::Vector2d;

PlanPoint plan_of(const Vec3& p) {
  return p.head<2>();
}

// Which cells of a raster the boundary faces cover, seen from above.
class Shadow {
 public:
  explicit Shadow(const TetMesh& body) {
    low_ = PlanPoint::Constant(std::numeric_limits<double>::infinity());
    high_ = -low_;
    for (const Vec3& node : body.nodes) {
      low_ = low_.cwiseMin(plan_of(node));
      high_ = high_.cwiseMax(plan_of(node));
    }
    cell_ = (high_ - low_).cwiseMax(1e-9) / kCells;
    covered_.assign(kCells * kCells, 0);
    for (const Triangle& face : body.faces)
      cover(plan_of(body.nodes[face[0]]), plan_of(body.nodes[face[1]]),
            plan_of(body.nodes[face[2]]));
  }
  bool over(const PlanPoint& p) const {
    const int i = column(p.x()), j = row(p.y());
    return covered_[static_cast<std::size_t>(j * kCells + i)] != 0;
  }
  const PlanPoint& low() const { return low_; }
  const PlanPoint& high() const { return high_; }

 private:
  static constexpr int kCells = 256;

  int column(double x) const { return cell_of((x - low_.x()) / cell_.x()); }
  int row(double y) const { return cell_of((y - low_.y()) / cell_.y()); }
  static int cell_of(double v) { return std::clamp(static_cast<int>(v), 0, kCells - 1); }

  void cover(const PlanPoint& a, const PlanPoint& b, const PlanPoint& c) {
    const auto side = [](const PlanPoint& p, const PlanPoint& q, const PlanPoint& r) {
      return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
    };
    const double area = side(a, b, c);
    if (area == 0) return;
    const PlanPoint least = a.cwiseMin(b).cwiseMin(c), most = a.cwiseMax(b).cwiseMax(c);
    for (int j = row(least.y()); j <= row(most.y()); ++j)
      for (int i = column(least.x()); i <= column(most.x()); ++i) {
        const PlanPoint p = low_ + PlanPoint((i + 0.5) * cell_.x(), (j + 0.5) * cell_.y());
        const bool in =
            side(a, b, p) / area >= 0 && side(b, c, p) / area >= 0 && side(c, a, p) / area >= 0;
        if (in) covered_[static_cast<std::size_t>(j * kCells + i)] = 1;
      }
  }

  PlanPoint low_, high_, cell_;
  std::vector<char> covered_;
};

}  // namespace

PlaneClassifier region_classifier(const LocationTable& table, const std::vector<int>& label,
                                  int regions, RegionRule rule) {
  Eigen::MatrixXd points(static_cast<Eigen::Index>(table.size()), 2);
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    points.row(i) = plan_of(table.point[i]).transpose();
  if (rule == RegionRule::kNearest)
    return [points, label](const PlanPoint& p) {
      Eigen::Index nearest = 0;
      (points.rowwise() - p.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
      return label[static_cast<std::size_t>(nearest)];
    };
  const auto qda = std::make_shared<Qda>(choose_qda(points, label, regions));
  return [qda](const PlanPoint& p) { return qda->classify(p); };
}

int contradicted(const PlaneClassifier& classify, const LocationTable& table,
                 const std::vector<int>& label) {
  int count = 0;
  for (std::size_t i = 0; i < label.size(); ++i)
    count += classify(plan_of(table.point[i])) != label[i];
  return count;
}

std::vector<BoundaryLine> region_boundaries(const PlaneClassifier& classify,
                                            const LocationTable& table,
                                            const std::optional<TetMesh>& body, int scan_points) {
  if (body) {
    const Shadow shadow(*body);
    return class_boundaries([&](const PlanPoint& p) { return shadow.over(p) ? classify(p) : -1; },
                            shadow.low(), shadow.high(), scan_points);
  }
  PlanPoint low = plan_of(table.point.front()), high = low;
  for (const Vec3& p : table.point) {
    low = low.cwiseMin(plan_of(p));
    high = high.cwiseMax(plan_of(p));
  }
  const PlanPoint size = high - low;
  const double n = static_cast<double>(table.size());
  const double spacing = std::max(std::sqrt(size.x() * size.y() / n), size.maxCoeff() / n);
  const PlanPoint margin = PlanPoint::Constant(0.5 * spacing);
  return class_boundaries(classify, low - margin, high + margin, scan_points);
}

void label_body(TetMesh& body, const PlaneClassifier& classify) {
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    Vec3 centre = Vec3::Zero();
    for (int k = 0; k < 4; ++k) centre += 0.25 * body.nodes[body.tets[t][k]];
    body.region[t] = classify(plan_of(centre));
  }
}

void KeyPoints::add(const Eigen::Vector2d& p, int region) {
  std::vector<Parameter> rows = effect_rows(map_effect(), 1, {p.x(), p.y(), 0});
  rows.pop_back();  // `local` stands once for the model, and here not at all
  ++number_[region];
  for (Parameter& row : rows) {
    row.name = row.name.substr(0, 1) + std::to_string(number_[region]);
    row.region = region;
    row.state = ParameterState::kFixed;
    model_.parameters.push_back(row);
  }
}

void place_key_points(Model& model, const PlaneClassifier& classify,
                      const std::vector<BoundaryLine>& lines, int keys) {
  KeyPoints key(model);
  for (const BoundaryLine& line : lines) {
    const std::vector<PlanPoint> points = key_points(line, keys);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const PlanPoint along =
          points[std::min(i + 1, points.size() - 1)] - points[i == 0 ? 0 : i - 1];
      if (along.norm() <= 0) continue;
      const PlanPoint across = PlanPoint(-along.y(), along.x()).normalized();
      // As near as the classes on both sides are still these two.
      double off = 0.25 * length(line) / (keys - 1);
      for (int attempt = 0; attempt < 6; ++attempt, off /= 2) {
        const int left = classify(points[i] + off * across);
        const int right = classify(points[i] - off * across);
        if (std::minmax(left, right) != std::minmax(line.a, line.b)) continue;
        key.add(points[i] + off * across, left);
        key.add(points[i] - off * across, right);
        break;
      }
    }
  }
}

Model region_model(const LocationTable& table, const RegionEstimate& regions,
                   const PlaneClassifier& classify, const std::vector<BoundaryLine>& lines,
                   int keys) {
  double nu = 0;
  for (const double v : table.nu) nu += v / static_cast<double>(table.size());
  Model model;
  model.parameters = body_rows(regions.value.front().E, nu);
  modulus_of(model)->std_error = regions.value.front().E_std;
  const Parameter modulus = *modulus_of(model);
  const int count = static_cast<int>(regions.value.size());
  for (int r = 1; r < count; ++r) {
    Parameter row = modulus;
    row.region = r;
    row.value = regions.value[r].E;
    row.std_error = regions.value[r].E_std;
    model.parameters.insert(model.parameters.begin() + r, row);
  }
  place_key_points(model, classify, lines, keys);
  return model;
}

}  // namespace hapsim
