// Motion in, forces out at once.
#pragma once

#include <ostream>
#include <string>

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
  std::int64_t misses = 0;          // forces later than one period after their line was due
  std::int64_t deep = 0, held = 0;  // lines that are beyond what is valid, and of these those held
  std::int64_t off = 0;             // lines whose place contact meshes cannot be made for
  // What is said of the deep ones; "" where there is none.
  std::string depth_summary() const;
};

// Runs until the input ends; `loop` made with `relaxed` where the source has contact points. Every
// force is written and flushed before the next line is read, so an Error of a bad line comes after
// all forces before it; the error of a closed pipe comes through. Nothing is allocated once the
// first line is through, apart from lines longer than those before.
void run_live(MotionSource& in, std::ostream& out, ToolLoop& loop, const LiveOptions& options,
              LiveReport& report);

}  // namespace hapsim
