#include <algorithm>

#include "base/error.h"
#include "base/nearest.h"
#include "io/csv.h"

namespace hapsim {

void fail_missing_column(const std::string& where, const std::string& missing,
                         const std::vector<std::string>& header,
                         const std::vector<std::string>& taken) {
  std::vector<std::string> candidates = header;
  std::erase_if(candidates, [&](const std::string& name) {
    return std::find(taken.begin(), taken.end(), name) != taken.end();
  });
  const std::string near = nearest(missing, candidates);
  std::string mend;
  if (!near.empty()) {
    mend = "did you mean " + shown(near) + "? rename it";
  } else if (header.size() == 1) {
    mend = "there is one column only; separate columns by commas, semicolons or tabs";
  } else {
    std::string names;
    for (std::size_t c = 0; c < header.size() && c < 20; ++c) names += (c ? " " : "") + header[c];
    mend = "present are: " + names + (header.size() > 20 ? " ..." : "");
  }
  fail_input(where, "column '" + missing + "' is missing", mend);
}

void BadCells::add(const std::string& column, long line, std::string_view cell) {
  if (++count_ > 10) return;
  cell = trim(cell);
  if (count_ > 1) list_ += ", ";
  list_ += column + " is " + (cell.empty() ? "empty" : shown(cell)) + " (line " +
           std::to_string(line) + ")";
}

void BadCells::fail_if_any(const std::string& where) const {
  if (count_ == 0) return;
  fail_input(where,
             (count_ == 1 ? "a cell is not a finite number: " : "cells are not finite numbers: ") +
                 list_ + (count_ > 10 ? " and more" : ""),
             "correct or remove the row" + std::string(count_ == 1 ? "" : "s"));
}

int CsvTable::find(const std::string& column) const {
  for (std::size_t c = 0; c < header.size(); ++c)
    if (header[c] == column) return static_cast<int>(c);
  return -1;
}

std::vector<double> CsvTable::numbers(const std::string& column) const {
  const int c = find(column);
  if (c < 0) fail_missing_column(name, column, header);
  const std::vector<std::string>& cells = columns[static_cast<std::size_t>(c)];
  std::vector<double> values(cells.size());
  BadCells bad;
  for (std::size_t row = 0; row < cells.size(); ++row)
    if (!parse_number(cells[row], values[row])) bad.add(column, line[row], cells[row]);
  bad.fail_if_any(name);
  return values;
}

CsvTable read_csv(Input& input) {
  CsvReader reader(input);
  return read_rows(reader, input.name());
}

CsvTable read_rows(CsvReader& reader, const std::string& name) {
  CsvTable table;
  table.name = name;
  table.header = reader.header();
  table.columns.resize(table.header.size());
  std::vector<std::string_view> fields;
  while (reader.next(fields)) {
    for (std::size_t c = 0; c < fields.size(); ++c) table.columns[c].emplace_back(fields[c]);
    table.line.push_back(reader.line());
  }
  table.metadata = reader.metadata();  // last, for comments may stand between the rows
  return table;
}

}  // namespace hapsim
