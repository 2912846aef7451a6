// A diagnosis as a table, JSON, sentences and cases for CI servers, and what a table of one says.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "diagnose/diagnose.h"
#include "io/csv.h"
#include "report/junit.h"

namespace hapsim {

// Names of what was diagnosed, for the commands that add an effect.
struct DiagnosedFiles {
  std::string recording, body, model;
  std::string flags =
      {};  // that the diagnosis was asked with and the commands need: " --noise 0.02"
  std::string output = {};  // of the table; "": none
};

// The hs-identify command that adds what was found.
std::string add_command(const DiagnosedFiles& files, const Finding& finding);
// What to do next, most often a command: add all that is missing, record what tells rivals apart
// (`plan`: the file of these presses, "" when none was asked for), look where an unexplained error
// lies, or use the model.
std::string next_step(const Diagnosis& diagnosis, const DiagnosedFiles& files,
                      const std::string& plan);

// CSV: rank 0 is the model as a whole, then the effects, best first; the command only where the
// effect may be there. `seed`: of the flips, for the metadata.
void write_diagnosis(std::ostream& out, const Diagnosis& diagnosis, const DiagnosedFiles& files,
                     const std::string& seed);

// Effects of such a table with the verdict missing, in its order. Error(kBadInput): it is no
// diagnosis.
std::vector<std::string> missing_effects(const CsvTable& table);

// The same numbers as JSON text (two spaces of indent, a newline at the end).
std::string diagnosis_json(const Diagnosis& diagnosis, const DiagnosedFiles& files);

// Everything in words: the verdict, the sizes of error and noise, and a line or more an effect.
std::vector<std::string> diagnosis_lines(const Diagnosis& diagnosis, const DiagnosedFiles& files);

// A case for the model, which fails unless it is complete, and one an effect, which fails where it
// is missing and is skipped where it could not be tested.
std::vector<JunitCase> diagnosis_cases(const Diagnosis& diagnosis);

}  // namespace hapsim
