#include "diagnose/left_over.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "compare/structure.h"
#include "diagnose/foreseen.h"
#include "diagnose/gates.h"
#include "diagnose/left_line.h"
#include "diagnose/measure.h"
#include "diagnose/press_lines.h"
#include "estimate/probability.h"

namespace hapsim {
namespace {

using Gains = Eigen::Matrix<double, 6, 1>;

// A model's residual [N] with what the allowance is of.
struct Ground {
  const TrialGround& g;
  Eigen::VectorXd f;
  std::vector<GainBlock> blocks;
  double noise;  // of an independent sample [N]
  Weights weights;
};

Ground ground_of(const TrialGround& g, const Eigen::VectorXd& f, double noise) {
  const Selection all = all_episodes(g.dataset);
  return {g, f,
          g.allowance.floor > 0 ? gain_directions(g.dataset, all, f) : std::vector<GainBlock>{},
          noise, Weights(g.dataset, all, f, noise, g.allowance.floor)};
}

// The gains of each position over delta, and the residual without them.
struct Posterior {
  std::vector<Gains> gains;
  Eigen::VectorXd beside;
  double squares() const {
    double sum = 0;
    for (const Gains& z : gains) sum += z.squaredNorm();
    return sum;
  }
};

Posterior posterior(const Eigen::VectorXd& residual, const Ground& on) {
  Posterior p{{}, residual};
  const double sigma = on.noise;
  for (const GainBlock& block : on.blocks) {
    const auto position = static_cast<std::size_t>(block.position);
    const Eigen::MatrixXd D =
        block.deviations(on.g.dataset.floor_at(position, on.g.allowance.floor)) / sigma;
    Eigen::MatrixXd H = D.transpose() * D;
    H.diagonal().array() += 1;
    const Eigen::VectorXd z = H.ldlt().solve(D.transpose() * residual(block.rows) / sigma);
    p.beside(block.rows) -= sigma * (D * z);
    p.gains.emplace_back(z.head<6>());
  }
  return p;
}

// What gains that all positions share do to the force, a column each: the six symmetric matrices in
// the recording's axes.
Eigen::MatrixXd shared_in_axes(const Ground& on) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(on.f.size(), 6);
  const double half = std::sqrt(0.5);
  for (Eigen::Index row = 0; row < on.f.size(); row += 3) {
    const Eigen::Vector3d f = on.f.segment<3>(row);
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      columns(row + k, k) = f[k];
      columns(row + a, 3 + k) = half * f[b];
      columns(row + b, 3 + k) = half * f[a];
    }
  }
  return columns;
}

// The same along each place's normal and across it: about the normal a frame is arbitrary.
Eigen::MatrixXd shared_in_contact(const Ground& on) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(on.f.size(), 2);
  for (const GainBlock& block : on.blocks)
    for (std::size_t i = 0; i < block.rows.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      columns(block.rows[i], 0) = block.Z(at, 0);
      columns(block.rows[i], 1) = std::sqrt(0.5) * (block.Z(at, 1) + block.Z(at, 2));
    }
  return columns;
}

// Gains that all positions share, as means of the allowed ones: posterior under their own prior, of
// standard deviation delta / sqrt(positions).
struct Shared {
  double largest = 0;  // over that deviation
  double rest = 0;     // sum |c_p|^2 / delta^2 without them
};
Shared shared_gains(const Eigen::VectorXd& residual, const Eigen::MatrixXd& columns,
                    const Ground& on) {
  const double sd = on.g.allowance.floor / std::sqrt(static_cast<double>(on.blocks.size()));
  Eigen::MatrixXd C = sd * columns;
  Eigen::VectorXd r = residual;
  on.weights.whiten(C);
  on.weights.whiten(r);
  Eigen::MatrixXd H = C.transpose() * C;
  H.diagonal().array() += 1;
  const Eigen::VectorXd m = H.ldlt().solve(C.transpose() * r);
  return {m.cwiseAbs().maxCoeff(), posterior(residual - sd * (columns * m), on).squares()};
}

