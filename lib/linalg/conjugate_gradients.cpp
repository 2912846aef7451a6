#include "linalg/conjugate_gradients.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cmath>
#include <utility>

#include "linalg/block_sparse.h"
#include "linalg/counts.h"
#include "linalg/midpoint_grid.h"

namespace hapsim {
namespace {

using Lanes = std::array<double, kLanes>;
using Vector = std::vector<double>;  // kLanes columns side by side

Lanes dots(const Vector& a, const Vector& b) {
  Lanes sum{};
  for (std::size_t i = 0; i < a.size(); i += kLanes)
    for (int l = 0; l < kLanes; ++l) sum[l] += a[i + l] * b[i + l];
  return sum;
}

// y += a x, or y = x + a y.
void add(const Lanes& a, const Vector& x, Vector& y) {
  for (std::size_t i = 0; i < y.size(); i += kLanes)
    for (int l = 0; l < kLanes; ++l) y[i + l] += a[l] * x[i + l];
}
void extend(const Lanes& a, const Vector& x, Vector& y) {
  for (std::size_t i = 0; i < y.size(); i += kLanes)
    for (int l = 0; l < kLanes; ++l) y[i + l] = x[i + l] + a[l] * y[i + l];
}

}  // namespace

struct ConjugateGradients::Impl {
  virtual ~Impl() = default;
  mutable std::atomic<int> most{0};  // iterations(); several threads may solve at once
  virtual bool prepare(SymmetricSparse matrix, const BlockEnds& ends) = 0;
  virtual void multiply_by_matrix(const Vector& x, Vector& y) const = 0;
  virtual void apply_factor(Vector& z) const = 0;
  virtual std::size_t held_bytes() const = 0;
  void precondition(const Vector& r, Vector& z) const {
    z = r;
    apply_factor(z);
    if (coarse) coarse->add_correction(scale, r, z);
  }
  std::vector<int> order;  // of the unknowns
  Eigen::VectorXd scale;   // 1 / sqrt(diagonal), in that order
  double shift = 0;
  std::unique_ptr<MidpointGrid> coarse;
};

namespace {

template <int B, class Base>
struct Blocked : Base {
  BlockSparse<B, double> a;  // scaled
  BlockSparse<B, float> l;

