// An image of the stiffness inside the body, as a comparison's report shows it.
#pragma once

#include <string>

#include "imaging/image_file.h"
#include "report/report.h"

namespace hapsim {

// Cells through the image, two layers of the body's surface, and in words how finely and how deep
// it sees. After add_body(). `name`: of the image's file. Error(kBadInput): it is of another body
// than the report's.
void add_image(const ImageOnBody& image, const std::string& name, Report& report);

}  // namespace hapsim
