#include "import/side_by_side.h"

#include <algorithm>
#include <map>

#include "base/error.h"
#include "import/column_roles.h"
#include "import/column_synonyms.h"
#include "io/number.h"
#include "tables/column_name.h"
#include "tables/header_words.h"
#include "tables/raw_rows.h"

namespace hapsim {
namespace {

struct Named {
  std::string key;  // what its like in another curve has, too
  ScalarMatch match;
  bool approach = false, retract = false;
};

bool is_count(const std::string& word) {
  return !word.empty() &&
         std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
}

Named named(const RawTable& table, std::size_t c) {
  Named out;
  ColumnName name = take_apart(table.header[c]);
  if (name.unit.kind == UnitKind::kNone) name.unit = parse_unit(table.unit[c]);
  std::string joined;
  for (std::string word : name.words) {
    while (word.size() > 1 && is_count(word.substr(word.size() - 1))) word.pop_back();
    const bool retract = is_word(word, Word::kRetract),
               approach = !retract && is_word(word, Word::kApproach);
    out.retract |= retract;
    out.approach |= approach;
    if (retract || approach || is_count(word) || press_word(word) == PressWord::kGroup) continue;
    joined += word;
  }
  // "Extension" is a travel, and no half of a curve.
  out.match = scalar_role(joined, name.unit.kind);
  out.key = joined + " " + name.unit.name;
  return out;
}

class Unfolder {
 public:
  Unfolder(const RawTable& table, const std::string& specimen)
      : table_(table), specimen_(specimen) {
    for (std::size_t c = 0; c < table.header.size(); ++c) {
      names_.push_back(named(table, c));
      columns_[names_.back().key].push_back(c);
    }
  }

  RawTable run() {
    const std::vector<std::size_t> forces = columns_of(ScalarRole::kForce);
    if (forces.size() < 2) return only();
    std::vector<std::size_t> travels = columns_of(ScalarRole::kDepth);
    if (travels.empty()) travels = columns_of(ScalarRole::kGap);
    if (travels.empty()) return only();
    // "f1, f2, f3, d1, d2, d3" are vectors: theirs stand together, those of specimens take turns.
    const bool turns = travels.size() == forces.size() && take_turns(forces, travels);
    if (travels.size() != forces.size() || (forces.size() == 3 && !turns)) {
      if (travels.size() == 3 || (forces.size() == 3 && has_other_vector())) return only();
      fail_input(table_.name,
                 shown(table_.header[forces[0]]) + " and " + shown(table_.header[forces[1]]) +
                     " may both be the force, of " + std::to_string(travels.size()) + " travels",
                 "say which by --column force=NAME");
    }
    return stacked(forces);
  }

 private:
  RawTable only() const {
    if (!specimen_.empty() && specimen_ != "1")
      fail_input(table_.name, "there is no specimen " + shown(specimen_),
                 "the table holds one curve");
    return table_;
  }

  // The columns of the best name for a role that has several, else of the best.
  std::vector<std::size_t> columns_of(ScalarRole role) const {
    std::vector<std::size_t> best;
    int rank = 1000;
    for (std::size_t c = 0; c < names_.size(); ++c) {
      if (names_[c].match.role != role || names_[c].match.rank >= rank) continue;
      rank = names_[c].match.rank;
      best = columns_.at(names_[c].key);
    }
    return best;
  }

  // Three columns of one name that are neither forces nor travels: normals, places.
  bool has_other_vector() const {
    return std::any_of(columns_.begin(), columns_.end(), [this](const auto& named) {
      return named.second.size() == 3 && names_[named.second[0]].match.role == ScalarRole::kCount;
    });
  }

  static bool take_turns(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
    for (std::size_t i = 0; i + 1 < a.size(); ++i)
      if (std::max(a[i], b[i]) > std::min(a[i + 1], b[i + 1])) return false;
    return true;
  }

  RawTable stacked(const std::vector<std::size_t>& forces) const {
    const std::size_t n = forces.size();
    std::size_t wanted = n;
    double number;
    if (!specimen_.empty()) {
      if (!parse_number(specimen_, number) || number < 1 || number > static_cast<double>(n) ||
          number != static_cast<double>(static_cast<std::size_t>(number)))
        fail_input(table_.name, "there is no specimen " + shown(specimen_),
                   "they are counted from 1 to " + std::to_string(n));
      wanted = static_cast<std::size_t>(number) - 1;
    }
    RawTable out;
    out.name = table_.name;
    out.metadata = table_.metadata;
    out.notes = table_.notes;
    std::vector<std::vector<std::size_t>> from(n);  // from[curve][column of out]
    std::vector<std::string> header, unit, left_out;
    std::vector<std::size_t> own;  // columns of `out` that each curve has for itself
    for (std::size_t c = 0; c < names_.size(); ++c) {
      const std::vector<std::size_t>& same = columns_.at(names_[c].key);
      if (same.size() != n && same.size() != 1) left_out.push_back(table_.header[c]);
      if ((same.size() != n && same.size() != 1) || same[0] != c) continue;
      if (same.size() == n) own.push_back(header.size());
      for (std::size_t k = 0; k < n; ++k) from[k].push_back(same[same.size() == n ? k : 0]);
      header.push_back(table_.header[c]);
      unit.push_back(table_.unit[c]);
    }
    header.push_back("source");
    unit.emplace_back();
    out.set_header(header);
    out.unit = unit;
    const bool halves = n == 2 && names_[forces[0]].approach && names_[forces[1]].retract;
    int begun = 0;
    for (std::size_t k = 0; k < n; ++k) {
      if (wanted < n && k != wanted) continue;
      int last = -1;
      for (std::size_t row = 0; row < table_.rows(); ++row) {
        const auto cell = [&](std::size_t c) -> const std::string& {
          return table_.columns[from[k][c]][row];
        };
        if (std::all_of(own.begin(), own.end(), [&](std::size_t c) { return is_missing(cell(c)); }))
          continue;
        if (last >= 0 && table_.block[row] != last && !halves) ++begun;
        last = table_.block[row];
        for (std::size_t c = 0; c < from[k].size(); ++c) out.columns[c].push_back(cell(c));
        out.columns.back().push_back(table_.header[forces[k]]);
        out.line.push_back(table_.line[row]);
        out.block.push_back(begun);
      }
      begun += halves ? 0 : 1;
    }
    std::string all;
    for (const std::size_t c : forces) all += (all.empty() ? "" : ", ") + table_.header[c];
    out.notes.push_back(
        halves       ? "the way in and the way out stand side by side (" + all + "): one press"
        : wanted < n ? "of " + std::to_string(n) + " specimens side by side the one of " +
                           shown(table_.header[forces[wanted]])
                     : std::to_string(n) + " specimens side by side (" + all +
                           "): all are read, one recording each (--specimen N takes one)");
    for (const std::string& name : left_out)
      out.notes.push_back("column " + shown(name) +
                          " stands beside some specimens and not others: left out");
    return out;
  }

  const RawTable& table_;
  const std::string& specimen_;
  std::vector<Named> names_;
  std::map<std::string, std::vector<std::size_t>> columns_;
};

}  // namespace

RawTable unfold(const RawTable& table, const std::string& specimen) {
  return Unfolder(table, specimen).run();
}

}  // namespace hapsim
