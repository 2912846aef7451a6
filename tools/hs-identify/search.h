// Long fits of hs-identify: progress, an end by a signal, and going on from there.
#pragma once

#include <fmt/format.h>
#include <sys/stat.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <mutex>
#include <sstream>
#include <thread>

#include "base/error.h"
#include "cli/tool.h"
#include "fit/fit.h"
#include "hs-identify/flags.h"
#include "io/interrupt.h"
#include "model/search_state.h"

namespace hapsim {

inline std::vector<Option> search_flags() {
  return {{.flag = flag::starts,
           .value = "N",
           .help = "Starts of the fit: the usual ones and N - 1 spread evenly over the bounds; the "
                   "least error wins.",
           .group = "Fit",
           .default_text = "1",
           .minimum = 1,
           .maximum = 100000},
          {.flag = flag::resume,
           .help = "Goes on with the search of --starts in which --model was interrupted. While a "
                   "search runs it is saved as FILE.search beside the -o FILE, for the case that "
                   "it is killed.",
           .group = "Fit"},
          {.flag = flag::seed,
           .value = "N",
           .help = "Seed of --starts.",
           .group = "Fit",
           .default_text = "1",
           .minimum = 0}};
}

inline SearchState search_asked(const Arguments& arguments, const Model& start) {
  if (!arguments[flag::resume])
    return {0, static_cast<int>(arguments[flag::starts]),
            static_cast<std::uint64_t>(arguments[flag::seed])};
  if (!arguments.given(flag::model))
    fail_usage("--resume needs the model that an interrupted run wrote", "add --model FILE");
  for (const AnyFlag& flag :
       AnyFlags{flag::starts, flag::seed, flag::add, flag::remove, flag::diagnosis})
    if (arguments.given(flag))
      fail_usage("--resume and " + flag + " exclude each other",
                 "the search goes on as it was begun");
  const std::string& file = arguments[flag::model];
  const auto state = unfinished_search(start, file);
  if (!state) fail_usage(file + " is no model of an interrupted search", "leave --resume out");
  return *state;
}

// Writes the best model so far and ends the process where a signal has asked for that and nothing
// has come of it within a second, for what is computed then cannot be left earlier.
class LastResort {
 public:
  // `write` takes the text of a model to its file.
  LastResort(const Interrupt& interrupt, std::function<void(const std::string&)> write)
      : interrupt_(interrupt), write_(std::move(write)), thread_([this] { wait(); }) {}
  ~LastResort() {
    ended_.store(true);
    thread_.join();
  }
  LastResort(const LastResort&) = delete;
  LastResort& operator=(const LastResort&) = delete;
  void seen() { seen_.store(true); }  // the signal: the process ends by itself
  void keep(Model model, double rmse) {
    const std::lock_guard lock(mutex_);
    if (rmse >= least_) return;
    least_ = rmse;
    best_ = std::move(model);
  }

 private:
  void wait() {
    using namespace std::chrono_literals;
    constexpr int kPatience = 14;  // of 50 ms
    for (int asked = 0; !ended_.load(); std::this_thread::sleep_for(50ms)) {
      if (!interrupt_.asked() || seen_.load() || ++asked < kPatience) continue;
      const std::lock_guard lock(mutex_);
      if (ended_.load() || std::isinf(least_)) continue;
      try {
        mark_interrupted(best_, "while the model was improved");
        std::ostringstream text;
        write_model(text, best_);
        write_(text.str());
        std::_Exit(static_cast<int>(ExitCode::kNoConvergence));
      } catch (const std::exception& error) {
        std::fputs(error.what(), stderr);
        std::_Exit(static_cast<int>(ExitCode::kIo));
      }
    }
  }

  const Interrupt& interrupt_;
  std::function<void(const std::string&)> write_;
  std::mutex mutex_;
  Model best_;
  double least_ = std::numeric_limits<double>::infinity();
  std::atomic<bool> ended_{false}, seen_{false};
  std::thread thread_;
};

// The search of several starts as it goes, beside the model that is to come: what ends the process
// without asking (SIGKILL, a power cut) loses no more than the starts of a second. Gone on with by
// --model FILE.search --resume.
class SavedSearch {
 public:
  SavedSearch(const Arguments& arguments, const SearchState& search, const Metadata& metadata)
      : search_(search), metadata_(metadata) {
    const std::string& model = arguments.output();
    struct stat info = {};
    if (search.starts > 1 && model != "-" &&
        (stat(model.c_str(), &info) != 0 || S_ISREG(info.st_mode)))
      path_ = model + ".search";
    // Gone on with from there: it is saved already.
    saved_ = arguments.given(flag::model) && arguments[flag::model] == path_;
  }
  // For FitOptions::after_start.
  void keep(Model best, int starts_done) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point now = Clock::now();
    if (path_.empty() || (saved_ && now - last_ < std::chrono::seconds(1))) return;
    best.metadata = metadata_;
    unmark(best);
    SearchState state = search_;
    state.done = starts_done;
    mark_unfinished(best, state);
    Output output(path_);
    write_model(output.stream(), best);
    output.commit();
    saved_ = true;
    last_ = now;
  }
  // The model is written: what is saved is of no use any more.
  void finish() const {
    if (saved_) std::remove(path_.c_str());
  }

 private:
  std::string path_;
  SearchState search_;
  Metadata metadata_;
  bool saved_ = false;
  std::chrono::steady_clock::time_point last_;
};

// Watches the fits until end(); before and after, a signal ends the process as it always does.
class SearchWatch {
 public:
  explicit SearchWatch(const Arguments& arguments)
      : interrupt_(std::make_unique<Interrupt>()),
        progress_(std::make_unique<Progress>(arguments, "", 0)),
        last_resort_(
            std::make_unique<LastResort>(*interrupt_, [&arguments](const std::string& model) {
              Output output(arguments.output());
              output.stream() << model;
              output.commit();
              say(arguments, "hs-identify",
                  "interrupted while the model was improved; the best so far is written: go on "
                  "from it with --model");
            })) {}
  std::function<void(const Model&, double)> keep() {
    return [this](const Model& model, double rmse) {
      if (last_resort_) last_resort_->keep(model, rmse);
    };
  }
  // Another thing than a fit is under way.
  void show(const std::string& what, std::size_t k = 0, std::size_t n = 0) {
    if (progress_) progress_->show(what, k, n);
  }
  std::function<bool(const FitProgress&)> watch() {
    return [this](const FitProgress& p) {
      const std::string error =
          std::isnan(p.rmse) ? "fitting" : fmt::format("fitting, error {:.4g} N", p.rmse);
      if (progress_) {
        if (p.starts > 1)
          progress_->show(error + ", start", static_cast<std::size_t>(p.start) + 1,
                          static_cast<std::size_t>(p.starts));
        else
          progress_->show(error);
      }
      if (interrupted() && last_resort_) last_resort_->seen();
      return !interrupted();
    };
  }
  bool interrupted() const { return interrupt_ && interrupt_->asked(); }
  bool end() {  // whether it was interrupted
    const bool asked = interrupted();
    last_resort_.reset();
    interrupt_.reset();
    progress_.reset();
    return asked;
  }

 private:
  std::unique_ptr<Interrupt> interrupt_;
  std::unique_ptr<Progress> progress_;
  std::unique_ptr<LastResort> last_resort_;
};

}  // namespace hapsim
