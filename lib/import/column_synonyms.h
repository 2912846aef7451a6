// What a column's name means, by the table of words (tables/header_words.h).
#pragma once

#include <string>

#include "import/column_roles.h"

namespace hapsim {

// Role of a vector by the name of its components without the axis ("contactpoint"); kCount: none.
VectorRole vector_role(const std::string& base);

// Role of a scalar column, and how sure it is: the column with the lowest rank gets the role.
struct ScalarMatch {
  ScalarRole role = ScalarRole::kCount;
  int rank = 0;
};
ScalarMatch scalar_role(const std::string& joined, UnitKind unit);

// Whether a name means the episode a row belongs to ("site"), a group of them ("specimen"), or may
// mean an episode or a row's number ("point", "index"): then its values decide.
enum class PressWord { kNo, kYes, kGroup, kPerhaps };
PressWord press_word(const std::string& joined);

// A machine's travel, whose zero is arbitrary, and not a depth below the surface.
bool is_travel(const std::string& joined);

}  // namespace hapsim