  bool prepare(SymmetricSparse matrix, const BlockEnds& ends) override {
    const std::vector<int> blocks = cuthill_mckee_order(block_pattern(matrix, B));
    a = reordered_blocks<B>(matrix, blocks);
    if (!ends.empty()) {
      this->coarse = std::make_unique<MidpointGrid>();
      this->coarse->assemble(matrix, ends, blocks);
    }
    this->scale.resize(matrix.size);
    matrix = {};  // before factors need as much
    if (this->coarse && !this->coarse->factorise()) return false;
    this->order.clear();
    for (const int b : blocks)
      for (int i = 0; i < B; ++i) this->order.push_back(B * b + i);
    const LowerPattern& p = a.pattern;
    for (int c = 0; c < p.size(); ++c)
      for (int i = 0; i < B; ++i) {
        const double d = a.value[static_cast<std::size_t>(B * B) * p.start[c] + B * i + i];
        if (!(d > 0)) return false;
        this->scale[B * c + i] = 1 / std::sqrt(d);
      }
    double* value = a.value.data();
    for (int c = 0; c < p.size(); ++c)
      for (int k = p.start[c]; k < p.start[c + 1]; ++k)
        for (int i = 0; i < B; ++i)
          for (int j = 0; j < B; ++j)
            *value++ *= this->scale[B * p.row[k] + i] * this->scale[B * c + j];
    for (double& raised = this->shift = 0; raised < 100; raised = raised == 0 ? 1e-3 : 2 * raised)
      if (incomplete_cholesky<B>(a, raised, l)) return true;
    return false;
  }
  void multiply_by_matrix(const Vector& x, Vector& y) const override {
    multiply(a, x.data(), y.data());
  }
  void apply_factor(Vector& z) const override { apply_inverse(l, z.data()); }
  std::size_t held_bytes() const override {
    using hapsim::held_bytes;
    return sizeof *this + held_bytes(a) + held_bytes(l) + held_bytes(this->order) +
           held_bytes(this->scale) + held_bytes(this->coarse);
  }
};

}  // namespace

ConjugateGradients::ConjugateGradients() = default;
ConjugateGradients::~ConjugateGradients() = default;
ConjugateGradients::ConjugateGradients(ConjugateGradients&&) noexcept = default;
ConjugateGradients& ConjugateGradients::operator=(ConjugateGradients&&) noexcept = default;

bool ConjugateGradients::prepare(SymmetricSparse matrix, int block, const BlockEnds& ends) {
  ++solver_counts.factorisations;
  assert((block == 1 || block == 3) && matrix.size % block == 0);
  assert(ends.empty() || (block == 3 && 3 * ends.size() == static_cast<std::size_t>(matrix.size)));
  for (int c = 0; c < matrix.size; ++c)
    if (matrix.column_start[c] == matrix.column_start[c + 1] ||
        matrix.row[matrix.column_start[c]] != c)
      return false;
  if (block == 3)
    impl_ = std::make_unique<Blocked<3, Impl>>();
  else
    impl_ = std::make_unique<Blocked<1, Impl>>();
  return impl_->prepare(std::move(matrix), ends);
}

IterationReport ConjugateGradients::solve(const Eigen::MatrixXd& b, Eigen::MatrixXd& x,
                                          double tolerance, int limit) const {
  const std::vector<int>& order = impl_->order;
  const auto size = static_cast<Eigen::Index>(order.size());
  assert(b.rows() == size && x.rows() == size && b.cols() == x.cols());
  if (limit == 0) limit = std::max(1000, static_cast<int>(10 * std::sqrt(size)));
  IterationReport all;
  all.converged = true;
  const std::size_t length = order.size() * kLanes;
  for (Eigen::Index first = 0; first < b.cols(); first += kLanes) {
    const int columns = static_cast<int>(std::min<Eigen::Index>(kLanes, b.cols() - first));
    // The scaled system D A D y = D b in the order of the factor; x = D y. Its residual is D times
    // the true one, so the true one's norm is taken where a column is to stop.
    Vector load(length, 0.0), y(length, 0.0), r(length), z(length), p(length), q(length);
    Lanes norm{};
    for (Eigen::Index i = 0; i < size; ++i)
      for (int l = 0; l < columns; ++l) {
        const double value = b(order[i], first + l), s = impl_->scale[i];
        load[kLanes * i + l] = s * value;
        y[kLanes * i + l] = x(order[i], first + l) / s;
        norm[l] += value * value;
      }
    const auto residuals = [&](const Vector& scaled) {
      Lanes sum{};
      for (Eigen::Index i = 0; i < size; ++i) {
        const double back = 1 / impl_->scale[i];
        for (int l = 0; l < kLanes; ++l)
          sum[l] += scaled[kLanes * i + l] * scaled[kLanes * i + l] * back * back;
      }
      for (int l = 0; l < kLanes; ++l) sum[l] = norm[l] > 0 ? std::sqrt(sum[l] / norm[l]) : 0;
      return sum;
    };
    const auto true_residual = [&] {
      impl_->multiply_by_matrix(y, q);
      for (std::size_t i = 0; i < length; ++i) r[i] = load[i] - q[i];
    };
    for (int l = 0; l < columns; ++l)
      if (norm[l] == 0)
        for (Eigen::Index i = 0; i < size; ++i) y[kLanes * i + l] = 0;
    true_residual();
    Lanes rho{}, last{};  // last: the step along p
    int steps = 0;
    for (; steps < limit; ++steps) {
      const Lanes left = residuals(r);
      if (*std::max_element(left.begin(), left.end()) <= tolerance) break;
      impl_->precondition(r, z);
      const Lanes next = dots(r, z);
      Lanes beta{}, step{}, back{};
      for (int l = 0; l < kLanes; ++l) beta[l] = rho[l] > 0 ? next[l] / rho[l] : 0;
      // A coarse grid solved roughly is not the same operator at each step: what the residual has
      // changed by, -step q, is made orthogonal instead of the residual.
      if (impl_->coarse && steps > 0) {
        const Lanes across = dots(q, z);
        for (int l = 0; l < kLanes; ++l) beta[l] = rho[l] > 0 ? -last[l] * across[l] / rho[l] : 0;
      }
      if (steps == 0)
        p = z;
      else
        extend(beta, z, p);
      rho = next;
      impl_->multiply_by_matrix(p, q);
      const Lanes curvature = dots(p, q);
      bool moves = false;
      for (int l = 0; l < kLanes; ++l) {
        // A column that has arrived, or meets a direction of no curvature, stands still.
        if (left[l] > tolerance && curvature[l] > 0) step[l] = rho[l] / curvature[l];
        back[l] = -step[l];
        moves = moves || step[l] != 0;
      }
      if (!moves) break;
      last = step;
      add(step, p, y);
      add(back, q, r);
    }
    // The recurrence drifts from the truth: say the true residual.
    true_residual();
    const Lanes left = residuals(r);
    const double worst = *std::max_element(left.begin(), left.end());
    all.iterations = std::max(all.iterations, steps);
    all.residual = std::max(all.residual, worst);
    all.converged = all.converged && worst <= 2 * tolerance;
    for (Eigen::Index i = 0; i < size; ++i)
      for (int l = 0; l < columns; ++l)
        x(order[i], first + l) = impl_->scale[i] * y[kLanes * i + l];
  }
  for (int most = impl_->most; most < all.iterations;)
    if (impl_->most.compare_exchange_weak(most, all.iterations)) break;
  return all;
}

std::size_t ConjugateGradients::held_bytes() const {
  return impl_ ? impl_->held_bytes() : 0;
}

int ConjugateGradients::iterations() const {
  return impl_ ? impl_->most.load() : 0;
}

double ConjugateGradients::shift() const {
  return impl_->shift;
}

}  // namespace hapsim
