// bench_link_cost: what the seal of a packet and the last layer before a hand cost. Rows: what; the
// median and the 99th percentile of 20 batches of 10,000, a call [us].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "link/session.h"
#include "realtime/real_time.h"
#include "safety/hand_watch.h"
#include "safety/safe_force.h"

namespace hapsim {
namespace {

void time_it(const char* what, const std::function<void(int)>& call) {
  constexpr int kBatches = 20, kCalls = 10'000;
  std::vector<double> us;
  for (int b = 0; b < kBatches; ++b) {
    const std::int64_t start = monotonic_ns();
    for (int i = 0; i < kCalls; ++i) call(b * kCalls + i);
    us.push_back(1e-3 * static_cast<double>(monotonic_ns() - start) / kCalls);
  }
  std::sort(us.begin(), us.end());
  fmt::print("{:<52} {:8.4f} {:8.4f}\n", what, us[us.size() / 2], us.back());
}

int run() {
  SessionKeys keys;
  draw_random(keys.to_operator);
  draw_random(keys.to_teleoperator);
  Session near(keys, Side::kOperator), far(keys, Side::kTeleoperator);
  Packet packet, back;
  packet.number = 1;
  packet.first = {0.1, 0.2, 0.3};
  bool newest = false;
  long taken = 0;
  time_it("packet written and read without a seal", [&](int i) {
    packet.t = 1e-3 * i;
    taken += read_packet(write_packet(packet), back);
  });
  Datagram d;
  time_it("packet sealed, opened and checked", [&](int i) {
    packet.t = 1e-3 * i;
    near.write(packet, d);
    taken += far.read(d.view(), back, newest) == Session::Result::kTaken;
  });
  SafeForce safe({});
  double sum = 0;
  time_it("a sample within the limits through SafeForce", [&](int i) {
    sum += safe.pass(1e-3 * i, {0, 0, 1e-6 * (i % 100)}, {0, 0, 2 + std::sin(1e-3 * i)}).force.z();
  });
  SafeForce cut({});
  time_it("a sample beyond them", [&](int i) {
    sum += cut.pass(1e-3 * i, {0, 0, 1e-6 * (i % 100)}, {0, 30, 20}).force.z();
  });
  HandWatch watch(
      0.1, [] { return false; }, [] {});
  SafeForce watched({});
  time_it("the first, with the watch of a loop that may hang", [&](int i) {
    watch.asked(monotonic_ns());
    const auto lock = watch.answer();
    sum +=
        watched.pass(1e-3 * i, {0, 0, 1e-6 * (i % 100)}, {0, 0, 2 + std::sin(1e-3 * i)}).force.z();
  });
  return taken == 400'000 && std::isfinite(sum) ? 0 : 1;
}

}  // namespace
}  // namespace hapsim

int main() {
  return hapsim::run();
}
