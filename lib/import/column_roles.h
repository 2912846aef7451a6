// What each column of a foreign table means: recognised by names in eight languages, or told.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tables/column_name.h"
#include "tables/raw_table.h"

namespace hapsim {

enum class VectorRole {
  kPlain,        // bare x,y,z: a contact point or a tip position, told apart by their values
  kTip,          // tool tip, or centre of its ball
  kContact,      // contact point on the undeformed surface
  kContactBall,  // centre of the tool's ball at first contact
  kDeformed,     // point of the deformed surface under the tip
  kDesired,      // commanded tip
  kDisplacement,
  kNormal,
  kForce,
  kCount
};

enum class ScalarRole {
  kTime,
  kDepth,
  kForce,
  kTemperature,
  kContactFlag,
  kFail,
  kSample,
  kGap,  // between the tools; where there is no depth it is that, counted the other way
  kCount
};

struct ColumnMap {
  std::array<std::optional<std::array<int, 3>>, static_cast<std::size_t>(VectorRole::kCount)>
      vectors;
  std::array<int, static_cast<std::size_t>(ScalarRole::kCount)> scalars;  // -1: absent
  int time_fraction = -1;            // what the time is short of: nanoseconds beside seconds
  std::vector<int> press;            // columns that together name a press
  std::vector<UnitName> unit;        // per column, of its name or of the row of units
  std::vector<std::string> unknown;  // per column, what stands where its unit should and is none
  std::vector<std::string> meaning;  // per column, for people; "" when carried through
  bool displacement_word = false;  // the depth column is a machine's travel: its zero is arbitrary

  const std::array<int, 3>* find(VectorRole role) const;
  int find(ScalarRole role) const { return scalars[static_cast<std::size_t>(role)]; }
  bool has(VectorRole role) const { return find(role) != nullptr; }
  bool has(ScalarRole role) const { return find(role) >= 0; }
};

// `told` are texts "role=column" (roles: press t x y z tipx .. contactx .. ux .. nx .. fx .. depth
// force temp contact fail skip). Error(kUsage) for an unknown role, Error(kBadInput)
// for a column that the table lacks (with the nearest).
ColumnMap recognise_columns(const RawTable& table, const std::vector<std::string>& told);

std::string role_name(VectorRole role);
std::string role_name(ScalarRole role);

}  // namespace hapsim
