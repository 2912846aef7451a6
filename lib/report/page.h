// The sections of the report, each as HTML text; empty when there is nothing to show.
#pragma once

#include <string>

#include "report/report.h"

namespace hapsim {

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
