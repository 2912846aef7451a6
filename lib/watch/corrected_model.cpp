#include "watch/corrected_model.h"

#include <algorithm>
#include <cmath>

namespace hapsim {
namespace {

// From so far on the offset is that of the place that the tool comes to: faces on which points far
// away lie nearest are others, seldom ones beside an edge when they are inside.
constexpr double kNear = 0.002;   // [m]
constexpr double kInside = 1e-6;  // [m]
constexpr int kTries = 8;

}  // namespace

CorrectedModel::CorrectedModel(const PreparedBody& body, const SurfaceOffsets& offsets)
    : body_(body), loop_(body), offsets_(offsets) {}

Vec3 CorrectedModel::step(const MotionLine& line, bool fresh, const Correction& c, double gap) {
  if (c.gone) return c.bias;
  loop_.set_body(c.stiffness, c.relaxation, c.slowness);
  loop_.set_temperature(line.temperature);
  if (c.shift == Vec3::Zero()) {
    if (fresh) loop_.begin(line.point);
    return loop_.press(line.t, line.u, line.in_air) + c.bias;
  }
  Vec3 tool = line.point + line.u - c.shift;
  const ToolState& last = loop_.tool();
  if (fresh || (!last.touching() && last.surface.distance < kNear)) {
    Vec3 normal;
    const double offset = offsets_.at(tool, normal) + gap;
    offset_ = offset * normal;
  }
  tool -= offset_;
  if (!fresh) touch_between(line.t, tool);
  last_t_ = line.t;
  last_tool_ = tool;
  return loop_.step(line.t, tool) + c.bias;
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

double error_of(const std::vector<WatchedSample>& window, const std::vector<Vec3>& forces) {
  double n = 0, squares = 0;
  for (std::size_t i = 0; i < window.size(); ++i)
    if (window[i].counted) squares += (window[i].measured - forces[i]).squaredNorm(), n += 3;
  return n > 0 ? std::sqrt(squares / n) : 0;
}

double chi_square(const std::vector<WatchedSample>& window, const std::vector<Vec3>& forces) {
  double sum = 0;
  for (std::size_t i = 0; i < window.size(); ++i)
    if (window[i].counted)
      sum += (window[i].measured - forces[i]).squaredNorm() / (window[i].size * window[i].size);
  return sum;
}

}  // namespace hapsim
