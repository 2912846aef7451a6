#include "cli/progress.h"

#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdio>

#include "cli/tool.h"
#include "cli/wrap.h"

namespace hapsim {
namespace {

constexpr auto kInterval = std::chrono::milliseconds(100);
constexpr double kLong = 2;  // seconds from which on the time spent on a state is told

std::atomic<bool> line_is_drawn{false};

std::string duration_text(double seconds) {
  const long s = std::lround(seconds);
  char text[64];
  if (s < 60)
    std::snprintf(text, sizeof text, "%ld s", s);
  else if (s < 3600)
    std::snprintf(text, sizeof text, "%ld min %02ld s", s / 60, s % 60);
  else
    std::snprintf(text, sizeof text, "%ld h %02ld min", s / 3600, s / 60 % 60);
  return text;
}

double seconds_since(std::chrono::steady_clock::time_point then) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

// A line that a terminal of the usual width does not break.
std::string cut(std::string text) {
  if (columns(text) < kTextWidth) return text;
  while (columns(text) > kTextWidth - 4) do
      text.pop_back();
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xc0) == 0x80);
  return text + "...";
}

}  // namespace

void clear_progress_line() {
  if (line_is_drawn.exchange(false)) std::fputs("\r\033[K", stderr);
}

Progress::Progress(const Arguments& arguments, const std::string& what, std::size_t total)
    : what_(what),
      total_(total),
      shown_(!arguments.quiet() && isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      state_since_(start_),
      sweep_since_(start_) {
  if (shown_) thread_ = std::thread([this] { draw_until_stopped(); });
}

Progress::~Progress() {
  if (!shown_) return;
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  stopping_.notify_one();
  thread_.join();
  std::fputs("\r\033[K", stderr);
  line_is_drawn = false;
}

void Progress::step(std::size_t done) {
  const std::lock_guard lock(mutex_);
  done_ += done;
}

void Progress::found_done() {
  const std::lock_guard lock(mutex_);
  ++before_;
  ++done_;
}

void Progress::running(const std::string& what) {
  const std::lock_guard lock(mutex_);
  running_ = what;
}

void Progress::show(const std::string& state) {
  show(state, 0, 0);
}

void Progress::show(const std::string& state, std::size_t k, std::size_t n) {
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (state != state_) state_since_ = now;
  if (k > 0 && k < k_) sweep_since_ = now;
  state_ = state;
  if (k > 0) k_ = k;
  n_ = k > 0 ? n : 0;
}

std::string Progress::time_left(std::size_t done, std::size_t total,
                                Clock::time_point since) const {
  if (done == 0 || done >= total) return "";
  return ", about " + duration_text(seconds_since(since) / static_cast<double>(done) *
                                    static_cast<double>(total - done));
}

std::string Progress::line() const {
  if (!state_.empty()) {
    const std::string text = what_.empty() ? state_ : what_ + ": " + state_;
    if (n_ > 0)
      return text + " " + std::to_string(k_) + "/" + std::to_string(n_) +
             time_left(k_ - 1, n_, sweep_since_);
    const double spent = seconds_since(state_since_);
    return spent < kLong ? text : text + ", " + duration_text(spent);
  }
  if (done_ == 0 && running_.empty())
    return what_ + (total_ > 0 ? " 0/" + std::to_string(total_) : "") + ", " +
           duration_text(seconds_since(start_));
  std::string text = what_.empty() ? "" : what_ + " ";
  text += std::to_string(done_);
  if (total_ > 0) text += "/" + std::to_string(total_);
  if (what_.empty()) text += " done";
  if (total_ > 0 && done_ > before_) text += time_left(done_ - before_, total_ - before_, start_);
  if (!running_.empty()) text += ", running: " + running_;
  return text;
}

void Progress::draw_until_stopped() {
  std::unique_lock lock(mutex_);
  while (!stopping_.wait_for(lock, kInterval, [this] { return stopped_; })) {
    std::fprintf(stderr, "\r%s\033[K", cut(line()).c_str());
    std::fflush(stderr);
    line_is_drawn = true;
  }
}

}  // namespace hapsim
