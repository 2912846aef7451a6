#include <cassert>

#include "io/csv.h"

namespace hapsim {
namespace {

void append_field(std::string& line, std::string_view field, bool first) {
  const bool quote = field.find_first_of(",\"\n\r;\t") != field.npos ||
                     (first && (field.empty() || field[0] == '#')) ||
                     (!field.empty() && (field.front() == ' ' || field.back() == ' '));
  if (!quote) {
    line += field;
    return;
  }
  line += '"';
  for (const char c : field) {
    if (c == '"') line += '"';
    line += c;
  }
  line += '"';
}

std::string joined(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t c = 0; c < fields.size(); ++c) {
    if (c > 0) line += ',';
    append_field(line, fields[c], c == 0);
  }
  return line += '\n';
}

}  // namespace

CsvWriter::CsvWriter(std::ostream& out, const Metadata& metadata,
                     const std::vector<std::string>& header)
    : out_(out), width_(header.size()) {
  for (const Metadata::Line& line : metadata.lines()) {
    if (!line.key.empty())
      out_ << "# " << line.key << ": " << line.value << '\n';
    else
      out_ << (line.value.empty() ? "#" : "# ") << line.value << '\n';
  }
  out_ << joined(header);
}

void CsvWriter::row(const std::vector<std::string>& fields) {
  assert(fields.size() == width_);
  out_ << joined(fields);
}

}  // namespace hapsim
