#include <algorithm>
#include <set>

#include "base/error.h"
#include "io/csv.h"
#include "io/wrapped.h"

namespace hapsim {
namespace {

constexpr std::size_t kLongestRow = 16 * 1024 * 1024;

bool begins(std::string_view text, std::string_view with) {
  return text.substr(0, with.size()) == with;
}

// Refuses what is certainly no CSV, by its first line, and says what it is.
void check_kind(const std::string& name, std::string_view first) {
  const std::string table = "a CSV table is needed";
  refuse_wrapped(name, first);
  if (trim(first) == "ply") fail_input(name, "this is a PLY file", table);
  if (begins(first, "solid ")) fail_input(name, "this looks like an STL file", table);
}

// `where` is asked for when something is wrong: live streams take no memory line by line.
template <class Where>
void check_text(const Where& where, std::string_view line) {
  if (line.find('\r') != line.npos && line.find('\0') == line.npos)
    fail_input(where(), "a carriage return stands inside a line", "end lines with LF or CRLF");
  const auto is_binary = [](char c) { return static_cast<unsigned char>(c) < 0x20 && c != '\t'; };
  if (std::any_of(line.begin(), line.end(), is_binary))
    fail_input(where(), "this looks like a binary file", "a CSV table is needed");
}

bool opens_quote(std::string_view line) {
  return std::count(line.begin(), line.end(), '"') % 2 != 0;
}

char find_separator(std::string_view header) {
  std::size_t counts[3] = {0, 0, 0};
  constexpr std::string_view kSeparators = ",;\t";
  bool quoted = false;
  for (const char c : header) {
    if (c == '"') quoted = !quoted;
    const std::size_t which = kSeparators.find(c);
    if (!quoted && which != kSeparators.npos) ++counts[which];
  }
  return kSeparators[static_cast<std::size_t>(std::max_element(counts, counts + 3) - counts)];
}

// Digits, `mark`, digits, perhaps an exponent: a number if the mark is a point.
bool is_decimal(std::string_view text, char mark) {
  const auto digits = [&text] {
    std::size_t n = 0;
    while (n < text.size() && text[n] >= '0' && text[n] <= '9') ++n;
    text.remove_prefix(n);
    return n;
  };
  const auto sign = [&text] {
    if (!text.empty() && (text[0] == '-' || text[0] == '+')) text.remove_prefix(1);
  };
  text = trim(text);
  sign();
  const std::size_t whole = digits();
  if (text.empty() || text[0] != mark) return false;
  text.remove_prefix(1);
  if (whole + digits() == 0) return false;
  if (text.empty()) return true;
  if (text[0] != 'e' && text[0] != 'E') return false;
  text.remove_prefix(1);
  sign();
  return digits() > 0 && text.empty();
}

}  // namespace

CsvReader::CsvReader(Input& input) : input_(input) {
  read_header();
}

std::string CsvReader::where() const {
  return input_.name() + ":" + std::to_string(line_);
}

// Next line that is neither blank nor a comment.
bool CsvReader::read_line() {
  while (input_.read_line(text_)) {
    line_ = ++lines_read_;
    if (line_ == 1) {
      if (begins(text_, "\xef\xbb\xbf")) text_.erase(0, 3);
      check_kind(input_.name(), text_);
    }
    if (!text_.empty() && text_.back() == '\r') text_.pop_back();
    check_text([this] { return where(); }, text_);
    if (!text_.empty() && text_[0] == '#')
      metadata_.add_line(std::string_view(text_).substr(1));
    else if (!trim(text_).empty())
      return true;
  }
  return false;
}

// A quoted field may hold line breaks: the row goes on until its quotes are closed.
void CsvReader::join_quoted_lines() {
  if (text_.find('"') == text_.npos) return;
  bool open = opens_quote(text_);
  while (open) {
    const bool more = input_.read_line(more_);
    if (!more || text_.size() > kLongestRow)
      fail_input(where(), "a quote opens and never closes",
                 "close it, or double it inside a field");
    ++lines_read_;
    if (!more_.empty() && more_.back() == '\r') more_.pop_back();
    check_text([this] { return where(); }, more_);
    if (opens_quote(more_)) open = false;
    text_ += '\n';
    text_ += more_;
  }
}

void CsvReader::read_header() {
  if (!read_line())
    fail_input(input_.name(), lines_read_ == 0 ? "the file is empty" : "there is no header row",
               "the first row must name the columns");
  join_quoted_lines();
  separator_ = find_separator(text_);
  std::vector<std::string_view> names;
  split(names);
  double value;
  if (std::all_of(names.begin(), names.end(), [&](auto name) { return parse_number(name, value); }))
    fail_input(where(), "the first row holds numbers, not names of columns", "add a header row");
  std::set<std::string_view> seen;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const std::string_view name = trim(names[c]);
    if (name.empty())
      fail_input(where(), "column " + std::to_string(c + 1) + " has no name",
                 "name it or remove it (an index column, a separator too much?)");
    if (!seen.insert(name).second)
      fail_input(where(), "two columns are named " + shown(name), "rename one of them");
    header_.emplace_back(name);
  }
}

// Splits text_ at the separator, undoing quotes in place.
void CsvReader::split(std::vector<std::string_view>& fields) {
  fields.clear();
  char* read = text_.data();
  char* const end = read + text_.size();
  const bool any_quote = text_.find('"') != text_.npos;
  while (true) {
    if (!any_quote || read == end || *read != '"') {
      char* stop = std::find(read, end, separator_);
      fields.emplace_back(read, static_cast<std::size_t>(stop - read));
      if (stop == end) return;
      read = stop + 1;
      continue;
    }
    char* const start = ++read;
    char* write = start;
    while (read < end) {
      if (*read == '"') {
        if (read + 1 == end || read[1] != '"') break;
        ++read;
      }
      *write++ = *read++;
    }
    if (read == end)
      fail_input(where(), "a quote opens and never closes",
                 "close it, or double it inside a field");
    fields.emplace_back(start, static_cast<std::size_t>(write - start));
    if (++read == end) return;
    if (*read != separator_)
      fail_input(where(), "text follows a closing quote", "double a quote that is part of a field");
    ++read;
  }
}

// Where semicolons or tabs separate, 0,5 is a half as long as no number is written 0.5.
void CsvReader::mend_decimal_commas(std::vector<std::string_view>& fields) {
  for (const std::string_view field : fields) {
    if (point_line_ == 0 && is_decimal(field, '.')) point_line_ = line_;
    if (!is_decimal(field, ',')) continue;
    if (comma_line_ == 0) comma_line_ = line_;
    text_[static_cast<std::size_t>(field.data() - text_.data()) + field.find(',')] = '.';
  }
  if (comma_line_ != 0 && point_line_ != 0)
    fail_input(where(),
               "decimal commas (line " + std::to_string(comma_line_) +
                   ") and decimal points (line " + std::to_string(point_line_) + ") are mixed",
               "write all numbers with a point");
}

bool CsvReader::next(std::vector<std::string_view>& fields) {
  if (!read_line()) return false;
  join_quoted_lines();
  split(fields);
  if (fields.size() != header_.size())
    fail_input(where(),
               std::to_string(fields.size()) + " fields where the header names " +
                   std::to_string(header_.size()),
               separator_ == ',' && fields.size() > header_.size()
                   ? "write decimal points, not commas, and quote text that holds a comma"
                   : "complete the row or remove it");
  if (separator_ != ',') mend_decimal_commas(fields);
  return true;
}

}  // namespace hapsim
