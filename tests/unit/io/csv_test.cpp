#include "io/csv.h"

#include <sstream>

#include "expect_error.h"

namespace hapsim {
namespace {

CsvTable table_of(const std::string& text) {
  Input input = Input::from_bytes(text, "t.csv");
  return read_csv(input);
}

std::string csv_failure(const std::string& text) {
  return error_of([&] { table_of(text); });
}

using Row = std::vector<std::string>;
using Numbers = std::vector<double>;

TEST(Csv, ReadsColumnsByName) {
  const CsvTable t = table_of("# a: 1\nx,y\n1,2\n3,4");
  EXPECT_EQ(t.header, (Row{"x", "y"}));
  EXPECT_EQ(t.numbers("y"), (Numbers{2, 4}));
  EXPECT_EQ(t.metadata.find("a"), "1");
  EXPECT_EQ(t.line, (std::vector<long>{3, 4}));
}

TEST(Csv, FindsTheSeparator) {
  EXPECT_EQ(table_of("x;y\n1;2\n").numbers("y"), (Numbers{2}));
  EXPECT_EQ(table_of("x\ty\n1\t2\n").numbers("y"), (Numbers{2}));
  EXPECT_EQ(table_of("\"a;b\",c\n1,2\n").header, (Row{"a;b", "c"}));
  EXPECT_EQ(table_of("x\n1\n").numbers("x"), (Numbers{1}));
}

TEST(Csv, UnderstandsMarkCarriageReturnsAndQuotes) {
  const CsvTable t =
      table_of("\xef\xbb\xbfx,note\r\n1,\"a, \"\"b\"\"\"\r\n\r\n2,\"two\r\nlines\"\r\n3,c");
  EXPECT_EQ(t.header, (Row{"x", "note"}));
  EXPECT_EQ(t.columns[1], (Row{"a, \"b\"", "two\nlines", "c"}));
  EXPECT_EQ(t.line, (std::vector<long>{2, 4, 6}));
}

TEST(Csv, GathersCommentsBetweenRows) {
  const CsvTable t = table_of("x\n1\n# later: yes\n2\n");
  EXPECT_EQ(t.metadata.find("later"), "yes");
  EXPECT_EQ(t.rows(), 2u);
}

TEST(Csv, UnderstandsDecimalCommas) {
  EXPECT_EQ(table_of("x;y\n1,5;-2,5e-3\n").numbers("y"), (Numbers{-2.5e-3}));
  EXPECT_EQ(table_of("x\ty\n,5\t2\n").numbers("x"), (Numbers{0.5}));
  EXPECT_EQ(csv_failure("x;y\n1,5;2\n1.5;2\n"),
            "t.csv:3: decimal commas (line 2) and decimal points (line 3) are mixed; write all "
            "numbers with a point");
  EXPECT_EQ(csv_failure("x,y\n1,5,2,5\n"),
            "t.csv:2: 4 fields where the header names 2; write decimal points, not commas, and "
            "quote text that holds a comma");
}

TEST(Csv, RefusesWrongRows) {
  EXPECT_EQ(csv_failure("x,y\n1,2\n3\n"),
            "t.csv:3: 1 fields where the header names 2; complete the row or remove it");
  EXPECT_EQ(csv_failure("x,y\n1,\"2\n3\n"),
            "t.csv:2: a quote opens and never closes; close it, or double it inside a field");
  EXPECT_EQ(csv_failure("x,y\n1,\"2\"3\n"),
            "t.csv:2: text follows a closing quote; double a quote that is part of a field");
}

TEST(Csv, NeedsAHeader) {
  EXPECT_EQ(csv_failure(""), "t.csv: the file is empty; the first row must name the columns");
  EXPECT_EQ(csv_failure("# only\n"),
            "t.csv: there is no header row; the first row must name the columns");
  EXPECT_EQ(csv_failure("1,2,3\n4,5,6\n"),
            "t.csv:1: the first row holds numbers, not names of columns; add a header row");
  EXPECT_EQ(csv_failure("x,y,x\n"), "t.csv:1: two columns are named 'x'; rename one of them");
  EXPECT_EQ(csv_failure("x,,y\n"),
            "t.csv:1: column 2 has no name; name it or remove it (an index column, a separator too "
            "much?)");
  EXPECT_EQ(table_of("x,y\n").rows(), 0u);
}

TEST(Csv, SaysWhatElseTheFileIs) {
  EXPECT_NE(csv_failure(std::string("x\0y", 3)).find("looks like a binary file"),
            std::string::npos);
  EXPECT_NE(csv_failure("x,y\n1,\x01\n").find("t.csv:2: this looks like a binary file"),
            std::string::npos);
  EXPECT_NE(csv_failure(std::string("\xff\xfex\0,\0", 6)).find("UTF-16"), std::string::npos);
  EXPECT_NE(csv_failure(std::string("x\0,\0y\0", 6)).find("UTF-16"), std::string::npos);
  EXPECT_NE(csv_failure(std::string(6, '\0')).find("binary file"), std::string::npos);
  EXPECT_NE(csv_failure("ply\nformat ascii 1.0\n").find("PLY"), std::string::npos);
  EXPECT_NE(csv_failure("PK\x03\x04zzz").find("spreadsheet"), std::string::npos);
  EXPECT_NE(csv_failure("x,y\r1,2\r").find("carriage return"), std::string::npos);
}

TEST(Csv, ListsBadCellsInOneLine) {
  const CsvTable t = table_of("x,fx\n1,nan\n2,\n3,abc\n4,inf\n5,1\n");
  EXPECT_EQ(
      error_of([&] { t.numbers("fx"); }),
      "t.csv: cells are not finite numbers: fx is 'nan' (line 2), fx is empty (line 3), fx is "
      "'abc' (line 4), fx is 'inf' (line 5); correct or remove the rows");
  std::string many = "x\n";
  for (int i = 0; i < 50; ++i) many += "bad\n";
  const std::string message = error_of([&] { table_of(many).numbers("x"); });
  EXPECT_NE(message.find("(line 11) and more;"), std::string::npos) << message;
  EXPECT_EQ(message.find("line 12"), std::string::npos);
}

TEST(Csv, NamesTheNearestColumn) {
  const CsvTable t = table_of("time,Force_x\n1,2\n");
  EXPECT_EQ(error_of([&] { t.numbers("force_x"); }),
            "t.csv: column 'force_x' is missing; did you mean 'Force_x'? rename it");
  EXPECT_EQ(error_of([&] { t.numbers("uz"); }),
            "t.csv: column 'uz' is missing; present are: time Force_x");
}

TEST(Csv, RoundTrips) {
  Metadata metadata;
  metadata.set("tool_radius", "0.004");
  metadata.add_comment("a comment");
  metadata.add_comment("");
  const Row header{"a", "b c", "d"};
  const std::vector<Row> rows{{"#1", "x,y", "\"q\""}, {"", " lead", "two\nlines"}, {"-", ";", ""}};
  std::ostringstream out;
  CsvWriter writer(out, metadata, header);
  for (const Row& row : rows) writer.row(row);
  const CsvTable t = table_of(out.str());
  EXPECT_EQ(t.header, header);
  ASSERT_EQ(t.rows(), rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (std::size_t c = 0; c < header.size(); ++c) EXPECT_EQ(t.columns[c][r], rows[r][c]);
  std::ostringstream again;
  CsvWriter rewriter(again, t.metadata, t.header);
  for (const Row& row : rows) rewriter.row(row);
  EXPECT_EQ(again.str(), out.str());
}

}  // namespace
}  // namespace hapsim
