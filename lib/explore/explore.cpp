#include "explore/explore.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "explore/judgement.h"
#include "explore/lump_places.h"
#include "explore/place_finder.h"
#include "explore/suspects.h"
#include "explore/unseen.h"
#include "model/model_edit.h"
#include "plan/press_depths.h"

namespace hapsim {
namespace {

constexpr std::size_t kOffered = 4;  // new places that a plan by models may choose from
constexpr double kTellsApart = 3;    // standard deviations; a plan that promises less tells nothing
constexpr double kStep = 0.02;       // [s] of a motion, where no recording says another

// One question to the loop, and what is at hand to answer it.
class Question {
 public:
  Question(const TetMesh& body, const std::vector<Vec3>& window, const Model& model,
           const Recording& recording, const ExploreOptions& options)
      : body_(body),
        window_(window),
        model_(model),
        recording_(recording),
        options_(options),
        surface_(boundary_surface(body), "body"),
        depths_(surface_, recording, options.depth) {}

  Exploration answer() {
    require_on_body(surface_, recording_);
    seen_ = pressed_places(recording_);
    result_.presses = recording_.presses().size();
    result_.places = seen_.size();
    result_.no_times = recording_.rows() > 0 && recording_.t.empty();
    if (result_.presses >= kLeastPresses)
      take_stock();
    else
      tell_what_is_hopeless();
    const std::vector<GoalState>& goals = result_.goals;
    const auto open = [](const GoalState& g) { return !g.reached; };
    const bool judged = result_.presses >= kLeastPresses && !goals.empty();
    result_.reached = judged && std::none_of(goals.begin(), goals.end(), open);
    if (result_.reached) {
      if (const auto image = sight_of(*known_, body_, options_)) tell_inside(*image);
      return std::move(result_);
    }
    if (result_.presses >= options_.most_presses)
      end("as many presses as --most-presses allows are there");
    else if (judged && std::none_of(goals.begin(), goals.end(),
                                    [&](const GoalState& g) { return open(g) && !g.unreachable; }))
      end("what is open cannot be reached by presses");
    else
      plan();
    for (const char* key : {"tool_radius", "tool"})
      if (const auto value = recording_.metadata.find(key))
        result_.plan.motion.metadata.set(key, *value);
    return std::move(result_);
  }

 private:
  // Of a modulus wanted better than any mesh gives, before anything is measured.
  void tell_what_is_hopeless() {
    const double asked = options_.experiment.floor;
    for (const WantedError& wanted : options_.goals.errors)
      if (const auto state = hopeless(wanted, asked >= 0 ? asked : kLeastFloor))
        result_.goals.push_back(*state);
  }

  // What is known by now.
  void take_stock() {
    known_ = judge(body_, window_, model_, recording_, options_);
    result_.diagnosis = known_->diagnosis;
    if (known_->diagnosis) result_.untested = untested_effects(*known_->diagnosis);
    result_.goals = known_->goals;
    seen_ = known_->seen;
    result_.gap = finder().widest_gap();
    if (options_.goals.unseen.value > 0)
      result_.goals.push_back(unseen_state(options_.goals.unseen,
                                           unseen_of(known_->left_out, finder().shares()),
                                           known_->experiment.allowance().floor));
    if (known_->image) tell_inside(*known_->image);
  }

  void tell_inside(const StiffnessImage& image) {
    result_.lumps = image.lumps;
    result_.inside = words_of(image);
    result_.sight = image.found.sight;
  }

  void plan() {
    const bool settled = known_ && known_->settled;
    const bool open = result_.diagnosis && !settled;
    if (open && !known_->coverage.lacking.empty()) return make_up_motions();
    // Effects that are possible alone may be what a boundary that lies wrong leaves.
    const bool places_first =
        is_open("unseen") && result_.diagnosis->verdict != ModelVerdict::kAmbiguous;
    if (open && !places_first && known_->coverage.places >= kSettledPlaces && tell_apart()) return;
    if (settled && sharpen()) return;
    if (is_open("unseen") && !known_->left_out.error.empty()) return look_where_least_is_foretold();
    if (known_ && known_->image && !known_->image->lumps.empty() && is_open("lump"))
      return surround_lump();
    spread();
  }

