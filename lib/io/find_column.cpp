#include "io/find_column.h"

#include <algorithm>
#include <cctype>

namespace hapsim {
namespace {

bool equal_but_case(const std::string& a, const std::string& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char p, char q) {
           return std::tolower(static_cast<unsigned char>(p)) ==
                  std::tolower(static_cast<unsigned char>(q));
         });
}

}  // namespace

std::string find_column(const CsvTable& table, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    for (const std::string& column : table.header) {
      if (equal_but_case(column, name)) return column;
    }
  }
  return "";
}

}  // namespace hapsim
