// Motion in, forces out at once.
#pragma once

#include <ostream>

#include "realtime/force_loop.h"
#include "realtime/latency.h"
#include "realtime/motion_source.h"

namespace hapsim {

struct LiveOptions {
  double rate = 0;        // lines a second by the clock; 0: each as soon as it comes
  ForceLoopOptions loop;  // `relaxed`: what the metadata `recovery: none` says otherwise
};

struct LiveReport {
  // From the line read (with a rate: from when it was due) to its force handed to the system.
  LatencyHistogram latency;
  std::int64_t misses = 0;  // forces later than one period after their line was due
};

// Runs until the input ends. Every force is written and flushed before the next line is read, so an
// Error of a bad line comes after all forces before it; the error of a closed pipe comes through.
// Nothing is allocated once the first line is through, apart from lines longer than those before.
void run_live(MotionSource& in, std::ostream& out, const PreparedBody& body,
              const LiveOptions& options, LiveReport& report);

}  // namespace hapsim
