#include "fit/first_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace hapsim {
namespace {

constexpr std::size_t kLeastUnseen = 10;  // rows
constexpr double kHeld = 0.95;            // of the largest depth

// Rows [0, begin) of a press foretell [begin, end).
struct Cut {
  std::size_t begin = 0, end = 0;
};

// Where the way in begins, the hold, the way out, and where that ends.
std::array<std::size_t, 4> parts_of(const Episode& e) {
  const std::size_t n = e.rows.size();
  std::vector<double> depth(n);
  for (std::size_t i = 0; i < n; ++i)
    depth[i] = e.view.in_air[i] ? 0 : -e.view.u[i].dot(e.view.normal);
  const double most = n > 0 ? *std::max_element(depth.begin(), depth.end()) : 0;
  if (most <= 0) return {n, n, n, n};
  const auto first = [&](std::size_t from, auto&& condition) {
    while (from < n && !condition(depth[from])) ++from;
    return from;
  };
  const std::size_t in = first(0, [&](double d) { return d > (1 - kHeld) * most; });
  const std::size_t hold = first(in, [&](double d) { return d >= kHeld * most; });
  const std::size_t out = first(hold, [&](double d) { return d < kHeld * most; });
  return {in, hold, out, n};
}

// Of [from, to) from the share (2/3)^steps on, each stretch half as long as what came before it.
void add_cuts(std::vector<Cut>& cuts, std::size_t from, std::size_t to, int steps) {
  const auto at = [&](int step) {
    return from + static_cast<std::size_t>(static_cast<double>(to - from) *
                                           std::pow(2.0 / 3, steps - step));
  };
  for (int step = 0; step < steps; ++step) cuts.push_back({at(step), at(step + 1)});
}

// As many of every press.
std::vector<Cut> cuts_of(const Episode& e) {
  const auto [in, hold, out, end] = parts_of(e);
  std::vector<Cut> cuts;
  add_cuts(cuts, in, hold, 2);
  add_cuts(cuts, hold, out, 4);
  add_cuts(cuts, out, end, 2);
  return cuts;
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

std::vector<UnseenPart> rests_of_presses(const Experiment& experiment) {
  std::vector<UnseenPart> result;
  std::vector<std::vector<Cut>> cuts;
  for (const Episode& e : experiment.dataset.episodes) cuts.push_back(cuts_of(e));
  const std::size_t count = cuts.empty() ? 0 : cuts.front().size();
  for (std::size_t which = 0; which < count; ++which) {
    UnseenPart part{experiment, all_episodes(experiment.dataset), {}, {}};
    Eigen::Index at = 0;
    for (std::size_t k = 0; k < experiment.dataset.episodes.size(); ++k) {
      const Episode& e = experiment.dataset.episodes[k];
      const Cut cut = cuts[k][which];
      if (cut.begin > 0 && cut.begin + kLeastUnseen <= cut.end) {
        part.known.dataset.episodes[k] = beginning(e, cut.begin);
        for (std::size_t i = cut.begin; i < cut.end; ++i)
          part.rows.push_back(at + static_cast<Eigen::Index>(i));
        part.lengths.push_back(static_cast<Eigen::Index>(cut.end - cut.begin));
      }
      at += static_cast<Eigen::Index>(e.rows.size());
    }
    if (!part.rows.empty()) result.push_back(std::move(part));
  }
  return result;
}

std::vector<UnseenPart> presses_left_out(const Experiment& experiment, int folds) {
  std::vector<UnseenPart> result;
  const Dataset& dataset = experiment.dataset;
  for (const Selection& out : make_folds(dataset, folds).held_out) {
    UnseenPart part{experiment, {}, {}, {}};
    Eigen::Index at = 0;
    for (const int e : all_episodes(dataset)) {
      const auto rows = static_cast<Eigen::Index>(dataset.episodes[e].rows.size());
      if (std::find(out.begin(), out.end(), e) == out.end()) {
        part.seen.push_back(e);
      } else {
        for (Eigen::Index i = 0; i < rows; ++i) part.rows.push_back(at + i);
        part.lengths.push_back(rows);
      }
      at += rows;
    }
    result.push_back(std::move(part));
  }
  return result;
}

}  // namespace hapsim
