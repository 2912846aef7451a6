// Style and scripts of the report, built into the library from lib/report/assets.
#pragma once

namespace hapsim::assets {

extern const char* const kStyle;
extern const char* const kPresses;
extern const char* const kBody;
extern const char* const kInside;
extern const char* const kTable;
extern const char* const kCopy;

}  // namespace hapsim::assets
