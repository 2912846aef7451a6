#include "fusion/taught_correction.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "effects/effect.h"
#include "material/maxwell_memory.h"

namespace hapsim {
namespace {

constexpr std::size_t kLeastLessons = 4;
constexpr double kEarnsItsPlace = 0.95;  // of the error on presses left out
constexpr auto kColumns = static_cast<Eigen::Index>(TaughtCorrection::kWeights);

// One press as a regression: a row a slow force.
struct Rows {
  Eigen::MatrixXd features;  // at the slow forces' times
  Eigen::MatrixXd missed;    // slow less fast, a column a component [N]
};

std::size_t after(const std::vector<double>& t, double when) {
  const auto at = std::lower_bound(t.begin(), t.end(), when) - t.begin();
  return std::clamp<std::size_t>(static_cast<std::size_t>(at), 1, t.size() - 1);
}

Rows rows_of(const LessonPress& press, const TaughtCorrection& scales) {
  Eigen::MatrixXd all(static_cast<Eigen::Index>(press.t.size()), kColumns);
  TaughtForce run(scales);
  for (std::size_t i = 0; i < press.t.size(); ++i) {
    run.step(i == 0 ? 0 : press.t[i] - press.t[i - 1], press.u[i]);
    all.row(static_cast<Eigen::Index>(i)) =
        Eigen::Map<const Eigen::RowVectorXd>(run.features().data(), kColumns);
  }
  const auto n = static_cast<Eigen::Index>(press.slow_t.size());
  Rows rows{Eigen::MatrixXd(n, kColumns), Eigen::MatrixXd(n, 3)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const auto s = static_cast<std::size_t>(k);
    const std::size_t b = after(press.t, press.slow_t[s]), a = b - 1;
    const double step = press.t[b] - press.t[a];
    const double w = step > 0 ? std::clamp((press.slow_t[s] - press.t[a]) / step, 0.0, 1.0) : 1;
    rows.features.row(k) =
        (1 - w) * all.row(static_cast<Eigen::Index>(a)) + w * all.row(static_cast<Eigen::Index>(b));
    rows.missed.row(k) = (press.slow[s] - (1 - w) * press.fast[a] - w * press.fast[b]).transpose();
  }
  return rows;
}

// Sums over presses, from which a press is left out by taking its own off.
struct Sums {
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(kColumns, kColumns);
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(kColumns, 3);
  double rows = 0;
  void add(const Rows& r, double sign) {
    square += sign * r.features.transpose() * r.features;
    product += sign * r.features.transpose() * r.missed;
    rows += sign * static_cast<double>(r.features.rows());
  }
  Eigen::VectorXd weights(double ridge, int component) const {
    Eigen::MatrixXd A = square;
    // In units of each feature's own size; one that never acts stays at nothing.
    for (Eigen::Index k = 0; k < kColumns; ++k) A(k, k) += ridge * square(k, k) + 1e-12 * rows;
    return A.ldlt().solve(product.col(component));
  }
};

TaughtCorrection scales_of(const std::vector<LessonPress>& lessons, double tool_radius) {
  TaughtCorrection c;
  double gap = 0, count = 0, longest = 0;
  for (const LessonPress& press : lessons)
    c.place += press.contact / static_cast<double>(lessons.size());
  for (const LessonPress& press : lessons) {
    c.reach =
        std::max(c.reach, (press.contact - c.place).norm() + std::max(tool_radius / 2, kSamePlace));
    for (const Vec3& u : press.u) c.scale = c.scale.cwiseMax(u.cwiseAbs());
    for (std::size_t k = 1; k < press.slow_t.size(); ++k)
      gap += press.slow_t[k] - press.slow_t[k - 1], ++count;
    if (!press.t.empty()) longest = std::max(longest, press.t.back() - press.t.front());
  }
  // From two slow steps to the longest press, in thirds.
  const double low = std::max(2 * gap / std::max(count, 1.0), 1e-4);
  const double high = std::max(longest, 8 * low);
  for (std::size_t k = 0; k < TaughtCorrection::kTimes; ++k)
    c.time[k] = low * std::pow(high / low, (static_cast<double>(k) + 1) / 3);
  return c;
}

}  // namespace

TaughtCorrection::Terms TaughtCorrection::terms(const Vec3& u) const noexcept {
  Vec3 s;
  for (int k = 0; k < 3; ++k) s[k] = scale[k] > 0 ? std::clamp(u[k] / scale[k], -1.0, 1.0) : 0;
  const double x = s.x(), y = s.y(), z = s.z();
  return {x,     y,         z,         x * z,     y * z,     z * z,    x * x,
          y * y, x * z * z, y * z * z, z * z * z, x * x * z, y * y * z};
}

Vec3 TaughtForce::step(double dt, const Vec3& u) noexcept {
  const TaughtCorrection::Terms now = correction_.terms(u);
  constexpr std::size_t n = TaughtCorrection::kTerms;
  std::copy(now.begin(), now.end(), features_.begin());
  for (std::size_t m = 0; m < TaughtCorrection::kTimes; ++m) {
    const MemoryStep s = memory_step(dt, correction_.time[m]);
    for (std::size_t k = 0; k < n; ++k) {
      double& kept = features_[(m + 1) * n + k];
      kept = begun_ ? s.a * kept + s.c * (now[k] - last_[k]) : now[k];
    }
  }
  last_ = now;
  begun_ = true;
  Vec3 force;
  for (int a = 0; a < 3; ++a) {
    const auto& weight = correction_.weight[static_cast<std::size_t>(a)];
    force[a] = 0;
    for (std::size_t k = 0; k < TaughtCorrection::kWeights; ++k)
      force[a] += weight[k] * features_[k];
  }
  return force;
}

Taught teach(const std::vector<LessonPress>& lessons, double tool_radius) {
  Taught result;
  for (const LessonPress& press : lessons)
    result.by_others.emplace_back(press.t.size(), Vec3::Zero());
  const auto usable = std::count_if(lessons.begin(), lessons.end(), [](const LessonPress& p) {
    return !p.slow.empty() && p.t.size() > 1;
  });
  if (static_cast<std::size_t>(usable) < kLeastLessons) return result;
  TaughtCorrection correction = scales_of(lessons, tool_radius);
  std::vector<Rows> rows;
  Sums all;
  for (const LessonPress& press : lessons) {
    rows.push_back(press.t.size() > 1 ? rows_of(press, correction)
                                      : Rows{Eigen::MatrixXd(0, kColumns), Eigen::MatrixXd(0, 3)});
    all.add(rows.back(), 1);
  }
  std::vector<TaughtCorrection> others(lessons.size(), correction);
  bool any = false;
  for (int a = 0; a < 3; ++a) {
    double plain = 0, least = 0, chosen = 0;
    for (const Rows& r : rows) plain += r.missed.col(a).squaredNorm();
    least = kEarnsItsPlace * kEarnsItsPlace * plain;
    for (double ridge = 1e-4; ridge < 20; ridge *= std::sqrt(10.0)) {
      double left = 0;
      for (const Rows& r : rows) {
        Sums rest = all;
        rest.add(r, -1);
        left += (r.missed.col(a) - r.features * rest.weights(ridge, a)).squaredNorm();
      }
      if (left < least) least = left, chosen = ridge;
    }
    if (chosen <= 0) continue;
    any = true;
    const auto put = [&](const Eigen::VectorXd& w, TaughtCorrection& c) {
      std::copy(w.data(), w.data() + kColumns, c.weight[static_cast<std::size_t>(a)].begin());
    };
    put(all.weights(chosen, a), correction);
    for (std::size_t p = 0; p < rows.size(); ++p) {
      Sums rest = all;
      rest.add(rows[p], -1);
      put(rest.weights(chosen, a), others[p]);
    }
  }
  if (!any) return result;
  for (std::size_t p = 0; p < lessons.size(); ++p) {
    TaughtForce run(others[p]);
    const LessonPress& press = lessons[p];
    for (std::size_t i = 0; i < press.t.size(); ++i)
      result.by_others[p][i] = run.step(i == 0 ? 0 : press.t[i] - press.t[i - 1], press.u[i]);
  }
  result.correction = correction;
  return result;
}

}  // namespace hapsim
