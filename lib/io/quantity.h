// Lengths, times, forces, pressures and angles as people write them: the one parser of options,
// tables and manifests.
#pragma once

#include <string>
#include <vector>

#include "base/units.h"

namespace hapsim {

// "0.004" (SI), "4mm" or "4 mm" in SI; 4mm is the very number 0.004. Error(kUsage) beginning with
// `what`: no number, or a unit that the quantity does not have.
double parse_quantity(const std::string& text, Quantity quantity, const std::string& what);
double parse_length(const std::string& text, const std::string& what);
// A length that a file holds: Error(kBadInput) at `where`.
double parse_length_at(const std::string& where, const std::string& text, const std::string& what);

// Numbers between ',', ':' or 'x', each turned into SI and what is between them kept:
// "120x80x40mm" is "0.12x0.08x0.04". `quantities` are those of the numbers in order, the last also
// of all that follow. A number without a unit has that of the next one of its quantity that has
// one; where none has, the text is as it was. So is text that is not of this form, for whoever
// reads it to refuse. Error(kUsage) as above: an unknown unit.
std::string list_in_si(const std::string& text, const std::vector<Quantity>& quantities,
                       const std::string& what);

// "length", and a value in SI and in another unit: "0.004 or 4mm".
struct QuantityWords {
  const char* name;
  const char* unit;  // SI
  const char* example;
};
const QuantityWords& words_of(Quantity quantity);

}  // namespace hapsim
