// A model that watches itself: how soon it notices a change, what it calls it, and what error is
// left; or, with `hours N [SEEDS [BODY...]]`, on each body how many alarms N hours of it unchanged
// give with each of so many seeds of presses, and how soon a softer one is noticed. Prints tables.
// Recorded in bench/results/watch*.txt (bench/record.sh).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "formats/tetmesh_io.h"
#include "support/changing_world.h"
#include "support/objects.h"
#include "tetmesh/body_mesh.h"
#include "watch/watch.h"

namespace {

using namespace hapsim;

constexpr double kFrom = 35, kSpread = 3;  // the change comes then [s]
constexpr double kAfter = 1;               // after the update the error is asked for [s] ...
constexpr double kSoon = 4;                // ... over so long [s]
constexpr double kEnough = 1.3, kBin = 0.25;
constexpr double kLater = 13, kEnd = 30;  // and again: shifts are refined no longer [s]

// Squared errors beside squared forces.
class Errors {
 public:
  void add(const Vec3& residual, const Vec3& force) {
    const double r = residual.squaredNorm(), f = force.squaredNorm();
    n_ += 1, r_ += r, f_ += f, ff_ += f * f, rf_ += r * f;
  }
  void add(const Errors& other) {
    n_ += other.n_, r_ += other.r_, f_ += other.f_, ff_ += other.ff_, rf_ += other.rf_;
  }
  double rms() const { return n_ > 0 ? std::sqrt(r_ / (3 * n_)) : 0; }
  // Over the error that `usual` ones, straight in the squared force, would have at these forces: a
  // body that has come nearer is pressed harder.
  double over(const Errors& usual) const {
    const double spread = usual.ff_ - usual.f_ * usual.f_ / usual.n_;
    const double slope = std::max(0.0, (usual.rf_ - usual.r_ * usual.f_ / usual.n_) / spread);
    const double base = (usual.r_ - slope * usual.f_) / usual.n_;
    return n_ > 0 ? std::sqrt(r_ / (n_ * base + slope * f_)) : 0;
  }

