// The one table of the formats of points, surfaces and meshes. A new format is its own file and a
// line in format_table.cpp; what can read or write it asks here.
#pragma once

#include <string>
#include <vector>

#include "formats/format.h"

namespace hapsim {

// All formats, in the order in which bytes are offered to them.
const std::vector<const Format*>& all_formats();

// For those who read tables themselves: their columns may mean more than points.
const Format& csv_format();
const Format& rows_format();

struct Recognised {
  const Format* format = nullptr;  // null: no format of ours
  Content content = Content::kNothing;
};

// By content, never by the name of a file.
Recognised recognise(const std::string& bytes);

// The format that the end of an output's name says; without an extension the first that can write
// `content`, PLY. Error(kUsage): no format of that extension can.
const Format& format_to_write(const std::string& path, Content content);

// Extensions with which format_to_write() succeeds.
std::vector<std::string> extensions_to_write(Content content);

// "PLY, STL or OFF": the formats that can be read as `content`.
std::string names_to_read(Content content);

// Error(kBadInput): the bytes are in no format that holds `content`. The line says which are read,
// and what these bytes are where that is known; or what they are wrapped in (io/wrapped.h).
[[noreturn]] void fail_format(const std::string& name, const std::string& bytes, Content content,
                              const std::string& mend);

}  // namespace hapsim
