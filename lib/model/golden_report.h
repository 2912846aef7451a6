// A comparison with a golden model: what is asked of it, and what comes of it as a table and as
// cases for CI servers.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "model/golden_model.h"
#include "report/junit.h"

namespace hapsim {

// "2%", "0.01", or for one parameter "nu=0.01" and "elastic.E=2%". Error(kUsage) beginning with
// `option`.
Tolerance parse_tolerance(const std::string& text, const std::string& option);
// "10%" or "0.1" as a share. Error(kUsage) beginning with `option`.
double parse_share(const std::string& text, const std::string& option);

// Error(kUsage) beginning with `option`: a tolerance names a parameter that is not there.
void require_named(const std::vector<Tolerance>& tolerances, const std::vector<GoldenRow>& rows,
                   const std::string& option);

// CSV effect,region,parameter,value,golden,allowed,verdict; what is not there stays empty.
void write_golden(std::ostream& out, const std::vector<GoldenRow>& rows);

// A case a row, named "elastic.E[2]" in region 2.
std::vector<JunitCase> golden_cases(const std::vector<GoldenRow>& rows);

}  // namespace hapsim
