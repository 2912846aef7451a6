// What parsing, help and man page derive alike from a specification.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "base/units.h"
#include "cli/tool.h"

namespace hapsim {

// One number: kNumber, kInteger and single quantities.
bool is_number(const Option& option);

// The quantities of a value's numbers in order, the last also of those that follow; none where a
// value takes no unit.
std::vector<Quantity> quantities_of(const Option& option);

// The tool's own flags, then those that every tool has. With groups: group by group, in the order
// in which these are first named, "General" last; --output stands in "Output" where that is.
std::vector<Option> all_options(const ToolSpec& spec);

// "-o," for "--output", "" for a flag without a short form: what precedes the long flag.
std::string short_flag(const std::string& flag);

// Whether `word` is the long or the short form of the option.
bool is_flag(const std::string& word, const Option& option);

// "from 0 to 1", "of at least 0", "" without bounds.
std::string bounds_text(const Option& option);

// The option's help with choices, bounds, default and the like.
std::string full_help(const Option& option);

// "[OPTIONS] --body FILE [INPUT]": what follows the name of the tool.
std::string synopsis(const ToolSpec& spec);

// What the positional argument is, with the rule for standard input.
std::string input_text(const ToolSpec& spec);

extern const std::array<std::pair<const char*, const char*>, 6> kExitCodes;

}  // namespace hapsim
