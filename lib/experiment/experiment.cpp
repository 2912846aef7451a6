#include "experiment/experiment.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "effects/plates_law.h"
#include "experiment/dataset_parts.h"
#include "experiment/series_doubt.h"
#include "model/body_parameters.h"
#include "recording/torque_columns.h"

namespace hapsim {
namespace {

// Nothing is pressed in by more than the body's size: a wrong digit or unit, of which contact laws
// find no equilibrium.
void require_small_displacements(std::span<const TetMesh> bodies, const Dataset& dataset) {
  std::vector<double> size;
  for (const TetMesh& body : bodies) {
    Eigen::AlignedBox3d box;
    for (const Vec3& p : body.nodes) box.extend(p);
    size.push_back(box.diagonal().norm());
  }
  const Recording& recording = dataset.recording;
  for (const Episode& e : dataset.episodes) {
    const int setup = dataset.setup_of[static_cast<std::size_t>(e.position)];
    const double most = size[static_cast<std::size_t>(dataset.setups[setup].body)];
    for (std::size_t i = 0; i < e.rows.size(); ++i)
      if (!e.view.in_air[i] && e.view.u[i].norm() > most)
        fail_input(fmt::format("{}:{}", recording.name, recording.line[e.rows[i]]),
                   fmt::format("a displacement of {:.3g} m on a body of {:.3g} m",
                               e.view.u[i].norm(), most),
                   "correct or remove the row; all lengths are in metres");
  }
}

// The nearest place of the same body and tool at which it fits.
std::size_t nearest_fit(std::size_t p, const Places& places, const Dataset& dataset) {
  std::size_t nearest = p;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t q = 0; q < places.size(); ++q) {
    const double distance = (dataset.positions[q] - dataset.positions[p]).norm();
    if (!places.unfit(q).empty() || dataset.setup_of[q] != dataset.setup_of[p] || distance >= least)
      continue;
    least = distance;
    nearest = q;
  }
  return nearest;
}

// Leaves out the positions of which something is said.
std::vector<UnfitPlace> leave_out(const std::vector<std::string>& why, Dataset& dataset) {
  std::vector<UnfitPlace> out;
  std::vector<std::size_t> rest;
  for (std::size_t p = 0; p < why.size(); ++p)
    if (why[p].empty())
      rest.push_back(p);
    else
      out.push_back({dataset.positions[p], why[p]});
  if (!out.empty()) dataset = at_positions(dataset, rest);
  return out;
}

// Leaves out what does not fit, or borrows for it.
std::vector<UnfitPlace> settle_unfit(Places& places, Dataset& dataset, bool borrow) {
  std::vector<UnfitPlace> unfit;
  std::vector<std::size_t> fit, from;
  for (std::size_t p = 0; p < places.size(); ++p) {
    const std::string& why = places.unfit(p);
    from.push_back(why.empty() ? p : nearest_fit(p, places, dataset));
    if (why.empty()) {
      fit.push_back(p);
      continue;
    }
    unfit.push_back({dataset.positions[p], why});
    if (from.back() == p) throw Error(ExitCode::kBadInput, dataset.recording.name, why, "");
  }
  if (unfit.empty()) return unfit;
  if (!borrow) dataset = at_positions(dataset, fit);
  places = places.chosen(borrow ? from : fit);
  return unfit;
}

// Of independent doubts by position, either of which may be empty.
std::vector<double> together(std::vector<double> a, const std::vector<double>& b) {
  if (a.empty()) return b;
  for (std::size_t p = 0; p < b.size(); ++p) a[p] = std::hypot(a[p], b[p]);
  return a;
}

// Counts, and leaves out unless every row is needed, what compresses too far.
std::size_t leave_strained(Dataset& dataset, bool keep) {
  std::vector<std::size_t> samples;
  std::size_t beyond = 0;
  for (const Episode& e : dataset.episodes) {
    std::size_t count = 0;
    while (count < e.view.size() &&
           std::abs(e.view.u[count].dot(e.view.normal)) <=
               (e.view.height > 0 ? kMostPlateStrain * e.view.height
                                  : std::numeric_limits<double>::infinity()))
      ++count;
    samples.push_back(count);
    beyond += e.view.size() - count;
  }
  if (beyond > 0 && !keep) dataset = beginnings(dataset, samples);
  return beyond;
}

}  // namespace

Experiment make_experiment(const TetMesh& body, Recording recording,
                           const ExperimentOptions& options) {
  return make_experiment(std::span(&body, 1), make_dataset(std::move(recording)), options);
}

