// Values of flags against their specification.
#pragma once

#include <string>

#include "cli/tool.h"

namespace hapsim {

// A quantity with a unit in SI ("4mm": "0.004"); everything else as it is. Throws Error(kUsage)
// when `text` is no quantity of the option's kind.
std::string in_si(const Option& option, const std::string& text);

// Throws Error(kUsage) when `text` is no value of the option: not a finite number, not whole, out
// of bounds, not a choice, empty, a file with an extension that is not written.
void check_value(const Option& option, const std::string& text);

// Error(kIo) where an output that is asked for could not be made, Error(kUsage) where two are one
// file: told before the work.
void check_outputs(const ToolSpec& spec, const Arguments& arguments);

}  // namespace hapsim
