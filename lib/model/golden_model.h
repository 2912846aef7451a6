// A model against a golden one of the same recording: equal within what is allowed.
#pragma once

#include <string>
#include <vector>

#include "model/model.h"

namespace hapsim {

// How much one parameter may differ: a share of the golden value, or in the parameter's own unit.
struct Tolerance {
  std::string parameter;  // "elastic.E", "E", "" for all
  double value = 0;
  bool relative = true;
};

struct GoldenOptions {
  std::vector<Tolerance> tolerances;  // the last that fits a parameter holds
  double standard_errors = 3;         // of the difference, both models' standard errors together
  double worse = 0.1;                 // share by which rmse and heldout may exceed the golden ones
};

enum class GoldenVerdict { kSame, kDiffers, kNew, kGone };

struct GoldenRow {
  std::string effect;  // "" for the errors rmse and heldout, and for converged
  int region = 0;
  std::string parameter;  // or rmse, heldout [N], converged (0, 1)
  std::string unit;
  double value = 0, golden = 0;  // NaN where there is none
  double allowed = 0;            // largest |value - golden| on its side that is the same
  GoldenVerdict verdict = GoldenVerdict::kSame;
  std::string why;  // of a verdict other than kSame: one line
};

// A free or derived parameter is the same when it differs by no more than its tolerance or than the
// standard errors explain, whichever is more; those of a parameter that is stepped in its logarithm
// are factors (interval.h). A fixed one may differ by its tolerance, at least 1e-9 of its size. A
// parameter that only one model has, or that is free in one and fixed in the other, differs. The
// error of the fit and that on unseen data (metadata rmse, heldout) may be smaller by any amount,
// but not absent where the golden model has it. A fit that was ended early differs from one that
// was not. Rows in the order of the golden model, then what is new, then the errors.
std::vector<GoldenRow> compare_with_golden(const Model& model, const Model& golden,
                                           const GoldenOptions& options);

const char* golden_verdict_name(GoldenVerdict verdict);  // same, differs, new, gone

}  // namespace hapsim
