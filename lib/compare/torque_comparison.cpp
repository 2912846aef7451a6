#include "compare/torque_comparison.h"

#include <fmt/format.h>

#include <cmath>

#include "recording/torque_columns.h"

namespace hapsim {
namespace {

constexpr double kAsNoise = 1.15;  // as forces within their doubt (wording.cpp)

Eigen::VectorXd in_a_row(const std::vector<Vec3>& values) {
  Eigen::VectorXd all(3 * static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    all.segment<3>(3 * static_cast<Eigen::Index>(i)) = values[i];
  return all;
}

}  // namespace

TorqueComparison compare_torques(const Recording& measured, const Recording& simulated) {
  TorqueComparison torque;
  Torques own = read_torques(measured);
  torque.error.unused = own.unused;
  if (own.values.empty()) return torque;
  Torques model;
  if (has_tip_torques(simulated)) model = read_torques(simulated);
  if (model.values.empty()) {
    torque.error.unused =
        "torques of the recording are compared with none: the simulated forces have no tqx,tqy,tqz";
    return torque;
  }
  torque.measured = std::move(own.values);
  torque.simulated = std::move(model.values);
  const Noise noise = torque_noise(measured, torque.measured);
  const Eigen::VectorXd all = in_a_row(torque.measured);
  const Eigen::VectorXd left = all - in_a_row(torque.simulated);
  const auto count = static_cast<double>(all.size());
  torque.error.rows = torque.measured.size();
  torque.error.rms = std::sqrt(left.squaredNorm() / count);
  torque.error.size = std::sqrt(all.squaredNorm() / count);
  torque.error.noise = noise.value;
  torque.error.noise_origin = noise.origin;
  torque.mesh = simulated.metadata.number("torque_uncertainty", simulated.name).value_or(0);
  torque.pole = torque_pole(left, in_a_row(measured.f), noise.value);
  return torque;
}

bool torques_explained(const TorqueComparison& torque) {
  return !torque.compared() ||
         torque.error.rms <= kAsNoise * std::hypot(torque.error.noise, torque.mesh);
}

std::string pole_words(const TorquePole& pole, double rms) {
  constexpr double kMost = 0.5;   // of the rms that is left
  constexpr double kCertain = 5;  // standard errors
  const double distance = pole.offset.norm();
  if (!(pole.rms_after < kMost * rms) || distance < kCertain * pole.std_error.maxCoeff()) return "";
  const Vec3 mm = 1e3 * pole.offset;
  return fmt::format(
      "they are as if the tool touched {:.2g} mm from where it is said to, at ({:.2f}, {:.2f}, "
      "{:.2f}) mm from there: {:.2g} N m would be left",
      mm.norm(), mm[0], mm[1], mm[2], pole.rms_after);
}

std::vector<std::string> torque_facts(const TorqueComparison& torque) {
  if (!torque.compared())
    return torque.error.unused.empty() ? std::vector<std::string>{}
                                       : std::vector<std::string>{torque.error.unused};
  const TorqueError& e = torque.error;
  std::vector<std::string> facts{fmt::format(
      "error {:.3g} N m = {:.2g} x noise ({:.3g} N m, {}), of torques of {:.3g} N m rms over {} "
      "rows",
      e.rms, e.rms / e.noise, e.noise, e.noise_origin, e.size, e.rows)};
  if (torques_explained(torque)) return facts;
  if (const std::string words = pole_words(torque.pole, e.rms); !words.empty())
    facts.push_back(words);
  return facts;
}

}  // namespace hapsim
