#include "realtime/acfm_fit.h"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "estimate/multi_start.h"
#include "fem/memory.h"
#include "realtime/acfm_loop.h"
#include "realtime/stiffness_field.h"

namespace hapsim {
namespace {

using Episodes = std::vector<const Episode*>;

// An axis that moves by less than this share of the whole motion tells nothing of its stiffness.
constexpr double kLeastMotion = 1e-3;

// What one axis saw: sample by sample, the presses one after the other.
struct AxisData {
  Eigen::VectorXd u, f;    // [m], [N]
  Eigen::VectorXd size;    // |u| of the whole displacement [m]
  std::vector<double> dt;  // [s] since the sample before; negative: a press begins
  double moved = 0;        // root of the sum of squares [m]
};

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

using Windows = std::vector<std::pair<double, double>>;

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

struct AxisFit {
  AcfmAxis axis;
  bool undetermined = false;
};

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

// What an axis that did not move takes from the others: tangents from each other, else across from
// along by the ratio of a bonded disc.
void derive(SubModel& sub, const std::array<char, 3>& moved, int terms) {
  const double nu = 0.4;
  const Eigen::Matrix3d C = disc_compliance(1, nu, 1, Vec3::UnitZ());
  const double ratio = C(2, 2) / C(0, 0);  // of the stiffness across over along
  for (std::size_t a = 0; a < 3; ++a) {
    if (moved[a]) continue;
    const std::size_t other = a < 2 ? 1 - a : 0;
    const std::size_t from = a < 2 && moved[other] ? other : a < 2 ? 2 : moved[0] ? 0 : 1;
    AcfmAxis& axis = sub.axis[a];
    axis = sub.axis[from];
    axis.error.fill(std::numeric_limits<double>::quiet_NaN());
    axis.derived = true;
    const double factor = a < 2 && from < 2 ? 1 : a < 2 ? ratio : 1 / ratio;
    axis.value[0] *= factor;
    for (int i = 0; i < terms; ++i) axis.value[static_cast<std::size_t>(2 * i + 1)] *= factor;
  }
}

struct Span {
  double step = 0, longest = 0;  // [s]
};

Span span_of(const Dataset& dataset) {
  Span span;
  std::vector<double> steps;
  for (const Episode& e : dataset.episodes) {
    if (e.view.t.empty()) continue;
    span.longest = std::max(span.longest, e.view.t.back());
    for (std::size_t i = 1; i < e.view.t.size(); ++i)
      if (e.view.t[i] > e.view.t[i - 1]) steps.push_back(e.view.t[i] - e.view.t[i - 1]);
  }
  if (steps.empty()) return span;
  const auto middle = steps.begin() + static_cast<long>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  span.step = *middle;
  return span;
}

class Fitter {
 public:
  Fitter(const Dataset& dataset, const std::vector<Vec3>& normals, const AcfmFitOptions& options)
      : dataset_(dataset), normals_(normals), options_(options), windows_(options.windows) {
    const Span span = span_of(dataset);
    if (options.terms > 0 && !(span.longest > 0))
      fail_usage("relaxation needs times, and the recording has none",
                 "record a column t, or ask for springs alone (0 elements)");
    if (windows_.empty())
      windows_.assign(static_cast<std::size_t>(options.terms), {0.5 * span.step, 3 * span.longest});
    times_ = time_starts(windows_, 2 * span.step, std::max(8 * span.step, span.longest),
                         !options.windows.empty());
  }

  // Fitted on these episodes of a position; adds what is not determined to `remarks`.
  SubModel fit(std::size_t position, const Episodes& episodes, int& derived,
               std::vector<std::string>& remarks) const {
    SubModel sub;
    sub.point = dataset_.positions[position];
    sub.normal = normals_[position];
    const Eigen::Matrix3d frame = acfm_frame(sub.normal);
    std::array<AxisData, 3> data;
    double whole = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      data[a] = axis_data(dataset_, episodes, frame.col(static_cast<Eigen::Index>(a)));
      whole = std::hypot(whole, data[a].moved);
    }
    if (!(whole > 0))
      fail_input(dataset_.recording.name, fmt::format("nothing moves at position {}", position + 1),
                 "remove its presses");
    std::array<char, 3> moved{};
    for (std::size_t a = 0; a < 3; ++a) {
      if (data[a].moved < kLeastMotion * whole) continue;
      moved[a] = 1;
      const AxisFit one = fit_axis(data[a], windows_, times_, options_.windows.empty(),
                                   options_.noise, options_.stiffening);
      sub.axis[a] = one.axis;
      if (one.undetermined)
        remarks.push_back(fmt::format(
            "position {}, axis {}: these presses do not tell its elements apart", position + 1,
            a == 2   ? "n"
            : a == 1 ? "t2"
                     : "t1"));
    }
    derive(sub, moved, options_.terms);
    derived += 3 - moved[0] - moved[1] - moved[2];
    return sub;
  }

