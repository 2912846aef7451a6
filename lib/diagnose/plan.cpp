#include "diagnose/plan.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "effects/catalogue.h"
#include "io/number.h"
#include "model/weights.h"

namespace hapsim {
namespace {

constexpr double kAir = 0.2;                          // [s] before and after a press
constexpr double kPause = 5;                          // [s] between presses
constexpr double kLift = 5e-4;                        // [m] of the tool over the body, in the air
constexpr double kSlow = 3, kFast = 0.15, kHold = 5;  // [s]
constexpr int kLeastSteps = 15;                       // of a movement, however slow the recording

// A path of the tool: displacements in the frame of the contact (two tangents, depth), reached one
// after the other.
struct Leg {
  Vec3 to;  // tangent 1, tangent 2, depth [m]
  double seconds;
};
struct Path {
  std::string name;
  std::vector<Leg> legs;
};

std::vector<Path> paths(double deepest) {
  std::vector<Path> result;
  const auto down = [](double depth) { return Vec3(0, 0, depth); };
  for (const double share : {0.3, 1.0, 1.5}) {
    const double d = share * deepest;
    const std::string depth = fmt::format("{:.2g} mm deep", 1e3 * d);
    result.push_back({"slowly " + depth, {{down(d), kSlow}, {down(0), kSlow}}});
    result.push_back({"fast " + depth, {{down(d), kFast}, {down(0), kFast}}});
    result.push_back(
        {"fast " + depth + ", held", {{down(d), kFast}, {down(d), kHold}, {down(0), kFast}}});
  }
  const double side = 0.5 * deepest;
  const auto sideways = [&](const std::string& name, double x, double y) {
    result.push_back(
        {fmt::format("{:.2g} mm deep, then {:.2g} mm sideways {}", 1e3 * deepest, 1e3 * side, name),
         {{down(deepest), 1},
          {Vec3(side * x, side * y, deepest), 1},
          {Vec3(-side * x, -side * y, deepest), 2},
          {down(deepest), 1},
          {down(0), 1}}});
  };
  sideways("along x and back", 1, 0);
  sideways("along y and back", 0, 1);
  sideways("diagonally and back", std::sqrt(0.5), std::sqrt(0.5));
  return result;
}

struct Candidates {
  Dataset dataset;
  std::vector<std::string> names;  // one an episode
};

void append_row(Recording& r, int press, double t, const Vec3& position, const Vec3& u, bool air) {
  r.line.push_back(0);
  r.press.push_back(press);
  r.t.push_back(t);
  r.position.push_back(position);
  r.u.push_back(u);
  r.contact.push_back(air ? 0 : 1);
}

// One press along a path, from `start` [s] on.
void append_press(Recording& r, int press, double start, double step, const Vec3& position,
                  const Vec3& normal, const Path& path) {
  Vec3 x_tangent = Vec3::UnitX() - normal.x() * normal;
  if (x_tangent.norm() < 0.1) x_tangent = Vec3::UnitY() - normal.y() * normal;
  x_tangent.normalize();
  const Vec3 y_tangent = normal.cross(x_tangent);
  const auto world = [&](const Vec3& local) {
    return Vec3(local.x() * x_tangent + local.y() * y_tangent - local.z() * normal);
  };
  double t = start;
  const auto air = [&] {
    for (const double end = t + kAir; t < end - step / 2; t += step)
      append_row(r, press, t, position, kLift * normal, true);
  };
  air();
  Vec3 at = Vec3::Zero();
  for (const Leg& leg : path.legs) {
    const int steps = std::max(kLeastSteps, static_cast<int>(std::lround(leg.seconds / step)));
    for (int i = 0; i < steps; ++i, t += leg.seconds / steps)
      append_row(r, press, t, position, world(at + (leg.to - at) * i / steps), false);
    at = leg.to;
  }
  air();
}

// Every path at every position, each as if it came right after the recording.
Candidates make_candidates(const Workspace& w) {
  const Dataset& known = w.dataset;
  const DataSummary summary = summarise(known, 1);
  const double step = summary.sample_step > 0 ? summary.sample_step : 0.02;
  Candidates candidates;
  Recording r;
  r.name = "plan";
  r.metadata = known.recording.metadata;
  int press = 0;
  const std::vector<Vec3> normals = w.body->normals();
  for (std::size_t p = 0; p < known.positions.size(); ++p)
    for (const Path& path : paths(summary.depth)) {
      append_press(r, press++, 0, step, known.positions[p], normals[p], path);
      candidates.names.push_back(path.name);
    }
  if (!known.recording.temp.empty())
    r.temp.assign(r.rows(),
                  std::accumulate(known.recording.temp.begin(), known.recording.temp.end(), 0.0) /
                      static_cast<double>(known.recording.temp.size()));
  candidates.dataset = make_dataset(std::move(r));
  set_normals(candidates.dataset, normals);
  std::vector<double> past(known.positions.size(), 0);
  for (const Episode& e : known.episodes)
    for (std::size_t i = 0; i < e.view.size(); ++i)
      if (!e.view.in_air[i]) past[e.position] = std::max(past[e.position], e.view.u[i].norm());
  for (Episode& e : candidates.dataset.episodes) {
    e.view.past_depth = past[e.position];
    for (std::size_t i = 0; i < e.view.session.size(); ++i)
      e.view.session[i] = summary.session + kPause + e.view.t[i];
  }
  return candidates;
}

// What a set of presses says, added up over them: of the difference to another model, of this one's
// parameters, and of both.
struct Evidence {
  double difference = 0;
  Eigen::VectorXd both;
  Eigen::MatrixXd information;
  void add(const Evidence& e) {
    difference += e.difference;
    both += e.both;
    information += e.information;
  }
};

// Offsets of single presses say nothing of the next ones.
Model without_press_offsets(Model model) {
  std::erase_if(model.parameters,
                [](const Parameter& p) { return require_effect(p.effect).card().by_press; });
  return model;
}

// Information on the model's parameters in the recording, with a trace of what their bounds say.
Eigen::MatrixXd known_information(const Model& model, const Workspace& w) {
  constexpr double kVague = 100;
  const Selection all = all_episodes(w.dataset);
  Signal signal = model_forces(model, w.dataset, all, *w.body, true);
  Weights(w.dataset, all, signal.f, w.noise.value, w.floor).whiten(signal.df);
  Eigen::MatrixXd H = signal.df.transpose() * signal.df;
  const std::vector<int> free = model.free_parameters();
  for (std::size_t c = 0; c < free.size(); ++c) {
    const Parameter& p = model.parameters[free[c]];
    const double scale =
        std::max(std::abs(p.value), parameter_card(require_effect(p.effect), p.name)->scale);
    const auto k = static_cast<Eigen::Index>(c);
    H(k, k) += 1 / (kVague * kVague * scale * scale);
  }
  return H;
}

// Chi-square by which the other model stays away, this one's parameters refitted.
double separation(const Evidence& e, const Eigen::MatrixXd& known) {
  return e.difference - e.both.dot((known + e.information).ldlt().solve(e.both));
}

// Greedy choice: `gain` of a set of candidates together, larger is better.
template <typename Gain>
std::vector<std::size_t> choose(std::size_t candidates, std::size_t count, const Gain& gain) {
  std::vector<std::size_t> chosen;
  while (chosen.size() < std::min(count, candidates)) {
    std::size_t best = candidates;
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < candidates; ++k) {
      if (std::find(chosen.begin(), chosen.end(), k) != chosen.end()) continue;
      std::vector<std::size_t> with = chosen;
      with.push_back(k);
      const double value = gain(with);
      if (value > most) {
        most = value;
        best = k;
      }
    }
    if (best == candidates) break;
    chosen.push_back(best);
  }
  return chosen;
}

}  // namespace

