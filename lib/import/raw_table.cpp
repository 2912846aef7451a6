#include "import/raw_table.h"

#include <algorithm>
#include <map>
#include <set>

#include "base/error.h"
#include "import/raw_rows.h"
#include "import/text_decode.h"
#include "import/unit_name.h"
#include "io/number.h"

namespace hapsim {
namespace {

struct TextLine {
  long number;
  std::string_view text;
};

bool is_comment(std::string_view line) {
  return !line.empty() && (line[0] == '#' || line[0] == '%' || line.substr(0, 2) == "//");
}

// Splits the text into lines; comments go to the metadata, blank lines go.
std::vector<TextLine> lines_of(std::string_view text, Metadata& metadata) {
  std::vector<TextLine> lines;
  long number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    ++number;
    if (is_comment(trim(line))) {
      metadata.add_line(trim(line).substr(trim(line)[0] == '/' ? 2 : 1));
    } else if (line.find_first_not_of(" \t;,|") != line.npos) {
      lines.push_back({number, line});
    }
  }
  return lines;
}

struct Shape {
  std::size_t width = 0;  // cells of a data row
  bool comma = false;     // decimal commas
};

std::size_t count_numbers(const RawRow& row, bool comma) {
  return static_cast<std::size_t>(
      std::count_if(row.cells.begin(), row.cells.end(),
                    [comma](const auto& cell) { return is_raw_number(cell, comma); }));
}

bool is_data(const RawRow& row, const Shape& shape) {
  const std::size_t numbers = count_numbers(row, shape.comma);
  const auto filled = static_cast<std::size_t>(std::count_if(
      row.cells.begin(), row.cells.end(), [](const auto& cell) { return !is_missing(cell); }));
  return row.cells.size() == shape.width && numbers >= 2 && 2 * numbers >= filled;
}

// A row of units has at least one unit and nothing but units; without brackets single letters such
// as "t" or "F" are no units, so a header is not taken for one.
bool is_units(const RawRow& row) {
  bool any = false;
  for (const std::string& cell : row.cells) {
    const std::string bare = fold(cell);
    if (bare.find_first_not_of(" []()") == bare.npos) continue;
    if (parse_unit(cell).kind == UnitKind::kNone) return false;
    any = true;
  }
  return any;
}

void drop_trailing_cell(std::vector<RawRow>& rows) {
  for (RawRow& row : rows)
    if (row.cells.size() > 1 && row.cells.back().empty()) row.cells.pop_back();
}

// Most frequent width of the rows that hold numbers, and whether commas are decimal marks.
Shape find_shape(const std::vector<RawRow>& rows, char separator, const std::string& name) {
  Shape shape;
  std::map<std::size_t, std::size_t> widths;
  long comma_line = 0, point_line = 0;
  for (const RawRow& row : rows) {
    if (count_numbers(row, true) < 2) continue;
    ++widths[row.cells.size()];
    for (const std::string& cell : row.cells) {
      if (cell.find('.') != cell.npos && is_raw_number(cell, false)) point_line = row.line;
      if (cell.find(',') != cell.npos && is_raw_number(cell, true)) comma_line = row.line;
    }
  }
  if (separator != ',' && comma_line && point_line)
    fail_input(name,
               "decimal commas (line " + std::to_string(comma_line) +
                   ") and decimal points (line " + std::to_string(point_line) + ") are mixed",
               "write all numbers with a point");
  shape.comma = comma_line != 0;
  const auto most =
      std::max_element(widths.begin(), widths.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most != widths.end()) shape.width = most->first;
  return shape;
}

void set_header(RawTable& table, const std::vector<std::string>& names, std::size_t width,
                const std::string& where) {
  if (names.size() != width)
    fail_input(where,
               "the header names " + std::to_string(names.size()) +
                   " columns where the rows have " + std::to_string(width),
               "give each column a name, or name them by --names");
  std::set<std::string> seen;
  for (std::size_t c = 0; c < width; ++c) {
    std::string name = names[c].empty() ? "column " + std::to_string(c + 1) : names[c];
    while (!seen.insert(name).second) name += "'";
    table.header.push_back(name);
  }
  table.unit.assign(width, "");
  table.columns.resize(width);
}

class BadRows {
 public:
  void add(const std::string& name, const RawRow& row, std::size_t width) {
    if (++count_ == 1)
      first_ = name + ":" + std::to_string(row.line);
    else if (count_ <= 10)
      others_ += (others_.empty() ? "" : ", ") + std::to_string(row.line);
    if (count_ == 1)
      wrong_ = std::to_string(row.cells.size()) + " cells where the header names " +
               std::to_string(width);
    if (count_ == 1 && row.cells.size() == width) wrong_ = "a row without numbers";
  }
  std::size_t count() const { return count_; }
  void fail_if_any() const {
    if (count_ == 0) return;
    fail_input(first_,
               wrong_ + (others_.empty()
                             ? ""
                             : " (so are lines " + others_ + (count_ > 10 ? ", ..." : "") + ")"),
               "complete the rows or remove them");
  }

