#include "import/column_roles.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/error.h"
#include "base/nearest.h"
#include "import/column_synonyms.h"
#include "io/number.h"
#include "tables/fold.h"
#include "tables/header_words.h"
#include "tables/raw_rows.h"

namespace hapsim {
namespace {

constexpr std::array kVectorNames{"position",
                                  "tip position",
                                  "contact point",
                                  "ball centre at contact",
                                  "deformed surface point",
                                  "commanded tip position",
                                  "displacement",
                                  "surface normal",
                                  "force"};
constexpr std::array kScalarNames{
    "time", "depth", "force", "temperature", "contact flag", "failed", "number of the sample",
    "gap"};
constexpr std::array kAxes{"x", "y", "z"};

struct Told {
  const char* role;
  VectorRole vector;
};
constexpr std::array kToldVectors{
    Told{"", VectorRole::kPlain},          Told{"tip", VectorRole::kTip},
    Told{"contact", VectorRole::kContact}, Told{"ball", VectorRole::kContactBall},
    Told{"u", VectorRole::kDisplacement},  Told{"n", VectorRole::kNormal},
    Told{"f", VectorRole::kForce}};
constexpr std::array<std::pair<const char*, ScalarRole>, 8> kToldScalars{
    {{"t", ScalarRole::kTime},
     {"depth", ScalarRole::kDepth},
     {"force", ScalarRole::kForce},
     {"temp", ScalarRole::kTemperature},
     {"contact", ScalarRole::kContactFlag},
     {"fail", ScalarRole::kFail},
     {"sample", ScalarRole::kSample},
     {"gap", ScalarRole::kGap}}};

UnitKind kind_of(VectorRole role) {
  if (role == VectorRole::kForce) return UnitKind::kForce;
  return role == VectorRole::kNormal ? UnitKind::kNone : UnitKind::kLength;
}

// A column's values are not numbered anew for nearly every row.
bool names_episodes(const std::vector<std::string>& values) {
  std::size_t changes = 0;
  for (std::size_t i = 1; i < values.size(); ++i) changes += values[i] != values[i - 1];
  return values.size() > 2 && changes * 2 < values.size();
}

class Recogniser {
 public:
  explicit Recogniser(const RawTable& table) : table_(table) {
    map_.scalars.fill(-1);
    map_.meaning.assign(table.header.size(), "");
    for (std::size_t c = 0; c < table.header.size(); ++c) {
      names_.push_back(take_apart(table.header[c]));
      if (names_[c].unit.kind == UnitKind::kNone && !table.unit[c].empty()) {
        names_[c].unit = parse_unit(table.unit[c]);
        names_[c].unknown = names_[c].unit.kind == UnitKind::kNone ? table.unit[c] : "";
      }
      map_.unit.push_back(names_[c].unit);
      map_.unknown.push_back(names_[c].unknown);
    }
    taken_.assign(table.header.size(), false);
  }

  ColumnMap run(const std::vector<std::string>& told) {
    for (const std::string& text : told) tell(text);
    finish_told();
    find_vectors();
    find_plane();
    find_presses();
    find_scalars();
    find_fraction();
    if (!map_.has(ScalarRole::kDepth) && map_.has(ScalarRole::kGap)) {
      map_.scalars[static_cast<std::size_t>(ScalarRole::kDepth)] = map_.find(ScalarRole::kGap);
      map_.displacement_word = true;
    }
    return map_;
  }

 private:
  int column(const std::string& name) {
    const auto at = std::find(table_.header.begin(), table_.header.end(), name);
    if (at == table_.header.end()) {
      const std::string near = nearest(name, table_.header);
      fail_input(table_.name, "--column: the table has no column '" + name + "'",
                 near.empty() ? "see --list for its columns" : "did you mean '" + near + "'?");
    }
    return static_cast<int>(at - table_.header.begin());
  }

  void take(int c, const std::string& meaning) {
    taken_[static_cast<std::size_t>(c)] = true;
    map_.meaning[static_cast<std::size_t>(c)] = meaning;
  }

