// hs-link --listen: presses a body by what an operator far away does.
#pragma once

#include <fmt/format.h>

#include "base/random.h"
#include "experiment/contact_radius.h"
#include "hs-link/closed.h"
#include "io/interrupt.h"
#include "link/impaired_channel.h"
#include "link/telepresence.h"
#include "prepared_options.h"
#include "realtime/force_loop.h"
#include "realtime/real_time.h"
#include "safety/safety_options.h"

namespace hapsim {

inline Impairment impairment(const Arguments& a) {
  return {a[flag::delay], a[flag::jitter], a[flag::loss], a[flag::duplicate], a[flag::reorder]};
}

inline int run_teleoperator(const Arguments& arguments) {
  for (const AnyFlag& flag : AnyFlags{flag::model, flag::tool_radius})
    if (!arguments.given(flag))
      fail_usage("a teleoperator needs " + flag, "give it: it has a body to press");
  const UdpAddress at = parse_address(arguments[flag::listen]);
  const Secret key = link_key(arguments, at);
  const SafetyLimits limits = safety_limits(arguments);
  Input model_input(arguments[flag::model]);
  const Model model = read_model(model_input);
  std::shared_ptr<Progress> progress;
  const PreparedBodyOptions options =
      prepared_options(arguments, contact_radius(model, arguments[flag::tool_radius]), progress);
  const TetMesh mesh = load_body(arguments);
  const PreparedBody body(mesh, model, options);
  progress.reset();
  tell_accuracy(arguments, "hs-link", body.field());
  ToolLoopOptions hand;
  hand.sensor = false;
  hand.fitted = fitted_range(model.metadata, model.name);
  ForceLoop loop(body, hand);
  Terms terms = link_terms(mesh, arguments[flag::tool_radius]);
  terms.model = fingerprint_of(model);
  UdpSocket socket(at);
  say(arguments, "hs-link", "listening at " + to_text(socket.address()));
  TeleoperatorEnd end(key, terms);
  Teleoperator far(loop, limits, terms.low, terms.high);
  const auto seed = static_cast<std::uint64_t>(arguments[flag::seed]);
  ImpairedChannel channel(impairment(arguments), seed + 1000);
  const Interrupt interrupt;
  Random random(seed);
  const double noise = arguments[flag::add_noise];
  const double idle = arguments[flag::idle];
  std::array<unsigned char, 2048> buffer{};
  UdpAddress from;
  Datagram out;
  Packet answer;
  std::string refused;
  // So many at once: a flood must not keep the loop from its clock.
  constexpr int kAtOnce = 256;
  for (std::int64_t heard = monotonic_ns(); !interrupt.asked();) {
    std::int64_t now = monotonic_ns();
    if (idle > 0 && now - heard > std::llround(1e9 * idle)) break;
    socket.wait(std::min(channel.next_due(), now + (end.is_linked() ? 5'000'000 : 100'000'000)));
    now = monotonic_ns();
    std::size_t size = 0;
    for (int i = 0; i < kAtOnce && (size = socket.receive(buffer, from)) > 0; ++i) {
      const TeleoperatorEnd::Answer got = end.receive(now, from, {buffer.data(), size}, out);
      if (got.reply) socket.send(from, out.view());
      if (end.refusal() != refused && !(refused = end.refusal()).empty())
        say(arguments, "hs-link", to_text(from) + " is refused: " + refused);
      if (!got.received) continue;
      heard = now;
      if (!far.press(now, *got.received, answer)) continue;
      for (int k = 0; k < 3; ++k) answer.first[k] += noise * random.normal();
      if (end.write(answer, out)) channel.push(now, out);
    }
    far.idle(now);
    while (channel.pop(now, out)) socket.send(end.peer(), out.view());
  }
  if (end.is_linked() && far.farewell(answer) && end.write(answer, out))
    for (int i = 0; i < 3; ++i) socket.send(end.peer(), out.view());  // one may be lost
  std::string told = "teleoperator: " + end.counts().summary();
  if (far.impossible() > 0) told += fmt::format(", {} impossible motions", far.impossible());
  if (far.losses() > 0) told += fmt::format(", the operator was lost {} times", far.losses());
  say(arguments, "hs-link", told);
  return 0;
}

}  // namespace hapsim
