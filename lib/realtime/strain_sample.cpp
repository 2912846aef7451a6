#include "realtime/strain_sample.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/error.h"
#include "realtime/power_table.h"
#include "realtime/stored_numbers.h"
#include "realtime/strain_mesh.h"

namespace hapsim {
namespace {

constexpr double kStrainFloor = 0.05;  // of the largest force: below, errors are over that
constexpr std::size_t kMemoryBytes = std::size_t{1} << 28;  // of numbers of all states at a time
constexpr double kStrainRidge = 1e-7;                       // of the columns' squares
constexpr double kAsides[] = {1, 0.3};                      // StrainSample::aside
constexpr double kFolds = 0.1;  // error of the memory from which on a narrower way is asked for
constexpr int kDown = 6, kSideways = 4;  // steps of the way straight down, and of the others
constexpr const char* kStrainKind = "hsstra04";

struct Powers {
  int i, j, k;
};

constexpr std::array<Powers, kStrainTerms> monomials() {
  constexpr std::array<int, 5> most{6, 4, 4, 2, 1};
  std::array<Powers, kStrainTerms> all{};
  int n = 0;
  for (int m = 0; m < 5; ++m)
    for (int i = std::max(0, 3 - m); i <= most[static_cast<std::size_t>(m)]; ++i)
      for (int j = 0; j <= m; ++j) all[static_cast<std::size_t>(n++)] = {i, j, m - j};
  return all;
}
constexpr std::array<Powers, kStrainTerms> kMonomials = monomials();

struct Solved {
  std::vector<Vec3> v, f;  // ways in radii and forces that move the tool, in the frame [N]
};

void fit(const Solved& solved, double radius, StrainSample& sample) {
  const auto rows = static_cast<Eigen::Index>(3 * solved.v.size());
  const Eigen::Matrix3d K = sample.frame * sample.K * sample.frame.transpose();
  const double unit = K(0, 0) * radius;
  double largest = 0;
  for (const Vec3& f : solved.f) largest = std::max(largest, f.norm());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows + kStrainTerms, kStrainTerms);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(rows + kStrainTerms);
  for (std::size_t s = 0; s < solved.v.size(); ++s) {
    const double weight = unit / std::max(solved.f[s].norm(), kStrainFloor * largest);
    const auto row = 3 * static_cast<Eigen::Index>(s);
    A.middleRows<3>(row) = weight * strain_gradients(solved.v[s]);
    b.segment<3>(row) = weight * (solved.f[s] / unit - K * solved.v[s] / K(0, 0));
  }
  const Eigen::VectorXd scale = A.colwise().norm().cwiseMax(1e-12).cwiseInverse().transpose();
  A = A * scale.asDiagonal();
  const Eigen::MatrixXd forces = A.topRows(rows);
  A.bottomRows(kStrainTerms).diagonal().setConstant(std::sqrt(kStrainRidge));
  const Eigen::VectorXd x = A.colPivHouseholderQr().solve(b);
  sample.fit =
      std::sqrt((forces * x - b.head(rows)).squaredNorm() / static_cast<double>(solved.v.size()));
  sample.c = x.cwiseProduct(scale);
}

std::string gives_way(double depth) {
  return fmt::format("the body is not stable when pressed by {:.3g} tool radii", depth);
}

// From the states that were visited, the first step straight down after the undeformed one. What
// leaves nothing is told by `why`.
void remember(FullPress& press, double radius, const std::vector<Vec3>& visited,
              const std::vector<ToolBody::State>& states, StrainSample& sample, std::string& why) {
  const Eigen::MatrixXd weights = inside_weights(visited);
  Eigen::MatrixXd stresses;  // that move the inside
  for (std::size_t i = 0; i < states.size(); ++i) {
    press.restore(states[i]);
    const Eigen::VectorXd s = press.stresses();
    if (i == 0) stresses.setZero(s.size(), kInsideFields);
    stresses += s * weights.row(static_cast<Eigen::Index>(i));
  }
  press.restore(states[1]);
  const std::optional<Eigen::MatrixXd> fields = press.moved_inside(stresses);
  if (!fields) {
    sample.into = 0;
    why = gives_way(visited[1][0]);
    return;
  }
  const auto numbers = static_cast<std::size_t>(stresses.rows());
  stresses.resize(0, 0);
  const Eigen::Matrix3d inside = sample.frame * sample.K * sample.frame.transpose();
  std::vector<Vec3> stable;
  std::vector<std::pair<std::size_t, Eigen::MatrixXd>> by;  // states, and their directions' fields
  for (std::size_t i = 0; i < states.size(); ++i) {
    press.restore(states[i]);
    if (auto own = press.fields()) {
      stable.push_back(visited[i]);
      by.emplace_back(i, *std::move(own));
      continue;
    }
    // A state that is not stable inside has no response, so the way counts to the one before.
    const double d = visited[i][0], before = i > 0 ? visited[i - 1][0] : 0;
    sample.into = std::min(sample.into, before < d ? before : 0);
    if (!(sample.into > 0) && why.empty()) why = gives_way(d);
  }
  if (!(sample.into > 0)) return;
  StressStates all(sample.frame, radius, inside(0, 0) * radius * radius, stable, sample.aside);
  constexpr std::size_t kKept = 8 + 2 * kInsideFields;  // of a state and number (add())
  const std::size_t parts = 1 + sizeof(float) * kKept * numbers * stable.size() / kMemoryBytes;
  for (std::size_t part = 0; part < parts; ++part)
    all.add([&](std::size_t i) {
      press.restore(states[by[i].first]);
      return press.stress_response(by[i].second, *fields, {part, parts});
    });
  sample.memory = all.fit(sample.memory_fit);
  sample.memory->C.topLeftCorner<3, 3>() -= inside / inside(0, 0);
}

}  // namespace

