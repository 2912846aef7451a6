// The table of model versions and their errors.
#pragma once

#include <string>
#include <vector>

namespace hapsim {

struct HistoryRow {
  std::string model;        // file
  std::string effects;      // "elastic+viscoelastic"
  double rmse = 0;          // [N]
  double held_out = 0;      // [N], NaN when there is nothing to hold out
  std::string held_out_by;  // what was not seen: errors by other things are not to be compared
  double noise = 0;         // [N]
  double force_rms = 0;     // [N]
  int parameters = 0;       // free ones
};

// Adds a row to a CSV (made when absent):
// step,model,effects,parameters,rmse,heldout,noise,force_rms,heldout_by. A row of the same model
// file is replaced, so a repeated run does not grow the table.
void add_history(const std::string& path, const HistoryRow& row);

}  // namespace hapsim