  bool is_open(const std::string& goal) const {
    return std::any_of(result_.goals.begin(), result_.goals.end(),
                       [&](const GoalState& g) { return g.name == goal && !g.reached; });
  }

  // Presses with the motions that no press so far had, at new places where there are any.
  void make_up_motions() {
    result_.aim = Aim::kTest;
    std::string what;
    std::vector<std::size_t> turns;
    for (const LackingMotion& m : known_->coverage.lacking) {
      what += (what.empty() ? "" : "; ") + m.what;
      if (std::find(turns.begin(), turns.end(), m.turn) == turns.end()) turns.push_back(m.turn);
    }
    result_.why = "to test what no press so far could show: " + what;
    std::vector<PressablePlace> places = places_by_spread(count());
    if (places.empty()) places = finder().pressed_again(count());
    press(places, turns);
  }

  bool tell_apart() {
    Suspects suspects = suspects_of(*result_.diagnosis, known_->experiment, options_.diagnose);
    if (suspects.models.size() < 2) return false;
    PlanAsked asked;
    asked.depth_at = full_depth();
    for (const PressablePlace& p : places_by_spread(kOffered)) asked.places.push_back(p.point);
    MeasurementPlan plan = plan_presses(suspects.models, known_->experiment, count(), asked);
    if (!(plan.separation >= kTellsApart)) return false;
    result_.aim = Aim::kTellApart;
    result_.promise = plan.separation;
    result_.rivals = std::move(suspects.names);
    std::string names;
    for (const std::string& name : result_.rivals) names += (names.empty() ? "" : " from ") + name;
    result_.why =
        fmt::format("to tell {}: {:.3g} standard deviations of the noise", names, plan.separation);
    take(std::move(plan));
    return true;
  }

  // What is farthest from its goal; what is not known at all is farthest.
  const GoalState* least_known() const {
    const GoalState* worst = nullptr;
    const auto lacks = [](const GoalState& g) {
      return std::isfinite(g.value) ? g.value / g.wanted : std::numeric_limits<double>::infinity();
    };
    for (const GoalState& g : result_.goals)
      if (!g.reached && !g.unreachable && !g.determine.empty() &&
          (worst == nullptr || lacks(g) > lacks(*worst)))
        worst = &g;
    return worst;
  }

  // A pressed place tells little more of the stiffness than it did: the meshes err there as before.
  // So only new ones are offered.
  bool sharpen() {
    const GoalState* worst = least_known();
    if (worst == nullptr) return false;
    PlanAsked asked;
    asked.depth_at = full_depth();
    asked.parameter = worst->determine;
    asked.region = worst->region;
    asked.pressed_places = false;
    for (const PressablePlace& p : places_by_spread(std::max(kOffered, count())))
      asked.places.push_back(p.point);
    if (asked.places.empty()) return false;
    MeasurementPlan plan =
        plan_presses({result_.diagnosis->rivals.front()}, known_->experiment, count(), asked);
    result_.aim = Aim::kSharpen;
    result_.promise = plan.separation;
    result_.parameter = worst->determine;
    const std::string now =
        std::isfinite(worst->value)
            ? fmt::format("{}, {:.2g} %, wanted {:.2g} %", worst->name, 100 * worst->value,
                          100 * worst->wanted)
            : fmt::format("{}, wanted {:.2g} %, is not known", worst->name, 100 * worst->wanted);
    result_.why =
        fmt::format("to know {} better ({}): its standard error falls to {:.0f} % of that",
                    worst->determine, now, 100 * plan.separation);
    take(std::move(plan));
    return true;
  }

  void look_where_least_is_foretold() {
    result_.aim = Aim::kUnseen;
    result_.why =
        "to foretell places that nobody has pressed: near those that the others foretold worst";
    press(places_by_spread(count()));
  }