  void tell(const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == text.npos || equals == 0)
      fail_usage("--column " + text + " is not of the form ROLE=NAME",
                 "write for example --column fz=Kraft");
    const std::string role = fold(text.substr(0, equals));
    const int c = column(std::string(trim(text.substr(equals + 1))));
    if (role == "skip") return take(c, "");
    if (role == "press") {
      map_.press.push_back(c);
      return take(c, "press");
    }
    for (const auto& [name, scalar] : kToldScalars)
      if (role == name) {
        map_.scalars[static_cast<std::size_t>(scalar)] = c;
        if (scalar == ScalarRole::kDepth)
          map_.displacement_word = is_travel(names_[static_cast<std::size_t>(c)].joined());
        return take(c, role_name(scalar));
      }
    for (const Told& vector : kToldVectors)
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (role == std::string(vector.role) + kAxes[axis]) {
          auto& place = told_[vector.vector];
          if (place.empty()) place.assign(3, -1);
          place[axis] = c;
          return take(c, role_name(vector.vector) + " " + kAxes[axis]);
        }
    fail_usage("--column: '" + role + "' is no role",
               "use press t x y z tipx contactx ballx ux nx fx (also y, z) depth force temp "
               "contact fail sample gap skip");
  }

  void finish_told() {
    for (const auto& [role, place] : told_) {
      if (std::find(place.begin(), place.end(), -1) != place.end())
        fail_usage("--column: the " + role_name(role) + " needs all of its three components",
                   "tell x, y and z");
      map_.vectors[static_cast<std::size_t>(role)] = {place[0], place[1], place[2]};
    }
  }

  // Three free columns with the same base and the axes x, y, z. Short names win over longer ones,
  // which are the same quantity in another frame or from another sensor.
  void find_vectors() {
    std::map<std::pair<std::string, char>, std::array<int, 3>> triples;
    for (std::size_t c = 0; c < names_.size(); ++c) {
      if (taken_[c]) continue;
      for (const Component& part : components(names_[c].words)) {
        auto& triple = triples.try_emplace({part.base, part.style}, std::array<int, 3>{-1, -1, -1})
                           .first->second;
        if (triple[static_cast<std::size_t>(part.axis)] < 0)
          triple[static_cast<std::size_t>(part.axis)] = static_cast<int>(c);
      }
    }
    std::vector<std::pair<std::string, std::array<int, 3>>> found;
    for (const auto& [key, triple] : triples)
      if (*std::min_element(triple.begin(), triple.end()) >= 0)
        found.emplace_back(key.first, triple);
    std::stable_sort(found.begin(), found.end(),
                     [](const auto& a, const auto& b) { return a.first.size() < b.first.size(); });
    for (const auto& [base, triple] : found) {
      const VectorRole role = vector_role(base);
      if (role == VectorRole::kCount || map_.has(role)) continue;
      if (std::any_of(triple.begin(), triple.end(),
                      [this](int c) { return taken_[static_cast<std::size_t>(c)]; }))
        continue;
      map_.vectors[static_cast<std::size_t>(role)] = triple;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        take(triple[axis], role_name(role) + " " + kAxes[axis]);
        UnitName& unit = map_.unit[static_cast<std::size_t>(triple[axis])];
        if (unit.kind != kind_of(role)) unit = {};
      }
    }
  }

  // "x" and "y" without a "z": a place on a flat top, whose height is told by --at.
  void find_plane() {
    if (map_.has(VectorRole::kPlain)) return;
    std::array<int, 3> place{-1, -1, -1};
    for (std::size_t c = 0; c < names_.size(); ++c)
      for (const Component& part : components(names_[c].words))
        if (!taken_[c] && part.style == 'x' &&
            (vector_role(part.base) == VectorRole::kPlain || is_word(part.base, Word::kStage)) &&
            place[static_cast<std::size_t>(part.axis)] < 0)
          place[static_cast<std::size_t>(part.axis)] = static_cast<int>(c);
    if (place[0] < 0 || place[1] < 0 || place[2] >= 0) return;
    map_.vectors[static_cast<std::size_t>(VectorRole::kPlain)] = place;
    take(place[0], "position x");
    take(place[1], "position y");
  }

  void find_presses() {
    if (!map_.press.empty()) return;
    std::vector<int> groups, perhaps;
    for (std::size_t c = 0; c < names_.size(); ++c) {
      if (taken_[c]) continue;
      const PressWord word = press_word(names_[c].joined());
      if (word == PressWord::kNo || !names_episodes(table_.columns[c]) ||
          (word == PressWord::kPerhaps && !counts(c)))
        continue;
      (word == PressWord::kYes     ? map_.press
       : word == PressWord::kGroup ? groups
                                   : perhaps)
          .push_back(static_cast<int>(c));
    }
    // "region, point" and "region, site" name a press together.
    if (map_.press.empty() && !perhaps.empty() && !is_constant(perhaps.front()))
      map_.press.push_back(perhaps.front());
    for (const int c : groups)
      if (map_.press.empty() || !is_constant(c)) map_.press.push_back(c);
    // One name for all of the table tells nothing apart, unless it is hapsim's own.
    if (std::all_of(map_.press.begin(), map_.press.end(), [this](int c) {
          return is_constant(c) && table_.header[static_cast<std::size_t>(c)] != "press";
        }))
      map_.press.clear();
    for (const int c : map_.press) take(c, "press");
  }

