// Tables as machines and people export them: any encoding and separator, decimal commas, titles
// above the header, a row of units below it, the header repeated where files were joined,
// statistics below the rows; and the binary files that hold such tables.
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
  std::vector<int> block;                         // 0, then one more where a recording begins
  std::vector<std::string> notes;                 // what was assumed, for people

  std::size_t rows() const { return line.size(); }
  // Columns by these names, "column 3" where one is empty, "Load'" where it is there already.
  void set_header(const std::vector<std::string>& names);
};

struct TableOptions {
  std::vector<std::string> names;  // instead of the header
  std::string encoding;            // of text, as decode() knows it; "": found
  std::string decimal;             // "point", "comma"; "": found
  std::string part;  // of a file of several tables: its group or variable; "": the only one
  std::vector<std::string> topics;  // of a bag: those that are read; empty: the only ones
  bool positions_alone = false;     // of a bag: its forces are not wanted
  std::string length_unit;          // of a bag, whose messages name none; "": m, as ROS has it
};

// Reads a table, whatever the container (tables/container.h). Error(kBadInput) with the line: no
// table, no header, rows of the wrong length (up to ten are listed), decimal marks mixed or
// doubtful; for what only one flag can tell the error names it.
RawTable read_raw_table(Input& input, const TableOptions& options = {});

}  // namespace hapsim
