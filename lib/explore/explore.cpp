#include "explore/explore.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "diagnose/draft_experiment.h"
#include "diagnose/held_out.h"
#include "effects/catalogue.h"
#include "explore/lump_places.h"
#include "explore/planned_places.h"
#include "explore/seen_places.h"
#include "fit/extend.h"
#include "mesh/window.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

constexpr std::size_t kOffered = 4;  // new places that a plan by models may choose from
constexpr double kTellsApart = 3;    // standard deviations; a plan that promises less tells nothing
constexpr double kStep = 0.02;       // [s] of a motion, where no recording says another
constexpr std::size_t kLeastPlaces = kLeastPresses;  // before a lump is looked for

// One question to the loop, and what is at hand to answer it.
class Question {
 public:
  Question(const TetMesh& body, const std::vector<Vec3>& window, const Model& model,
           const Recording& recording, const ExploreOptions& options)
      : body_(body), window_(window), model_(model), recording_(recording), options_(options) {}

  Exploration answer() {
    seen_ = pressed_places(recording_);
    result_.presses = recording_.presses().size();
    result_.places = seen_.size();
    if (result_.presses >= kLeastPresses) judge();
    result_.reached =
        !result_.goals.empty() && std::all_of(result_.goals.begin(), result_.goals.end(),
                                              [](const GoalState& g) { return g.reached; });
    result_.ended = !result_.reached && result_.presses >= options_.most_presses;
    if (!result_.done()) plan();
    for (const char* key : {"tool_radius", "tool"})
      if (const auto value = recording_.metadata.find(key))
        result_.plan.motion.metadata.set(key, *value);
    return std::move(result_);
  }

 private:
  // What is known by now.
  void judge() {
    Model start = model_;
    experiment_ = draft_experiment(body_, window_, start, recording_, options_.experiment);
    const TrialGround ground(*experiment_, experiment_->allowance());
    const Selection all = all_episodes(experiment_->dataset);
    if (start.parameters.empty()) start = elastic_model(*experiment_, all);
    if (options_.goals.of_forces()) {
      result_.diagnosis = diagnose(start, *experiment_, ground.allowance, options_.diagnose);
      const Diagnosis& d = *result_.diagnosis;
      result_.goals.push_back(verdict_state(d, result_.presses));
      // An error is none of a model that lacks something, and not asked for before.
      for (const WantedError& wanted : options_.goals.errors) {
        if (settles(d, result_.presses))
          result_.goals.push_back(error_state(wanted, d.rivals.front()));
        else
          result_.goals.push_back({wanted.parameter, "", std::nan(""), wanted.share, false});
      }
    }
    fitted_ = fit(start, *experiment_, all, trial_fit_options(ground));
    if (!fitted_->converged)
      fail_numerics(recording_.name, "the model does not fit: " + fitted_->message,
                    "give another one by --model");
    seen_ = seen_places(*fitted_, *experiment_);
    if (options_.goals.lump > 0) look_inside();
  }

  void look_inside() {
    if (seen_.size() < kLeastPlaces) {
      result_.goals.push_back(lump_state(options_.goals.lump, {}));
      return;
    }
    const MaterialSpec material = material_of(fitted_->model);
    if (material.modulus.size() > 1 || !material.features.empty())
      fail_input("", "a lump is looked for in a body of one modulus",
                 "give a model without regions, layers and inclusions, or none");
    ImageOptions options;
    options.threads = options_.experiment.threads;
    options_.diagnose.tell("looking inside");
    image_ = stiffness_image(fitted_->model, *experiment_, fitted_->about, body_, options);
    result_.goals.push_back(lump_state(options_.goals.lump, *image_));
    result_.lumps = image_->lumps;
    result_.inside = words_of(*image_);
  }

  void plan() {
    const Diagnosis* d = result_.diagnosis ? &*result_.diagnosis : nullptr;
    if (d != nullptr && !settles(*d, result_.presses) && tell_apart(*d)) return;
    if (d != nullptr && settles(*d, result_.presses) && sharpen(*d)) return;
    if (image_ && !image_->lumps.empty() && !result_.goals.back().reached) return surround_lump();
    spread();
  }