 private:
  const Dataset& dataset_;
  const std::vector<Vec3>& normals_;
  const AcfmFitOptions& options_;
  Windows windows_;
  std::vector<std::vector<double>> times_;
};

// Sum of squared errors along an episode [N^2].
double squares(const Acfm& model, const Dataset& dataset, const Episode& e,
               std::vector<Vec3>* forces = nullptr) {
  AcfmLoop loop(model);
  loop.begin(dataset.positions[static_cast<std::size_t>(e.position)]);
  double sum = 0;
  for (std::size_t i = 0; i < e.rows.size(); ++i) {
    const double t = e.view.t.empty() ? std::nan("") : e.view.t[i];
    const Vec3 f = loop.press(t, e.view.u[i], e.view.in_air[i] != 0);
    if (forces != nullptr) (*forces)[static_cast<std::size_t>(e.rows[i])] = f;
    if (!dataset.recording.f.empty()) sum += (dataset.recording.f[e.rows[i]] - f).squaredNorm();
  }
  return sum;
}

}  // namespace

AcfmFit fit_acfm(const Dataset& dataset, const std::vector<Vec3>& normals,
                 const AcfmFitOptions& options) {
  const Fitter fitter(dataset, normals, options);
  const std::size_t count = dataset.positions.size();
  std::vector<Episodes> at(count);
  for (const Episode& e : dataset.episodes) at[static_cast<std::size_t>(e.position)].push_back(&e);
  AcfmFit fit;
  fit.model.terms = options.terms;
  fit.model.positions.resize(count);
  std::vector<double> held(count, 0.0), held_rows(count, 0.0);
  std::vector<std::vector<std::string>> remarks(count);
  std::vector<int> derived(count, 0);
  in_parallel(count, options.threads, [&](std::size_t p) {
    fit.model.positions[p] = fitter.fit(p, at[p], derived[p], remarks[p]);
    const std::size_t parts =
        std::min(at[p].size(), static_cast<std::size_t>(std::max(options.folds, 0)));
    for (std::size_t fold = 0; parts > 1 && fold < parts; ++fold) {
      Episodes training, rest;
      for (std::size_t i = 0; i < at[p].size(); ++i)
        (i % parts == fold ? rest : training).push_back(at[p][i]);
      int ignored = 0;
      std::vector<std::string> unsaid;
      Acfm alone;
      alone.terms = options.terms;
      alone.positions = {fitter.fit(p, training, ignored, unsaid)};
      for (const Episode* e : rest) {
        held[p] += squares(alone, dataset, *e);
        held_rows[p] += static_cast<double>(e->rows.size());
      }
    }
  });
  double sum = 0, unseen = 0, unseen_rows = 0, elsewhere = 0;
  for (const Episode& e : dataset.episodes) sum += squares(fit.model, dataset, e);
  const double components = 3 * static_cast<double>(dataset.rows());
  fit.rmse = std::sqrt(sum / components);
  for (std::size_t p = 0; p < count; ++p) {
    unseen += held[p];
    unseen_rows += held_rows[p];
    fit.derived_axes += derived[p];
    fit.remarks.insert(fit.remarks.end(), remarks[p].begin(), remarks[p].end());
    if (count < 2 || options.folds < 1) continue;
    Acfm others = fit.model;
    others.positions.erase(others.positions.begin() + static_cast<long>(p));
    for (const Episode* e : at[p]) elsewhere += squares(others, dataset, *e);
  }
  if (unseen_rows > 0) fit.held_out_presses = std::sqrt(unseen / (3 * unseen_rows));
  if (count > 1 && options.folds > 0) fit.held_out_positions = std::sqrt(elsewhere / components);
  return fit;
}

std::vector<Vec3> acfm_forces(const Acfm& model, const Dataset& dataset) {
  std::vector<Vec3> forces(dataset.rows(), Vec3::Zero());
  for (const Episode& e : dataset.episodes) squares(model, dataset, e, &forces);
  return forces;
}

}  // namespace hapsim
