// A network as bad as is asked for, before a real one.
#pragma once

#include <cstdint>
#include <vector>

#include "base/random.h"
#include "link/datagram.h"

namespace hapsim {

struct Impairment {
  double delay = 0;      // least time on the way [s]
  double jitter = 0;     // size of what comes on top, which changes within a tenth of a second [s]
  double loss = 0;       // share of packets
  double duplicate = 0;  // share that comes twice
  double reorder = 0;    // share that has a jitter of its own and may overtake or be overtaken
};

// Packets wait here until they are due. All memory is taken at the start: at most `capacity` wait,
// what comes on top is lost. Time in ns of any one clock.
class ImpairedChannel {
 public:
  ImpairedChannel(const Impairment& impairment, std::uint64_t seed, std::size_t capacity = 8192);
  void push(std::int64_t now, const Datagram& datagram) noexcept;
  // The next one that is due, false when there is none.
  bool pop(std::int64_t now, Datagram& datagram) noexcept;
  std::int64_t next_due() const noexcept;  // the largest number when nothing waits

 private:
  struct Waiting {
    std::int64_t due = 0;
    std::uint64_t order = 0;
    Datagram datagram;
    bool operator<(const Waiting& o) const {  // a heap has the largest first
      return due != o.due ? due > o.due : order > o.order;
    }
  };
  void add(std::int64_t due, const Datagram& datagram) noexcept;

  Impairment impairment_;
  Random random_;
  std::size_t capacity_;
  std::vector<Waiting> heap_;
  double swing_ = 0;                    // of the jitter: normal, with a memory
  std::int64_t pushed_ = 0, last_ = 0;  // last push; due of the last that keeps its order
  std::uint64_t order_ = 0;
};

}  // namespace hapsim
