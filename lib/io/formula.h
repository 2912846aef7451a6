// Text of others in tables that people open in a spreadsheet.
#pragma once

#include <string>

namespace hapsim {

// The text, with an apostrophe before what a spreadsheet would take for a formula and run: it
// begins with = + - @, a tab or a carriage return and is no number (OWASP, "CSV Injection").
std::string without_formula(const std::string& text);

}  // namespace hapsim
