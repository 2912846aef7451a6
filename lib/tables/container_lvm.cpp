// LabVIEW measurements (.lvm): a header of the file, then segments, each with a header of its own.
// Source: National Instruments, "LabVIEW Measurement File Specification" (2011).
#include <algorithm>
#include <map>

#include "base/error.h"
#include "io/number.h"
#include "tables/container.h"
#include "tables/number_style.h"
#include "tables/raw_rows.h"
#include "tables/text_decode.h"

namespace hapsim {
namespace {

constexpr std::string_view kTitle = "LabVIEW Measurement";
constexpr std::string_view kEndOfHeader = "***End_of_Header***";

using Keys = std::map<std::string, std::vector<std::string>>;

struct LvmSection {
  Keys keys;                 // of its header: a cell a channel
  std::vector<RawRow> rows;  // the first names the columns
};

class LvmReader {
 public:
  LvmReader(const std::string& bytes, const std::string& name, const TableOptions& options)
      : name_(name), decoded_(decode_text(bytes, options.encoding, name)) {
    table_.name = name;
  }

  RawTable read() {
    read_segments();
    if (segments_.empty() || segments_[0].rows.size() < 2)
      fail_input(name_, "the LabVIEW measurement holds no rows", "write it again with its data");
    for (std::size_t s = 0; s < segments_.size(); ++s) add(segments_[s], static_cast<int>(s));
    if (segments_.size() > 1)
      table_.notes.push_back(std::to_string(segments_.size()) + " recordings, one a segment");
    return table_;
  }

 private:
  std::string key(const std::string& name, const std::string& otherwise) const {
    const auto at = file_.find(name);
    return at == file_.end() || at->second.empty() ? otherwise : at->second[0];
  }

  void read_segments() {
    long number = 0;
    bool in_file_header = true, in_header = false;
    char separator = '\t';
    for (std::size_t at = 0; at < decoded_.text.size();) {
      const std::size_t end = std::min(decoded_.text.find('\n', at), decoded_.text.size());
      const std::string_view line = std::string_view(decoded_.text).substr(at, end - at);
      at = end + 1;
      ++number;
      if (number == 1 && line.find(',') != line.npos) separator = ',';
      std::vector<std::string> cells = split_cells(line, separator);
      const bool empty =
          std::all_of(cells.begin(), cells.end(), [](const auto& c) { return c.empty(); });
      if (empty) continue;
      if (cells[0] == kEndOfHeader) {
        in_header = in_file_header = false;
        continue;
      }
      const std::vector<std::string> values(cells.begin() + 1, cells.end());
      if (in_file_header) {
        file_[cells[0]] = values;
        if (cells[0] == "Separator" && !values.empty() && values[0] == "Comma") separator = ',';
        continue;
      }
      if (cells[0] == "Channels") {
        segments_.emplace_back();
        in_header = true;
      }
      if (segments_.empty()) segments_.emplace_back();
      if (in_header)
        segments_.back().keys[cells[0]] = values;
      else
        segments_.back().rows.push_back({number, std::move(cells)});
    }
  }

  void add(const LvmSection& segment, int block) {
    if (segment.rows.empty()) return;
    std::vector<std::string> names = segment.rows[0].cells;
    while (!names.empty() && (names.back() == "Comment" || names.back().empty())) names.pop_back();
    const bool one = key("X_Columns", "One") == "One", none = key("X_Columns", "One") == "No";
    if (none) names.insert(names.begin(), "X_Value");
    if (table_.header.empty()) {
      table_.set_header(names);
      set_units(segment, names, one || none);
    } else if (names.size() != table_.header.size()) {
      fail_input(name_ + ":" + std::to_string(segment.rows[0].line),
                 "this segment has other columns than the first", "cut the file there");
    }
    const NumberStyle style{key("Decimal_Separator", ".") == "," ? ',' : '.', 0};
    double start = 0, step = 0;
    if (none && !(number(segment, "X0", style, start) && number(segment, "Delta_X", style, step) &&
                  step > 0))
      fail_input(name_, "there is no column of X, and X0 and Delta_X do not say it",
                 "write the file with its X");
    for (std::size_t i = 1; i < segment.rows.size(); ++i) {
      const RawRow& row = segment.rows[i];
      std::vector<std::string> cells;
      if (none) {
        cells.push_back(format_number(start + static_cast<double>(i - 1) * step));
        // An empty cell stands where the column of X would be.
        cells.insert(cells.end(),
                     row.cells.begin() + (!row.cells.empty() && row.cells[0].empty() ? 1 : 0),
                     row.cells.end());
      } else {
        cells = row.cells;
      }
      cells.resize(names.size());
      for (std::size_t c = 0; c < names.size(); ++c)
        table_.columns[c].push_back(plain_number(cells[c], style));
      table_.line.push_back(row.line);
      table_.block.push_back(block);
    }
  }

  static bool number(const LvmSection& segment, const std::string& name, const NumberStyle& style,
                     double& value) {
    const auto at = segment.keys.find(name);
    return at != segment.keys.end() && !at->second.empty() &&
           parse_number(plain_number(at->second[0], style), value);
  }

  void set_units(const LvmSection& segment, const std::vector<std::string>& names, bool one_x) {
    const auto labels = segment.keys.find("Y_Unit_Label");
    const auto dimension = segment.keys.find("X_Dimension");
    const bool time = dimension == segment.keys.end() || dimension->second.empty() ||
                      dimension->second[0] == "Time";
    std::size_t channel = 0;
    for (std::size_t c = 0; c < names.size(); ++c) {
      const bool x = names[c].rfind("X_Value", 0) == 0 && (c == 0 || !one_x);
      if (x && time) table_.unit[c] = "s";
      if (x) continue;
      if (labels != segment.keys.end() && channel < labels->second.size())
        table_.unit[c] = labels->second[channel];
      ++channel;
    }
  }

  const std::string& name_;
  DecodedText decoded_;
  Keys file_;
  std::vector<LvmSection> segments_;
  RawTable table_;
};

bool is_lvm(const std::string& bytes) {
  return bytes.compare(0, kTitle.size(), kTitle) == 0 ||
         bytes.compare(0, kTitle.size() + 3, "\xef\xbb\xbf" + std::string(kTitle)) == 0;
}

RawTable read_lvm(const std::string& bytes, const std::string& name, const TableOptions& options) {
  return LvmReader(bytes, name, options).read();
}

}  // namespace

const Container kLvmFile{"LabVIEW measurement", is_lvm, read_lvm};

}  // namespace hapsim
