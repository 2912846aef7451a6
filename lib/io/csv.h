// CSV as hapsim writes and reads it: `#` comments and metadata, a header row, columns by name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "io/metadata.h"
#include "io/number.h"
#include "io/stream.h"

namespace hapsim {

// One row at a time, in bounded memory. Separator found from the header (comma, semicolon or tab);
// UTF-8 byte-order mark, CRLF and quoted fields are understood; decimal commas too, where commas do
// not separate. Error(kBadInput) for UTF-16, binary bytes, and commas mixed with decimal points.
class CsvReader {
 public:
  // Reads comments, metadata and the header. Error(kBadInput) when there is no header, or one with
  // numbers, empty or equal names.
  explicit CsvReader(Input& input);
  const Metadata& metadata() const { return metadata_; }
  const std::vector<std::string>& header() const { return header_; }
  // Next data row, false at the end; the fields live until the next call. Comment lines between
  // rows go to metadata(). A row with a wrong number of fields is Error(kBadInput) with its line.
  bool next(std::vector<std::string_view>& fields);
  long line() const { return line_; }  // of the last row, counted from 1
  std::string where() const;           // "data.csv:17"

 private:
  bool read_line();
  void read_header();
  void join_quoted_lines();
  void split(std::vector<std::string_view>& fields);
  void mend_decimal_commas(std::vector<std::string_view>& fields);
  Input& input_;
  Metadata metadata_;
  std::vector<std::string> header_;
  std::string text_;
  std::string more_;
  char separator_ = ',';
  long line_ = 0;
  long lines_read_ = 0;
  long comma_line_ = 0;  // first line with a decimal comma, a decimal point; 0: none yet
  long point_line_ = 0;
};

// Throws Error(kBadInput): column `missing` is not in `header`; names the nearest that is, apart
// from `taken` ones, which have a meaning of their own.
[[noreturn]] void fail_missing_column(const std::string& where, const std::string& missing,
                                      const std::vector<std::string>& header,
                                      const std::vector<std::string>& taken = {});

// Cells that are not finite numbers, gathered to be reported together in one line.
class BadCells {
 public:
  void add(const std::string& column, long line, std::string_view cell);
  bool full() const { return count_ >= 10; }
  // Throws Error(kBadInput) naming up to ten cells with column and line, if there are any.
  void fail_if_any(const std::string& where) const;

 private:
  std::string list_;
  std::size_t count_ = 0;
};

// A whole table as text, column by column.
struct CsvTable {
  std::string name;  // of the source, for error messages
  Metadata metadata;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> columns;  // columns[c][row]
  std::vector<long> line;                         // line[row] in the source

  std::size_t rows() const { return line.size(); }
  int find(const std::string& column) const;  // index, -1 when absent
  // Finite numbers of a column. Error(kBadInput) naming the column that is missing and the nearest
  // present one; or listing up to ten bad cells with their lines ("nan", "inf", text, empty).
  std::vector<double> numbers(const std::string& column) const;
};

CsvTable read_csv(Input& input);
// What a reader has not read yet; `name`: of the source.
CsvTable read_rows(CsvReader& reader, const std::string& name);

// Writes metadata, header and rows; fields are quoted where they must be.
class CsvWriter {
 public:
  CsvWriter(std::ostream& out, const Metadata& metadata, const std::vector<std::string>& header);
  void row(const std::vector<std::string>& fields);

 private:
  std::ostream& out_;
  std::size_t width_;
};

}  // namespace hapsim
