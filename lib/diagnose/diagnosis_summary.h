// A diagnosis on one screen.
#pragma once

#include "cli/summary.h"
#include "diagnose/diagnosis_table.h"

namespace hapsim {

// The verdict, what is missing with its numbers, how many effects were tested in vain, and the next
// command. `plan`: the file of the next presses, "" when none was asked for.
Summary diagnosis_summary(const Diagnosis& diagnosis, const DiagnosedFiles& files,
                          const std::string& plan);

}  // namespace hapsim
