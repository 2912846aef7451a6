// Motion as it comes, read beside the loop that sends it.
#pragma once

#include <atomic>
#include <exception>
#include <thread>

#include "io/stream.h"
#include "realtime/motion_source.h"
#include "realtime/spsc_ring.h"

namespace hapsim {

// A thread reads the source ahead, as far as `capacity` lines; neither a slow file nor a hand that
// rests holds up who takes them. The source must not be used meanwhile. SIGINT and SIGTERM go to
// that thread alone, so that they end a read that waits.
class MotionFeed {
 public:
  // `input` is the source's and ends on signals (Input::end_on_signals()); a feed that goes before
  // the input has ended ends it.
  MotionFeed(MotionSource& source, const Input& input, std::size_t capacity = 1024);
  ~MotionFeed();
  MotionFeed(const MotionFeed&) = delete;
  MotionFeed& operator=(const MotionFeed&) = delete;

  // The next line, where one is there. Throws what the source threw, once the lines before it are
  // taken.
  bool take(MotionLine& line);
  // Throws what the source threw, whatever lines there are before it: for who waits to begin.
  void require_sound() const;
  bool has_ended() const { return ended_.load(std::memory_order_acquire); }  // none is to come
  // Readable once a line or the end has come since it was read.
  int event() const { return event_; }
  void clear_event() noexcept;

 private:
  void run(MotionSource& source);

  const Input& input_;
  SpscRing<MotionLine> ring_;
  int event_ = -1;
  std::exception_ptr thrown_;
  std::atomic<bool> ended_{false}, stop_{false};
  std::thread thread_;
};

}  // namespace hapsim
