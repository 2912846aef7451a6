#include <unistd.h>

#include <cmath>
#include <cstdio>

#include "cli/tool.h"

namespace hapsim {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kInterval = std::chrono::milliseconds(100);

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

}  // namespace

Progress::Progress(const Arguments& arguments, const std::string& what, std::size_t total)
    : what_(what),
      total_(total),
      shown_(!arguments.quiet() && isatty(STDERR_FILENO) == 1),
      start_(Clock::now()),
      drawn_(start_) {}

Progress::~Progress() {
  if (shown_) std::fputs("\r\033[K", stderr);
}

void Progress::step(std::size_t done) {
  if (!shown_) return;
  const std::lock_guard lock(mutex_);
  done_ += done;
  if (!is_due()) return;
  std::string line = what_ + ": " + std::to_string(done_);
  if (total_ > 0) {
    line += " of " + std::to_string(total_);
    const double seconds = std::chrono::duration<double>(drawn_ - start_).count();
    if (done_ > before_ && done_ < total_)
      line += ", " +
              duration_text(seconds / static_cast<double>(done_ - before_) *
                            static_cast<double>(total_ - done_)) +
              " left";
  }
  draw(line);
}

void Progress::found_done() {
  {
    const std::lock_guard lock(mutex_);
    ++before_;
  }
  step();
}

void Progress::show(const std::string& state) {
  if (!shown_) return;
  const std::lock_guard lock(mutex_);
  if (is_due()) draw(what_ + ": " + state);
}

bool Progress::is_due() {
  const auto now = Clock::now();
  if (now - drawn_ < kInterval) return false;
  drawn_ = now;
  return true;
}

void Progress::draw(const std::string& line) {
  std::fprintf(stderr, "\r%s\033[K", line.c_str());
  std::fflush(stderr);
}

}  // namespace hapsim
