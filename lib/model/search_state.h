// The mark on a model whose fit, or what comes after it, was ended early, and where its search can
// go on.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "model/model.h"

namespace hapsim {

// Metadata `converged: no`, and of a search from several starts `search: 7 of 20 starts, seed 1`.
struct SearchState {
  int done = 0;  // starts gone through
  int starts = 1;
  std::uint64_t seed = 1;
};

void mark_unfinished(Model& model, const SearchState& state);
// Metadata `interrupted: while the model was improved`: what a signal ended after the fit.
void mark_interrupted(Model& model, const std::string& what);
void unmark(Model& model);
bool is_unfinished(const Model& model);
// Empty: no such search. `where` names the file in Error(kBadInput) for a mark that cannot be read.
std::optional<SearchState> unfinished_search(const Model& model, const std::string& where);

}  // namespace hapsim