double chance_of_sum(double sum, double freedom) {
  return fisher_upper(sum / freedom, freedom, 1e9);
}

void judge_gains(const Posterior& p, const Eigen::VectorXd& residual, const Ground& on,
                 LeftOver& left) {
  constexpr double kMost = 0.5;
  const auto count = static_cast<double>(p.gains.size());
  const double sum = p.squares();
  double largest = 0;
  for (std::size_t k = 0; k < p.gains.size(); ++k) {
    if (p.gains[k].squaredNorm() <= largest) continue;
    largest = p.gains[k].squaredNorm();
    left.where = on.g.dataset.positions[static_cast<std::size_t>(on.blocks[k].position)];
  }
  const Shared axes = shared_gains(residual, shared_in_axes(on), on);
  const Shared contact = shared_gains(residual, shared_in_contact(on), on);
  left.strain = sum / (6 * count);
  left.common = std::max(axes.largest, contact.largest);
  left.common_share = 1 - std::min(axes.rest, contact.rest) / std::max(sum, 1e-300);
  const double by_all = chance_of_sum(sum, 6 * count);
  const double by_mean = std::min(1.0, 8 * student_two_sided(left.common, 1e9));
  const double by_one = std::min(1.0, count * chance_of_sum(largest, 6));
  left.strained = 3 * std::min({by_all, by_mean, by_one}) < kStrained;
  if (!left.strained) return;
  const bool several = count > 2;
  const bool at_one = several && by_one < by_all && largest > kMost * sum;
  left.kind = at_one ? "place" : several && left.common_share > kMost ? kSetUp : kBody;
}

// What is beyond noise and mesh in the whitened residual and goes together from one sample to the
// next, or is foretold by those before in any other way: more than a fifth of the noise's square
// (half, where the noise was measured from differences, which are too small where noise has a
// colour).
bool is_structured(Eigen::VectorXd residual, const Ground& on) {
  const TrialGround& g = on.g;
  const double most = g.experiment.noise.measured ? 0.5 : 0.2;
  on.weights.whiten(residual);
  double product = 0;
  Eigen::Index at = 0;
  std::vector<Eigen::Index> lengths;
  for (const Episode& e : g.dataset.episodes) {
    lengths.push_back(static_cast<Eigen::Index>(e.rows.size()));
    for (std::size_t i = 0; i < e.rows.size(); ++i, ++at)
      if (i > 0) product += residual.segment<3>(3 * at).dot(residual.segment<3>(3 * at - 3));
  }
  const auto count = static_cast<double>(residual.size());
  return std::min(std::max(product, foreseen_squares(residual, lengths)),
                  residual.squaredNorm() - count) > most * count;
}

// What hs-compare finds first in the same forces.
Observation first_observation(const Eigen::VectorXd& f, const Eigen::VectorXd& beside,
                              const TrialGround& g) {
  const std::vector<int> rows = stacked_rows(g.dataset, all_episodes(g.dataset));
  const Recording& recording = g.dataset.recording;
  std::vector<Vec3> measured(recording.f), simulated(recording.f);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto at = 3 * static_cast<Eigen::Index>(i);
    simulated[static_cast<std::size_t>(rows[i])] = f.segment<3>(at);
    measured[static_cast<std::size_t>(rows[i])] = f.segment<3>(at) + beside.segment<3>(at);
  }
  const auto found =
      find_structure(row_facts(recording), measured, simulated, g.allowance.noise, 1);
  return found.empty() ? Observation{} : found.front();
}