  // The rivals, or where nothing passes the gates the best of what is possible: fitted models, and
  // their effects' names.
  std::vector<Model> suspects(const Diagnosis& d) {
    if (d.rivals.size() > 1) {
      for (const Finding& f : d.findings)
        if (f.verdict == Verdict::kIndistinguishable) result_.rivals.push_back(f.effect);
      return d.rivals;
    }
    constexpr std::size_t kMost = 3;
    std::vector<Model> models;
    const TrialGround ground(*experiment_, experiment_->allowance());
    const Selection all = all_episodes(experiment_->dataset);
    const Fit base = fit(d.rivals.front(), *experiment_, all, trial_fit_options(ground));
    for (const Finding& f : d.findings) {
      if (f.verdict != Verdict::kPossible || models.size() == kMost) continue;
      options_.diagnose.tell("fitting " + f.effect);
      try {
        const Fit with =
            fit_best(with_effect(base, f.effect, *experiment_, all, trial_extend_options(ground)),
                     *experiment_, all, trial_fit_options(ground));
        if (!with.converged) continue;
        models.push_back(with.model);
        result_.rivals.push_back(f.effect);
      } catch (const Error&) {  // these presses cannot bear it after all
      }
    }
    return models;
  }

  bool tell_apart(const Diagnosis& d) {
    const std::vector<Model> models = suspects(d);
    if (models.size() < 2) return false;
    PlanAsked asked;
    asked.depth = depth();
    for (const PressablePlace& p : places_by_spread(kOffered)) asked.places.push_back(p.point);
    MeasurementPlan plan = plan_presses(models, *experiment_, options_.presses, asked);
    if (!(plan.separation >= kTellsApart)) {
      result_.rivals.clear();
      return false;
    }
    result_.aim = Aim::kTellApart;
    result_.promise = plan.separation;
    std::string names;
    for (const std::string& name : result_.rivals) names += (names.empty() ? "" : " from ") + name;
    result_.why =
        fmt::format("to tell {}: {:.3g} standard deviations of the noise", names, plan.separation);
    take(std::move(plan));
    return true;
  }

  // The parameter that is farthest from what is wanted. A pressed place tells little more of the
  // stiffness than it did: the meshes err there as before. So only new ones are offered.
  bool sharpen(const Diagnosis& d) {
    const GoalState* worst = nullptr;
    for (const GoalState& g : result_.goals)
      if (!g.reached && std::isfinite(g.value) && g.name.find(' ') != std::string::npos &&
          (worst == nullptr || g.value / g.wanted > worst->value / worst->wanted))
        worst = &g;
    if (worst == nullptr) return false;
    PlanAsked asked;
    asked.depth = depth();
    asked.parameter = worst->name;
    asked.pressed_places = false;
    for (const PressablePlace& p : places_by_spread(std::max(kOffered, options_.presses)))
      asked.places.push_back(p.point);
    if (asked.places.empty()) return false;
    MeasurementPlan plan = plan_presses({d.rivals.front()}, *experiment_, options_.presses, asked);
    result_.aim = Aim::kSharpen;
    result_.promise = plan.separation;
    result_.parameter = worst->name;
    result_.why = fmt::format(
        "to know {} better ({:.2g} %, wanted {:.2g} %): its standard error falls "
        "to {:.0f} % of that",
        worst->name, 100 * worst->value, 100 * worst->wanted, 100 * plan.separation);
    take(std::move(plan));
    return true;
  }

  void surround_lump() {
    const Lump& lump = image_->lumps.front();
    const std::vector<PressablePlace> places =
        fitting([&](const std::vector<PressablePlace>& left, std::size_t count) {
          return lump_places(left, seen_, lump, radius(), image_->error, count);
        });
    result_.aim = Aim::kLump;
    result_.why = fmt::format("to know better where the lump near ({:.0f}, {:.0f}, {:.0f}) mm lies",
                              1e3 * lump.centre.x(), 1e3 * lump.centre.y(), 1e3 * lump.centre.z());
    press(places);
  }

