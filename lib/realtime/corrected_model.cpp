#include "realtime/corrected_model.h"

#include <algorithm>
#include <cmath>

#include "realtime/insert_vertex.h"

namespace hapsim {
namespace {

constexpr double kApart = 1e-3;   // points nearer to a known one than this tell nothing [m]
constexpr double kInside = 1e-6;  // [m]
constexpr int kTries = 8;
constexpr std::size_t kMostSeen = 400;  // then every new one takes the place of the oldest

}  // namespace

void SurfaceOffsets::add(const Vec3& contact) {
  for (const auto& [point, distance] : seen_)
    if ((point - contact).norm() < kApart) return;
  add(contact, surface_->at(contact).distance);
}

void SurfaceOffsets::add(const Vec3& place, double offset) {
  if (seen_.size() == kMostSeen) seen_.erase(seen_.begin());
  seen_.emplace_back(place, offset);
}

double SurfaceOffsets::interpolated(const Vec3& place, std::size_t without) const {
  double sum = 0, weights = 0;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    if (i == without) continue;
    const double squared = (seen_[i].first - place).squaredNorm() + kApart * kApart;
    const double weight = 1 / (squared * std::sqrt(squared));
    sum += weight * seen_[i].second;
    weights += weight;
  }
  return weights > 0 ? sum / weights : 0;
}

double SurfaceOffsets::at(const Vec3& point, Vec3& normal) const {
  const SurfaceSide side = surface_->at(point);
  const Surface& surface = surface_->surface();
  const Triangle& corner = surface.faces[side.face];
  const Vec3 weight = corner_weights(side.point, surface.vertices[corner[0]],
                                     surface.vertices[corner[1]], surface.vertices[corner[2]]);
  normal.setZero();  // without steps from face to face
  for (int k = 0; k < 3; ++k) normal += weight[k] * surface_->vertex_normal(corner[k]);
  normal.normalize();
  return interpolated(side.point, seen_.size());
}

double SurfaceOffsets::uncertainty() const {
  double squares = 0;
  for (std::size_t i = 0; i < seen_.size(); ++i)
    squares += std::pow(seen_[i].second - interpolated(seen_[i].first, i), 2);
  return seen_.empty() ? 0 : std::sqrt(squares / static_cast<double>(seen_.size()));
}

CorrectedModel::CorrectedModel(const PreparedBody& body, const SurfaceOffsets& offsets)
    : body_(body), loop_(body), offsets_(offsets) {}

Vec3 CorrectedModel::step(const MotionLine& line, bool fresh, const Correction& c, double gap) {
  if (c.gone) return c.bias;
  if (c.shift == Vec3::Zero()) {
    if (fresh) loop_.begin(line.point);
    return c.stiffness * loop_.press(line.t, line.u, line.in_air) + c.bias;
  }
  if (fresh) {
    Vec3 normal;
    const double offset = offsets_.at(line.point - c.shift, normal) + gap;
    offset_ = offset * normal;
  }
  const Vec3 tool = line.point + line.u - c.shift - offset_;
  if (!fresh) touch_between(line.t, tool);
  last_t_ = line.t;
  last_tool_ = tool;
  return c.stiffness * loop_.step(line.t, tool) + c.bias;
}

// The contact begins where the way from the last sample goes through the surface: samples far
// apart would put it too deep, and the force would jump with the shift.
void CorrectedModel::touch_between(double t, const Vec3& tool) {
  const ToolState& last = loop_.tool();
  if (last.touching() || last.surface.face < 0) return;
  const double before = last.surface.distance;
  const double after = body_.distance().at(tool, last.surface.face).distance;
  if (before <= 0 || after >= 0) return;
  // By false position; the point taken is inside.
  double out = 0, in = 1, far = before, deep = after;
  for (int i = 0; i < kTries && deep < -kInside; ++i) {
    const double share = in - (in - out) * (deep + 0.5 * kInside) / (deep - far);
    const double distance =
        body_.distance().at(last_tool_ + share * (tool - last_tool_), last.surface.face).distance;
    (distance < 0 ? in : out) = share;
    (distance < 0 ? deep : far) = distance;
  }
  loop_.step(last_t_ + in * (t - last_t_), last_tool_ + in * (tool - last_tool_));
}

void CorrectedModel::take_state(const CorrectedModel& other) {
  loop_.restore(other.loop_.state());
  offset_ = other.offset_;
  last_t_ = other.last_t_;
  last_tool_ = other.last_tool_;
}

std::vector<std::size_t> press_indices(const std::vector<WatchedSample>& window) {
  std::vector<std::size_t> index(window.size(), 0);
  for (std::size_t i = 1; i < window.size(); ++i)
    index[i] = index[i - 1] + (window[i].line.press != window[i - 1].line.press ? 1 : 0);
  return index;
}

std::vector<Vec3> corrected_forces(const PreparedBody& body, const SurfaceOffsets& offsets,
                                   const std::vector<WatchedSample>& window, const Correction& c,
                                   const std::vector<double>& gaps) {
  CorrectedModel model(body, offsets);
  const std::vector<std::size_t> press = press_indices(window);
  std::vector<Vec3> result;
  result.reserve(window.size());
  for (std::size_t i = 0; i < window.size(); ++i)
    result.push_back(model.step(window[i].line, i == 0 || press[i] != press[i - 1], c,
                                gaps.empty() ? 0 : gaps[press[i]]));
  return result;
}

double chi_square(const std::vector<WatchedSample>& window, const std::vector<Vec3>& forces) {
  double sum = 0;
  for (std::size_t i = 0; i < window.size(); ++i)
    if (window[i].counted)
      sum += (window[i].measured - forces[i]).squaredNorm() / (window[i].size * window[i].size);
  return sum;
}

}  // namespace hapsim