 private:
  std::size_t count_ = 0;
  std::string first_, wrong_, others_;
};

void add_row(RawTable& table, const RawRow& row, bool comma, int block) {
  for (std::size_t c = 0; c < row.cells.size(); ++c) {
    std::string cell = row.cells[c];
    if (comma && is_raw_number(cell, true)) std::replace(cell.begin(), cell.end(), ',', '.');
    table.columns[c].push_back(std::move(cell));
  }
  table.line.push_back(row.line);
  table.block.push_back(block);
}

}  // namespace

RawTable read_raw_table(Input& input, const std::vector<std::string>& names) {
  RawTable table;
  table.name = input.name();
  const std::string text = decode_text(input.read_all(), table.name);
  const std::vector<TextLine> lines = lines_of(text, table.metadata);
  if (lines.empty())
    fail_input(table.name, "the file is empty", "a table with a header row is needed");

  std::vector<std::string_view> sample;  // from the middle, away from titles
  for (std::size_t i = lines.size() / 2; i < lines.size() && sample.size() < 200; ++i)
    sample.push_back(lines[i].text);
  const char separator = find_separator(sample);
  if (separator == 0)
    fail_input(table.name, "no table of numbers is found",
               "columns separated by tabs, semicolons, commas or spaces are needed");
  std::vector<RawRow> rows;
  rows.reserve(lines.size());
  for (const TextLine& line : lines)
    rows.push_back({line.number, split_cells(line.text, separator)});

  Shape shape = find_shape(rows, separator, table.name);
  if (std::all_of(rows.begin(), rows.end(), [&shape](const RawRow& row) {
        return row.cells.size() < shape.width || row.cells.back().empty() || !is_data(row, shape);
      })) {
    drop_trailing_cell(rows);
    shape = find_shape(rows, separator, table.name);
  }

  std::size_t first = 0;
  while (first < rows.size() && !is_data(rows[first], shape)) ++first;
  if (first == rows.size()) fail_input(table.name, "no row of numbers is found", "see --list");
  std::size_t head = first;  // one past the header
  std::size_t units = rows.size();
  if (head >= 1 && is_units(rows[head - 1]) && (head >= 2 || !names.empty())) units = --head;
  const bool has_header = head >= 1 && rows[head - 1].cells.size() > 1;
  if (!names.empty()) {
    set_header(table, names, shape.width, table.name);
  } else if (has_header) {
    set_header(table, rows[head - 1].cells, shape.width,
               table.name + ":" + std::to_string(rows[head - 1].line));
  } else {
    fail_input(table.name + ":" + std::to_string(rows[first].line),
               "the numbers have no header row",
               "name the columns by --names t,depth,force (or what they are)");
  }
  if (units < rows.size() && rows[units].cells.size() <= shape.width)
    std::copy(rows[units].cells.begin(), rows[units].cells.end(), table.unit.begin());
  for (std::size_t i = 0; has_header && i + 1 < head; ++i) {
    std::string title;
    for (const std::string& cell : rows[i].cells)
      title += (title.empty() || cell.empty() ? "" : " ") + cell;
    table.metadata.add_comment(title);
  }

  BadRows bad;
  int block = 0;
  std::size_t skipped_titles = 0;
  for (std::size_t i = first; i < rows.size(); ++i) {
    const RawRow& row = rows[i];
    const bool repeated = has_header && row.cells == rows[head - 1].cells;
    if (!repeated && row.cells.size() == shape.width && count_numbers(row, true) > 0) {
      add_row(table, row, shape.comma, block);
    } else if (repeated) {
      if (!table.line.empty() && table.block.back() == block) ++block;
    } else if (units < rows.size() && row.cells == rows[units].cells) {
      continue;
    } else if (count_numbers(row, true) == 0 && row.cells.size() == shape.width &&
               std::all_of(row.cells.begin(), row.cells.end(),
                           [](const auto& c) { return is_missing(c); })) {
      table.notes.push_back("line " + std::to_string(row.line) +
                            " is left out: it holds no number");
    } else {
      // Titles of a further recording stand before its header; a cut last row is a stopped logger.
      const auto next = std::find_if(
          rows.begin() + static_cast<std::ptrdiff_t>(i), rows.end(),
          [&](const RawRow& r) { return has_header && r.cells == rows[head - 1].cells; });
      const bool title = next != rows.end() && count_numbers(row, true) < 2 &&
                         std::none_of(rows.begin() + static_cast<std::ptrdiff_t>(i), next,
                                      [&](const RawRow& r) { return is_data(r, shape); });
      if (title)
        ++skipped_titles;
      else if (i + 1 == rows.size() && row.cells.size() < shape.width)
        table.notes.push_back("line " + std::to_string(row.line) +
                              " is left out: the last row is cut");
      else
        bad.add(table.name, row, shape.width);
      if (bad.count() > 10) break;
    }
  }
  bad.fail_if_any();
  if (block > 0)
    table.notes.push_back(std::to_string(block + 1) + " recordings, one after each header");
  if (skipped_titles)
    table.notes.push_back(std::to_string(skipped_titles) + " lines between them are titles");
  if (shape.comma) table.notes.push_back("decimal commas");
  return table;
}

}  // namespace hapsim
