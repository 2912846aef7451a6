// The word that was probably meant.
#pragma once

#include <string>
#include <vector>

namespace hapsim {

// Candidate with the smallest edit distance to `word` (case ignored); "" when none is near enough
// (more than a third of the letters differ, at least one allowed).
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace hapsim
