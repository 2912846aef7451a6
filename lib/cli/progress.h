// Progress on a terminal: one line on standard error that is drawn again and again.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace hapsim {

class Arguments;

// On standard error, only when that is a terminal and not --quiet; thread-safe. The line is drawn
// by a thread of its own, so that a long step shows that time goes on.
class Progress {
 public:
  // `what` is counted: "contact positions 7/31, about 12 s". total 0: not known.
  Progress(const Arguments& arguments, const std::string& what, std::size_t total);
  ~Progress();  // clears the line
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void step(std::size_t done = 1);
  void show(const std::string& state);  // instead of a count: "fit: error 0.07 N, 12 s"
  // The same of the k-th of n, from 1: "testing friction 7/31, about 12 s". A k that falls begins
  // anew.
  void show(const std::string& state, std::size_t k, std::size_t n);
  // "3/8 done, running: cycles auto": what is under way, beside a count that step() advances.
  void running(const std::string& what);
  void found_done();  // one that had been done before: it does not tell how long the others take

 private:
  using Clock = std::chrono::steady_clock;

  std::string line() const;
  std::string time_left(std::size_t done, std::size_t total, Clock::time_point since) const;
  void draw_until_stopped();

  std::string what_;
  std::size_t total_;
  std::size_t done_ = 0;
  std::size_t before_ = 0;  // of done_
  std::string state_, running_;
  std::size_t k_ = 0, n_ = 0;
  bool shown_;
  Clock::time_point start_, state_since_, sweep_since_;
  mutable std::mutex mutex_;
  std::condition_variable stopping_;
  bool stopped_ = false;
  std::thread thread_;
};

// Takes a line that is drawn off the terminal before something else is written there.
void clear_progress_line();

}  // namespace hapsim
