// A library of models on a screen.
#pragma once

#include <fmt/format.h>

#include "base/counted.h"
#include "base/shell_words.h"
#include "cli/summary.h"
#include "model/body_parameters.h"
#include "model/model_library.h"

namespace hapsim {

// `name`: the library's file.
inline Summary library_summary(const std::vector<LibraryEntry>& entries, const std::string& name) {
  constexpr std::size_t kMost = 6;
  Summary s;
  s.mark = entries.empty() ? Summary::Mark::kOpen : Summary::Mark::kGood;
  s.verdict = name + ": " + counted(static_cast<std::ptrdiff_t>(entries.size()), "model", "models");
  s.values = {{"entries", static_cast<double>(entries.size()), "1"}};
  SummaryItem item{"MODELS", "", "", {}};
  for (const LibraryEntry& e : entries) {
    const Parameter *E = modulus_of(e.model), *nu = poissons_ratio_of(e.model);
    const auto rmse = e.model.metadata.find("rmse");
    s.values.push_back({fmt::format("{}.E", e.id), E->value, "Pa", E->std_error});
    s.values.push_back({fmt::format("{}.nu", e.id), nu->value, "1", nu->std_error});
    if (item.facts.size() < kMost)
      item.facts.push_back(fmt::format("{}: E = {:.4g} Pa, nu = {:.3g}{}", words_of(e), E->value,
                                       nu->value, rmse ? ", error " + *rmse + " N" : ""));
  }
  if (entries.empty()) return s;
  if (entries.size() > kMost)
    item.facts.push_back(fmt::format("... and {} more", entries.size() - kMost));
  s.items.push_back(std::move(item));
  s.next = fmt::format("hs-library {} --show {} -o m.csv", shell_quoted(name), entries.back().id);
  return s;
}

}  // namespace hapsim
