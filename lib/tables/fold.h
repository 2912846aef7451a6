// Letters of any script and width in one plain form, for comparing names of columns and units.
#pragma once

#include <string>
#include <string_view>

namespace hapsim {

// Full-width and half-width forms, squared units ("㎜"), superscripts, spaces, brackets, dashes and
// accents of `text` (UTF-8) in plain form, its case kept: "Épaisseur（㎜）" is "Epaisseur(mm)".
// German umlauts become two letters, a micro sign u. Chinese, Japanese, Greek and Cyrillic letters
// stay; other signs go.
std::string plain(std::string_view text);

// plain() in lower case.
std::string fold(std::string_view text);

}  // namespace hapsim