// What it is, without what was seen beside it.
std::string kind_in_words(const LeftOver& left) {
  const std::string much = fmt::format("{:.2g} x the noise is left", left.error);
  const std::string strain =
      left.strained
          ? fmt::format(" ({:.2g} times the squares that mesh and shape are allowed)", left.strain)
          : "";
  const auto may_be = [&](const char* kind) {
    return std::any_of(left.kinds.begin(), left.kinds.end(),
                       [&](const LeftKind& each) { return each.kind == kind && each.alike; });
  };
  if (left.events.found)
    return fmt::format(
        "{}, in single samples at one part of the presses ({} of {} presses err by more than {:g} "
        "times the noise at {:.0f} to {:.0f} % of their samples): look at what happens there, a "
        "change of speed or direction, a switch.",
        much, left.events.presses, left.events.of, LockedEvents::kFarOff, 100 * left.events.from,
        100 * left.events.until);
  if (left.kind == kSetUp)
    return fmt::format(
        "{}, and it is the same gain at all positions{}: look at what they share, the sensor, the "
        "robot and the tool, before the body",
        much,
        left.strained ? fmt::format(" ({:.2g} standard deviations of what mesh and shape may do)",
                                    left.common)
                      : "");
  if (left.kind == "place")
    return fmt::format(
        "{}; the position ({:.1f}, {:.1f}, {:.1f}) mm has a stiffness of its own that no other "
        "position confirms: press around it, a few millimetres apart",
        much, 1e3 * left.where.x(), 1e3 * left.where.y(), 1e3 * left.where.z());
  if (left.kind == kDirection)
    return fmt::format(
        "{}, and it goes with the direction and the size of the force, alike at all positions: "
        "look at what gives way or holds in some directions only (friction, a support that "
        "slides), and at the axes of the sensor and of the motion, before the body",
        much);
  if (left.kind == kPress)
    return fmt::format(
        "{}, and it is a gain that changes from press to press, at one place too: look at what "
        "changes between presses, the grip, the temperature, the body itself{}",
        much,
        may_be(kPlaceAndWay) ? "; or it differs by place and way of pressing together, which "
                               "presses of one place the same way would tell (they are too few "
                               "here, or have little of it): press one place twice as it errs most"
                             : "");
  if (left.kind == kPlaceAndWay)
    return fmt::format(
        "{}, and it goes with the load, comes back where a place is pressed the same way again and "
        "differs from place to place and from way to way: look at what holds or gives way at some "
        "places in some directions (fibres, walls, edges, the tool's own shape), and press more "
        "ways at one place",
        much);
  if (left.kind == kWander)
    return fmt::format(
        "{}, and it moves slowly in each press, in each in its own way: look at what breathes, "
        "swings or settles by itself meanwhile, and record that, or hold still for longer",
        much);
  if (left.kind == kZeroOfPress)
    return fmt::format(
        "{}, and it is a zero that changes from press to press: look at what the sensor does "
        "between presses, its taring, its cable, its temperature",
        much);
  if (left.kind == kBody)
    return fmt::format(
        "{}, and it is a stiffness that differs by place{}: look at the body, its shape and its "
        "support",
        much, strain);
  return much + " with structure";
}

std::string words_of(const LeftOver& left) {
  std::string words = kind_in_words(left) + left.observed;
  if (words.back() != '.') words += '.';
  const std::string kinds = words_of(left.kinds);
  return kinds.empty() ? words : words + " " + kinds;
}

// Whether a stiffness of each place, and gains of all, had presses left out to be judged by.
bool could_be_tried(const Dataset& dataset) {
  return dataset.episodes.size() >=
         std::max<std::size_t>(kLeastPresses, 2 * dataset.positions.size());
}

}  // namespace

