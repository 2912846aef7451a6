// -h, --help and the man page.
#pragma once

#include <string>

#include "cli/tool.h"

namespace hapsim {

// A screen of it: what is required, the names of the other options by group, examples.
std::string short_help_text(const ToolSpec& spec);
std::string help_text(const ToolSpec& spec);  // 80 columns
std::string man_page(const ToolSpec& spec);   // roff, man(7)
// A row of the table that hs is built with: `{Task::kModel, "hs-identify", "the material ..."},`.
std::string about_text(const ToolSpec& spec);

}  // namespace hapsim