Experiment make_experiment(std::span<const TetMesh> bodies, Dataset dataset,
                           const ExperimentOptions& options) {
  require_small_displacements(bodies, dataset);
  // Forces are asked of every press that is simulated; a fit does without some.
  PressDepth depth;
  std::vector<UnfitPlace> unfit;
  if (options.borrow) {
    depth = press_depth(bodies, dataset);
  } else {
    const PositionsThrough through = positions_through(bodies, dataset);
    unfit = leave_out(through.why, dataset);
    depth = through.others;
  }
  ContactLibraryOptions library;
  library.threads = options.threads;
  library.cache = options.cache;
  library.rim_edge = options.rim_edge;
  library.draft = options.draft;
  library.memo = std::make_shared<Memo>(options.memory);
  if (options.progress) library.step = options.progress(dataset.positions.size());
  std::vector<std::shared_ptr<const ContactLibrary>> libraries;
  for (const Setup& s : dataset.setups)
    libraries.push_back(std::make_shared<ContactLibrary>(bodies[static_cast<std::size_t>(s.body)],
                                                         s.tool_radius, library));
  Places places = [&] {
    try {
      return Places(libraries, dataset, options.nu_low, options.nu_high);
    } catch (const Error& error) {  // names the contact, not the file in which it stands
      if (error.code() != ExitCode::kBadInput) throw;
      throw Error(error.code(), dataset.recording.name, error.what(), "");
    }
  }();
  for (UnfitPlace& place : settle_unfit(places, dataset, options.borrow))
    unfit.push_back(std::move(place));
  dataset.label = places.labels();
  dataset = on_body(std::move(dataset), places.stands());
  const std::size_t too_strained = leave_strained(dataset, options.borrow);
  std::vector<std::vector<Vec3>> windows;
  for (const Setup& s : dataset.setups) {
    const auto b = static_cast<std::size_t>(s.body);
    windows.push_back(b < options.windows.size() ? options.windows[b] : std::vector<Vec3>{});
  }
  dataset.curve_doubt =
      series_doubt(places, dataset, (options.nu_low + std::min(options.nu_high, 0.45)) / 2);
  dataset.doubt = together(places.beyond_windows(windows), dataset.curve_doubt);
  for (std::size_t p = 0; p < dataset.curve_doubt.size(); ++p)
    dataset.curve_doubt[p] = std::hypot(dataset.curve_doubt[p], places.contact(p).mesh_uncertainty);
  Noise noise;
  if (options.noise > 0)
    noise = {options.noise, false};
  else if (!dataset.recording.f.empty())
    noise = force_noise(dataset.recording);
  const ShapeError shape = shape_error(places);
  double floor = options.floor, doubted_floor = options.floor;
  if (options.floor < 0) {
    const double mesh = places.mesh_uncertainty();
    floor = std::max(kLeastFloor, std::hypot(mesh, shape.share()));
    doubted_floor = std::max(kLeastFloor, std::hypot(mesh, shape.share_unmoved()));
  }
  return {std::move(dataset), places,       noise, shape,        depth,
          std::move(unfit),   too_strained, floor, doubted_floor};
}

std::vector<std::string> left_out_words(const Experiment& experiment, bool borrowed) {
  std::vector<std::string> words;
  if (!experiment.unfit.empty())
    words.push_back(fmt::format(
        "WARNING: {} of {} places {}, for this body cannot be pressed so there; the first: {}",
        experiment.unfit.size(),
        experiment.dataset.positions.size() + (borrowed ? 0 : experiment.unfit.size()),
        borrowed ? "are taken for their nearest neighbours" : "are left out",
        experiment.unfit.front().why));
  if (experiment.too_strained > 0)
    words.push_back(
        fmt::format("{} of {} samples strain the body between the plates by more than {:.0f} %, "
                    "or come after "
                    "such: {}",
                    experiment.too_strained,
                    experiment.dataset.rows() + (borrowed ? 0 : experiment.too_strained),
                    100 * kMostPlateStrain,
                    borrowed ? "their forces are beyond what was verified"
                             : "left out, for no law was verified so far"));
  if (tool_turns(experiment.dataset.recording))
    words.emplace_back(
        "the tool turns (thx,thy,thz): its forces are taken for those of one that does not, and "
        "torques and marked points do not count; hs-simulate --live turns a flat tool");
  return words;
}

Experiment at_positions(const Experiment& e, const std::vector<std::size_t>& positions) {
  return {at_positions(e.dataset, positions),
          e.places.chosen(positions),
          e.noise,
          e.shape,
          e.depth,
          {},
          e.too_strained,
          e.floor,
          e.doubted_floor};
}

void set_poisson_range(const Model& model, ExperimentOptions& options) {
  const Parameter* nu = poissons_ratio_of(model);
  if (nu == nullptr) return;
  options.nu_low = nu->state == ParameterState::kFree ? nu->lower : nu->value;
  options.nu_high = nu->state == ParameterState::kFree ? nu->upper : nu->value;
}

}  // namespace hapsim
