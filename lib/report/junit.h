// JUnit's XML, which CI servers show as a list of tests.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace hapsim {

struct JunitCase {
  std::string name;
  std::string failure;  // one line; empty: passed
  std::string details;  // more lines of a failure
  bool skipped = false;
};

// One suite; `suite` names the tool, and is the class of its cases.
void write_junit(std::ostream& out, const std::string& suite, const std::vector<JunitCase>& cases);

}  // namespace hapsim
