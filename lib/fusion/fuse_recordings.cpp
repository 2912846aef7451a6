#include "fusion/fuse_recordings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/error.h"
#include "estimate/simplex_search.h"
#include "fusion/fusion_file.h"
#include "fusion/slow_rows.h"

namespace hapsim {
namespace {

// Where the data say nothing, parameters stay within a factor of about e^3 of the start.
constexpr double kPrior = 3;
// Observations that learned shares are worth: as many as half the memory for what they have been.
constexpr double kLearnedShares = 20;

class Run {
 public:
  Run(const Recording& fast, const FusionParameters& parameters)
      : fast_(fast), fusion_(parameters, std::max<std::size_t>(longest(fast) + 2, 16)) {}

  FusedForces operator()(const SlowRows& slow) {
    FusedForces out;
    for (auto* list : {&out.force, &out.deviation, &out.held, &out.extrapolated})
      list->assign(fast_.rows(), Vec3::Zero());
    for (const Press& press : fast_.presses()) {
      const std::vector<SlowRow>& rows = slow.at(press.id);
      std::size_t next = 0;
      const SlowRow *last = nullptr, *before = nullptr;  // by their own times
      const auto start = static_cast<std::size_t>(press.rows.front());
      fusion_.begin(fast_.t[start], fast_.position[start]);
      for (const int row : press.rows) {
        const auto i = static_cast<std::size_t>(row);
        const double t = fast_.t[i];
        // What arrives between two samples counts from the second.
        const Vec3 force = fusion_.step(t, fast_.u[i], fast_.f[i]);
        for (; next < rows.size() && rows[next].arrives <= t; ++next) {
          fusion_.observe(rows[next].t, rows[next].force);
          if (last != nullptr && rows[next].t <= last->t) continue;
          before = last;
          last = &rows[next];
        }
        if (fast_.in_air(i)) continue;
        out.force[i] = force;
        out.deviation[i] = fusion_.deviation();
        if (last != nullptr) out.held[i] = out.extrapolated[i] = last->force;
        if (before != nullptr)
          out.extrapolated[i] +=
              (t - last->t) / (last->t - before->t) * (last->force - before->force);
      }
    }
    out.report = fusion_.report();
    return out;
  }
  const CorrectionWorth& worth() const { return fusion_.worth(); }

