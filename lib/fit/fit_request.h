// What a fit is asked for: the start, the effects to add, how many terms and regions; and the
// models that follow from that.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fit/extend.h"
#include "fit/maxwell_terms.h"

namespace hapsim {

// "2", "auto", "sites" or "labels" as ExtendOptions::regions. Error(kUsage) beginning with
// `option`.
int parse_regions(const std::string& text, const std::string& option);

struct TermsRequest {
  int count = 1;
  bool automatic = false;  // `count` is the most that is offered
  TimeWindows windows;     // as many as `count`, or none
};

// `terms`: 1 to 5, auto, or auto:N; empty: one, or as many as there are windows. `windows`:
// LOW:HIGH in seconds. Error(kUsage) beginning with the option's name: neither of these, or they
// contradict each other.
TermsRequest parse_terms(const std::optional<std::string>& terms,
                         const std::vector<std::string>& windows);

struct FitRequest {
  Model start;                   // empty: elastic from the data
  bool automatic = false;        // what to add is found by diagnosis
  std::vector<std::string> add;  // in order
  std::vector<std::string> fix;  // set_state()
  TermsRequest terms;
  std::function<void(const std::string&)> say;  // what was chosen on the way; may be empty
};

// The same in the words of a command line. The functions are called when they are needed; empty:
// not given.
struct AskedFit {
  std::function<Model()> model;      // to start from
  std::vector<std::string> effects;  // of a new model; "auto" alone: found by diagnosis
  bool effects_given = false;        // otherwise they are the usual ones
  std::vector<std::string> add, remove, fix, free;
  std::function<std::vector<std::string>()> diagnosed;  // to be added after `add`
  std::optional<std::string> terms;
  std::vector<std::string> windows;
};
// Error(kUsage): they contradict each other, or name what is not there.
FitRequest fit_request(const AskedFit& asked);

// Error(kUsage) where a value of `fix` ("nu=0.45", "elastic.nu=0.45") lies outside the bounds of
// every parameter of that name.
void require_within_bounds(const std::vector<std::string>& fix);

// The range of Poisson's ratio that will be asked: that of the start, or the value at which it is
// fixed.
void set_poisson_range(const FitRequest& request, ExperimentOptions& options);

// Models to fit on the chosen episodes: fitted step by step, one effect after the other. `known`:
// what fits that solve nothing stand on.
Starts build_starts(const FitRequest& request, const Experiment& experiment,
                    const Selection& selection, const FitOptions& fit_options,
                    const ExtendOptions& extend, const Linearisation& known = {});

// The error on what each fold leaves out: fits anew from the fit on all data. A map over the body
// comes from positions, so it is built anew from those that the fold may see.
HeldOut held_out_error(const FitRequest& request, const Model& fitted, const Experiment& experiment,
                       const Folds& folds, const FitOptions& fit_options,
                       const ExtendOptions& extend);

}  // namespace hapsim
