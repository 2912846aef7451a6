#include "model/search_state.h"

#include <fmt/format.h>

#include <cstdio>

#include "base/error.h"

namespace hapsim {

void mark_unfinished(Model& model, const SearchState& state) {
  model.metadata.set("converged", "no");
  if (state.starts > 1)
    model.metadata.set(
        "search", fmt::format("{} of {} starts, seed {}", state.done, state.starts, state.seed));
}

void mark_interrupted(Model& model, const std::string& what) {
  model.metadata.set("interrupted", what);
}

void unmark(Model& model) {
  model.metadata.remove("interrupted");
  model.metadata.remove("converged");
  model.metadata.remove("search");
}

bool is_unfinished(const Model& model) {
  return model.metadata.find("converged").value_or("") == "no";
}

std::optional<SearchState> unfinished_search(const Model& model, const std::string& where) {
  const auto text = model.metadata.find("search");
  if (!text || !is_unfinished(model)) return std::nullopt;
  SearchState state;
  unsigned long long seed = 0;
  int end = 0;
  const int read = std::sscanf(text->c_str(), "%d of %d starts, seed %llu%n", &state.done,
                               &state.starts, &seed, &end);
  if (read != 3 || end != static_cast<int>(text->size()) || state.starts < 2 || state.done < 0 ||
      state.done > state.starts)
    fail_input(where, "its metadata search says '" + *text + "'",
               "it reads '7 of 20 starts, seed 1'");
  state.seed = seed;
  return state;
}

}  // namespace hapsim
