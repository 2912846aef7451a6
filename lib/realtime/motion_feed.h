// Motion as it comes, read beside the loop that sends it.
#pragma once

#include <atomic>
#include <exception>
#include <thread>

#include "io/stream.h"
#include "realtime/motion_source.h"
#include "realtime/spsc_ring.h"
#include "realtime/tool_source.h"

namespace hapsim {

// A thread reads the source ahead, as far as `capacity` lines; neither a slow file nor a hand that
// rests holds up who takes them. The source must not be used meanwhile. SIGINT and SIGTERM go to
// that thread alone, so that they end a read that waits.
template <class Source, class Item>
class Feed {
 public:
  // `input` is the source's and ends on signals (Input::end_on_signals()); a feed that goes before
  // the input has ended ends it.
  Feed(Source& source, const Input& input, std::size_t capacity = 1024);
  ~Feed();
  Feed(const Feed&) = delete;
  Feed& operator=(const Feed&) = delete;

  // The next line, where one is there. Throws what the source threw, once the lines before it are
  // taken.
  bool take(Item& item);
  // Throws what the source threw, whatever lines there are before it: for who waits to begin.
  void require_sound() const;
  bool has_ended() const { return ended_.load(std::memory_order_acquire); }  // none is to come
  // Readable once a line or the end has come since it was read.
  int event() const { return event_; }
  void clear_event() noexcept;

 private:
  void run(Source& source);

  const Input& input_;
  SpscRing<Item> ring_;
  int event_ = -1;
  std::exception_ptr thrown_;
  std::atomic<bool> ended_{false}, stop_{false};
  std::thread thread_;
};

using MotionFeed = Feed<MotionSource, MotionLine>;
using StepFeed = Feed<ToolSource, ToolStep>;
extern template class Feed<MotionSource, MotionLine>;
extern template class Feed<ToolSource, ToolStep>;

}  // namespace hapsim
