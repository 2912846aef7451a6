#include <algorithm>
#include <map>

#include "base/error.h"
#include "io/number.h"
#include "tables/column_name.h"
#include "tables/container.h"
#include "tables/fold.h"
#include "tables/header_words.h"
#include "tables/number_style.h"
#include "tables/raw_rows.h"
#include "tables/text_decode.h"
#include "tables/trailing_block.h"
#include "tables/unit_name.h"

namespace hapsim {
namespace {

struct TextLine {
  long number;
  std::string_view text;
};

bool is_comment(std::string_view line) {
  return !line.empty() && (line[0] == '#' || line[0] == '%' || line.substr(0, 2) == "//");
}

// Splits the text into lines; comments go apart, blank lines go.
std::vector<TextLine> lines_of(std::string_view text, std::vector<TextLine>& comments) {
  std::vector<TextLine> lines;
  long number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    ++number;
    if (is_comment(trim(line))) {
      comments.push_back({number, trim(line).substr(trim(line)[0] == '/' ? 2 : 1)});
    } else if (line.find_first_not_of(" \t;,|") != line.npos) {
      lines.push_back({number, line});
    }
  }
  return lines;
}

std::size_t count_numbers(const RawRow& row) {
  return static_cast<std::size_t>(
      std::count_if(row.cells.begin(), row.cells.end(),
                    [](const auto& cell) { return may_be_number(cell) || may_be_moment(cell); }));
}

bool is_data(const RawRow& row, std::size_t width) {
  const std::size_t numbers = count_numbers(row);
  const auto filled = static_cast<std::size_t>(std::count_if(
      row.cells.begin(), row.cells.end(), [](const auto& cell) { return !is_missing(cell); }));
  return row.cells.size() == width && numbers >= 2 && 2 * numbers >= filled;
}

std::size_t known_words(const std::vector<std::string>& cells) {
  return static_cast<std::size_t>(std::count_if(cells.begin(), cells.end(), [](const auto& cell) {
    return is_known_word(take_apart(cell).joined());
  }));
}

// A row of units has nothing but units, or stands below a header whose words are known and is
// mostly units; without brackets single letters such as "t" or "F" are no units, so a header is not
// taken for one.
bool is_units(const RawRow& row, const RawRow* above) {
  std::size_t units = 0, others = 0;
  for (const std::string& cell : row.cells) {
    const std::string bare = fold(cell);
    if (bare.find_first_not_of(" []()") == bare.npos) continue;
    ++(parse_unit(cell).kind == UnitKind::kNone ? others : units);
  }
  const bool below_header =
      above && above->cells.size() >= row.cells.size() && known_words(above->cells) >= 2;
  return units > 0 && (others == 0 || (below_header && units > others));
}

void drop_trailing_cell(std::vector<RawRow>& rows) {
  for (RawRow& row : rows)
    if (row.cells.size() > 1 && row.cells.back().empty()) row.cells.pop_back();
}

// Most frequent width of the rows that hold numbers.
std::size_t find_width(const std::vector<RawRow>& rows) {
  std::map<std::size_t, std::size_t> widths;
  for (const RawRow& row : rows)
    if (count_numbers(row) >= 2) ++widths[row.cells.size()];
  const auto most =
      std::max_element(widths.begin(), widths.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == widths.end() ? 0 : most->first;
}

// The first row of numbers. Results above a table may have rows of its width: they are few beside
// it, and another header stands between.
std::size_t first_row(const std::vector<RawRow>& rows, std::size_t width) {
  std::vector<std::pair<std::size_t, std::size_t>> runs;  // first, one past the last
  std::size_t longest = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!is_data(rows[i], width)) continue;
    if (runs.empty() || runs.back().second != i) runs.emplace_back(i, i);
    runs.back().second = i + 1;
    longest = std::max(longest, i + 1 - runs.back().first);
  }
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const std::size_t first = runs[r].first, end = runs[r].second;
    if (10 * (end - first) >= longest || r + 1 == runs.size()) return first;
    const auto other_header = [&](const RawRow& row) {
      return count_numbers(row) == 0 && known_words(row.cells) >= 2 &&
             (first == 0 || row.cells != rows[first - 1].cells) &&
             (first < 2 || row.cells != rows[first - 2].cells);
    };
    if (std::none_of(rows.begin() + static_cast<std::ptrdiff_t>(end),
                     rows.begin() + static_cast<std::ptrdiff_t>(runs[r + 1].first), other_header))
      return first;
  }
  return rows.size();
}

