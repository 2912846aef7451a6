#include "watch/watch.h"

#include <algorithm>
#include <cmath>

#include "watch/material_fit.h"
#include "watch/shift_fit.h"

namespace hapsim {
namespace {

constexpr double kKept = 10;      // [s]
constexpr double kPatience = 6;   // after the alarm at most [s]
constexpr double kNextPress = 2;  // [s]
constexpr int kPresses = 3;   // one press tells a shift along its normal alone, and not from a bias
constexpr double kClear = 5;  // margin of an explanation by fewer presses
constexpr int kLeastPresses = 4;  // from which an error can be stated
constexpr double kKnown = 0.5;    // of the usual error may be the shift's: both are 1.12 times that
constexpr double kThinned = 100;  // samples a second that a change is explained from
constexpr int kMaterialPresses = 6;  // over which a material is refined
constexpr int kSearchedPresses = 8;  // from so few on a shift is searched for everywhere

bool touches(const WatchedSample& s) {
  return s.counted && !s.line.in_air && s.line.u.norm() > 0;
}

int presses(const std::vector<WatchedSample>& window) {
  int n = 0;
  std::int32_t last = 0;
  for (const WatchedSample& s : window)
    if (touches(s) && (n == 0 || s.line.press != last)) {
      last = s.line.press;
      ++n;
    }
  return n;
}

}  // namespace

ModelWatch::ModelWatch(const PreparedBody& body, const WatchOptions& options)
    : body_(body),
      options_(options),
      test_(options.test),
      known_offsets_(body.distance()),
      offsets_(body.distance()),
      model_(body, offsets_),
      before_(body, offsets_),
      kept_(static_cast<std::size_t>(std::max(1.0, kKept * options.test.rate))) {}

std::size_t ModelWatch::oldest() const {
  return count_ - std::min(count_, kept_.size());
}

Vec3 ModelWatch::step(const MotionLine& line, const Vec3& measured) {
  const bool fresh = count_ == 0 || line.press != press_;
  if (fresh) {
    if (!events_.empty() && !events_.back().settled && alarm_ < 0) refine();
    if (alarm_ < 0 && correction_.shift == Vec3::Zero()) {
      known_offsets_.add(line.point);
      offsets_ = known_offsets_;
    }
    press_begun_ = count_;
  }
  press_ = line.press;
  Vec3 model = model_.step(line, fresh, correction_);
  if (share_ < 1) {
    if (share_ + 1 / (options_.blend * options_.test.rate) >= 1) test_.restart();
    share_ = std::min(1.0, share_ + 1 / (options_.blend * options_.test.rate));
    model = share_ * model + (1 - share_) * before_.step(line, fresh, old_);
  }
  kept_[count_++ % kept_.size()] = {line, measured, model};
  learned_ = learned_ || test_.learned();
  const bool refining = !events_.empty() && !events_.back().settled;
  if (!refining)
    factors_.add(line.press, press_begun_, line.point - correction_.shift, model - correction_.bias,
                 measured - correction_.bias);
  const bool in_contact = !line.in_air && model.norm() > 0;
  if (test_.add({model, measured, model_.uncertainty(), in_contact, line.press}) && alarm_ < 0 &&
      !refining) {
    alarm_ = line.t;
    change_ = test_.since();
    waits_until_ = count_ + static_cast<std::size_t>(options_.evidence * options_.test.rate);
  }
  if (alarm_ >= 0 && count_ >= waits_until_) name();
  return model;
}

double ModelWatch::usual_error() const {
  double squares = 0;
  const std::size_t from = oldest();
  for (std::size_t i = from; i < count_; ++i) squares += std::pow(test_.size(kept(i).model), 2);
  return count_ > from ? std::sqrt(squares / static_cast<double>(count_ - from))
                       : test_.size(Vec3::Zero());
}

// The error of a stiffness that has changed by a share x, beside that usual share s of the force:
// sqrt(s^2 + x^2).
double ModelWatch::least_change() const {
  double squares = 0;
  for (std::size_t i = oldest(); i < count_; ++i) squares += kept(i).model.squaredNorm() / 3;
  const double force = std::sqrt(squares / static_cast<double>(std::max(count_ - oldest(), 1UL)));
  const double growth = test_.least_growth();
  return force > 0 ? usual_error() / force * std::sqrt(growth * growth - 1) : 0;
}

void ModelWatch::append(std::size_t begin, std::size_t from,
                        std::vector<WatchedSample>& window) const {
  const auto every =
      std::max<std::size_t>(1, static_cast<std::size_t>(options_.test.rate / kThinned));
  for (std::size_t i = begin; i < count_; i += every) {
    window.push_back(kept(i));
    window.back().counted = i >= from;
    window.back().size = test_.size(window.back().measured);
  }
}

void ModelWatch::name() {
  std::size_t from = std::max(change_, oldest());
  const double begun = kept(from).line.t;
  // What changed within a press (a tool stuck to a body that moves) is told by the next one, when
  // there is one soon.
  std::size_t next = from;
  while (next < count_ && kept(next).line.press == kept(from).line.press) ++next;
  const auto evidence = static_cast<std::size_t>(options_.evidence * options_.test.rate);
  if (next + evidence <= count_) {
    from = next;
  } else if (kept(count_ - 1).line.t - alarm_ < kNextPress) {
    waits_until_ = count_ + evidence / 2;
    return;
  }
  // From the beginning of the press in which it fell, so that what the body remembers is known.
  std::size_t begin = from;
  while (begin > oldest() && kept(begin - 1).line.press == kept(from).line.press) --begin;
  std::vector<WatchedSample> window;
  append(begin, from, window);
  const int told_by = presses(window);
  if (told_by == 0 && count_ < waits_until_ + kept_.size() / 2)
    return;  // the air alone tells less; wait for contact a while
  usual_ = factors_.usual(change_, test_.share());
  const Explanation best = explain_change(body_, known_offsets_, window, correction_, usual_);
  const bool plain =
      (best.change == Change::kMaterial || best.change == Change::kGone) && best.margin > kClear;
  if (!plain && told_by < kPresses && kept(count_ - 1).line.t - alarm_ < kPatience) {
    waits_until_ = count_ + evidence;
    return;
  }
  change_ = from;
  WatchEvent event;
  event.begun = begun;
  event.alarm = alarm_;
  event.named = kept(count_ - 1).line.t;
  event.change = best.change;
  event.correction = best.change == Change::kUnexplained ? correction_ : best.correction;
  // Part of a press tells how stiff a material is, and not yet how it relaxes.
  if (best.change == Change::kMaterial && told_by < kPresses) {
    event.correction = correction_;
    event.correction.gone = false;
    fit_stiffness(body_, known_offsets_, window, event.correction);
  }
  event.shift_error = best.shift_error;
  event.error_before = usual_error();
  event.error_with = best.error;
  event.presses = told_by;
  event.settled =
      !options_.adapts || (best.change != Change::kMoved && best.change != Change::kMaterial);
  if (best.change != Change::kMoved) event.updated = event.named;
  events_.push_back(event);
  if (!event.settled) since_ = std::move(window), known_ = correction_;
  if (options_.adapts && best.change != Change::kUnexplained) take_over(event.correction, begin);
  alarm_ = -1;
  test_.restart();
}

// From the correction so far to another, whose model has followed the stream since `begin`.
void ModelWatch::take_over(const Correction& correction, std::size_t begin) {
  old_ = correction_;
  before_.take_state(model_);
  correction_ = correction;
  model_.take_state(CorrectedModel(body_, offsets_));
  for (std::size_t i = begin; i < count_; ++i)
    model_.step(kept(i).line, i == begin || kept(i).line.press != kept(i - 1).line.press,
                correction_);
  share_ = 0;
  factors_.clear();
}

// A press has ended.
void ModelWatch::refine() {
  WatchEvent& event = events_.back();
  const std::size_t begin = std::max(press_begun_, oldest());
  // The first ended press was named from in part.
  while (!since_.empty() && since_.back().line.press == press_) since_.pop_back();
  append(begin, std::max(begin, change_), since_);
  event.presses = presses(since_);
  if (event.change == Change::kMaterial)
    refine_material(begin);
  else
    refine_shift(begin);
}

// What relaxes as well, where that is told by now.
void ModelWatch::refine_material(std::size_t begin) {
  WatchEvent& event = events_.back();
  if (event.presses < kPresses) return;
  const Explanation best = explain_material(body_, known_offsets_, since_, known_);
  take_over(best.correction, begin);
  event.correction = best.correction;
  if (event.presses >= kMaterialPresses) settle();
}

void ModelWatch::refine_shift(std::size_t begin) {
  WatchEvent& event = events_.back();
  const ShiftFit fit = fit_shift(body_, known_offsets_, since_, known_, correction_.shift, usual_,
                                 event.presses <= kSearchedPresses);
  Correction correction = correction_;
  correction.shift = fit.shift;
  correction.stiffness = fit.stiffness;
  offsets_ = known_offsets_;
  const std::vector<std::size_t> press = press_indices(since_);
  for (std::size_t i = 0; i < since_.size(); ++i) {
    if (i > 0 && press[i] == press[i - 1]) continue;
    const Vec3 place = since_[i].line.point - fit.shift;
    Vec3 normal;
    const double offset = known_offsets_.at(place, normal);
    offsets_.add(place, offset + fit.gaps[press[i]]);
  }
  take_over(correction, begin);
  event.correction = correction;
  event.shift_error = fit.std_error;
  if (event.updated < 0 && event.presses >= kLeastPresses && fit.force_error < kKnown)
    event.updated = kept(count_ - 1).line.t;
  if (event.presses >= kRefinedPresses) settle();
}

void ModelWatch::settle() {
  events_.back().error_with =
      error_of(since_, corrected_forces(body_, offsets_, since_, correction_));
  events_.back().settled = true;
  if (!events_.back().explains())
    events_.back().updated = -1;
  else if (events_.back().updated < 0)
    events_.back().updated = kept(count_ - 1).line.t;
  since_.clear();
  test_.restart();
  if (events_.back().change == Change::kMoved) test_.learn_anew();  // it is pressed elsewhere
}

}  // namespace hapsim