LeftOver left_over(const Fit& fitted, const TrialGround& g) {
  const Selection all = all_episodes(g.dataset);
  const Eigen::VectorXd f = model_forces(fitted, g.experiment, all, false).f;
  const Eigen::VectorXd residual = measured_forces(g.dataset, all) - f;
  const Ground on = ground_of(g, f, g.allowance.noise);
  const Posterior p = posterior(residual, on);
  LeftOver left;
  left.error = force_error(g.dataset, residual).told() / g.allowance.noise;
  left.beside_gains = force_error(g.dataset, p.beside).told() / g.allowance.noise;
  // What is no larger than the noise has its colour: so many samples are as one of them.
  const double alike = left.beside_gains < kLikeNoise ? autocorrelation_time(p.beside, g) : 1;
  if (g.allowance.floor > 0 && alike < kLikeWhite) {
    judge_gains(p, residual, on, left);
  } else if (g.allowance.floor > 0) {
    const Ground coloured = ground_of(g, f, std::sqrt(alike) * g.allowance.noise);
    judge_gains(posterior(residual, coloured), residual, coloured, left);
  }
  left.structured = is_structured(residual, on);
  if (left.noise_alone()) left.events = find_locked_events(g.dataset, p.beside, g.allowance.noise);
  if (left.noise_alone()) return left;
  if (left.events.found) {
    left.kind = kEvent;
    left.words = words_of(left);
    return left;
  }
  // The gains are the story where they take most of it away.
  const double all_of_it = left.error * left.error - 1;
  const bool by_gains =
      left.strained &&
      left.error * left.error - left.beside_gains * left.beside_gains > 0.5 * all_of_it;
  if (!by_gains) left.kind = "left";
  if (left.structured && left.beside_gains > kLikeNoise) {
    const Observation seen = first_observation(f, by_gains ? p.beside : residual, g);
    if (!by_gains && !seen.kind.empty()) left.kind = seen.kind;
    if (!seen.sentence.empty()) left.observed = ". " + seen.sentence;
    const LineLeft line =
        by_gains || left.kind != "left" ? LineLeft{} : find_line_left(residual, g.dataset);
    if (line.frequency > 0) {
      left.kind = kFrequency;
      const std::string when =
          line.always ? "" : fmt::format(", from {:.0f} to {:.0f} s", line.from, line.until);
      left.observed += fmt::format(
          "{} Most of it is at {:.3g} Hz{}: look at what turns, breathes or hums at that rate, or "
          "so far from a multiple of the recording's own",
          left.observed.empty() ? "." : "", line.frequency, when);
    }
  }
  left.words = words_of(left);
  return left;
}

namespace {

// "frequency" of a swing that is no line, where laws say little.
void tell_swing(const Eigen::VectorXd& residual, const TrialGround& g, LeftOver& left) {
  const double noise = g.allowance.noise;
  const bool other = left.kind == kEvent || left.kind == kFrequency || left.kind == "place";
  if (other || (!left.kinds.empty() && left.kinds.front().share >= kMostOfIt)) return;
  const double swing = left.kind == "left" ? swing_left(residual, g.dataset, noise) : 0;
  const PressLines lines = swing > 0 ? PressLines{} : find_press_lines(residual, g.dataset, noise);
  if (swing == 0 && lines.share < kMostOfIt) return;
  left.kind = kFrequency;
  left.observed += left.observed.empty() ? "." : "";
  left.observed +=
      swing > 0
          ? fmt::format(
                " It swings about {:.2g} Hz, not steadily: look at what turns or hums only at "
                "times, or at a speed that changes",
                swing)
          : fmt::format(
                " It swings in each press at a rate of its own, {:.2g} to {:.2g} Hz: look at "
                "what beats, breathes or turns now faster, now slower, and record that",
                lines.slowest, lines.fastest);
}

}  // namespace

void tell_kinds(const Fit& fitted, const TrialGround& g, LeftOver& left) {
  if (left.noise_alone()) return;
  const Selection all = all_episodes(g.dataset);
  const Eigen::VectorXd f = model_forces(fitted, g.experiment, all, false).f;
  const Eigen::VectorXd residual = measured_forces(g.dataset, all) - f;
  left.kinds = kinds_of(residual, f, g);
  const auto is = [&](std::initializer_list<const char*> kinds) {
    return std::find(kinds.begin(), kinds.end(), left.kind) != kinds.end();
  };
  if (!is({kEvent, kFrequency, "place"})) {
    if (!left.kinds.empty())
      left.kind = left.kinds.front().kind;
    else if (could_be_tried(g.dataset) || !is({kBody, kSetUp}))
      left.kind = "left";
  }
  tell_swing(residual, g, left);
  left.words = words_of(left);
}

}  // namespace hapsim