Eigen::Matrix<double, 3, kStrainTerms> strain_gradients(const Vec3& v) noexcept {
  const PowerTable d(v[0]), p(v[1]), q(v[2]);
  Eigen::Matrix<double, 3, kStrainTerms> g;
  for (int t = 0; t < kStrainTerms; ++t) {
    const auto [i, j, k] = kMonomials[static_cast<std::size_t>(t)];
    g.col(t) << d.d[i] * p.f[j] * q.f[k], d.f[i] * p.d[j] * q.f[k], d.f[i] * p.f[j] * q.d[k];
  }
  return g;
}

Vec3 strain_gradient(const StrainCoefficients& c, const Vec3& v) noexcept {
  const PowerTable d(v[0]), p(v[1]), q(v[2]);
  Vec3 g = Vec3::Zero();
  for (int t = 0; t < kStrainTerms; ++t) {
    const auto [i, j, k] = kMonomials[static_cast<std::size_t>(t)];
    g[0] += c[t] * d.d[i] * p.f[j] * q.f[k];
    g[1] += c[t] * d.f[i] * p.d[j] * q.f[k];
    g[2] += c[t] * d.f[i] * p.f[j] * q.d[k];
  }
  return g;
}

Eigen::Matrix3d strain_hessian(const StrainCoefficients& c, const Vec3& v) noexcept {
  const PowerTable d(v[0]), p(v[1]), q(v[2]);
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  for (int t = 0; t < kStrainTerms; ++t) {
    const auto [i, j, k] = kMonomials[static_cast<std::size_t>(t)];
    h(0, 0) += c[t] * d.dd[i] * p.f[j] * q.f[k];
    h(1, 1) += c[t] * d.f[i] * p.dd[j] * q.f[k];
    h(2, 2) += c[t] * d.f[i] * p.f[j] * q.dd[k];
    h(0, 1) += c[t] * d.d[i] * p.d[j] * q.f[k];
    h(0, 2) += c[t] * d.d[i] * p.f[j] * q.d[k];
    h(1, 2) += c[t] * d.f[i] * p.d[j] * q.d[k];
  }
  h(1, 0) = h(0, 1), h(2, 0) = h(0, 2), h(2, 1) = h(1, 2);
  return h;
}

std::string StrainSample::bytes() const {
  std::vector<double> numbers(point.begin(), point.end());
  numbers.insert(numbers.end(), frame.data(), frame.data() + 9);
  numbers.insert(numbers.end(), K.data(), K.data() + 9);
  numbers.insert(numbers.end(), {into, aside, fit});
  const StrainMeshError error = finer.value_or(StrainMeshError{-1});
  numbers.insert(numbers.end(), error.begin(), error.end());
  numbers.insert(numbers.end(), c.data(), c.data() + kStrainTerms);
  if (memory) {
    numbers.push_back(memory_fit);
    numbers.insert(numbers.end(), memory->C.data(), memory->C.data() + memory->C.size());
    const InsideMemory& inside = memory->inside;
    numbers.insert(numbers.end(), inside.g.data(), inside.g.data() + inside.g.size());
    numbers.insert(numbers.end(), inside.w.data(), inside.w.data() + inside.w.size());
    numbers.insert(numbers.end(), inside.stiffness.data(),
                   inside.stiffness.data() + inside.stiffness.size());
    numbers.insert(numbers.end(), inside.stressed.data(),
                   inside.stressed.data() + inside.stressed.size());
  }
  return stored_numbers(kStrainKind, numbers);
}