  // Whole numbers without a unit, or names: a "position" with decimals is a length.
  bool counts(std::size_t c) const {
    const auto& cells = table_.columns[c];
    return names_[c].unit.kind != UnitKind::kLength &&
           std::all_of(cells.begin(), cells.end(), [](const std::string& cell) {
             double value;
             return !parse_number(cell, value) || value == std::floor(value);
           });
  }

  // Text in the first filled cells is no quantity, whatever its name. (A clock has digits, too.)
  bool holds_numbers(std::size_t c) const {
    const auto& cells = table_.columns[c];
    const auto filled = std::find_if(cells.begin(), cells.end(),
                                     [](const auto& cell) { return !is_missing(cell); });
    return filled != cells.end() &&
           std::string("0123456789+-.").find((*filled)[0]) != std::string::npos;
  }

  bool is_constant(int c) const {
    const auto& values = table_.columns[static_cast<std::size_t>(c)];
    return std::all_of(values.begin(), values.end(),
                       [&values](const auto& v) { return v == values.front(); });
  }

  void find_scalars() {
    std::array<int, static_cast<std::size_t>(ScalarRole::kCount)> rank;
    rank.fill(1000);
    for (std::size_t c = 0; c < names_.size(); ++c) {
      if (taken_[c]) continue;
      const ScalarMatch match = scalar_role(names_[c].joined(), names_[c].unit.kind);
      if (match.role == ScalarRole::kCount || !holds_numbers(c)) continue;
      const auto role = static_cast<std::size_t>(match.role);
      if (map_.scalars[role] >= 0 && match.rank >= rank[role]) continue;
      if (map_.scalars[role] >= 0 && rank[role] == 1000) continue;  // it was told
      if (map_.scalars[role] >= 0) map_.meaning[static_cast<std::size_t>(map_.scalars[role])] = "";
      map_.scalars[role] = static_cast<int>(c);
      rank[role] = match.rank;
      map_.meaning[c] = role_name(match.role);
      if (match.role == ScalarRole::kDepth) map_.displacement_word = is_travel(names_[c].joined());
    }
    for (const int c : map_.scalars)
      if (c >= 0) taken_[static_cast<std::size_t>(c)] = true;
  }

  // "stamp.sec" and "stamp.nanosec": the second is what the first is short of.
  void find_fraction() {
    const int whole = map_.find(ScalarRole::kTime);
    if (whole < 0) return;
    const ColumnName& name = names_[static_cast<std::size_t>(whole)];
    const auto is_fraction = [&](std::size_t c) {
      return c != static_cast<std::size_t>(whole) && map_.meaning[c].empty() &&
             names_[c].unit.kind == UnitKind::kTime && names_[c].unit.factor < name.unit.factor &&
             names_[c].joined() == name.joined();
    };
    for (std::size_t c = 0; c < names_.size(); ++c)
      if (name.unit.factor == 1 && is_fraction(c)) {
        map_.time_fraction = static_cast<int>(c);
        return take(static_cast<int>(c), "time, to be added");
      }
  }

  const RawTable& table_;
  ColumnMap map_;
  std::vector<ColumnName> names_;
  std::vector<bool> taken_;
  std::map<VectorRole, std::vector<int>> told_;
};

}  // namespace

const std::array<int, 3>* ColumnMap::find(VectorRole role) const {
  const auto& vector = vectors[static_cast<std::size_t>(role)];
  return vector ? &*vector : nullptr;
}

ColumnMap recognise_columns(const RawTable& table, const std::vector<std::string>& told) {
  return Recogniser(table).run(told);
}

std::string role_name(VectorRole role) {
  return kVectorNames[static_cast<std::size_t>(role)];
}
std::string role_name(ScalarRole role) {
  return kScalarNames[static_cast<std::size_t>(role)];
}

}  // namespace hapsim
