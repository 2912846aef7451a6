// The overview of many recordings: one page with a table to sort, and what failed.
#pragma once

#include <limits>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "report/report.h"

namespace hapsim {

struct OverviewRow {
  std::string name;
  std::string link;  // to the recording's own report, relative to the page; "" for none
  std::string effects, verdict, missing;
  std::string asked;  // the effects asked for: "elastic", "auto"
  double rmse = std::numeric_limits<double>::quiet_NaN();      // [N]
  double held_out = std::numeric_limits<double>::quiet_NaN();  // [N]
  double noise = std::numeric_limits<double>::quiet_NaN();     // [N]
  std::string modulus, nu;                                     // as text
};

struct OverviewFailure {
  std::string name;
  std::string message;
  std::string command;  // that repeats it; may be empty
};

struct Overview {
  std::string title;
  std::string verdict;  // one line
  std::vector<OverviewRow> rows;
  std::vector<OverviewFailure> failures;
  std::vector<std::string> not_run;  // names
  std::vector<std::pair<std::string, std::string>> provenance;
};

// "median error 0.021 N, 1.1 times the noise; models: 20 complete, 3 incomplete", and where the
// rows ask for different effects such a line for each. Empty without any error.
std::vector<std::string> overview_lines(const Overview& overview);

// By name: in how many of these lists, of names between blanks, it stands; of one that stands in a
// list twice, as a relaxation of several terms, once.
std::map<std::string, int> count_names(const std::vector<std::string>& lists);

// One HTML file that needs no network: key numbers, how often each verdict, failures, and the
// recordings with the largest error first (a click on a column's head sorts by it).
void write_overview(std::ostream& out, const Overview& overview);

}  // namespace hapsim
