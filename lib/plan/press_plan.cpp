#include "plan/press_plan.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "base/error.h"
#include "effects/catalogue.h"
#include "experiment/labels.h"
#include "experiment/weights.h"
#include "io/number.h"
#include "plan/press_depths.h"
#include "plan/press_paths.h"
#include "plan/unpressed_places.h"

namespace hapsim {
namespace {

constexpr std::size_t kMorePlaces = 6;  // each is meshed and solved anew

struct Candidates {
  Dataset dataset;
  std::vector<std::string> names;             // one an episode
  std::shared_ptr<const SetupPlaces> places;  // the recording's, or more
};

// Whether the model says something of places that were not pressed that no other model says.
bool depends_on_place(const Model& model) {
  for (const std::string& name : model.effects()) {
    const EffectCard& card = require_effect(name).card();
    if (card.needs_positions || card.solved) return true;
  }
  return false;
}

// The recording's positions, and some between and around them where the models say different things
// of other places. None that cannot be pressed.
std::shared_ptr<const SetupPlaces> places_for(const std::vector<Model>& models, const Experiment& e,
                                              const PlanAsked& asked) {
  const std::shared_ptr<const SetupPlaces>& pressed = e.places.setup(0);
  if (!asked.places.empty()) {
    std::vector<Vec3> places;
    if (asked.pressed_places) places = pressed->positions();
    places.insert(places.end(), asked.places.begin(), asked.places.end());
    return pressed->with_positions(places);
  }
  if (std::none_of(models.begin(), models.end(), depends_on_place)) return pressed;
  std::vector<Vec3> places = pressed->positions();
  for (const Vec3& p : unpressed_places(pressed->surface(), pressed->contacts(),
                                        e.dataset.recording.disc_radius(), kMorePlaces)) {
    try {
      pressed->with_positions({p});
      places.push_back(p);
    } catch (const Error&) {  // an edge, a gap: nothing to press on
    }
  }
  return pressed->with_positions(places);
}

std::vector<ToolStand> stands_of(const SetupPlaces& places) {
  std::vector<ToolStand> stands;
  for (std::size_t p = 0; p < places.contacts().size(); ++p) stands.push_back(places.stand(p));
  return stands;
}

// Of a full press at each place: as asked, or as any so far went into the surface, which the
// deepest of the paths goes beyond.
std::vector<double> depths_at(const SetupPlaces& places, const std::vector<ToolStand>& stands,
                              const PlanAsked& asked, const Recording& so_far) {
  const SignedDistance surface(places.surface());
  const PressDepths known(surface, so_far, kDeepestPath * deepest_so_far(surface, so_far));
  std::vector<double> depths;
  for (std::size_t p = 0; p < stands.size(); ++p) {
    const Vec3& at = places.positions()[p];
    depths.push_back(asked.depth_at ? asked.depth_at(at, stands[p].normal)
                                    : known.full_at(at, stands[p].normal));
  }
  return depths;
}

// Every path at every position, each as if it came right after the recording.
Candidates make_candidates(const std::vector<Model>& models, const Experiment& e,
                           const PlanAsked& asked) {
  const Dataset& known = e.dataset;
  const DataSummary summary = summarise(known, 1);
  const double step = summary.sample_step > 0 ? summary.sample_step : 0.02;
  Candidates candidates;
  candidates.places = places_for(models, e, asked);
  const std::vector<Vec3>& positions = candidates.places->positions();
  const std::vector<ToolStand> stands = stands_of(*candidates.places);
  const std::vector<double> depths = depths_at(*candidates.places, stands, asked, known.recording);
  Recording r;
  r.name = "plan";
  r.metadata = known.recording.metadata;
  int presses = 0;
  for (std::size_t p = 0; p < positions.size(); ++p)
    for (const PressPath& path : press_paths(depths[p])) {
      append_press(r, presses++, 0, step, positions[p], stands[p].normal, path);
      candidates.names.push_back(path.name);
    }
  if (!known.recording.temp.empty())
    r.temp.assign(r.rows(),
                  std::accumulate(known.recording.temp.begin(), known.recording.temp.end(), 0.0) /
                      static_cast<double>(known.recording.temp.size()));
  candidates.dataset = on_body(make_dataset(std::move(r)), stands);
  candidates.dataset.label = labels_at(candidates.places->labels(), candidates.dataset.positions);
  std::vector<double> past(positions.size(), 0);
  const bool pressed_first = asked.places.empty() || asked.pressed_places;
  for (const Episode& press : known.episodes)
    for (std::size_t i = 0; i < press.view.size() && pressed_first; ++i)
      if (!press.view.in_air[i])
        past[press.position] = std::max(past[press.position], press.view.u[i].norm());
  for (Episode& press : candidates.dataset.episodes) {
    press.view.past_depth = past[press.position];
    for (std::size_t i = 0; i < press.view.session.size(); ++i)
      press.view.session[i] = summary.session + kPauseBetweenPresses + press.view.t[i];
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
                [](const Parameter& p) { return require_effect(p.effect).card().per_press; });
  return model;
}

// Information on the model's parameters in the recording, with a trace of what their bounds say.
Eigen::MatrixXd known_information(const Model& model, const Experiment& e) {
  constexpr double kVague = 100;  // scales: what the data leave open stays finite, no more
  const Selection all = all_episodes(e.dataset);
  Signal signal = solved_forces(model, e, all, true);
  Weights(e.dataset, all, signal.f, e.noise.value, e.floor).whiten(signal.df);
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

// The free parameter that a plan determines: the least certain of those that are asked for, of all
// where none is.
Eigen::Index asked_for(const Model& model, const Eigen::VectorXd& uncertain,
                       const PlanAsked& asked) {
  const std::vector<int> free = model.free_parameters();
  Eigen::Index worst = -1, of_all = 0;
  uncertain.maxCoeff(&of_all);
  for (std::size_t c = 0; c < free.size(); ++c) {
    const Parameter& p = model.parameters[static_cast<std::size_t>(free[c])];
    const auto k = static_cast<Eigen::Index>(c);
    if (p.effect + " " + p.name != asked.parameter) continue;
    if (asked.region >= 0 && p.region != asked.region) continue;
    if (worst < 0 || uncertain[k] > uncertain[worst]) worst = k;
  }
  return worst < 0 ? of_all : worst;
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

MeasurementPlan plan_presses(const std::vector<Model>& models, const Experiment& e,
                             std::size_t count, const PlanAsked& asked) {
  std::vector<Model> plain;
  std::vector<Eigen::MatrixXd> known;
  for (const Model& m : models) {
    plain.push_back(without_press_offsets(m));
    known.push_back(known_information(plain.back(), e));
  }
  const Candidates candidates = make_candidates(plain, e, asked);
  const SetupPlaces& places = *candidates.places;
  std::vector<SetupLinearisation> about;
  for (const Model& m : plain)
    about.push_back(SetupLinearisation::solve(candidates.places, material_of(m)));
  const std::size_t presses = candidates.dataset.episodes.size();
  // By press and ordered pair of models (a model with itself when it is alone).
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < plain.size(); ++a)
    for (std::size_t b = 0; b < plain.size(); ++b)
      if (a != b || plain.size() == 1) pairs.emplace_back(a, b);
  std::vector<std::vector<Evidence>> evidence(presses);
  for (std::size_t k = 0; k < presses; ++k) {
    const Selection one{static_cast<int>(k)};
    std::vector<Signal> signals;
    for (std::size_t m = 0; m < plain.size(); ++m) {
      const MaterialSpec material = material_of(plain[m]);
      const auto stiffness_at = [&](std::size_t p) { return about[m].at(p, material); };
      signals.push_back(
          model_forces(plain[m], candidates.dataset, stiffness_at, one, true, places.threads()));
    }
    for (const auto& [a, b] : pairs) {
      const Weights weights(candidates.dataset, one, signals[b].f, e.noise.value, e.floor);
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
    const Eigen::VectorXd uncertain = spread(known[0]);
    const Eigen::Index worst = asked_for(plain[0], uncertain, asked);
    const double before = uncertain[worst];
    const Parameter& p = plain[0].parameters[free[static_cast<std::size_t>(worst)]];
    plan.parameter = p.effect + " " + p.name;
    plan.region = p.region;
    const auto gain = [&](const std::vector<std::size_t>& set) {
      return -spread(known[0] + together(set, 0).information)[worst];
    };
    chosen = choose(presses, count, gain);
    plan.separation = chosen.empty() ? 1 : -gain(chosen) / before;
  }

  Recording& motion = plan.motion;
  motion.metadata.set("tool_radius", format_number(e.dataset.recording.tool_radius()));
  const DataSummary summary = summarise(e.dataset, 1);
  const double step = summary.sample_step > 0 ? summary.sample_step : 0.02;
  const std::vector<ToolStand> stands = stands_of(places);
  const std::vector<double> depths = depths_at(places, stands, asked, e.dataset.recording);
  double start = 0;
  for (const std::size_t k : chosen) {
    const auto position = static_cast<std::size_t>(candidates.dataset.episodes[k].position);
    const int number = static_cast<int>(plan.presses.size()) + 1;
    const std::vector<PressPath> paths = press_paths(depths[position]);
    append_press(motion, number, start, step, places.positions()[position], stands[position].normal,
                 paths[k % paths.size()]);
    start = motion.t.back() + kPauseBetweenPresses;
    double alone = std::numeric_limits<double>::infinity();
    if (plain.size() > 1)
      for (std::size_t q = 0; q < pairs.size(); ++q)
        alone = std::min(alone, separation(evidence[k][q], known[pairs[q].second]));
    plan.presses.push_back({candidates.names[k], places.positions()[position],
                            plain.size() > 1 ? std::sqrt(std::max(0.0, alone)) : 0});
  }
  return plan;
}

std::vector<std::string> plan_lines(const MeasurementPlan& plan, const std::string& file) {
  std::vector<std::string> lines;
  const auto line = [&](const std::string& text) { lines.push_back(text); };
  if (plan.parameter.empty())
    line(fmt::format("to tell them apart, record {} ({:.3g} standard deviations of the noise):",
                     file, plan.separation));
  else
    line(fmt::format("to know {} better, record {} (its standard error falls to {:.0f} %):",
                     plan.parameter, file, 100 * plan.separation));
  for (const PlannedPress& p : plan.presses)
    line(fmt::format("  at ({:.1f}, {:.1f}, {:.1f}) mm: {}{}", 1e3 * p.position.x(),
                     1e3 * p.position.y(), 1e3 * p.position.z(), p.motion,
                     p.separation > 0 ? fmt::format(" ({:.3g} alone)", p.separation) : ""));
  return lines;
}

}  // namespace hapsim
