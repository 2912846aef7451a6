// bench_link_energy [SESSIONS [SEED]]: how much energy a hand gets over a bad network, with and
// without the passivity of lib/safety/energy_budget.h. A session is 10 s of a hand that is free to
// be moved by what it feels: a mass with damper and spring after a drive that presses a block, all
// drawn at random, with the network (0 to 600 ms each way, jitter, up to 20 % lost) and the body
// (200 to 5,000 N/m, with or without relaxation). Every second session may identify the body. Each
// runs twice with the same chance, once without the limit of energy. Exit code 1 where one with it
// gains more than the bound.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <vector>

#include "base/random.h"
#include "effects/catalogue.h"
#include "link/impaired_channel.h"
#include "link/telepresence.h"
#include "realtime/force_loop.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr int kSamples = 10'000, kSteps = 10;  // [ms]; of the hand within one
constexpr double kTop = 0.04, kRadius = 0.004;
constexpr std::array<double, 5> kModuli{2e4, 5e4, 1e5, 2e5, 5e5};  // [Pa]

Model model_of(double E, bool relaxes) {
  Model model;
  model.parameters = effect_rows(*find_effect("elastic"), 1, {E, 0.45});
  if (relaxes)
    for (const Parameter& p : effect_rows(*find_effect("viscoelastic"), 1, {0.3 * E, 0.2}))
      model.parameters.push_back(p);
  return model;
}

std::unique_ptr<PreparedBody> prepared(const Model& model) {
  PreparedBodyOptions options;
  options.tool_radius = kRadius;
  options.most_samples = 16;
  options.rim_edge = 0.5;
  return std::make_unique<PreparedBody>(test::block_mesh({0.08, 0.08, kTop}, 4, 4, 3, 1), model,
                                        options);
}

struct Session {
  double mass, damper, spring;  // of hand and device [kg], [N s/m], [N/m]
  double depth, frequency, aside, aside_frequency;
  Impairment network;
  std::size_t body;
  bool identifies;
};

Session random_session(Random& random) {
  const auto between = [&](double low, double high) {
    return low * std::pow(high / low, random.uniform());
  };
  Session s{};
  s.mass = between(0.1, 1.5);
  s.damper = between(1, 20);
  s.spring = between(30, 500);
  s.depth = between(0.003, 0.02);
  s.frequency = between(0.1, 2);
  s.aside = 0.3 * s.depth * random.uniform();
  s.aside_frequency = between(0.1, 3);
  s.network = {0.6 * random.uniform(), 0.05 * random.uniform(), 0.2 * random.uniform(),
               0.02 * random.uniform(), 0.02 * random.uniform()};
  s.body = random.integer(2 * kModuli.size());
  return s;
}

struct Run {
  double net = 0, gain = 0, speed = 0, late_speed = 0, strongest = 0;
  double near = 0, there = 0;  // energies that both sides have counted at the end [J]
  long late_touched = 0;
  double felt = 0, asked = 0;  // of the last 2 s
  bool predicts = false;
};

Run run(const Session& s, PreparedBody& there, PreparedBody& here, std::uint64_t seed,
        const SafetyLimits& limits) {
  ForceLoop hidden(there);
  UnitResponse response(here, {0.2});
  OperatorOptions options;
  options.samples = s.identifies ? 1500 : 1'000'000'000;
  options.remember = 1;
  options.limits = limits;
  Operator near(response, options);
  Teleoperator far(hidden, limits, {0, 0, 0}, {0.08, 0.08, kTop});
  ImpairedChannel out(s.network, seed), back(s.network, seed + 1'000'000);
  Run r;
  Vec3 x(0.04, 0.04, kTop + 0.005), v = Vec3::Zero(), force = Vec3::Zero();
  MotionLine line;
  line.press = 0;
  line.in_air = true;
  Datagram d;
  Packet packet;
  std::uint64_t newest_there = 0, newest_here = 0;
  double work = 0, taken = 0;
  const double w = 2 * M_PI * s.frequency, w_aside = 2 * M_PI * s.aside_frequency;
  for (int ms = 0; ms < kSamples; ++ms) {
    const Vec3 x_before = x;
    for (int i = 0; i < kSteps; ++i) {
      const double h = 1e-3 / kSteps, t = 1e-3 * ms + h * i;
      const Vec3 drive(0.04 + s.aside * std::sin(w_aside * t), 0.04,
                       kTop + 0.005 - (s.depth + 0.005) * 0.5 * (1 - std::cos(w * t)));
      v += h / s.mass * (s.spring * (drive - x) - s.damper * v + force);
      x += h * v;
    }
    const Vec3 dx = x - x_before;
    work += force.dot(dx);
    taken += limits.damping * dx.squaredNorm() / 1e-3;
    r.gain = std::max(r.gain, work);
    r.net = std::max(r.net, work - taken);
    r.speed = std::max(r.speed, 1e3 * dx.norm());
    if (ms > kSamples - 2000) r.late_speed = std::max(r.late_speed, 1e3 * dx.norm());
    const std::int64_t now = kMs * (1000 + ms);
    // A touch begins a press; in the air it is the last one's.
    const bool in_air = x.z() >= kTop;
    if (line.press == 0 || (line.in_air && !in_air)) {
      ++line.press;
      line.point = {x.x(), x.y(), kTop};
    }
    line.in_air = in_air;
    line.t = 1e-3 * ms;
    line.u = x - line.point;
    const Packet motion = near.move(now, line);
    force = near.felt().force;
    r.strongest = std::max(r.strongest, force.norm());
    const bool is_touched = (near.felt().flags & kSafeEnergy) != 0;
    if (ms >= kSamples - 2000) {
      r.late_touched += is_touched;
      r.felt += (near.felt().unlimited - force).norm();
      r.asked += near.felt().unlimited.norm();
    }
    out.push(now, Datagram(write_packet(motion)));
    while (out.pop(now, d)) {
      Received got;
      if (!read_packet(d.view(), got.packet)) continue;
      got.is_anew = newest_there == 0;
      got.is_newest = got.packet.number > newest_there;
      newest_there = std::max(newest_there, got.packet.number);
      if (far.press(now, got, packet)) back.push(now, Datagram(write_packet(packet)));
    }
    far.idle(now);
    while (back.pop(now, d)) {
      Received got;
      if (!read_packet(d.view(), got.packet)) continue;
      got.is_anew = newest_here == 0;
      got.is_newest = got.packet.number > newest_here;
      newest_here = std::max(newest_here, got.packet.number);
      near.receive(now, got);
    }
  }
  r.predicts = near.predicts();
  r.near = near.energy_in();
  r.there = near.energy_there();
  return r;
}

