// The sections of the report, each as HTML text; empty when there is nothing to show.
#pragma once

#include <ostream>
#include <string>

#include "report/report.h"

namespace hapsim {

// From the document type to the beginning of the body, with the style.
void write_head(std::ostream& out, const std::string& title);
std::string page_header(const Report& report);
// The versions of the model side by side, each with what it adds and its error on unseen data.
std::string page_strip(const Report& report);
std::string page_next(const Report& report);  // the next step, with a button that copies it
std::string page_numbers(const Report& report);
std::string page_versions(const Report& report);
std::string page_parameters(const Report& report);
std::string page_diagnosis(const Report& report);
std::string page_body(const Report& report);
// The image inside the body: its cells as a script, and its cuts.
std::string inside_data(const Report& report);
std::string page_inside(const Report& report);
std::string page_presses(const Report& report);
std::string page_residuals(const Report& report);
std::string page_learned(const Report& report);
std::string page_slices(const Report& report);
std::string page_tables(const Report& report);
std::string page_reading(const Report& report);
std::string page_provenance(const Report& report);

}  // namespace hapsim
