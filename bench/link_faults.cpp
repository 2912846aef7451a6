// bench_link_faults: what a hand feels while the link, the network or the other side goes wrong.
// Each fault is one session of 9 s or more on a clock of the bench's own, both ends and the network
// between them in this process: a tool presses a block, from 2 s on the fault is there, most until
// 3 s. One row a fault:
//   fault; most force and most change per ms at the hand; longest time in which there was a force
//   though no packet of the peer had come [ms]; what became of the session; whether all is as it
//   must be: no NaN, no force or step above its limit, zero within hold + ramp, and the session
//   goes on (a force again, answers) or is over for a reason that is told.
// Exit code 1 where one is not. `bench_link_faults NAME...`: those whose names contain one of
// these.
//
// `bench_link_faults hours N`: N hours at 1 kHz without a fault, as fast as they go. A row an hour:
// resident memory [MB], the hand's largest force and its mean [N], answers of that hour; then what
// memory has grown by since the second hour and how far the mean is from its; exit code 1 where
// that is more than 1 MB or 0.1 %. Recorded in bench/results/link-hours.txt.
#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <memory>

#include "base/random.h"
#include "effects/catalogue.h"
#include "link/impaired_channel.h"
#include "link/telepresence.h"
#include "realtime/force_loop.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

constexpr Secret kKey{3, 1, 4, 1, 5}, kWrong{2, 7, 1};
constexpr std::int64_t kMs = 1'000'000;
constexpr int kFrom = 2000, kUntil = 3000, kAfter = 6000;  // [ms]

Terms terms() {
  Terms t;
  t.tool_radius = 0.004;
  t.high = {0.08, 0.08, 0.04};
  t.model[0] = 1;
  return t;
}

Model model_of(double E, double E1) {
  Model model;
  model.parameters = effect_rows(*find_effect("elastic"), 1, {E, 0.45});
  if (E1 > 0)
    for (const Parameter& p : effect_rows(*find_effect("viscoelastic"), 1, {E1, 0.1}))
      model.parameters.push_back(p);
  return model;
}

const PreparedBody& body(bool hidden) {
  static const auto prepared = [](const Model& model) {
    PreparedBodyOptions options;
    options.tool_radius = 0.004;
    return std::make_unique<PreparedBody>(test::block_mesh({0.08, 0.08, 0.04}, 4, 4, 3, 1), model,
                                          options);
  };
  static const auto there = prepared(model_of(2.2e4, 6e3)), here = prepared(model_of(1, 0));
  return hidden ? *there : *here;
}

struct World;
struct Fault {
  std::string name;
  std::function<void(World&, int ms)> each = {};                 // of the time of the fault
  std::function<void(World&, Packet&)> motion = {}, force = {};  // changed by who has the key
  Impairment network = {0.01, 0, 0, 0, 0};
  Impairment bad = {0.01, 0, 0, 0, 0};  // while it lasts
  std::string over = {};                // a part of what is told where the session must not go on
  int until = kUntil;
  int end() const { return std::max(until + 3000, kUntil + kAfter); }
};