struct Group {
  long sessions = 0, over = 0, over_limited = 0, above = 0;
  double most = -1, most_limited = -1, raw = -1, raw_limited = -1;
  std::vector<double> touched, changed, speed, speed_limited;  // touched: of the last 2 s [%]
};

double median(std::vector<double> v) {
  if (v.empty()) return 0;
  std::nth_element(v.begin(), v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

int bench(int sessions, std::uint64_t seed) {
  const auto begun = std::chrono::steady_clock::now();
  std::vector<std::unique_ptr<PreparedBody>> bodies;
  for (const double E : kModuli)
    for (const bool relaxes : {false, true}) bodies.push_back(prepared(model_of(E, relaxes)));
  const auto here = prepared(model_of(1, false));
  const SafetyLimits limits;
  const double bound = limits.energy_bound();
  Random random(seed);
  const std::array<double, 5> edges{0.01, 0.1, 0.3, 0.6, 10};
  std::array<Group, 5> groups;
  Group all, known, unknown;
  long fast = 0;
  for (int i = 0; i < sessions; ++i) {
    Session s = random_session(random);
    s.identifies = i % 2 == 1;
    const std::uint64_t chance = seed + 10 + static_cast<std::uint64_t>(2 * i);
    const Run free = run(s, *bodies[s.body], *here, chance, of_any_energy(limits));
    const Run limited = run(s, *bodies[s.body], *here, chance, limits);
    // Whoever goes faster than the limit of speed has another bound: told apart.
    const bool is_fast = limited.speed > limits.speed;
    fast += is_fast;
    std::size_t g = 0;
    while (s.network.delay > edges[g]) ++g;
    for (Group* group : {&groups[g], limited.predicts ? &known : &unknown, &all}) {
      ++group->sessions;
      group->over += free.net > bound;
      group->over_limited += limited.net > (limited.predicts ? 2 : 1) * bound;
      group->most = std::max(group->most, free.net);
      group->most_limited = std::max(group->most_limited, limited.net);
      group->raw = std::max(group->raw, free.gain);
      group->raw_limited = std::max(group->raw_limited, limited.gain);
      group->touched.push_back(static_cast<double>(limited.late_touched) / 20);
      if (limited.asked > 0) group->changed.push_back(100 * limited.felt / limited.asked);
      group->speed.push_back(free.late_speed);
      group->speed_limited.push_back(limited.late_speed);
    }
  }
  fmt::print(
      "bound {:.1f} mJ beyond what {:g} N s/m of the hand took; force {:g} N, {:g} N/s, "
      "hand to {:g} m/s; twice where the body was identified\n\n",
      1e3 * bound, limits.damping, limits.force, limits.rate, limits.speed);
  fmt::print(
      "{:>15} {:>8} | {:>12} {:>10} {:>10} {:>11} | {:>12} {:>10} {:>10} {:>11} {:>9} {:>9}\n",
      "delay each way", "sessions", "over without", "most [mJ]", "raw [mJ]", "late [m/s]",
      "over with it", "most [mJ]", "raw [mJ]", "late [m/s]", "touched %", "changed %");
  const auto row = [](const std::string& name, const Group& g) {
    if (g.sessions == 0) return;
    fmt::print(
        "{:>15} {:>8} | {:>12} {:>10.1f} {:>10.1f} {:>11.3f} | {:>12} {:>10.2f} {:>10.2f} "
        "{:>11.3f} {:>9.1f} {:>9.1f}\n",
        name, g.sessions, g.over, 1e3 * g.most, 1e3 * g.raw, median(g.speed), g.over_limited,
        1e3 * g.most_limited, 1e3 * g.raw_limited, median(g.speed_limited), median(g.touched),
        median(g.changed));
  };
  const std::array<const char*, 5> names{"to 10 ms", "to 100 ms", "to 300 ms", "to 600 ms", ""};
  for (std::size_t g = 0; g < groups.size(); ++g) row(names[g], groups[g]);
  row("identified", known);
  row("not identified", unknown);
  row("all", all);
  fmt::print(
      "\nmost: largest energy given less what that damping took; raw: with it; late: median "
      "of the hand's\nlargest speed in the last 2 s; touched: median of samples that were "
      "damped or cut\n");
  fmt::print("with it the hand was faster than {:g} m/s in {} of {} sessions\n", limits.speed, fast,
             sessions);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  fmt::print("{:.0f} s\n", took.count());
  return all.over_limited > 0 ? 1 : 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::bench(argc > 1 ? std::atoi(argv[1]) : 1000,
                       argc > 2 ? static_cast<std::uint64_t>(std::atoll(argv[2])) : 1);
}