 private:
  double n_ = 0, r_ = 0, f_ = 0, ff_ = 0, rf_ = 0;
};

struct Draw {
  bool false_alarm = false;
  double noticed = 1e9, named = 1e9, updated = 1e9;  // [s] from the change
  Change called = Change::kNone;
  // Errors over the former one: as they are, and at equal force.
  double plain = 0, equal = 0;   // after the update
  double below = 1e9;            // that it is below kEnough from then on, after the update [s]
  double named_equal = 0;        // after the name
  double refined = 0, told = 0;  // later; and with the truth
  double jump = 0;               // of the force within a millisecond while a model takes over [N]
  // Of a shift: when it counts as known and at the end, what it is off and what is stated [m].
  Vec3 off_updated = Vec3::Zero(), stated_updated = Vec3::Zero();
  Vec3 off = Vec3::Zero(), stated = Vec3::Zero();
};

// A case of what may happen; `other`: the body becomes that one.
struct Case {
  const char* name;
  Change change;
  const PreparedBody* other = nullptr;
  Correction truth = {};  // of `other`
};

Draw trial(const PreparedBody& truth, const PreparedBody& known, const Case& what,
           std::uint64_t seed) {
  const Change change = what.change;
  Random random(1000 + seed);
  test::PressStream stream(truth, seed);
  stream.when = kFrom + kSpread * random.uniform();
  Vec3 way(random.normal(), random.normal(), random.normal());
  way.normalize();
  if (change == Change::kMoved) stream.after.shift = 0.005 * way;
  if (change == Change::kMaterial && what.other == nullptr) stream.after.stiffness = 0.7;
  if (what.other != nullptr) stream.becomes(*what.other);
  if (change == Change::kSensor) stream.after.bias = 0.1 * way;
  if (change == Change::kGone) stream.after.gone = true;
  WatchOptions options;
  options.test.learning = 10;
  ModelWatch watch(known, options);
  // The model told the truth about the change: what its own mesh leaves of the error.
  SurfaceOffsets offsets(known.distance());
  CorrectedModel told(known, offsets);
  Correction truth_told = what.truth;
  if (what.other == nullptr) truth_told.stiffness = stream.after.stiffness;
  truth_told.bias = stream.after.bias;
  truth_told.shift = stream.after.shift;
  truth_told.gone = stream.after.gone;
  Errors usual, first, soon, later, best;
  std::vector<Errors> bins(static_cast<std::size_t>(4 * kSoon / kBin));  // after the update
  Draw draw;
  int press = -1;
  Vec3 last = Vec3::Zero();
  for (double t = 0; t < kFrom + kSpread + 4 + kEnd;) {
    const auto [line, f] = stream.next();
    t = line.t;
    const Vec3 model = watch.step(line, f);
    const bool fresh = line.press != press;
    press = line.press;
    if (fresh && t < stream.when) offsets.add(line.point);
    const Vec3 oracle = told.step(line, fresh, truth_told);
    if (t > 15 && t < stream.when) usual.add(f - model, f);
    const double step = (model - last).norm();
    last = model;
    if (watch.events().empty()) continue;
    const WatchEvent& e = watch.events().front();
    if (e.updated >= 0 && draw.stated_updated.isZero()) {
      draw.off_updated = e.correction.shift - stream.after.shift;
      draw.stated_updated = e.shift_error;
    }
    const double since = t - e.named;
    if (since < 0.06) draw.jump = std::max(draw.jump, step);
    const double updated = e.updated < 0 ? 1e9 : t - e.updated;
    if (updated >= 0 && updated < 4 * kSoon)
      bins[static_cast<std::size_t>(updated / kBin)].add(f - model, f);
    if (updated >= kAfter && updated < kAfter + kSoon) first.add(f - model, f);
    if (since >= kAfter && since < kAfter + kSoon) soon.add(f - model, f), best.add(f - oracle, f);
    if (since >= kLater && since < kEnd) later.add(f - model, f);
  }
  if (!watch.events().empty()) {
    const WatchEvent& e = watch.events().front();
    draw.false_alarm = e.alarm < stream.when;
    draw.noticed = e.alarm - stream.when;
    draw.named = e.named - stream.when;
    draw.called = e.change;
    draw.updated = e.updated - stream.when;
    draw.off = e.correction.shift - stream.after.shift;
    draw.stated = e.shift_error;
  }
  const auto span = static_cast<std::size_t>(kSoon / kBin);
  for (std::size_t b = 0; b + span <= bins.size() && draw.below > 1e8; ++b) {
    Errors window;
    for (std::size_t i = b; i < b + span; ++i) window.add(bins[i]);
    if (window.rms() < kEnough * usual.rms()) draw.below = kBin * static_cast<double>(b);
  }
  draw.plain = first.rms() / usual.rms();
  draw.equal = first.over(usual);
  draw.named_equal = soon.over(usual);
  draw.refined = later.over(usual);
  draw.told = best.over(usual);
  return draw;
}

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
}

// How far the shift is off, and whether the stated standard errors are as large.
void shift_intervals(const char* when, const std::vector<Draw>& draws, Vec3 Draw::*off,
                     Vec3 Draw::*stated) {
  std::vector<double> distances, errors;
  double squares = 0;
  int within = 0, components = 0;
  for (const Draw& d : draws) {
    if (d.called != Change::kMoved || (d.*stated).isZero()) continue;
    distances.push_back((d.*off).norm());
    errors.push_back((d.*stated).norm());
    for (int k = 0; k < 3; ++k) {
      const double share = std::abs((d.*off)[k] / (d.*stated)[k]);
      squares += share * share;
      within += share < 1.96 ? 1 : 0;
      ++components;
    }
  }
  if (components == 0) return;
  fmt::print(
      "          (of the shift's 5 mm {:.2f} mm off {}, {:.2f} at most, stated {:.2f}; {} of {} "
      "components within\n          their 95 % interval, rms of error over stated {:.2f})\n",
      1e3 * quantile(distances, 0.5), when, 1e3 * quantile(distances, 1),
      1e3 * quantile(errors, 0.5), within, components, std::sqrt(squares / components));
}

