// hs-link --peer: moves, and feels what comes back.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "hs-link/closed.h"
#include "hs-link/teleoperator.h"
#include "io/csv.h"
#include "io/number.h"
#include "prepared_options.h"
#include "realtime/latency.h"
#include "realtime/motion_feed.h"
#include "realtime/motion_lines.h"
#include "safety/safety_words.h"
#include "stream_options.h"
#include "watch/identified_material.h"

namespace hapsim {

// One run of the operator: motion in, what is felt out, datagrams between.
class OperatorRun {
 public:
  OperatorRun(const Arguments& arguments, const UdpAddress& peer, OperatorEnd& end, Operator& near,
              std::ostream& out)
      : peer_(peer),
        end_(end),
        near_(near),
        out_(out),
        socket_(any_port_towards(peer)),
        channel_(impairment(arguments), static_cast<std::uint64_t>(arguments[flag::seed])),
        hold_(std::llround(1e9 * near.limits().hold)) {}

  // Whether the teleoperator has shaken hands, within `patience` [ns]. A motion that is wrong is
  // said without it.
  bool link(std::int64_t patience, const Input& input, const MotionFeed& feed) {
    for (const std::int64_t end = monotonic_ns() + patience;
         !end_.is_linked() && end_.refusal().empty() && monotonic_ns() < end &&
         !input.ended_by_signal();) {
      feed.require_sound();
      exchange();
      socket_.wait(std::min(channel_.next_due(), monotonic_ns() + 10'000'000));
    }
    return end_.is_linked();
  }

  void exchange() {
    const std::int64_t now = monotonic_ns();
    if (end_.tick(now, datagram_)) channel_.push(now, datagram_);
    // What waits may have come any time since all had been taken: where this process was stopped
    // meanwhile it is old, and no force may go on because of it.
    const std::int64_t came = emptied_ != 0 ? emptied_ : now;
    std::size_t size = 0;
    constexpr int kAtOnce = 256;  // a flood must not keep the loop from its clock
    int taken = 0;
    for (; taken < kAtOnce && (size = socket_.receive(buffer_, from_)) > 0; ++taken) {
      if (!(from_ == peer_)) {
        ++strangers_;
        continue;
      }
      if (const auto received = end_.receive(now, {buffer_.data(), size}))
        near_.receive(came, *received);
    }
    if (taken < kAtOnce) emptied_ = now;
    while (channel_.pop(now, datagram_)) socket_.send(peer_, datagram_.view());
  }

  void answer(const MotionLine& line) {
    exchange();
    const std::int64_t now = monotonic_ns();
    const Packet packet = near_.move(now, line);
    if (end_.write(packet, datagram_)) channel_.push(now, datagram_);
    write(line, near_.felt());
    exchange();
    last_ = line;
    moved_ = now;
  }

  // No motion has come: while the hand's last force is on its way to zero, what it gets is said.
  void rest() {
    exchange();
    const std::int64_t now = monotonic_ns();
    if (moved_ == 0 || now - moved_ <= hold_ || near_.felt().force == Vec3::Zero()) return;
    write(last_, near_.miss(now));
  }

  void end_by_signal() {
    if (moved_ != 0) write(last_, near_.end());
  }

  // Every line of the motion by the clock of `rate`, or as it comes (0).
  void run(MotionFeed& feed, Input& input, double rate, LatencyHistogram& latency, long& misses) {
    std::optional<Pacer> pacer;
    MotionLine line;
    while (!input.ended_by_signal()) {
      std::int64_t due = 0;
      if (pacer) due = pacer->wait();
      feed.clear_event();
      const bool ended = feed.has_ended();
      if (!feed.take(line)) {
        if (ended) return;
        rest();
        if (!pacer)
          socket_.wait(std::min(channel_.next_due(), monotonic_ns() + 1'000'000), feed.event());
        continue;
      }
      if (!pacer && rate > 0) {
        pacer.emplace(rate);
        due = pacer->wait();
      }
      if (!pacer) due = monotonic_ns();
      answer(line);
      const std::int64_t took = monotonic_ns() - due;
      latency.add(took);
      if (pacer && took > pacer->period()) ++misses;
    }
    end_by_signal();
  }

  // What is still on its way.
  void wait(double time) {
    const std::int64_t end = monotonic_ns() + std::llround(1e9 * time);
    while (monotonic_ns() < end) {
      socket_.wait(std::min(channel_.next_due(), monotonic_ns() + 10'000'000));
      exchange();
    }
  }

  const SafetyCounts& counts() const { return counts_; }
  long strangers() const { return strangers_; }

 private:
  void write(const MotionLine& line, const SafeSample& felt) {
    counts_.add(felt);
    write_force_line(text_, line, felt.force);
    text_.pop_back();
    append_columns(text_, near_.measured());
    text_ += near_.predicts() ? ",1," : ",0,";
    text_ += std::to_string(felt.flags);
    append_columns(text_, felt.unlimited);
    text_ += ',' + format_number(near_.energy_in()) + ',';
    if (!std::isnan(near_.measured_at())) text_ += format_number(near_.measured_at());
    text_ += '\n';
    out_ << text_;
    out_.flush();
  }