// Both sides, the network, and somebody beside it who sees and sends all.
struct World {
  World(const Fault& fault, const Terms& near_terms, const Secret& near_key, std::uint64_t first)
      : fault_(fault),
        near_end(near_key, near_terms, first),
        far_end(std::make_unique<TeleoperatorEnd>(kKey, terms(), first)) {
    OperatorOptions options;
    options.samples = 500;
    near = std::make_unique<Operator>(response, options);
    restart_far();
  }
  void restart_far() {
    far_end = std::make_unique<TeleoperatorEnd>(kKey, terms());
    far = std::make_unique<Teleoperator>(hidden, SafetyLimits(), terms().low, terms().high);
  }
  void to_far(const Datagram& d, std::uint16_t from = 1) {
    UdpAddress sender;
    sender.port = from;
    Datagram reply;
    const auto got = far_end->receive(now, sender, d.view(), reply);
    if (got.reply) send_back(reply);
    Packet answer;
    if (!got.received || !far->press(now, *got.received, answer)) return;
    if (lasts && fault_.force) fault_.force(*this, answer);
    if (far_end->write(answer, reply)) send_back(reply);
  }
  void to_near(const Datagram& d) {
    const auto got = near_end.receive(now, d.view());
    if (!got) return;
    near->receive(now, *got);
    heard = now;
  }
  void send_back(const Datagram& d) {
    seen_back.push_back(d);
    (lasts ? back_bad : back).push(now, d);
  }
  void send_out(const Datagram& d) {
    seen_out.push_back(d);
    (lasts ? out_bad : out).push(now, d);
  }
  // One ms: the hand moves, datagrams arrive. `changed`: what becomes of the motion on its way.
  void pass(int ms, const std::function<void(World&, Packet&)>& changed) {
    Datagram d;
    if (near_runs && near_end.tick(now, d)) send_out(d);
    if (near_runs) {
      Packet motion = near->move(now, line(ms));
      if (changed) changed(*this, motion);
      if (near_end.write(motion, d)) send_out(d);
      silent = 1e-6 * static_cast<double>(now - heard);
    }
    for (ImpairedChannel* way : {&out, &out_bad})
      while (way->pop(now, d))
        if (far_runs) to_far(d, address);
    if (far_runs) far->idle(now);
    const long before = near->answered();
    for (ImpairedChannel* way : {&back, &back_bad})
      while (way->pop(now, d))
        if (near_runs) to_near(d);
    answers = near->answered() - before;
    // Only what an eavesdropper could keep.
    for (std::vector<Datagram>* seen : {&seen_out, &seen_back})
      if (seen->size() > 20'000) seen->erase(seen->begin(), seen->begin() + 10'000);
  }
  MotionLine line(int ms) const {
    MotionLine l;
    l.t = 1e-3 * ms + skew;
    l.point = {0.04, 0.04, 0.04};
    l.u = {0, 0, -0.002 * std::min(1.0, 1e-3 * ms) * (1 + 0.5 * std::sin(4e-3 * ms))};
    return l;
  }

  const Fault& fault_;
  ForceLoop hidden{body(true)};
  UnitResponse response{body(false), {0.1}};
  OperatorEnd near_end;
  std::unique_ptr<TeleoperatorEnd> far_end;
  std::unique_ptr<Operator> near;
  std::unique_ptr<Teleoperator> far;
  ImpairedChannel out{fault_.network, 1}, back{fault_.network, 2}, out_bad{fault_.bad, 3},
      back_bad{fault_.bad, 4};
  std::vector<Datagram> seen_out, seen_back;  // by somebody beside the network
  Random random{9};
  std::int64_t now = 0, heard = 0;
  double silent = 0;  // how long no packet of the peer had come when the hand last moved [ms]
  long answers = 0;   // of this ms
  bool lasts = false, far_runs = true, near_runs = true;
  double skew = 0;
  std::uint16_t address = 1;
};

struct Row {
  double force = 0, step = 0, silent = 0;
  bool finite = true, fell = true, works = false;
  std::string state;
};

Row run(const Fault& fault, const Terms& near_terms = terms(), const Secret& near_key = kKey,
        std::uint64_t first = 1) {
  World w(fault, near_terms, near_key, first);
  const SafetyLimits limits;
  Row row;
  Vec3 before = Vec3::Zero();
  double late_force = 0;
  long late_answers = 0;
  for (int ms = 1; ms < fault.end(); ++ms) {
    w.now = kMs * (1000 + ms);
    w.lasts = ms >= kFrom && ms < fault.until;
    if (w.lasts && fault.each) fault.each(w, ms);
    w.pass(ms, w.lasts ? fault.motion : nullptr);
    if (w.near_runs) {
      const SafeSample& felt = w.near->felt();
      row.finite = row.finite && felt.force.allFinite() && felt.unlimited.allFinite();
      row.force = std::max(row.force, felt.force.norm());
      row.step = std::max(row.step, (felt.force - before).norm());
      before = felt.force;
      if (felt.force != Vec3::Zero()) row.silent = std::max(row.silent, w.silent);
      if (ms > fault.end() - 1000) late_force = std::max(late_force, felt.force.norm());
    }
    if (ms > fault.end() - 1000) late_answers += w.answers;
  }
  row.fell = row.silent <= 1e3 * (limits.hold + limits.ramp) + 1;
  const bool goes_on = late_answers > 500 && late_force > 0.5;
  if (!w.near_end.refusal().empty())
    row.state = "refused: " + w.near_end.refusal();
  else if (!w.near_end.is_linked())
    row.state = "nothing answered";
  else if (goes_on)
    row.state = "goes on";
  else if (w.near->lost())
    row.state = "lost, force zero";
  else
    row.state = "linked";
  row.works = fault.over.empty() ? goes_on : row.state.find(fault.over) != std::string::npos;
  return row;
}

