// A column's name taken apart: words, axis, unit.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tables/unit_name.h"

namespace hapsim {

struct ColumnName {
  std::vector<std::string> words;  // folded: "ContactPoint_x [mm]" gives contact, point, x
  UnitName unit;                   // kNone when the name holds none
  std::string unknown;             // what stands in brackets as a unit and is none that is known

  std::string joined() const;  // the words without anything between them
};

// Understands units in brackets, after "/", a comma or " in ", as a last word ("x_mm"), and glued
// to a word that the table of words has ("distancemm", "forceN").
ColumnName take_apart(std::string_view name);

// One way to read a name as the component of a vector.
struct Component {
  std::string base;  // "contactpoint"; "" for a bare "x"; "f:contact" for "contact_fx"
  int axis = 0;      // 0, 1, 2
  char style = 'x';  // 'x' letters, '1' counted from one, '0' counted from zero
};

// All ways to read the words as a component: "tip_x", "x_tip", "tipx", "tip_1".
std::vector<Component> components(const std::vector<std::string>& words);

}  // namespace hapsim