  UdpAddress peer_, from_;
  OperatorEnd& end_;
  Operator& near_;
  std::ostream& out_;
  UdpSocket socket_;
  ImpairedChannel channel_;
  std::int64_t hold_, moved_ = 0, emptied_ = 0;
  std::array<unsigned char, 2048> buffer_{};
  Datagram datagram_;
  MotionLine last_;
  SafetyCounts counts_;
  std::string text_;
  long strangers_ = 0;
};

inline void tell_quality(const Arguments& arguments, const Operator& near, const char* when,
                         std::size_t first, std::size_t last, double rate) {
  const FeltQuality q = felt_quality(near.record(), first, last, rate);
  if (q.peak <= 0) {
    say(arguments, "hs-link", fmt::format("{}: no force was felt ({} answers)", when, q.samples));
    return;
  }
  say(arguments, "hs-link",
      fmt::format("{}: felt {:.1f} ms behind the displacement, {:.1f} ms behind the body's "
                  "force; error {:.3g} N rms = {:.2f} % of the peak {:.3g} N ({} answers)",
                  when, 1e3 * q.lag, 1e3 * q.force_lag, q.rms, 100 * q.rms / q.peak, q.peak,
                  q.samples));
}

// What both sides have counted, and whether the hand got more than it put in.
inline std::string energy_words(const Operator& near) {
  const double bound = near.limits().energy_bound(near.period());
  std::string text = fmt::format(
      "energy: the hand put in {:.3g} mJ, the body has taken {:.3g} mJ; the hand was at most "
      "{:.3g} "
      "mJ ahead",
      1e3 * near.energy_in(), 1e3 * near.energy_there(), 1e3 * near.most_given());
  return text +
         (std::isfinite(bound) ? fmt::format(" (bound {:.3g})", 1e3 * bound) : " (no bound)");
}

inline int run_operator(const Arguments& arguments) {
  const UdpAddress peer = parse_address(arguments[flag::peer]);
  const Secret key = link_key(arguments, peer);
  Input input(arguments.input());
  MotionLines motion(input);
  motion.require_contact_points("press,t,x,y,z,ux,uy,uz");
  std::shared_ptr<Progress> progress;
  const PreparedBodyOptions options = prepared_options(
      arguments, stream_radius(arguments, motion.metadata(), input.name()), progress);
  const std::vector<double> times =
      parse_relaxation_times(arguments.list(flag::times), flag::times.name);
  const double nu = arguments[flag::nu], asked_rate = arguments[flag::rate];
  const double rate = asked_rate > 0 ? asked_rate : 1000;
  OperatorOptions operator_options;
  operator_options.rate = rate;
  operator_options.samples =
      arguments[flag::samples] > 0 ? arguments[flag::samples] : std::numeric_limits<long>::max();
  operator_options.limits = safety_limits(arguments);
  const TetMesh mesh = load_body(arguments);
  const PreparedBody body(mesh, unit_model(nu), options);
  progress.reset();
  tell_accuracy(arguments, "hs-link", body.field());
  motion.within(mesh.nodes);
  UnitResponse response(body, times);
  Terms terms = link_terms(mesh, options.tool_radius);
  if (arguments.given(flag::expect_model)) {
    Input expected(arguments[flag::expect_model]);
    terms.model = fingerprint_of(read_model(expected));
  }
  OperatorEnd end(key, terms);
  Operator near(response, operator_options);
  Metadata metadata = motion.metadata();
  metadata.set("felt", "forces over a network");
  Output output(arguments.output());
  std::vector<std::string> header = kForceColumns;
  header.insert(header.end(),
                {"mx", "my", "mz", "predicted", "safety", "ax", "ay", "az", "energy", "mt"});
  CsvWriter(output.stream(), metadata, header);
  input.end_on_signals();  // what was felt and identified until then is written
  OperatorRun run(arguments, peer, end, near, output.stream());
  LatencyHistogram latency;
  long misses = 0;
  {
    MotionFeed feed(motion, input);
    const bool linked = run.link(std::llround(1e9 * arguments[flag::patience]), input, feed);
    if (!end.refusal().empty())
      fail_input(to_text(peer), "the teleoperator refuses: " + end.refusal(),
                 "start both sides with the same version, tool and body");
    if (!linked)
      fail_io(to_text(peer), "nothing answered",
              "start hs-link --listen there first, with the same key, and an --idle longer than "
              "this one's start");
    say(arguments, "hs-link", enter_real_time());
    run.run(feed, input, asked_rate, latency, misses);
  }
  run.wait(2 * arguments[flag::delay] + 0.5);
  leave_real_time();
  output.commit();

  const auto line = [&](const std::string& said) { say(arguments, "hs-link", said); };
  line("operator: " + end.counts().summary() +
       (run.strangers() > 0 ? fmt::format(", {} from elsewhere", run.strangers()) : ""));
  if (const std::string cut = run.counts().summary(); !cut.empty()) line("safety: " + cut);
  line(energy_words(near));
  line(latency.summary() + fmt::format("; {} later than a period", misses));
  const std::size_t all = near.record().size();
  if (!near.predicts()) {
    tell_quality(arguments, near, "never identified", 0, all, rate);
  } else {
    const auto at = static_cast<std::size_t>(near.identified_at());
    const auto settled = at + static_cast<std::size_t>(5 * operator_options.blend * rate);
    tell_quality(arguments, near, "before identification", 0, at, rate);
    if (settled < all) tell_quality(arguments, near, "after it", settled, all, rate);
    const OnlineEstimate& found = near.estimate();
    line(fmt::format("identified after {:.2f} s in at most {:.3g} ms: {}",
                     static_cast<double>(at) / rate, 1e3 * near.longest_identification(),
                     moduli_words(found, times, 3)));
    if (arguments.given(flag::identified)) {
      Output identified(arguments[flag::identified]);
      write_model(identified.stream(), identified_model(found, times, nu));
      identified.commit();
    }
  }
  if (near.lost())
    fail_io(to_text(peer), "the teleoperator was silent at the end; the force had gone to zero",
            "see why it stopped; what was felt is written");
  return 0;
}

}  // namespace hapsim