void changes(const PreparedBody& truth, const PreparedBody& known, int draws,
             const std::string& only) {
  fmt::print(
      "times [s]: from the change until it is noticed and until the model is updated, from there "
      "until the\n"
      "error over the next 4 s is below 1.3 times the former; errors: over 4 s from 1 s after the "
      "update on,\n"
      "over the former; medians and worst\n"
      "change    noticed         named   updated     below       error       <1.3  at equal    "
      "<1.3  from the   later       told the    jump\n"
      "          in 2 s after    rightly after       1.3                           force           "
      "    name on                truth       [N]\n");
  const auto dry = test::prepared_dome(7, 1.6e4, 1.44e4, 0.3);
  Case drier{"drier", Change::kMaterial, dry.get()};
  drier.truth.stiffness = 0.8;
  drier.truth.relaxation = 3;
  drier.truth.slowness = 2;
  for (const Case& what : {Case{"moved", Change::kMoved}, Case{"material", Change::kMaterial},
                           drier, Case{"sensor", Change::kSensor}, Case{"gone", Change::kGone}}) {
    const Change change = what.change;
    if (!only.empty() && only != what.name) continue;
    std::vector<Draw> all;
    for (int i = 0; i < draws; ++i)
      all.push_back(trial(truth, known, what, static_cast<std::uint64_t>(i + 1)));
    const auto count = [&](auto&& holds) { return std::count_if(all.begin(), all.end(), holds); };
    const auto values = [&](double Draw::*member) {
      std::vector<double> v;
      for (const Draw& d : all) v.push_back(d.*member);
      return v;
    };
    const auto pair = [&](double Draw::*member) {
      return fmt::format("{:.2f} {:.2f}", quantile(values(member), 0.5),
                         quantile(values(member), 1));
    };
    const auto of = [&](long n) { return fmt::format("{}/{}", n, draws); };
    fmt::print("{:9} {:6} {:9} {:7} {:11} {:9} {:11} {:5} {:11} {:5} {:10} {:11} {:11} {:.2f}\n",
               what.name, of(count([](const Draw& d) { return !d.false_alarm && d.noticed < 2; })),
               pair(&Draw::noticed), of(count([&](const Draw& d) { return d.called == change; })),
               pair(&Draw::updated), pair(&Draw::below), pair(&Draw::plain),
               of(count([](const Draw& d) { return d.plain < 1.3; })), pair(&Draw::equal),
               of(count([](const Draw& d) { return d.equal < 1.3; })), pair(&Draw::named_equal),
               pair(&Draw::refined), pair(&Draw::told), quantile(values(&Draw::jump), 1));
    if (change == Change::kMoved) {
      shift_intervals("once updated", all, &Draw::off_updated, &Draw::stated_updated);
      shift_intervals("at the end", all, &Draw::off, &Draw::stated);
    }
  }
}

// The world is the body on one mesh, the model knows it on another.
struct MeshPair {
  TetMesh truth, known;
};

// dome, block, ball, organ, or TRUTH.ply:KNOWN.ply
MeshPair pair_named(const std::string& name) {
  BodyOptions options;
  options.preserve_surface = true;
  if (name == "dome") return {test::dome_mesh(7), test::dome_mesh(5)};
  if (name == "block")
    return {test::block_mesh({0.12, 0.21, 0.06}, 12, 21, 6, 1),
            test::block_mesh({0.12, 0.21, 0.06}, 8, 14, 4, 1)};
  if (name == "ball")
    return {make_body_mesh(test::half_ball(20), options),
            make_body_mesh(test::half_ball(14), options)};
  if (name == "organ")
    return {make_body_mesh(test::lump(20), options), make_body_mesh(test::lump(14), options)};
  const std::size_t colon = name.find(':');
  Input truth(name.substr(0, colon)), known(name.substr(colon + 1));
  return {read_body(truth), read_body(known)};
}

