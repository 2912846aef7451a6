// Motion in, forces out at once.
#pragma once

#include <array>
#include <ostream>
#include <string>
#include <vector>

#include "realtime/latency.h"
#include "realtime/motion_source.h"
#include "realtime/tool_loop.h"

namespace hapsim {

struct LiveOptions {
  double rate = 0;         // lines a second by the clock; 0: each as soon as it comes
  bool remembers = false;  // a new press at the place of the last goes on from it
};

struct LiveReport {
  // From the line read (with a rate: from when it was due) to its force handed to the system.
  LatencyHistogram latency;
  std::int64_t misses = 0;  // forces later than one period after their line was due
  // Forces of lines in contact that are beyond what is valid, by the bits of Beyond.
  std::array<std::int64_t, 7> beyond{};
  std::int64_t deep = 0;  // of the first two bits together
  void count(int beyond) noexcept;
  std::vector<std::string> beyond_words() const;  // what is said of them
};

// Runs until the input ends; `loop` made with `relaxed` where the source has contact points. Every
// force is written and flushed before the next line is read, so an Error of a bad line comes after
// all forces before it; the error of a closed pipe comes through. Nothing is allocated once the
// first line is through, apart from lines longer than those before.
void run_live(MotionSource& in, std::ostream& out, ToolLoop& loop, const LiveOptions& options,
              LiveReport& report);

}  // namespace hapsim