  void surround_lump() {
    const Lump& lump = known_->image->lumps.front();
    result_.aim = Aim::kLump;
    result_.why = fmt::format("to know better where the lump near ({:.0f}, {:.0f}, {:.0f}) mm lies",
                              1e3 * lump.centre.x(), 1e3 * lump.centre.y(), 1e3 * lump.centre.z());
    press(finder().fresh(
        [&](const std::vector<PressablePlace>& left, std::size_t n) {
          return lump_places(left, seen_, lump, radius(), known_->image->error, n);
        },
        count()));
  }

  void spread() {
    result_.aim = Aim::kSpread;
    result_.why =
        result_.presses < kLeastPresses
            ? fmt::format(
                  "to see whether places differ: of fewer than {} presses nothing is settled",
                  kLeastPresses)
        : known_->image
            ? "to find something inside: where the stiffness stands out, and where least is known"
            : "to see whether places differ: where the stiffness stands out, and where least is "
              "known";
    press(places_by_spread(count()));
  }

  // `first`: turns that come before the usual ones.
  void press(const std::vector<PressablePlace>& places, std::vector<std::size_t> first = {}) {
    if (places.empty() && seen_.empty())
      fail_input("", "no place is left that the tool could be pressed at",
                 "allow steeper ones (--steepest), or take a smaller tool");
    if (places.empty())
      return end(
          "no place is left that is a tool's radius away from those that were pressed: the goals "
          "cannot be reached with this tool on this body");
    for (std::size_t turn = result_.presses; first.size() < places.size(); ++turn)
      first.push_back(turn);
    take(presses_in_turn(places, first, full_depth(), step()));
  }

  void take(MeasurementPlan plan) {
    result_.plan = std::move(plan);
    for (const PlannedPress& p : result_.plan.presses)
      if (const std::string words = depths_.shallower_words(p.position); !words.empty())
        result_.shallower.push_back(words);
    go_on_after(recording_, result_.plan);
  }

  void end(const std::string& why) {
    result_.ended = true;
    result_.aim = Aim::kNone;
    result_.why = why;
  }

  std::vector<PressablePlace> places_by_spread(std::size_t count) {
    return finder().fresh(
        [&](const std::vector<PressablePlace>& left, std::size_t n) {
          return spread_places(left, seen_, 2 * radius(), n, doubts(left));
        },
        count);
  }

  // By what places that were left out say, while a goal asks for that.
  std::vector<double> doubts(const std::vector<PressablePlace>& places) const {
    if (!is_open("unseen") || known_->left_out.error.empty()) return {};
    return doubt_at(places, seen_, known_->left_out);
  }

  const PlaceFinder& finder() {
    if (finder_) return *finder_;
    ExperimentOptions options = options_.experiment;
    if (!model_.parameters.empty()) set_poisson_range(model_, options);
    finder_.emplace(body_, window_, seen_, PlaceRules{radius(), options_.steepest, options});
    return *finder_;
  }

  // Of the next motion.
  std::size_t count() const {
    return std::min(options_.presses, options_.most_presses - result_.presses);
  }
  double radius() const {
    return known_ ? known_->experiment.dataset.recording.disc_radius() : recording_.disc_radius();
  }
  double step() const {
    const double own = known_ ? summarise(known_->experiment.dataset, 1).sample_step : 0;
    return own > 0 ? std::max(1e-4, own) : kStep;
  }
  DepthAt full_depth() const {
    return [this](const Vec3& p, const Vec3& normal) { return depths_.full_at(p, normal); };
  }

  const TetMesh& body_;
  const std::vector<Vec3>& window_;
  const Model& model_;
  const Recording& recording_;
  const ExploreOptions& options_;
  const SignedDistance surface_;
  const PressDepths depths_;
  std::optional<Judgement> known_;  // of kLeastPresses or more
  std::vector<SeenPlace> seen_;
  std::optional<PlaceFinder> finder_;
  Exploration result_;
};

}  // namespace

Exploration explore(const TetMesh& body, const std::vector<Vec3>& window, const Model& model,
                    const Recording& recording, const ExploreOptions& options) {
  return Question(body, window, model, recording, options).answer();
}

}  // namespace hapsim
