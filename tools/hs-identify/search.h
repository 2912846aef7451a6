// Long fits of hs-identify: progress, an end by a signal, and going on from there.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <memory>

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
           .help = "Goes on with the search of --starts in which --model was interrupted.",
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

// Watches the fits until end(); before and after, a signal ends the process as it always does.
class SearchWatch {
 public:
  explicit SearchWatch(const Arguments& arguments)
      : interrupt_(std::make_unique<Interrupt>()),
        progress_(std::make_unique<Progress>(arguments, "fit", 0)) {}
  std::function<bool(const FitProgress&)> watch() {
    return [this](const FitProgress& p) {
      const std::string error = std::isnan(p.rmse) ? "" : fmt::format("error {:.4g} N", p.rmse);
      if (progress_)
        progress_->show(
            p.starts > 1 ? fmt::format("start {} of {}, {}", p.start + 1, p.starts, error) : error);
      return !interrupted();
    };
  }
  bool interrupted() const { return interrupt_ && interrupt_->asked(); }
  bool end() {  // whether it was interrupted
    const bool asked = interrupted();
    interrupt_.reset();
    progress_.reset();
    return asked;
  }

 private:
  std::unique_ptr<Interrupt> interrupt_;
  std::unique_ptr<Progress> progress_;
};

}  // namespace hapsim