std::optional<StrainSample> StrainSample::read(const std::string& bytes) {
  constexpr std::size_t kStatic = 3 + 9 + 9 + 3 + kStrainDepths + kStrainTerms;
  constexpr std::size_t kWhole = kStatic + 1 + kMemoryTerms * kMemoryTerms +
                                 2 * kInsideFields * kInsideNow * kInsideBefore +
                                 kInsideFields * kInsideFields * (kInsideNow + kInsideBefore);
  const auto stored = read_numbers(kStrainKind, bytes);
  if (!stored || (stored->size() != kStatic && stored->size() != kWhole)) return std::nullopt;
  const std::vector<double>& numbers = *stored;
  const bool remembers = numbers.size() == kWhole;
  StrainSample s;
  s.point = Eigen::Map<const Vec3>(numbers.data());
  s.frame = Eigen::Map<const Eigen::Matrix3d>(numbers.data() + 3);
  s.K = Eigen::Map<const Eigen::Matrix3d>(numbers.data() + 12);
  s.into = numbers[21];
  s.aside = numbers[22];
  s.fit = numbers[23];
  StrainMeshError error;
  std::copy_n(numbers.data() + 24, kStrainDepths, error.begin());
  if (error[0] >= 0) s.finer = error;
  s.c = Eigen::Map<const StrainCoefficients>(numbers.data() + 24 + kStrainDepths);
  if (remembers) {
    s.memory_fit = numbers[kStatic];
    s.memory.emplace();
    const double* next = numbers.data() + kStatic + 1;
    const auto take = [&next](auto& matrix) {
      std::copy(next, next + matrix.size(), matrix.data());
      next += matrix.size();
    };
    take(s.memory->C);
    take(s.memory->inside.g);
    take(s.memory->inside.w);
    take(s.memory->inside.stiffness);
    take(s.memory->inside.stressed);
  }
  return s;
}

namespace {

std::optional<StrainSample> solve_aside(const TetMesh& body, const ContactBase& base,
                                        const Model& model, const Vec3& point, double tool_radius,
                                        double into, double aside, bool memory, std::string& why) {
  const FullOptions options = strain_elements(base);
  StrainSample sample;
  Solved solved;
  try {
    FullPress press(body, model, point, tool_radius, options);
    sample.point = point;
    const Vec3 n = press.normal(), e = n.unitOrthogonal();
    sample.frame << -n.transpose(), e.transpose(), n.cross(e).transpose();
    const std::optional<Eigen::Matrix3d> K = press.stiffness();
    if (!K) {
      why = gives_way(0);
      return std::nullopt;
    }
    sample.K = *K;
    sample.into = into;
    sample.aside = aside;
    std::vector<Vec3> visited;
    std::vector<ToolBody::State> states;
    const auto keep = [&](const Vec3& v) {
      if (!memory) return;
      visited.push_back(v);
      states.push_back(press.state());
    };
    keep(Vec3::Zero());
    const auto way = [&](double angle, double share, int steps) {
      press.reset();
      double reached = 0;
      try {
        for (int i = 1; i <= steps; ++i) {
          const double d = into * i / steps, side = share * strain_side(d, aside);
          const Vec3 v(d, side * std::cos(angle), side * std::sin(angle));
          const Vec3 f = press.step(tool_radius * sample.frame.transpose() * v, 0);
          solved.v.push_back(v);
          solved.f.push_back(-sample.frame * f);
          keep(v);
          reached = d;
        }
      } catch (const Error& error) {
        if (error.code() != ExitCode::kNoConvergence) throw;
        if (!(reached > 0)) why = error.what();
      }
      sample.into = std::min(sample.into, reached);
    };
    way(0, 0, kDown);
    for (int k = 0; k < 6; ++k) {
      way(k * std::numbers::pi / 3, 1, kSideways);
      way((k + 0.5) * std::numbers::pi / 3, 0.5, kSideways);
    }
    if (memory && sample.into > 0) remember(press, tool_radius, visited, states, sample, why);
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput) throw;
    why = error.what();
    return std::nullopt;
  }
  if (!(sample.into > 0)) return std::nullopt;
  fit(solved, tool_radius, sample);
  return sample;
}

}  // namespace

std::optional<StrainSample> solve_strain_sample(const TetMesh& body, const ContactBase& base,
                                                const Model& model, const Vec3& point,
                                                double tool_radius, double into, bool memory,
                                                std::string& why) {
  std::optional<StrainSample> best;
  for (const double aside : kAsides) {
    std::optional<StrainSample> sample =
        solve_aside(body, base, model, point, tool_radius, into, aside, memory, why);
    if (!best || (sample && sample->memory_fit < best->memory_fit)) best = std::move(sample);
    if (!best || best->memory_fit < kFolds) break;
  }
  return best;
}

}  // namespace hapsim
