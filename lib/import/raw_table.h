// Tables as machines and people export them: any separator, decimal commas, titles above the
// header, a row of units below it, the header repeated where files were joined.
#pragma once

#include <string>
#include <vector>

#include "io/metadata.h"
#include "io/stream.h"

namespace hapsim {

struct RawTable {
  std::string name;                               // of the source, for error messages
  Metadata metadata;                              // of comment lines, and the titles as comments
  std::vector<std::string> header;                // unique names
  std::vector<std::string> unit;                  // from a row of units; "" where there is none
  std::vector<std::vector<std::string>> columns;  // columns[c][row], decimal points
  std::vector<long> line;                         // line[row] in the source
  std::vector<int> block;                         // 0, then one more after each repeated header
  std::vector<std::string> notes;                 // what was assumed, for people

  std::size_t rows() const { return line.size(); }
};

// Reads a table. `names` replaces the header of a file that has none. Error(kBadInput) with the
// line: no table, no header, rows of the wrong length (up to ten are listed), decimal marks mixed.
RawTable read_raw_table(Input& input, const std::vector<std::string>& names = {});

}  // namespace hapsim