  void spread() {
    result_.aim = Aim::kSpread;
    result_.why =
        result_.presses < kLeastPresses
            ? fmt::format(
                  "to see whether places differ: of fewer than {} presses nothing is settled",
                  kLeastPresses)
        : image_
            ? "to find something inside: where the stiffness stands out, and where least is known"
            : "to see whether places differ: where the stiffness stands out, and where least is "
              "known";
    press(places_by_spread(options_.presses));
  }

  void press(const std::vector<PressablePlace>& places) {
    if (places.empty())
      fail_input("", "no place is left that the tool could be pressed at",
                 "allow steeper ones (--steepest), or take a smaller tool");
    take(presses_in_turn(places, depth(), result_.presses, step()));
  }

  void take(MeasurementPlan plan) {
    result_.plan = std::move(plan);
    go_on_after(recording_, result_.plan);
  }

  std::vector<PressablePlace> places_by_spread(std::size_t count) {
    return fitting([&](const std::vector<PressablePlace>& left,
                       std::size_t n) { return spread_places(left, seen_, 2 * radius(), n); },
                   count);
  }

  std::vector<PressablePlace> fitting(const PlaceChoice& choose, std::size_t count = 0) {
    if (!setup_) prepare_nowhere();
    std::vector<PressablePlace> places =
        pressable_places(library_->surface(), radius(), options_.steepest);
    if (window_.size() > 2)
      std::erase_if(places,
                    [&](const PressablePlace& p) { return !inside_window(window_, p.point); });
    return fitting_places(std::move(places), count > 0 ? count : options_.presses, choose, setup_);
  }

  // Where the tool fits is found out by meshing, which the next round finds in the cache.
  void prepare_nowhere() {
    ExperimentOptions options = options_.experiment;
    if (!model_.parameters.empty()) set_poisson_range(model_, options);
    ContactLibraryOptions library;
    library.threads = options.threads;
    library.cache = options.cache;
    library.rim_edge = options.rim_edge;
    library.draft = true;
    library_ = std::make_shared<const ContactLibrary>(body_, radius(), library);
    setup_ = [library = library_, low = options.nu_low,
              high = options.nu_high](const std::vector<Vec3>& positions) {
      return SetupPlaces::prepare(library, positions, low, high);
    };
  }

  double radius() const {
    return experiment_ ? experiment_->dataset.recording.disc_radius() : recording_.disc_radius();
  }
  double step() const {
    return experiment_ ? std::max(1e-4, summarise(experiment_->dataset, 1).sample_step) : kStep;
  }
  double depth() const {
    if (options_.depth > 0) return options_.depth;
    constexpr double kDeepest = 1.5;  // of press_paths()
    double deepest = 0;
    for (std::size_t row = 0; row < recording_.rows(); ++row)
      if (!recording_.in_air(row)) deepest = std::max(deepest, recording_.u[row].norm());
    if (deepest > 0) return deepest / kDeepest;
    Eigen::AlignedBox3d box;
    for (const Vec3& v : body_.nodes) box.extend(v);
    return std::min(0.75 * recording_.tool_radius(), 0.1 * box.sizes().minCoeff());
  }

  const TetMesh& body_;
  const std::vector<Vec3>& window_;
  const Model& model_;
  const Recording& recording_;
  const ExploreOptions& options_;
  std::optional<Experiment> experiment_;
  std::optional<Fit> fitted_;  // the model as it was given
  std::optional<StiffnessImage> image_;
  std::vector<SeenPlace> seen_;
  std::shared_ptr<const ContactLibrary> library_;
  std::function<std::shared_ptr<const SetupPlaces>(const std::vector<Vec3>&)> setup_;
  Exploration result_;
};

}  // namespace

std::string aim_name(Aim aim) {
  switch (aim) {
    case Aim::kSpread:
      return "spread";
    case Aim::kTellApart:
      return "tell apart";
    case Aim::kSharpen:
      return "sharpen";
    case Aim::kLump:
      return "lump";
    default:
      return "none";
  }
}

Exploration explore(const TetMesh& body, const std::vector<Vec3>& window, const Model& model,
                    const Recording& recording, const ExploreOptions& options) {
  return Question(body, window, model, recording, options).answer();
}

}  // namespace hapsim
