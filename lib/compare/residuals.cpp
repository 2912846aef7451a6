#include "compare/residuals.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "io/number.h"
#include "recording/force_noise.h"

namespace hapsim {
namespace {

constexpr double kSameNumber = 1e-5;  // [m]; a file with five decimals still matches

[[noreturn]] void fail_match(const Recording& simulated, std::size_t row, const std::string& what) {
  fail_input(simulated.name + ":" + std::to_string(simulated.line[row]), what,
             "simulate this very recording: hs-simulate data.csv ... -o forces.csv");
}

using Names = std::array<const char*, 6>;  // of what was simulated, and of what is left

Recording with_columns(const Recording& measured, const Names& names,
                       const std::vector<Vec3>& values, const std::vector<Vec3>& simulated) {
  Recording result = measured;
  result.extra_header.clear();
  result.extra.clear();
  for (std::size_t c = 0; c < measured.extra_header.size(); ++c) {
    if (std::find(names.begin(), names.end(), measured.extra_header[c]) != names.end()) continue;
    result.extra_header.push_back(measured.extra_header[c]);
    result.extra.push_back(measured.extra[c]);
  }
  for (std::size_t c = 0; c < names.size(); ++c) {
    const auto k = static_cast<Eigen::Index>(c % 3);
    std::vector<std::string> column;
    column.reserve(measured.rows());
    for (std::size_t i = 0; i < measured.rows(); ++i)
      column.push_back(format_number(c < 3 ? simulated[i][k] : values[i][k] - simulated[i][k]));
    result.extra_header.emplace_back(names[c]);
    result.extra.push_back(std::move(column));
  }
  return result;
}

}  // namespace

NoiseLevel noise_level(const Recording& measured) {
  if (const auto declared = declared_noise(measured))
    return {declared->value, false, declared->origin};
  return {measure_force_noise(measured).sigma, true,
          "estimated from differences in time: there is no force_noise in the recording"};
}

ErrorSize error_size(const std::vector<Vec3>& measured, const std::vector<Vec3>& simulated) {
  ErrorSize size;
  Vec3 square = Vec3::Zero();
  double force = 0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    square += (measured[i] - simulated[i]).cwiseAbs2();
    force += measured[i].squaredNorm();
    size.force_peak = std::max(size.force_peak, measured[i].norm());
  }
  const double n = std::max<double>(1, static_cast<double>(measured.size()));
  const int axes = measured_axes(measured);
  size.rmse = std::sqrt(square.sum() / (axes * n));
  size.rmse_axis = (square / n).cwiseSqrt();
  size.force_rms = std::sqrt(force / (axes * n));
  return size;
}

void check_match(const Recording& measured, const Recording& simulated) {
  for (const Recording* r : {&measured, &simulated})
    if (r->f.empty())
      fail_input(r->name, "there are no force columns", "give a recording with fx,fy,fz");
  const std::size_t common = std::min(measured.rows(), simulated.rows());
  for (std::size_t i = 0; i < common; ++i) {
    const std::string at = fmt::format(" where {}:{} has ", measured.name, measured.line[i]);
    if (measured.press[i] != simulated.press[i])
      fail_match(simulated, i,
                 fmt::format("press {}{}press {}", simulated.press[i], at, measured.press[i]));
    const auto differs = [&](const Vec3& m, const Vec3& s, const char* name) {
      if ((m - s).cwiseAbs().maxCoeff() <= kSameNumber) return;
      fail_match(simulated, i,
                 fmt::format("{} ({:.6g}, {:.6g}, {:.6g}) m{}({:.6g}, {:.6g}, {:.6g}) m", name,
                             s[0], s[1], s[2], at, m[0], m[1], m[2]));
    };
    differs(measured.position[i], simulated.position[i], "contact point");
    differs(measured.u[i], simulated.u[i], "displacement");
  }
  if (measured.rows() != simulated.rows())
    fail_input(simulated.name,
               fmt::format("{} rows of forces for {} measured rows in {}", simulated.rows(),
                           measured.rows(), measured.name),
               "simulate the whole of the measured recording");
}

Recording with_residuals(const Recording& measured, const std::vector<Vec3>& simulated) {
  return with_columns(measured, {"sx", "sy", "sz", "rx", "ry", "rz"}, measured.f, simulated);
}

Recording with_torque_residuals(const Recording& measured, const std::vector<Vec3>& torque,
                                const std::vector<Vec3>& simulated) {
  return with_columns(measured, {"stqx", "stqy", "stqz", "rtqx", "rtqy", "rtqz"}, torque,
                      simulated);
}

}  // namespace hapsim
