// Which physical effect a fitted model lacks.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "diagnose/gates.h"
#include "diagnose/left_over.h"
#include "diagnose/marker_left.h"
#include "diagnose/of_one_kind.h"
#include "diagnose/stand_ins.h"
#include "diagnose/torque_left.h"
#include "diagnose/trial_ground.h"
#include "fit/extend.h"
#include "model/interval.h"

namespace hapsim {

enum class Verdict { kMissing, kPossible, kIndistinguishable, kAbsent, kNotTestable };
enum class ModelVerdict { kComplete, kIncomplete, kAmbiguous, kUnexplained };
std::string verdict_name(Verdict verdict);
std::string verdict_name(ModelVerdict verdict);

struct DiagnoseOptions {
  Gates gates;
  int folds = 6;
  int flips = 999;
  std::uint64_t seed = 1;
  const Markers* markers = nullptr;  // of the experiment; null: none
  std::string unknown;  // an effect that is taken for one of no catalogue: for trials, and inside
                        // a search for what there is without it
  // What is being done, and which of how many effects that is (from 1; 0: none of a count). It may
  // throw, which ends the diagnosis.
  std::function<void(const std::string&, std::size_t, std::size_t)> progress;
  void tell(const std::string& what, std::size_t k = 0, std::size_t n = 0) const {
    if (progress) progress(what, k, n);
  }
};

// A parameter of an effect as it was fitted.
struct FittedValue {
  std::string name, unit;
  double value = 0;
  double std_error = std::numeric_limits<double>::quiet_NaN();  // NaN: not estimated
  double identity = 0;                                          // where it does nothing
  ParameterInterval interval;                                   // 95 %, by the curvature
  bool logarithmic = false;                                     // that interval is a factor
};

// One effect of the catalogue, tried on top of the model (and of the effects found before it).
struct Finding {
  std::string effect;
  Verdict verdict = Verdict::kAbsent;
  ForceError rmse_now{0}, rmse_after{0};          // on what was fitted
  ForceError held_out_now{0}, held_out_after{0};  // on what was not
  double p_value = 1;
  double criterion_gain = 0;
  double memory = 1;       // samples per independent one in what it leaves
  double share = 0;        // of the misfit beyond noise
  double share_among = 1;  // of those that passed beside it (diagnose/probability.h)
  double probability = std::numeric_limits<double>::quiet_NaN();  // that it acts; NaN: not tested
  std::string beside;  // a rival beside which alone it was found missing
  std::vector<std::string> confused_with;
  std::string where, evidence, next_measurement;
  std::vector<FittedValue> values;
  std::string fitted;  // the values, or what a map was found to be, in words
  FittedValue smallest{{}, {}, std::numeric_limits<double>::quiet_NaN()};  // that would show
  bool one_more_term = false;
  bool admitted = false;     // of few presses: by what is unseen
  bool every_site = false;   // regions: a stiffness that changes from position to position
  bool hidden = false;       // a law of each place, beside a learned field, could do the same
  bool within_form = false;  // no more than an approximate law in the model may leave
  bool by_presses = false;   // held_out_* are of unseen presses: it helps no unseen position
  bool doubted = false;  // found missing and not stood by (diagnose/one_size.h, beside_curves.h)
  std::string curve;     // doubted: it is needed beside the effect (diagnose/beside_curves.h)
  bool plain = false;    // large beyond chance by its size, whatever unseen positions say
};

struct Diagnosis {
  ModelVerdict verdict = ModelVerdict::kComplete;
  std::vector<Finding> findings;  // best first
  double noise = 0, floor = 0, mesh_uncertainty = 0;
  bool noise_measured = false;
  ShapeError shape;
  bool shape_in_doubt =
      false;                  // contact points lie off it, not by a move; the floor allows for that
  ForceError rmse, held_out;  // of the model as given, refitted
  ForceError force_rms;       // of the measured forces
  ForceError rmse_end, held_out_end;  // with all missing effects added
  std::string kind_now;               // LeftOver::kind of the model as given, refitted
  LeftOver left;     // with all missing effects, of an ambiguous verdict with the best rival
  OneKind one_kind;  // of the missing effects
  // Kinds of all that the model as given misses, where effects are named and more than noise is
  // left beside them.
  std::vector<LeftKind> misfit;
  StandIns stand_ins;            // the verdict is `unexplained` then
  std::vector<int> odd_presses;  // what is left is theirs (diagnose/odd_presses.h)
  TorqueLeft torque;             // of the same model, where torques were measured
  MarkerLeft marker;             // of the same model, where points were seen
  std::string held_out_by;
  std::string explanation;  // of the verdict, in words
  // What to tell apart by further presses: the fitted rivals of an ambiguous verdict; otherwise the
  // model alone, with all missing effects.
  std::vector<Model> rivals;
};

// Refits the model, tries every effect of the catalogue on top of it, and goes on while one is
// found missing. Ranking is by the information criterion of true refits; acceptance by the gates.
// Depends on its arguments alone. Where contact points lie off the body's surface, what a wrong
// shape could do is judged again with a larger allowance.
Diagnosis diagnose(const Model& model, const Experiment& experiment, const Allowance& allowance,
                   const DiagnoseOptions& options);

}  // namespace hapsim
