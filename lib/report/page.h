// The sections of the report, each as HTML text; empty when there is nothing to show.
#pragma once

#include <ostream>
#include <string>

#include "report/report.h"

namespace hapsim {

// From the document type to the beginning of the body, with the style.
void write_head(std::ostream& out, const std::string& title);
std::string page_header(const Report& report);
std::string page_versions(const Report& report);
std::string page_parameters(const Report& report);
std::string page_diagnosis(const Report& report);
std::string page_body(const Report& report);
std::string page_presses(const Report& report);
std::string page_residuals(const Report& report);
std::string page_tables(const Report& report);
std::string page_reading(const Report& report);
std::string page_provenance(const Report& report);

}  // namespace hapsim
