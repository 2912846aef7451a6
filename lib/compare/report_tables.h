// The tables of a comparison's report: names, units and rounding, no statistics.
#pragma once

#include <string>

#include "compare/comparison.h"
#include "io/csv.h"
#include "model/model.h"
#include "report/report.h"

namespace hapsim {

inline constexpr const char* kNextMeasurement = "what to measure next";  // name of a note

// Model versions from a table of hs-identify --history: its cells, fractions to four digits, and
// the errors rmse, heldout and noise [N] of each version; NaN where a column or a number is
// missing.
void add_history(const CsvTable& table, Report& report);

// What hs-diagnose wrote of one model version; columns that are missing are left out.
void add_diagnosis(const CsvTable& table, const std::string& version, Report& report);

// Values with standard errors and 95 % intervals (1.96 standard errors), at most 60 rows.
void add_parameters(const Model& model, Report& report);

// A table each breakdown; positions with the largest error first, at most 200 of them.
void add_tables(const Comparison& comparison, Report& report);

// The numbers at the top of the page. `simulated`: of the simulated forces, whose mesh_uncertainty
// is shown; the error on unseen positions is that of the latest of report.versions which has one.
void add_numbers(const Comparison& comparison, const Metadata& simulated, Report& report);

}  // namespace hapsim
