#include "acfm/acfm_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "acfm/acfm_axis_fit.h"
#include "acfm/acfm_loop.h"
#include "base/error.h"
#include "base/median.h"
#include "base/parallel.h"
#include "realtime/stiffness_field.h"

namespace hapsim {
namespace {

// An axis that moves by less than this share of the whole motion tells nothing of its stiffness.
constexpr double kLeastMotion = 1e-3;

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
  span.step = upper_median(std::move(steps));
  return span;
}

class Fitter {
 public:
  Fitter(const Dataset& dataset, const std::vector<Vec3>& normals, const AcfmFitOptions& options)
      : dataset_(dataset), normals_(normals), options_(options), windows_(options.windows) {
    const Span span = span_of(dataset);
    if (options.terms > 0 && !(span.longest > 0))
      fail_input(dataset.recording.name, "relaxation needs times, and the recording has none",
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

std::vector<Vec3> contact_normals(const Dataset& dataset, const SignedDistance& surface) {
  std::vector<Vec3> normals;
  for (const Vec3& p : dataset.positions) {
    const SurfaceSide side = surface.at(p);
    if (std::abs(side.distance) > 3 * dataset.setups.front().tool_radius)
      fail_input(dataset.recording.name,
                 fmt::format("the contact at ({:.6g}, {:.6g}, {:.6g}) lies {:.3g} m off the "
                             "surface, more than 3 tool radii",
                             p.x(), p.y(), p.z(), std::abs(side.distance)),
                 "check the unit and that the body and the recording share one frame");
    normals.push_back(side.normal);
  }
  return normals;
}

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
