// The models that further presses are to tell apart.
#pragma once

#include <string>
#include <vector>

#include "diagnose/diagnose.h"

namespace hapsim {

struct Suspects {
  std::vector<Model> models;  // fitted
  std::vector<std::string> names;
};

// The rivals of an ambiguous verdict, or where nothing passes the gates up to three of the effects
// that are possible, each on top of the model.
Suspects suspects_of(const Diagnosis& diagnosis, const Experiment& experiment,
                     const DiagnoseOptions& options);

}  // namespace hapsim
