#include "fit/first_parts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.h"
#include "effects/catalogue.h"

namespace hapsim {
namespace {

constexpr std::size_t kLeastUnseen = 10;      // rows
constexpr std::size_t kUnseenStretches = 10;  // of what is unseen of one press
constexpr double kHeld = 0.95;                // of the largest depth

struct Cut {
  std::size_t learned = 0, end = 0;  // known: [0, learned); unseen: [learned, end)
};

double depth_at(const Episode& e, std::size_t i) {
  return e.view.in_air[i] ? 0 : -e.view.u[i].dot(e.view.normal);
}

// The last third of the way in, and the last three fifths of the hold.
std::array<Cut, 2> cuts_of(const Episode& e) {
  const std::size_t n = e.rows.size();
  double most = 0;
  for (std::size_t i = 0; i < n; ++i) most = std::max(most, depth_at(e, i));
  std::size_t touch = 0, deep = 0;
  while (touch < n && depth_at(e, touch) <= 0) ++touch;
  while (deep < n && depth_at(e, deep) < kHeld * most) ++deep;
  if (touch >= n || deep >= n) return {};
  std::size_t out = deep;
  while (out < n && depth_at(e, out) >= kHeld * most) ++out;
  if (out - deep < 2 * kLeastUnseen) out = n;  // nothing is held
  return {Cut{touch + 2 * (deep - touch) / 3, deep}, Cut{deep + 2 * (out - deep) / 5, out}};
}

// The first rows of an episode.
Episode beginning(const Episode& whole, std::size_t rows) {
  Episode e = whole;
  const auto cut = [rows](auto& column) {
    if (column.size() > rows) column.resize(rows);
  };
  cut(e.rows), cut(e.view.t), cut(e.view.session), cut(e.view.u);
  cut(e.view.in_air), cut(e.view.temperature);
  return e;
}

}  // namespace

std::vector<FirstParts> first_parts(const Experiment& experiment) {
  std::vector<FirstParts> result;
  for (const std::size_t which : {0, 1}) {
    FirstParts parts{experiment, {}, {}, 0};
    std::size_t at = 0;
    for (std::size_t k = 0; k < experiment.dataset.episodes.size(); ++k) {
      const Episode& e = experiment.dataset.episodes[k];
      const Cut cut = cuts_of(e)[which];
      parts.unseen.resize(at + e.rows.size(), 0);
      parts.stretch.resize(at + e.rows.size(), -1);
      const std::size_t count = cut.end - cut.learned;
      if (cut.learned > 0 && count >= kLeastUnseen) {
        parts.known.dataset.episodes[k] = beginning(e, cut.learned);
        for (std::size_t i = 0; i < count; ++i) {
          parts.unseen[at + cut.learned + i] = 1;
          parts.stretch[at + cut.learned + i] =
              parts.stretches + static_cast<int>(i * kUnseenStretches / count);
        }
        parts.stretches += static_cast<int>(kUnseenStretches);
      }
      at += e.rows.size();
    }
    if (parts.stretches > 0) result.push_back(std::move(parts));
  }
  return result;
}

ForceError Foretold::error(int axes) const {
  double square = 0, count = 0;
  for (std::size_t k = 0; k < squares.size(); ++k) square += squares[k], count += components[k];
  ForceError error;
  error.axes = axes;
  if (count > 0) error.pooled = std::sqrt(square / count);
  return error;
}

Foretold foretell(const Fit& fitted, const Experiment& experiment,
                  const std::vector<FirstParts>& parts, const FitOptions& options) {
  Foretold result;
  FitOptions about = options;
  about.rounds = 0;
  about.keep = nullptr;
  const Selection all = all_episodes(experiment.dataset);
  const Eigen::VectorXd measured = measured_forces(experiment.dataset, all);
  for (const FirstParts& part : parts) {
    const Fit learned = fit(fitted.model, part.known, all, about, fitted.about);
    const Eigen::VectorXd left = measured - model_forces(learned, experiment, all, false).f;
    std::vector<double> squares(static_cast<std::size_t>(part.stretches), 0.0), count = squares;
    for (std::size_t row = 0; row < part.stretch.size(); ++row) {
      if (part.stretch[row] < 0) continue;
      const auto s = static_cast<std::size_t>(part.stretch[row]);
      squares[s] += left.segment<3>(3 * static_cast<Eigen::Index>(row)).squaredNorm();
      count[s] += 3;
    }
    result.squares.insert(result.squares.end(), squares.begin(), squares.end());
    result.components.insert(result.components.end(), count.begin(), count.end());
  }
  return result;
}

double chance_of_no_fall(const Foretold& before, const Foretold& after, int resamples,
                         std::uint64_t seed) {
  const std::size_t n = before.squares.size();
  if (n == 0 || resamples < 1) return 1;
  Random random(seed);
  int none = 0;
  for (int k = 0; k < resamples; ++k) {
    double fall = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t s = random.integer(n);
      fall += before.squares[s] - after.squares[s];
    }
    none += fall <= 0;
  }
  return (1.0 + none) / (1.0 + resamples);
}

std::string counts_for_nothing(const Model& model, const std::string& effect) {
  const Effect& own = require_effect(effect);
  bool free = false;
  for (const Parameter& p : model.parameters) {
    if (p.effect != effect || p.state != ParameterState::kFree) continue;
    free = true;
    const ParameterCard* card = parameter_card(own, p.name);
    const double size = std::abs(p.value - card->identity);
    if (size > 0 && !(p.std_error >= size)) return "";
  }
  return free ? "its parameters are not told from none by these presses" : "";
}

}  // namespace hapsim