void check_width(const std::vector<std::string>& names, std::size_t width,
                 const std::string& where) {
  if (names.size() != width)
    fail_input(where,
               "the header names " + std::to_string(names.size()) +
                   " columns where the rows have " + std::to_string(width),
               "give each column a name, or name them by --names");
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

void add_row(RawTable& table, const RawRow& row, const NumberStyle& style, int block) {
  for (std::size_t c = 0; c < row.cells.size(); ++c)
    table.columns[c].push_back(plain_number(row.cells[c], style));
  table.line.push_back(row.line);
  table.block.push_back(block);
}

// A comment above the rows that names the columns: "# t, x, force", as numpy and rostopic write it.
const TextLine* header_comment(const std::vector<TextLine>& comments, long before, char separator,
                               std::size_t width) {
  const TextLine* found = nullptr;
  for (const TextLine& comment : comments) {
    if (comment.number >= before) break;
    const auto cells = split_cells(trim(comment.text), separator);
    if (cells.size() == width && known_words(cells) >= std::min<std::size_t>(2, width))
      found = &comment;
  }
  return found;
}

RawTable read_text(const std::string& bytes, const std::string& name, const TableOptions& options) {
  RawTable table;
  table.name = name;
  const DecodedText decoded = decode_text(bytes, options.encoding, name);
  std::vector<TextLine> comments;
  const std::vector<TextLine> lines = lines_of(decoded.text, comments);
  if (lines.empty()) fail_input(name, "the file is empty", "a table with a header row is needed");

  std::vector<std::string_view> sample;  // from the middle, away from titles
  for (std::size_t i = lines.size() / 2; i < lines.size() && sample.size() < 200; ++i)
    sample.push_back(lines[i].text);
  const char separator = find_separator(sample);
  if (separator == 0)
    fail_input(name, "no table of numbers is found",
               "columns separated by tabs, semicolons, commas or spaces are needed");
  std::vector<RawRow> rows;
  rows.reserve(lines.size());
  for (const TextLine& line : lines)
    rows.push_back({line.number, split_cells(line.text, separator)});

  std::size_t width = find_width(rows);
  if (std::all_of(rows.begin(), rows.end(), [width](const RawRow& row) {
        return row.cells.size() < width || row.cells.back().empty() || !is_data(row, width);
      })) {
    drop_trailing_cell(rows);
    width = find_width(rows);
  }

  const std::size_t first = first_row(rows, width);
  if (first == rows.size()) fail_input(name, "no row of numbers is found", "see --list");
  std::size_t head = first;  // one past the header
  std::size_t units = rows.size();
  if (head >= 1 && is_units(rows[head - 1], head >= 2 ? &rows[head - 2] : nullptr) &&
      (head >= 2 || !options.names.empty()))
    units = --head;
  bool has_header = head >= 1 && rows[head - 1].cells.size() > 1;
  const TextLine* comment =
      options.names.empty() && (!has_header || rows[head - 1].cells.size() != width)
          ? header_comment(comments, rows[first].line, separator, width)
          : nullptr;
  if (!options.names.empty()) {
    check_width(options.names, width, name);
    table.set_header(options.names);
  } else if (comment) {
    table.set_header(split_cells(trim(comment->text), separator));
    has_header = false;
  } else if (has_header) {
    check_width(rows[head - 1].cells, width, name + ":" + std::to_string(rows[head - 1].line));
    table.set_header(rows[head - 1].cells);
  } else {
    fail_input(name + ":" + std::to_string(rows[first].line), "the numbers have no header row",
               "name the columns by --names t,depth,force (or what they are)");
  }
  for (const TextLine& line : comments)
    if (&line != comment) table.metadata.add_line(line.text);
  if (units < rows.size() && rows[units].cells.size() <= width)
    std::copy(rows[units].cells.begin(), rows[units].cells.end(), table.unit.begin());
  for (std::size_t i = 0; has_header && i + 1 < head; ++i) {
    std::string title;
    for (const std::string& cell : rows[i].cells)
      title += (title.empty() || cell.empty() ? "" : " ") + cell;
    table.metadata.add_comment(title);
  }

  const std::size_t end = table_end(rows, first, width, has_header ? &rows[head - 1] : nullptr);
  StyleFinder styles;
  for (std::size_t i = first; i < end; ++i)
    if (rows[i].cells.size() == width && count_numbers(rows[i]) >= 2)
      for (const std::string& cell : rows[i].cells) styles.add(cell, rows[i].line);
  const NumberStyle style = styles.find(options.decimal, name);

  BadRows bad;
  int block = 0;
  std::size_t skipped_titles = 0;
  for (std::size_t i = first; i < end; ++i) {
    const RawRow& row = rows[i];
    const bool repeated = has_header && row.cells == rows[head - 1].cells;
    if (!repeated && row.cells.size() == width && count_numbers(row) > 0) {
      add_row(table, row, style, block);
    } else if (repeated) {
      if (!table.line.empty() && table.block.back() == block) ++block;
    } else if (units < rows.size() && row.cells == rows[units].cells) {
      continue;
    } else if (count_numbers(row) == 0 && row.cells.size() == width &&
               std::all_of(row.cells.begin(), row.cells.end(),
                           [](const auto& c) { return is_missing(c); })) {
      table.notes.push_back("line " + std::to_string(row.line) +
                            " is left out: it holds no number");
    } else {
      // Titles of a further recording stand before its header; a cut last row is a stopped logger.
      const auto next = std::find_if(
          rows.begin() + static_cast<std::ptrdiff_t>(i), rows.end(),
          [&](const RawRow& r) { return has_header && r.cells == rows[head - 1].cells; });
      const bool title = next != rows.end() && count_numbers(row) < 2 &&
                         std::none_of(rows.begin() + static_cast<std::ptrdiff_t>(i), next,
                                      [&](const RawRow& r) { return is_data(r, width); });
      if (title)
        ++skipped_titles;
      else if (i + 1 == rows.size() && row.cells.size() < width)
        table.notes.push_back("line " + std::to_string(row.line) +
                              " is left out: the last row is cut");
      else
        bad.add(name, row, width);
      if (bad.count() > 10) break;
    }
  }
  bad.fail_if_any();
  if (block > 0)
    table.notes.push_back(std::to_string(block + 1) + " recordings, one after each header");
  if (skipped_titles)
    table.notes.push_back(std::to_string(skipped_titles) + " lines between them are titles");
  if (end < rows.size())
    table.notes.push_back("line " + std::to_string(rows[end].line) +
                          (end + 1 < rows.size() ? " to " + std::to_string(rows.back().line) : "") +
                          " below the table: left out (" + shown(rows[end].cells[0]) + ")");
  if (decoded.guessed || (decoded.encoding != "UTF-8" && options.encoding.empty()))
    table.notes.push_back("the text is " + decoded.encoding +
                          (decoded.guessed ? " by its looks (--encoding says otherwise)" : ""));
  if (style.decimal == ',') table.notes.push_back("decimal commas");
  if (style.thousands)
    table.notes.push_back(std::string("'") + style.thousands + "' stands between thousands");
  return table;
}

}  // namespace

const Container kTextFile{"text", [](const std::string&) { return true; }, read_text};

}  // namespace hapsim