Datagram changed(Datagram d, std::size_t at, Random& random) {
  d.bytes[at % d.size] ^= static_cast<unsigned char>(1U << random.integer(8));
  return d;
}

Datagram noise(std::size_t size, Random& random) {
  Datagram d;
  d.size = size;
  for (std::size_t i = 0; i < size; ++i)
    d.bytes[i] = static_cast<unsigned char>(random.integer(256));
  return d;
}

// Of the right form, with a number and without the key.
Datagram forged(Message message, std::uint64_t number, Random& random) {
  Datagram d = noise(message == Message::kPacket ? kSealedBytes : kHandshakeBytes, random);
  put_header(d.bytes.data(), message, number);
  return d;
}

std::vector<Fault> strangers() {
  std::vector<Fault> all;
  const auto both = [&](const std::string& name,
                        const std::function<Datagram(World&, bool to_far)>& make, int times = 1) {
    all.push_back({name + ", to the teleoperator", [=](World& w, int) {
                     for (int i = 0; i < times; ++i) w.to_far(make(w, true), 666);
                   }});
    all.push_back({name + ", to the operator", [=](World& w, int) {
                     for (int i = 0; i < times; ++i) w.to_near(make(w, false));
                   }});
  };
  both("noise of any length",
       [](World& w, bool) { return noise(w.random.integer(257), w.random); });
  for (const auto& [name, number] : std::vector<std::pair<std::string, std::uint64_t>>{
           {"2^32 - 1", 0xFFFFFFFF}, {"2^64 - 1", ~std::uint64_t{0}}, {"1", 1}, {"0", 0}})
    both("forged packet of number " + name,
         [number = number](World& w, bool) { return forged(Message::kPacket, number, w.random); });
  both("forged hello", [](World& w, bool) { return forged(Message::kHello, 0, w.random); });
  both("forged welcome", [](World& w, bool) { return forged(Message::kWelcome, 0, w.random); });
  const auto last = [](World& w, bool to_far) {
    return (to_far ? w.seen_out : w.seen_back).back();
  };
  const auto other = [](World& w, bool to_far) {
    return (to_far ? w.seen_back : w.seen_out).back();
  };
  const auto first = [](World& w, bool to_far) {
    return (to_far ? w.seen_out : w.seen_back).front();
  };
  for (const auto& [name, from, to] :
       std::vector<std::tuple<std::string, std::size_t, std::size_t>>{
           {"header", 0, 8}, {"number", 8, 16}, {"text", 16, 112}, {"tag", 112, 128}})
    both("a bit turned in the " + name, [=, from = from, to = to](World& w, bool to_far) {
      return changed(last(w, to_far), from + w.random.integer(to - from), w.random);
    });
  both("cut packet", [=](World& w, bool to_far) {
    Datagram d = last(w, to_far);
    d.size = w.random.integer(d.size);
    return d;
  });
  both("longer packet", [=](World& w, bool to_far) {
    Datagram d = last(w, to_far);
    d.size += 1 + w.random.integer(100);
    return d;
  });
  both("every packet repeated", last);
  both("an old packet repeated", [](World& w, bool to_far) {
    auto& seen = to_far ? w.seen_out : w.seen_back;
    return seen[w.random.integer(seen.size())];
  });
  both("packets sent back to who sent them", other);
  both("the first datagram repeated", first);
  all.push_back(
      {"old hello from elsewhere", [](World& w, int) { w.to_far(w.seen_out.front(), 666); }});
  all.push_back({"flood of noise, 100,000/s for 10 s, teleoperator", [](World& w, int) {
                   for (int i = 0; i < 100; ++i) w.to_far(noise(128, w.random), 666);
                 }});
  all.back().until = kFrom + 10'000;
  all.push_back({"flood of forged packets, 100,000/s for 10 s, operator", [](World& w, int) {
                   for (int i = 0; i < 100; ++i)
                     w.to_near(forged(Message::kPacket, w.random.integer(1u << 31), w.random));
                 }});
  all.back().until = kFrom + 10'000;
  all.push_back({"flood of forged hellos, 100,000/s for 10 s", [](World& w, int) {
                   for (int i = 0; i < 100; ++i)
                     w.to_far(forged(Message::kHello, 0, w.random), 666);
                 }});
  all.back().until = kFrom + 10'000;
  all.push_back({"flood of repeated motions, 100,000/s for 10 s", [=](World& w, int) {
                   for (int i = 0; i < 100; ++i)
                     w.to_far(w.seen_out[w.random.integer(w.seen_out.size())], 666);
                 }});
  all.back().until = kFrom + 10'000;
  return all;
}