constexpr double kLearning = 30;                  // [s] in contact, of unchanged and softer bodies
constexpr double kSofterFrom = 120, kGiven = 60;  // [s] of the stream
constexpr int kSofterDraws = 20;

WatchOptions usual_options() {
  WatchOptions options;
  options.test.learning = kLearning;
  return options;
}

// Alarms in so many hours, in contact for a third of them.
std::size_t alarms_unchanged(const PreparedBody& truth, const PreparedBody& known, double hours,
                             std::uint64_t seed) {
  test::PressStream stream(truth, seed);
  ModelWatch watch(known, usual_options());
  std::size_t told = 0;
  const auto samples = static_cast<long>(hours * 3.6e6);
  for (long i = 0; i < samples; ++i) {
    const auto [line, f] = stream.next();
    watch.step(line, f);
    for (; told < watch.events().size(); ++told)
      fmt::print("  seed {}: alarm at {:.1f} s: {}\n", seed, watch.events()[told].alarm,
                 change_name(watch.events()[told].change));
  }
  return told;
}

// The body becomes 30 % softer: time in contact until that is noticed, in order [s].
void softer(const PreparedBody& truth, const PreparedBody& known) {
  std::vector<double> noticed;
  int early = 0, within = 0;
  double least = 0;
  for (int draw = 0; draw < kSofterDraws; ++draw) {
    const auto seed = static_cast<std::uint64_t>(101 + draw);
    Random random(1000 + seed);
    test::PressStream stream(truth, seed);
    stream.when = kSofterFrom + kSpread * random.uniform();
    stream.after.stiffness = 0.7;
    ModelWatch watch(known, usual_options());
    double in_contact = 0;
    for (double t = 0; t < stream.when + kGiven && watch.events().empty();) {
      const auto [line, f] = stream.next();
      t = line.t;
      watch.step(line, f);
      if (t >= stream.when && stream.touches()) in_contact += 1e-3;
    }
    least = std::max(least, watch.least_change());
    const bool told = !watch.events().empty();
    early += told && watch.events().front().alarm < stream.when ? 1 : 0;
    noticed.push_back(told ? in_contact : 1e9);
    within += told && in_contact <= 1 ? 1 : 0;
  }
  std::sort(noticed.begin(), noticed.end());
  fmt::print(
      "  -30 %: noticed within 1 s of contact in {} of {}, {:.2f} s (median), {:.2f} s at most; {} "
      "alarms before; least change that it says it notices {:.0f} %\n",
      within, kSofterDraws, quantile(noticed, 0.5), noticed.back(), early, 100 * least);
}

void hours(double hours, int seeds, const std::vector<std::string>& bodies) {
  std::size_t all = 0;
  for (const std::string& name : bodies) {
    const MeshPair pair = pair_named(name);
    const auto truth = test::prepared_soft(pair.truth), known = test::prepared_soft(pair.known);
    std::size_t alarms = 0;
    for (int seed = 1; seed <= seeds; ++seed)
      alarms += alarms_unchanged(*truth, *known, hours, static_cast<std::uint64_t>(seed));
    fmt::print("{}: {} alarms in {:g} h unchanged\n", name, alarms, seeds * hours);
    softer(*truth, *known);
    all += alarms;
  }
  fmt::print("in all {} alarms in {:g} h; stated {:g} an hour\n", all,
             static_cast<double>(bodies.size()) * seeds * hours, WatchOptions{}.test.false_alarms);
}

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  if (argc > 2 && std::string(argv[1]) == "hours") {
    std::vector<std::string> bodies(argv + std::min(argc, 4), argv + argc);
    if (bodies.empty()) bodies = {"dome", "block", "ball", "organ"};
    hours(std::atof(argv[2]), argc > 3 ? std::atoi(argv[3]) : 1, bodies);
  } else {
    const auto truth = test::prepared_dome(7), known = test::prepared_dome(5);
    changes(*truth, *known, argc > 1 ? std::atoi(argv[1]) : 10, argc > 2 ? argv[2] : "");
  }
}