 private:
  static std::size_t longest(const Recording& r) {
    std::size_t most = 0;
    for (const Press& p : r.presses()) most = std::max(most, p.rows.size());
    return most;
  }
  const Recording& fast_;
  Fusion fusion_;
};

std::vector<LessonPress> lessons_of(const Recording& fast, const SlowRows& slow) {
  std::vector<LessonPress> lessons;
  for (const Press& press : fast.presses()) {
    LessonPress lesson;
    lesson.contact = fast.position[static_cast<std::size_t>(press.rows.front())];
    for (const int row : press.rows) {
      const auto i = static_cast<std::size_t>(row);
      lesson.t.push_back(fast.t[i]);
      lesson.u.push_back(fast.u[i]);
      lesson.fast.push_back(fast.f[i]);
    }
    for (const SlowRow& row : slow.at(press.id)) {
      lesson.slow_t.push_back(row.t);
      lesson.slow.push_back(row.force);
    }
    lessons.push_back(std::move(lesson));
  }
  return lessons;
}

CorrectionShares shares_of(const Recording& fast, const std::vector<SlowRows>& paces,
                           const FusionParameters& parameters) {
  CorrectionWorth worth;
  for (const SlowRows& pace : paces) {
    Run run(fast, parameters);
    run(pace);
    worth.add(run.worth());
  }
  return worth.shares(parameters.share);
}

}  // namespace

FusedForces fuse(const Recording& fast, const SlowSource& slow,
                 const FusionParameters& parameters) {
  return Run(fast, parameters)(slow_rows(fast, slow));
}

LearnedFusion learn_fusion(const Recording& source, const SlowSource& slow,
                           const FusionParameters& start) {
  const SlowRows rows = slow_rows(source, slow);
  const std::vector<SlowRows> paces = paces_of(rows);
  std::size_t count = 0;
  for (const auto& [press, list] : rows) count += list.size();
  if (count < 20)
    fail_input(slow.recording->name, fmt::format("{} slow forces are too few to learn from", count),
               "give 20 or more, or parameters");
  LearnedFusion result;
  result.converged = true;
  result.parameters = start;
  // What is left of a press is learned with what the others teach of it.
  const Taught taught = teach(lessons_of(source, rows),
                              source.metadata.find("tool_radius") ? source.tool_radius() : 0);
  result.parameters.taught = {};
  Recording fast = source;
  std::size_t lesson = 0;
  for (const Press& press : source.presses()) {
    for (std::size_t k = 0; k < press.rows.size(); ++k)
      fast.f[static_cast<std::size_t>(press.rows[k])] += taught.by_others[lesson][k];
    ++lesson;
  }
  for (int a = 0; a < 3; ++a) {  // the components do not know of each other
    AxisFusion& axis = result.parameters.axis[static_cast<std::size_t>(a)];
    axis.force_scale = 1e-6;
    for (const Vec3& f : fast.f) axis.force_scale = std::max(axis.force_scale, std::abs(f[a]));
    // Starts are of the size of the forces.
    axis.offset_walk *= axis.force_scale;
    axis.drift_walk *= axis.force_scale;
    axis.noise *= axis.force_scale;
    axis.noise_rise *= axis.force_scale;
    const AxisFusion from = axis;
    const auto at = [&](const Eigen::VectorXd& x) {
      FusionParameters p = result.parameters;
      AxisFusion& here = p.axis[static_cast<std::size_t>(a)];
      for (std::size_t i = 0; i < kLearned; ++i)
        here.*(fusion_entries()[i].value) =
            std::clamp(std::exp(x[static_cast<Eigen::Index>(i)]), fusion_entries()[i].lower,
                       fusion_entries()[i].upper);
      here.noise = std::max(here.noise, 1e-5 * here.force_scale);  // numbers as they are written
      return p;
    };
    Eigen::VectorXd x(static_cast<Eigen::Index>(kLearned));
    for (std::size_t i = 0; i < kLearned; ++i)
      x[static_cast<Eigen::Index>(i)] = std::log(from.*(fusion_entries()[i].value));
    SimplexSearchOptions options;
    options.tolerance = 0.02;
    options.value_tolerance = 0.1;  // of twice a log likelihood
    options.most_evaluations = 2000;
    const SimplexSearchResult found = simplex_search(
        x,
        [&](const Eigen::VectorXd& y) {
          FusionParameters p = at(y);  // the filter's own: what is let in of it comes after
          p.weighs = false;
          double deviance = (y - x).squaredNorm() / (kPrior * kPrior);
          // As much by each pace as by another, though there are fewer slow forces.
          for (const SlowRows& pace : paces) {
            const FusionReport r = Run(fast, p)(pace).report;
            deviance += static_cast<double>(count) * r.deviance[a] /
                        static_cast<double>(std::max(r.observations, 1L) * paces.size());
          }
          return deviance;
        },
        options);
    result.parameters = at(found.x);
    result.converged = result.converged && found.converged;
    result.runs += found.evaluations;
  }
  result.parameters.share = shares_of(fast, paces, result.parameters);
  result.parameters.share_known = kLearnedShares;
  result.parameters.taught = taught.correction;
  return result;
}

ForceQuality force_quality(const Recording& motion, const std::vector<Vec3>& force,
                           const std::vector<Vec3>& exact) {
  ForceQuality quality;
  double squares = 0, rows = 0;
  for (const Press& press : motion.presses())
    for (std::size_t k = 0; k < press.rows.size(); ++k) {
      const auto i = static_cast<std::size_t>(press.rows[k]);
      if (motion.in_air(i)) continue;
      squares += (force[i] - exact[i]).squaredNorm();
      rows += 3;
      if (k == 0) continue;
      const auto before = static_cast<std::size_t>(press.rows[k - 1]);
      const double dt = motion.t[i] - motion.t[before];
      if (dt > 0)
        quality.largest_step =
            std::max(quality.largest_step, (force[i] - force[before]).norm() * 1e-3 / dt);
    }
  if (rows > 0) quality.rms = std::sqrt(squares / rows);
  return quality;
}

}  // namespace hapsim