// Of a peer that has the key and sends what is impossible.
std::vector<Fault> peers() {
  std::vector<Fault> all;
  const std::vector<std::string> motion{"t", "x", "y", "z", "ux", "uy", "uz", "energy"},
      force{"t", "fx", "fy", "fz", "ax", "ay", "az", "energy"};
  const auto set = [](Packet& p, std::size_t field, double value) {
    if (field == 0)
      p.t = value;
    else if (field < 4)
      p.first[static_cast<Eigen::Index>(field) - 1] = value;
    else if (field < 7)
      p.second[static_cast<Eigen::Index>(field) - 4] = value;
    else
      p.energy = value;
  };
  for (const auto& [name, value] :
       std::vector<std::pair<std::string, double>>{{"NaN", std::nan("")}, {"infinity", INFINITY}})
    for (std::size_t field = 0; field < 8; ++field) {
      all.push_back({name + " as " + motion[field] + " of motions"});
      all.back().motion = [=, value = value](World&, Packet& p) { set(p, field, value); };
      all.push_back({name + " as " + force[field] + " of forces"});
      all.back().force = [=, value = value](World&, Packet& p) { set(p, field, value); };
    }
  const auto of_force = [&](const std::string& name,
                            const std::function<void(World&, Packet&)>& f) {
    all.push_back({name});
    all.back().force = f;
  };
  const auto of_motion = [&](const std::string& name,
                             const std::function<void(World&, Packet&)>& f) {
    all.push_back({name});
    all.back().motion = f;
  };
  of_force("force of 99,999 N", [](World&, Packet& p) { p.first = {0, 0, 99'999}; });
  of_force("force that leaps by 50 N at each sample", [](World&, Packet& p) {
    p.first = {0, 0, p.number % 2 == 0 ? 50.0 : -50.0};
  });
  of_force("answers of motions that were never sent",
           [](World&, Packet& p) { p.answers += 1 << 30; });
  of_force("answers of another press", [](World&, Packet& p) {
    p.answers = 1;
    p.first *= 5;
  });
  of_force("forces without flags of a body ten times as stiff",
           [](World&, Packet& p) { p.first *= 10; });
  of_motion("displacement of -9.9 m", [](World&, Packet& p) { p.second = {0, 0, -9.9}; });
  of_motion("contact point 5 m away", [](World&, Packet& p) { p.first.x() += 5; });
  of_motion("tool that leaps by 20 mm",
            [](World&, Packet& p) { p.second.z() -= p.number % 2 == 0 ? 0.02 : 0; });
  of_motion("motion in the air and back", [](World&, Packet& p) { p.in_air = p.number % 20 < 10; });
  of_motion("a new press at every motion",
            [](World&, Packet& p) { p.press = static_cast<std::int32_t>(p.number); });
  of_motion("numbers that do not go on", [](World&, Packet& p) { p.number = 5; });
  all.push_back({"operator's clock an hour ahead", [](World& w, int) { w.skew = 3600; }});
  all.push_back({"operator's clock an hour back", [](World& w, int) { w.skew = -3600; }});
  all.push_back(
      {"operator's clock set every ms", [](World& w, int ms) { w.skew = ms % 2 == 0 ? 7 : -7; }});
  return all;
}

std::vector<Fault> networks() {
  std::vector<Fault> all;
  const auto bad = [&](const std::string& name, const Impairment& impairment, int until = kUntil) {
    all.push_back({name});
    all.back().bad = impairment;
    all.back().until = until;
  };
  bad("loss of 20 %", {0.01, 0, 0.2, 0, 0});
  bad("loss of 50 %", {0.01, 0, 0.5, 0, 0});
  bad("loss of 90 %", {0.01, 0, 0.9, 0, 0});
  bad("outage of 0.2 s", {0, 0, 1, 0, 0}, kFrom + 200);
  bad("outage of 1 s", {0, 0, 1, 0, 0});
  bad("outage of 4 s", {0, 0, 1, 0, 0}, kFrom + 4000);
  bad("delay of 0.3 s each way", {0.3, 0, 0, 0, 0});
  bad("jitter of 100 ms", {0.01, 0.1, 0, 0, 0});
  bad("half doubled, half reordered", {0.02, 0.02, 0, 0.5, 0.5});
  bad("all at once: 0.3 s, jitter, 30 % loss, doubled, reordered", {0.3, 0.05, 0.3, 0.2, 0.2});
  all.push_back({"slow from the start: 0.3 s each way, 20 % loss"});
  all.back().network = all.back().bad = {0.3, 0.02, 0.2, 0, 0};
  return all;
}

std::vector<Fault> processes() {
  std::vector<Fault> all;
  all.push_back({"teleoperator killed for good", [](World& w, int) { w.far_runs = false; }});
  all.back().over = "lost, force zero";
  all.push_back({"teleoperator killed, another begun after 1 s", [](World& w, int ms) {
                   w.far_runs = ms == kUntil - 1;
                   if (w.far_runs) w.restart_far();
                 }});
  all.push_back({"teleoperator restarted at once", [](World& w, int ms) {
                   if (ms == kFrom) w.restart_far();
                 }});
  all.push_back({"teleoperator stopped for 1 s, then goes on",
                 [](World& w, int ms) { w.far_runs = ms == kUntil - 1; }});
  all.push_back({"operator stopped for 1 s, then goes on",
                 [](World& w, int ms) { w.near_runs = ms == kUntil - 1; }});
  all.push_back({"operator restarted", [](World& w, int ms) {
                   if (ms == kFrom) w.near_end = OperatorEnd(kKey, terms());
                 }});
  all.push_back({"operator's address changes", [](World& w, int) { w.address = 77; }});
  all.push_back({"second operator with the key", [](World& w, int ms) {
                   static std::unique_ptr<OperatorEnd> second;
                   if (ms == kFrom) second = std::make_unique<OperatorEnd>(kKey, terms());
                   Datagram d, reply;
                   if (!second->tick(w.now, d)) return;
                   if (w.far_end->receive(w.now, {}, d.view(), reply).reply)
                     second->receive(w.now, reply.view());
                   if (second->write({}, d)) w.to_far(d, 88);
                 }});
  return all;
}

bool told(const Fault& fault, const Row& row) {
  const SafetyLimits limits;
  const bool good = row.finite && row.force <= limits.force * (1 + 1e-12) &&
                    row.step <= limits.rate * 1e-3 * (1 + 1e-9) && row.fell && row.works;
  fmt::print("{:<62} {:>7.3f} N {:>7.4f} N {:>6.0f} ms  {:<60} {}\n", fault.name, row.force,
             row.step, row.silent, row.state.substr(0, 60), good ? "ok" : "WRONG");
  std::fflush(stdout);
  return good;
}

double resident_megabytes() {
  std::ifstream status("/proc/self/statm");
  double all = 0, resident = 0;
  status >> all >> resident;
  return resident * 4096 / 1e6;
}

int hours(int count) {
  const Fault none{"none"};
  World w(none, terms(), kKey, 1);
  fmt::print("{:>5} {:>9} {:>9} {:>12} {:>10}\n", "hour", "MB", "most N", "mean N", "answers");
  constexpr int kHour = 3'600'000;
  double first_memory = 0, memory = 0, first_mean = 0, mean = 0;
  for (int hour = 1; hour <= count; ++hour) {
    double most = 0, sum = 0;
    long answers = 0;
    for (int k = 0; k < kHour; ++k) {
      const int ms = 1 + (hour - 1) * kHour + k;
      w.now = kMs * (1000 + static_cast<std::int64_t>(ms));
      w.pass(ms, nullptr);
      const double force = w.near->felt().force.norm();
      most = std::max(most, force);
      sum += force;
      answers += w.answers;
    }
    memory = resident_megabytes();
    mean = sum / kHour;
    if (hour <= 2) {
      first_memory = memory;
      first_mean = mean;
    }
    fmt::print("{:>5} {:>9.2f} {:>9.4f} {:>12.8f} {:>10}\n", hour, memory, most, mean, answers);
    std::fflush(stdout);
  }
  const double growth = memory - first_memory, drift = mean / first_mean - 1;
  fmt::print("since the second hour: memory {:+.2f} MB, mean force {:+.4f} %\n", growth,
             100 * drift);
  return growth <= 1 && std::abs(drift) <= 1e-3 ? 0 : 1;
}

int run_all(const std::vector<std::string>& wanted) {
  const auto asked = [&](const std::string& name) {
    for (const std::string& part : wanted)
      if (name.find(part) != std::string::npos) return true;
    return wanted.empty();
  };
  int faults = 0, wrong = 0;
  const auto count = [&](const Fault& fault, const Row& row) {
    ++faults;
    wrong += told(fault, row) ? 0 : 1;
  };
  std::vector<Fault> all{{"none"}};
  for (const auto& group : {strangers(), peers(), networks(), processes()})
    all.insert(all.end(), group.begin(), group.end());
  for (const Fault& fault : all)
    if (asked(fault.name)) count(fault, run(fault));
  for (const auto& [name, first] : std::vector<std::pair<std::string, std::uint64_t>>{
           {"numbers that pass 2^32", (std::uint64_t{1} << 32) - 2500},
           {"numbers that are used up after 3 s", ~std::uint64_t{0} - 3000}})
    if (const Fault fault{name}; asked(name)) count(fault, run(fault, terms(), kKey, first));
  struct Apart {
    std::string name;
    std::function<void(Terms&)> change;
    std::string told;
  };
  for (const Apart& apart : std::vector<Apart>{
           {"wrong version", [](Terms& t) { t.version = 9; }, "refused: its link has version"},
           {"wrong units",
            [](Terms& t) {
              t.units = {'m', 'm'};
            },
            "refused: its units"},
           {"wrong tool", [](Terms& t) { t.tool_radius = 0.01; }, "refused: its tool"},
           {"wrong body", [](Terms& t) { t.high.z() = 0.4; }, "refused: its body"},
           {"body that is no number", [](Terms& t) { t.low.x() = NAN; }, "refused: its body"},
           {"wrong model", [](Terms& t) { t.model[0] = 2; }, "refused: its model"}})
    if (asked(apart.name)) {
      Fault fault{apart.name};
      fault.over = apart.told;
      Terms t = terms();
      apart.change(t);
      count(fault, run(fault, t));
    }
  if (Fault fault{"wrong key"}; asked(fault.name)) {
    fault.over = "nothing answered";
    count(fault, run(fault, terms(), kWrong));
  }
  fmt::print("{} faults, {} not as they must be\n", faults, wrong);
  return wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  if (argc == 3 && std::string(argv[1]) == "hours") return hapsim::hours(std::stoi(argv[2]));
  return hapsim::run_all({argv + 1, argv + argc});
}
