// --help and the man page.
#pragma once

#include <string>

#include "cli/tool.h"

namespace hapsim {

std::string help_text(const ToolSpec& spec);  // 80 columns
std::string man_page(const ToolSpec& spec);   // roff, man(7)

}  // namespace hapsim
