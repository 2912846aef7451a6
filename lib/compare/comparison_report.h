// A whole comparison as a report.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/comparison.h"
#include "compare/error_map.h"
#include "compare/report_curves.h"
#include "compare/report_views.h"
#include "imaging/image_file.h"
#include "io/csv.h"
#include "model/model.h"
#include "report/report.h"
#include "solid/body_regions.h"

namespace hapsim {

// What is told beside the forces themselves.
struct ReportExtras {
  std::optional<std::string> title;  // otherwise one with the measured recording's name
  std::optional<CsvTable> history;   // of hs-identify
  std::vector<std::pair<std::string, CsvTable>>
      diagnoses;  // model version ("": the only one), its diagnosis
  std::optional<Model> model;
  std::optional<ImageOnBody> image;                        // of the stiffness inside the body
  std::shared_ptr<const BodyRegions> labels;               // of the body, where it has any
  std::string program;                                     // that made the report: its version
  std::vector<std::pair<std::string, std::string>> files;  // kind and name of each
  FlagMeanings flags;                                      // of columns of live forces
};

// `comparison` and `map` are of the last version; `map` may be empty. The verdict is good when the
// last diagnosis calls the model complete, or, without one, when only noise is left.
Report comparison_report(const Recording& measured, const std::vector<SimulatedVersion>& versions,
                         const Comparison& comparison, const ErrorMap& map,
                         const ReportExtras& extras);

}  // namespace hapsim
