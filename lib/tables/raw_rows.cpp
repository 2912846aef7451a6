#include "tables/raw_rows.h"

#include <algorithm>
#include <array>
#include <map>

#include "io/number.h"
#include "tables/fold.h"
#include "tables/number_style.h"

namespace hapsim {

bool is_missing(std::string_view cell) {
  static constexpr std::array kWords{"",   "nan",  "-nan", "-",   "--",   "n/a",
                                     "na", "null", "none", "inf", "-inf", "+inf"};
  const std::string folded = fold(trim(cell));
  return std::find(kWords.begin(), kWords.end(), folded) != kWords.end();
}

std::vector<std::string> split_cells(std::string_view line, char separator) {
  std::vector<std::string> cells;
  std::string cell;
  bool quoted = false;
  if (separator == ' ') line = trim(line);
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      quoted = !quoted;
    } else if (!quoted && (c == separator || (separator == ' ' && c == '\t'))) {
      cells.emplace_back(trim(cell));
      cell.clear();
      while (separator == ' ' && i + 1 < line.size() && (line[i + 1] == ' ' || line[i + 1] == '\t'))
        ++i;
    } else {
      cell += c;
    }
  }
  cells.emplace_back(trim(cell));
  return cells;
}

char find_separator(const std::vector<std::string_view>& lines) {
  char best = 0;
  double best_share = 0.5;
  for (const char separator : {'\t', ';', ',', '|', ' '}) {
    std::map<std::size_t, std::size_t> widths;
    std::size_t numbers = 0, filled = 0;
    for (const std::string_view line : lines) {
      const auto cells = split_cells(line, separator);
      ++widths[cells.size()];
      for (const std::string& cell : cells) {
        filled += !cell.empty();
        numbers += may_be_moment(cell) ||
                   may_be_number(cell, separator != ',' || line.find('"') != line.npos);
      }
    }
    const auto most =
        std::max_element(widths.begin(), widths.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == widths.end() || most->first < 2 || numbers < 2 * most->second) continue;
    const double share = static_cast<double>(numbers) / static_cast<double>(filled) *
                         static_cast<double>(most->second) / static_cast<double>(lines.size());
    if (share > best_share + 1e-9) {
      best_share = share;
      best = separator;
    }
  }
  return best;
}

}  // namespace hapsim