MeasurementPlan plan_presses(const std::vector<Model>& models, const Workspace& w,
                             std::size_t count) {
  const Candidates candidates = make_candidates(w);
  const std::size_t presses = candidates.dataset.episodes.size();
  std::vector<Model> plain;
  std::vector<Eigen::MatrixXd> known;
  for (const Model& m : models) {
    plain.push_back(without_press_offsets(m));
    known.push_back(known_information(plain.back(), w));
  }
  // By press and ordered pair of models (a model with itself when it is alone).
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < plain.size(); ++a)
    for (std::size_t b = 0; b < plain.size(); ++b)
      if (a != b || plain.size() == 1) pairs.emplace_back(a, b);
  std::vector<std::vector<Evidence>> evidence(presses);
  for (std::size_t k = 0; k < presses; ++k) {
    const Selection one{static_cast<int>(k)};
    std::vector<Signal> signals;
    for (const Model& m : plain)
      signals.push_back(model_forces(m, candidates.dataset, one, *w.body, true));
    for (const auto& [a, b] : pairs) {
      const Weights weights(candidates.dataset, one, signals[b].f, w.noise.value, w.floor);
      Eigen::MatrixXd r = signals[a].f - signals[b].f, J = signals[b].df;
      weights.whiten(r);
      weights.whiten(J);
      evidence[k].push_back({r.squaredNorm(), J.transpose() * r.col(0), J.transpose() * J});
    }
  }
  const auto together = [&](const std::vector<std::size_t>& set, std::size_t pair) {
    Evidence sum = evidence[set.front()][pair];
    for (std::size_t i = 1; i < set.size(); ++i) sum.add(evidence[set[i]][pair]);
    return sum;
  };

  MeasurementPlan plan;
  std::vector<std::size_t> chosen;
  if (plain.size() > 1) {
    const auto least = [&](const std::vector<std::size_t>& set) {
      double value = std::numeric_limits<double>::infinity();
      for (std::size_t q = 0; q < pairs.size(); ++q)
        value = std::min(value, separation(together(set, q), known[pairs[q].second]));
      return value;
    };
    chosen = choose(presses, count, least);
    plan.separation = chosen.empty() ? 0 : std::sqrt(std::max(0.0, least(chosen)));
  } else {
    const std::vector<int> free = plain[0].free_parameters();
    if (free.empty()) return plan;
    const auto spread = [&](const Eigen::MatrixXd& H) {
      Eigen::VectorXd sd = H.ldlt()
                               .solve(Eigen::MatrixXd::Identity(H.rows(), H.cols()))
                               .diagonal()
                               .cwiseMax(0)
                               .cwiseSqrt();
      for (std::size_t c = 0; c < free.size(); ++c) {
        const Parameter& p = plain[0].parameters[free[c]];
        sd[static_cast<Eigen::Index>(c)] /=
            std::max(std::abs(p.value), parameter_card(require_effect(p.effect), p.name)->scale);
      }
      return sd;
    };
    Eigen::Index worst = 0;
    const double before = spread(known[0]).maxCoeff(&worst);
    const Parameter& p = plain[0].parameters[free[static_cast<std::size_t>(worst)]];
    plan.parameter = p.effect + " " + p.name;
    const auto gain = [&](const std::vector<std::size_t>& set) {
      return -spread(known[0] + together(set, 0).information)[worst];
    };
    chosen = choose(presses, count, gain);
    plan.separation = chosen.empty() ? 1 : -gain(chosen) / before;
  }

  Recording& motion = plan.motion;
  motion.metadata.set("tool_radius", format_number(w.dataset.recording.tool_radius()));
  const DataSummary summary = summarise(w.dataset, 1);
  const double step = summary.sample_step > 0 ? summary.sample_step : 0.02;
  const std::vector<Vec3> normals = w.body->normals();
  const std::vector<Path> all_paths = paths(summary.depth);
  double start = 0;
  for (const std::size_t k : chosen) {
    const Episode& e = candidates.dataset.episodes[k];
    const auto position = static_cast<std::size_t>(e.position);
    const int number = static_cast<int>(plan.presses.size()) + 1;
    append_press(motion, number, start, step, w.dataset.positions[position], normals[position],
                 all_paths[k % all_paths.size()]);
    start = motion.t.back() + kPause;
    double alone = std::numeric_limits<double>::infinity();
    if (plain.size() > 1)
      for (std::size_t q = 0; q < pairs.size(); ++q)
        alone = std::min(alone, separation(evidence[k][q], known[pairs[q].second]));
    plan.presses.push_back({candidates.names[k], w.dataset.positions[position],
                            plain.size() > 1 ? std::sqrt(std::max(0.0, alone)) : 0});
  }
  return plan;
}

}  // namespace hapsim
