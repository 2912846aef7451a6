#include "acfm/acfm_axis_fit.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "estimate/multi_start.h"
#include "material/maxwell_memory.h"

namespace hapsim {

AxisData axis_data(const Dataset& dataset, const Episodes& episodes, const Vec3& direction) {
  AxisData data;
  std::size_t n = 0;
  for (const Episode* e : episodes) n += e->rows.size();
  data.u.resize(static_cast<Eigen::Index>(n));
  data.f.resize(static_cast<Eigen::Index>(n));
  data.size.resize(static_cast<Eigen::Index>(n));
  Eigen::Index at = 0;
  for (const Episode* e : episodes)
    for (std::size_t i = 0; i < e->rows.size(); ++i, ++at) {
      data.u[at] = e->view.in_air[i] ? 0 : direction.dot(e->view.u[i]);
      data.f[at] = e->view.in_air[i] ? 0 : direction.dot(dataset.recording.f[e->rows[i]]);
      data.size[at] = e->view.u[i].norm();
      const bool timed = i > 0 && !e->view.t.empty();
      data.dt.push_back(timed ? e->view.t[i] - e->view.t[i - 1] : -1);
    }
  data.moved = data.u.norm();
  return data;
}
namespace {

// The memory of x of one element, and its derivative by tau when asked.
Eigen::VectorXd memory_of(const AxisData& data, const Eigen::VectorXd& x, double tau,
                          Eigen::VectorXd* slope = nullptr) {
  Eigen::VectorXd m(x.size());
  if (slope != nullptr) slope->resize(x.size());
  double h = 0, dh = 0;
  for (Eigen::Index i = 0; i < m.size(); ++i) {
    const double dt = data.dt[static_cast<std::size_t>(i)];
    if (dt < 0) {
      h = x[i];
      dh = 0;
    } else {
      const MemoryStep s = memory_step(dt, tau);
      const double change = x[i] - x[i - 1];
      dh = s.a * dh + s.da_dtau * h + s.dc_dtau * change;
      h = s.a * h + s.c * change;
    }
    m[i] = h;
    if (slope != nullptr) (*slope)[i] = dh;
  }
  return m;
}
// Springs of given relaxation times by linear least squares, kept off zero.
std::vector<double> start_at(const AxisData& data, const std::vector<double>& tau, double typical) {
  Eigen::MatrixXd A(data.u.size(), static_cast<Eigen::Index>(tau.size()) + 1);
  A.col(0) = -data.u;
  for (std::size_t i = 0; i < tau.size(); ++i)
    A.col(static_cast<Eigen::Index>(i) + 1) = -memory_of(data, data.u, tau[i]);
  const Eigen::VectorXd k = A.colPivHouseholderQr().solve(data.f);
  std::vector<double> start{std::max(k[0], 0.05 * typical)};
  for (std::size_t i = 0; i < tau.size(); ++i) {
    start.push_back(std::max(k[static_cast<Eigen::Index>(i) + 1], 0.05 * typical));
    start.push_back(tau[i]);
  }
  return start;
}

}  // namespace

std::vector<std::vector<double>> time_starts(const Windows& windows, double low, double high,
                                             bool given) {
  std::vector<std::vector<double>> starts;
  const auto terms = static_cast<double>(windows.size());
  for (const double shift : {0.15, 0.4, 0.65, 0.9}) {
    std::vector<double> tau;
    for (std::size_t i = 0; i < windows.size(); ++i)
      tau.push_back(given ? windows[i].first * std::pow(windows[i].second / windows[i].first, shift)
                          : low * std::pow(high / low, (static_cast<double>(i) + shift) / terms));
    starts.push_back(tau);
  }
  return starts;
}
AxisFit fit_axis(const AxisData& data, const Windows& windows,
                 const std::vector<std::vector<double>>& times, bool sorted, double noise,
                 bool stiffening) {
  const auto terms = windows.size();
  const double typical =
      std::max(-data.f.dot(data.u) / data.u.squaredNorm(), 1e-9 * data.f.norm() / data.u.norm());
  const auto last = static_cast<Eigen::Index>(2 * terms + 1);  // of the stiffening
  const double deepest = data.size.maxCoeff();
  const ResidualFunction residuals = [&](const Eigen::VectorXd& x, Eigen::VectorXd& r,
                                         Eigen::MatrixXd* J) {
    Eigen::VectorXd q = data.u, w;
    if (stiffening) {
      w.resize(q.size());
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        const Stiffening bent = stiffening_at(x[last], data.size[i]);
        q[i] = data.u[i] * bent.factor;
        w[i] = data.u[i] * bent.slope;
      }
    }
    r = data.f + x[0] * q;
    if (J != nullptr) {
      J->resize(r.size(), x.size());
      J->col(0) = q;
      if (stiffening) J->col(last) = x[0] * w;
    }
    Eigen::VectorXd slope;
    for (std::size_t i = 0; i < terms; ++i) {
      const auto k = static_cast<Eigen::Index>(2 * i + 1);
      const Eigen::VectorXd m = memory_of(data, q, x[k + 1], J != nullptr ? &slope : nullptr);
      r += x[k] * m;
      if (J == nullptr) continue;
      J->col(k) = m;
      J->col(k + 1) = x[k] * slope;
      if (stiffening) J->col(last) += x[k] * memory_of(data, w, x[k + 1]);
    }
    r /= noise;
    if (J != nullptr) *J /= noise;
  };
  std::vector<std::vector<Unknown>> starts;
  for (const std::vector<double>& tau : times) {
    const std::vector<double> value = start_at(data, tau, typical);
    std::vector<Unknown> start(value.size());
    for (std::size_t j = 0; j < value.size(); ++j) {
      start[j].value = value[j];
      const bool time = j > 0 && j % 2 == 0;
      if (time) {
        start[j].lower = windows[j / 2 - 1].first;
        start[j].upper = windows[j / 2 - 1].second;
        start[j].logarithmic = true;
      } else {
        start[j].lower = j == 0 ? 1e-6 * typical : 0;
        start[j].upper = 1e12;
        start[j].scale = typical;
      }
    }
    if (stiffening) {
      Unknown bend;
      bend.value = 0.3 / deepest;
      bend.lower = -3 / deepest;
      bend.upper = 12 / deepest;
      bend.scale = 1 / deepest;
      start.push_back(bend);
    }
    starts.push_back(std::move(start));
  }
  LeastSquaresOptions options;
  options.max_iterations = 1000;  // valleys of elements that are near one another are long
  const LeastSquaresResult fit = minimise_from_many(starts, residuals, options).best;
  // A valley that is flat within the noise need not be walked to its end.
  const bool within_noise = fit.sum_of_squares < static_cast<double>(data.u.size());
  if (!fit.converged && !within_noise)
    fail_numerics("", "a sub-model did not converge: " + fit.message,
                  "give fewer elements, or --windows");
  const double freedom = static_cast<double>(data.u.size() - fit.x.size());
  const double misfit = freedom > 0 ? std::max(1.0, fit.sum_of_squares / freedom) : 1;
  std::vector<std::size_t> order(terms);
  for (std::size_t i = 0; i < terms; ++i) order[i] = i;
  const auto tau = [&](std::size_t i) { return fit.x[static_cast<Eigen::Index>(2 * i + 2)]; };
  if (sorted)
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return tau(a) < tau(b); });
  AxisFit result;
  result.undetermined = !fit.converged;
  const auto copy = [&](std::size_t to, std::size_t from) {
    const auto at = static_cast<Eigen::Index>(from);
    result.axis.value[to] = fit.x[at];
    result.axis.error[to] = fit.at_bound[from] || fit.undetermined[from]
                                ? std::numeric_limits<double>::quiet_NaN()
                                : std::sqrt(misfit * fit.covariance(at, at));
    result.undetermined |= fit.undetermined[from];
  };
  copy(0, 0);
  if (stiffening) copy(AcfmAxis::kStiffening, static_cast<std::size_t>(last));
  for (std::size_t i = 0; i < terms; ++i) {
    copy(2 * i + 1, 2 * order[i] + 1);
    copy(2 * i + 2, 2 * order[i] + 2);
  }
  return result;
}
}  // namespace hapsim
