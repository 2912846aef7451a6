// What is made for each recording of a manifest, step by step.
#pragma once

#include <string>
#include <vector>

#include "batch/manifest.h"

namespace hapsim {

// One command and the file that it makes. Files of the batch are relative to its folder, those of
// the user as the command names them.
struct BatchStep {
  std::string name;                // "model"
  std::string folder;              // "recordings/liver"
  std::string output;              // "recordings/liver/model.csv"
  std::vector<std::string> made;   // inputs that earlier steps make
  std::vector<std::string> given;  // inputs that are the user's
  bool writes_files = false;       // its options do, into FOLDER/files
  std::string command;             // a line for a shell in the folder where the batch was started
};

struct BatchOptions {
  std::string folder = "batch";  // where everything is made
  bool diagnosis = true;
  bool report = true;
  std::vector<std::string> writes;  // folders where the manifest's options may write as well
  double step_time = 21600;         // in which each step has to end [s]
};

struct Batch {
  Manifest manifest;
  BatchOptions options;
  std::vector<BatchStep> steps;         // of all rows; a body of several rows once
  std::vector<std::vector<int>> chain;  // [row]: its steps in order; empty when it has a problem

  const BatchStep& step_at(int s) const { return steps[static_cast<std::size_t>(s)]; }
};

// Rows with the same scan, unit and options share their body. Where a row's options do not say
// otherwise, each command runs with one thread: the batch is parallel over the recordings. A row
// whose options name files outside the recording's own folder has a problem, unless `writes` does.
Batch plan_batch(const Manifest& manifest, const BatchOptions& options);

// The row's file of a step, seen from the folder where the batch was started; "" without that step.
std::string output_of(const Batch& batch, std::size_t row, const std::string& step);

}  // namespace hapsim
