// hs-link: an operator and a teleoperator, two processes over UDP.
#include <fmt/format.h>

#include <random>

#include "base/error.h"
#include "base/random.h"
#include "common_options.h"
#include "hs-link/flags.h"
#include "hs-link/specification.h"
#include "io/csv.h"
#include "io/interrupt.h"
#include "link/impaired_channel.h"
#include "link/telepresence.h"
#include "link/udp.h"
#include "prepared_options.h"
#include "realtime/force_loop.h"
#include "realtime/latency.h"
#include "realtime/motion_lines.h"
#include "realtime/real_time.h"
#include "stream_options.h"
#include "watch/identified_material.h"

namespace hapsim {
namespace {

Impairment impairment(const Arguments& a) {
  return {a[flag::delay], a[flag::jitter], a[flag::loss], a[flag::duplicate], a[flag::reorder]};
}

// Of this process: another after a restart.
std::uint64_t draw_sender() {
  std::random_device device;
  return (static_cast<std::uint64_t>(device()) << 32) ^ device();
}

int run_teleoperator(const Arguments& arguments) {
  for (const AnyFlag& flag : AnyFlags{flag::model, flag::tool_radius})
    if (!arguments.given(flag))
      fail_usage("a teleoperator needs " + flag, "give it: it has a body to press");
  Input model_input(arguments[flag::model]);
  const Model model = read_model(model_input);
  std::shared_ptr<Progress> progress;
  const PreparedBodyOptions options =
      prepared_options(arguments, arguments[flag::tool_radius], progress);
  const PreparedBody body(load_body(arguments), model, options);
  progress.reset();
  tell_accuracy(arguments, "hs-link", body.field());
  ToolLoopOptions hand;
  hand.sensor = false;
  hand.fitted_depth = fitted_depth(model);
  ForceLoop loop(body, hand);
  UdpSocket socket(parse_address(arguments[flag::listen]));
  say(arguments, "hs-link", "listening at " + to_text(socket.address()));
  Teleoperator far(loop, draw_sender());
  ImpairedChannel channel(impairment(arguments),
                          static_cast<std::uint64_t>(arguments[flag::seed]) + 1000);
  const Interrupt interrupt;
  Random random(static_cast<std::uint64_t>(arguments[flag::seed]));
  const double noise = arguments[flag::add_noise];
  const double idle = arguments[flag::idle];
  std::array<unsigned char, 2048> buffer{};
  UdpAddress from, peer;
  Packet answer;
  PacketBytes bytes;
  for (std::int64_t heard = monotonic_ns(); !interrupt.asked();) {
    std::int64_t now = monotonic_ns();
    if (idle > 0 && now - heard > std::llround(1e9 * idle)) break;
    socket.wait(std::min(channel.next_due(), now + 100'000'000));
    now = monotonic_ns();
    while (const std::size_t size = socket.receive(buffer, from)) {
      if (!far.receive(now, {buffer.data(), size}, answer)) continue;
      heard = now;
      peer = from;
      for (int k = 0; k < 3; ++k) answer.first[k] += noise * random.normal();
      channel.push(now, write_packet(answer));
    }
    while (channel.pop(now, bytes)) socket.send(peer, bytes);
  }
  say(arguments, "hs-link", "teleoperator: " + far.counts().summary());
  return 0;
}

int run_operator(const Arguments& arguments) {
  Input input(arguments.input());
  MotionLines motion(input);
  motion.require_contact_points("press,t,x,y,z,ux,uy,uz");
  std::shared_ptr<Progress> progress;
  const PreparedBodyOptions options = prepared_options(
      arguments, stream_radius(arguments, motion.metadata(), input.name()), progress);
  const std::vector<double> times =
      parse_relaxation_times(arguments.list(flag::times), flag::times.name);
  const double nu = arguments[flag::nu], rate = arguments[flag::rate];
  const PreparedBody body(load_body(arguments), unit_model(nu), options);
  progress.reset();
  tell_accuracy(arguments, "hs-link", body.field());
  UnitResponse response(body, times);
  OperatorOptions operator_options;
  operator_options.rate = rate;
  operator_options.samples =
      arguments[flag::samples] > 0 ? arguments[flag::samples] : std::numeric_limits<long>::max();
  std::vector<MotionLine> lines;  // read beforehand: a file must not hold up the clock
  for (MotionLine line; motion.next(line);) lines.push_back(line);
  Operator near(response, draw_sender(), operator_options, lines.size());
  const UdpAddress peer = parse_address(arguments[flag::peer]);
  UdpSocket socket({peer.host == 0x7F000001 ? peer.host : 0, 0});
  ImpairedChannel channel(impairment(arguments), static_cast<std::uint64_t>(arguments[flag::seed]));
  Metadata metadata = motion.metadata();
  metadata.set("felt", "forces over a network");
  Output output(arguments.output());
  std::vector<std::string> header = kForceColumns;
  header.insert(header.end(), {"mx", "my", "mz", "predicted"});
  CsvWriter(output.stream(), metadata, header);
  say(arguments, "hs-link", enter_real_time());

  std::array<unsigned char, 2048> buffer{};
  PacketBytes bytes;
  UdpAddress from;
  long strangers = 0;
  const auto exchange = [&](std::int64_t now) {
    while (channel.pop(now, bytes)) socket.send(peer, bytes);
    while (const std::size_t size = socket.receive(buffer, from)) {
      if (from == peer)
        near.receive({buffer.data(), size});
      else
        ++strangers;
    }
  };
  const Interrupt interrupt;  // what was felt and identified until then is written
  Pacer pacer(rate);
  LatencyHistogram latency;
  long misses = 0;
  std::string text;
  for (const MotionLine& line : lines) {
    if (interrupt.asked()) break;
    const std::int64_t due = pacer.wait();
    exchange(monotonic_ns());
    channel.push(monotonic_ns(), write_packet(near.move(line)));
    write_force_line(text, line, near.felt());
    text.pop_back();
    append_columns(text, near.measured());
    text += near.predicts() ? ",1\n" : ",0\n";
    output.stream() << text;
    output.stream().flush();
    exchange(monotonic_ns());
    const std::int64_t took = monotonic_ns() - due;
    latency.add(took);
    if (took > pacer.period()) ++misses;
  }
  // What is still on its way.
  const std::int64_t end = monotonic_ns() + std::llround(1e9 * (2 * arguments[flag::delay] + 0.5));
  while (monotonic_ns() < end) {
    socket.wait(std::min(channel.next_due(), monotonic_ns() + 10'000'000));
    exchange(monotonic_ns());
  }
  leave_real_time();
  if (near.counts().taken == 0)
    fail_io(to_text(peer), "nothing answered",
            "start hs-link --listen there first, with an --idle longer than this one's start");
  output.commit();

  const auto line = [&](const std::string& said) { say(arguments, "hs-link", said); };
  line("operator: " + near.counts().summary() +
       (strangers > 0 ? fmt::format(", {} from elsewhere", strangers) : ""));
  line(latency.summary() + fmt::format("; {} later than a period", misses));
  const auto quality = [&](const char* when, std::size_t first, std::size_t last) {
    const FeltQuality q = felt_quality(near.record(), first, last, rate);
    if (q.peak <= 0) {
      line(fmt::format("{}: no force was felt ({} answers)", when, q.samples));
      return;
    }
    line(fmt::format(
        "{}: felt {:.1f} ms behind the displacement, {:.1f} ms behind the body's "
        "force; error {:.3g} N rms = {:.2f} % of the peak {:.3g} N ({} answers)",
        when, 1e3 * q.lag, 1e3 * q.force_lag, q.rms, 100 * q.rms / q.peak, q.peak, q.samples));
  };
  const std::size_t all = near.record().size();
  if (!near.predicts()) {
    quality("never identified", 0, all);
    return 0;
  }
  const auto at = static_cast<std::size_t>(near.identified_at());
  const auto settled = at + static_cast<std::size_t>(5 * operator_options.blend * rate);
  quality("before identification", 0, at);
  if (settled < all) quality("after it", settled, all);
  const OnlineEstimate& found = near.estimate();
  line(fmt::format("identified after {:.2f} s in at most {:.3g} ms: {}",
                   static_cast<double>(at) / rate, 1e3 * near.longest_identification(),
                   moduli_words(found, times, 3)));
  if (arguments.given(flag::identified)) {
    Output identified(arguments[flag::identified]);
    write_model(identified.stream(), identified_model(found, times, nu));
    identified.commit();
  }
  return 0;
}

int run(const Arguments& arguments) {
  if (arguments.given(flag::listen) == arguments.given(flag::peer))
    fail_usage("it is either a teleoperator or an operator", "give --listen or --peer");
  return arguments.given(flag::listen) ? run_teleoperator(arguments) : run_operator(arguments);
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::link_specification(), argc, argv, hapsim::run);
}
