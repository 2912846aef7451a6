#include "calibrate/arm_fit.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "calibrate/intervals.h"
#include "estimate/information.h"

namespace hapsim {
namespace {

// u = A (xx, yy, zz, xy, xz, yz) for u = S f.
Eigen::Matrix<double, 3, kSymmetric> by_numbers(const Vec3& f) {
  Eigen::Matrix<double, 3, kSymmetric> A;
  A << f.x(), 0, 0, f.y(), f.z(), 0,  //
      0, f.y(), 0, f.x(), 0, f.z(),   //
      0, 0, f.z(), 0, f.x(), f.y();
  return A;
}

// Displacements and forces about the means of their press.
struct Centred {
  Eigen::MatrixXd A;                  // 3 rows a sample
  Eigen::VectorXd u;                  // -(displacement)
  std::vector<Eigen::Index> lengths;  // samples of each press
};

Centred centred(const Recording& r) {
  Centred c;
  std::vector<Vec3> force, moved;
  for (const Press& press : r.presses()) {
    std::vector<std::size_t> rows;
    for (const int row : press.rows)
      if (!r.in_air(static_cast<std::size_t>(row))) rows.push_back(static_cast<std::size_t>(row));
    if (rows.size() < 3) continue;
    Vec3 mean_f = Vec3::Zero(), mean_u = Vec3::Zero();
    for (const std::size_t row : rows) {
      mean_f += r.f[row] / static_cast<double>(rows.size());
      mean_u += r.u[row] / static_cast<double>(rows.size());
    }
    for (const std::size_t row : rows) {
      force.push_back(r.f[row] - mean_f);
      moved.push_back(mean_u - r.u[row]);
    }
    c.lengths.push_back(static_cast<Eigen::Index>(rows.size()));
  }
  const auto n = static_cast<Eigen::Index>(force.size());
  c.A.resize(3 * n, kSymmetric);
  c.u.resize(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    c.A.middleRows<3>(3 * i) = by_numbers(force[static_cast<std::size_t>(i)]);
    c.u.segment<3>(3 * i) = moved[static_cast<std::size_t>(i)];
  }
  return c;
}

}  // namespace

ArmFit fit_arm(const Recording& presses) {
  const Centred c = centred(presses);
  double largest = 0;
  for (const Vec3& f : presses.f) largest = std::max(largest, f.cwiseAbs().maxCoeff());
  constexpr double kRounding = 1e-9;
  if (c.lengths.empty() || c.A.cwiseAbs().maxCoeff() <= kRounding * largest)
    fail_input(presses.name, "no press has three rows in contact and a force that changes",
               "press the rigid block slowly to the full force and record the way");
  constexpr double kExcited = 1e-2;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(c.A.transpose() * c.A, Eigen::ComputeFullV);
  const Eigen::VectorXd& power = svd.singularValues();
  const Eigen::MatrixXd& V = svd.matrixV();
  Eigen::MatrixXd inverse = Eigen::MatrixXd::Zero(kSymmetric, kSymmetric);
  Eigen::VectorXd unseen = Eigen::VectorXd::Zero(kSymmetric);
  double rank = 0;
  for (Eigen::Index d = 0; d < power.size(); ++d) {
    if (power[d] > kExcited * kExcited * power[0]) {
      inverse += V.col(d) * V.col(d).transpose() / power[d];
      rank += 1;
    } else {
      unseen += V.col(d).cwiseAbs2();
    }
  }
  const Eigen::VectorXd S = inverse * (c.A.transpose() * c.u), left = c.u - c.A * S;
  const double memory = autocorrelation_time(left, c.lengths);
  const auto presses_used = static_cast<double>(c.lengths.size());
  ArmFit fit;
  fit.freedom = (static_cast<double>(c.u.size()) - 3 * presses_used) / memory - rank;
  if (fit.freedom < 3)
    fail_input(presses.name,
               fmt::format("its {} rows in contact are too few to know the arm's error by",
                           c.u.size() / 3),
               "record more rows of each press, or more presses");
  const double variance = left.squaredNorm() / (fit.freedom * memory);
  fit.noise = std::sqrt(variance);
  fit.covariance = variance * memory * inverse;
  fit.reach = (c.A * S).cwiseAbs().maxCoeff();
  if (c.u.dot(c.A * S) > 0 && S.head<3>().sum() < 0)
    fail_input(presses.name, "the tool moves with the force of the block, not against it",
               "a press into the block has uz < 0 and fz > 0; see hs-import");
  const double t = student_quantile(kCalibrationConfidence, fit.freedom);
  std::string open;
  for (std::size_t k = 0; k < kSymmetric; ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    CalibratedValue& n = fit.numbers[k];
    constexpr double kHidden = 1e-3;
    if (unseen[at] > kHidden) {
      n.state = "assumed";
      open += std::string(open.empty() ? "" : ", ") + calibrated_names()[kArm + k].name;
      continue;
    }
    n.state = "fitted";
    n.value = S[at];
    n.std_error = std::sqrt(fit.covariance(at, at));
    n.lower = n.value - t * n.std_error;
    n.upper = n.value + t * n.std_error;
  }
  if (!open.empty())
    fit.open.push_back(open +
                       " taken for 0: no press pushes along those axes; press the block's "
                       "sides too");
  return fit;
}

void add_arm(const ArmFit& fit, const Recording& presses, Calibration& calibration) {
  for (std::size_t k = 0; k < kSymmetric; ++k) calibration.numbers[kArm + k] = fit.numbers[k];
  calibration.metadata.set("arm_source", presses.name);
  calibration.metadata.set("arm_noise", fmt::format("{:.4g}", fit.noise));
}

}  // namespace hapsim
