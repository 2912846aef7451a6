// The manifest of a batch: a CSV with a row a recording.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "effects/catalogue.h"
#include "io/stream.h"

namespace hapsim {

// The stages of a recording, in their order; `column` has flags for the stage's tool.
struct BatchStage {
  const char* step;    // "model"
  const char* tool;    // "hs-identify"
  const char* column;  // "options"
};
inline constexpr std::array<BatchStage, 8> kBatchStages{{
    {"data", "hs-import", "import_options"},
    {"points", "hs-scan2ply", "scan_options"},
    {"surface", "hs-reconstruct", "reconstruct_options"},
    {"body", "hs-tetmesh", "tetmesh_options"},
    {"model", "hs-identify", "options"},
    {"diagnosis", "hs-diagnose", "diagnose_options"},
    {"forces", "hs-simulate", "simulate_options"},
    {"report", "hs-compare", "compare_options"},
}};

// One recording. Paths are as a command in the current folder names them: those of the manifest
// are relative to the manifest's own folder, those of files in its options too.
struct ManifestRow {
  long line = 0;
  std::string name;
  std::string folder;  // the name as one word that is plain to make and shell
  std::string body, scan, data;
  std::string raw;     // a table of another machine, instead of data
  bool block = false;  // the body is the block that import_options state
  std::string scan_unit = "m";
  double tool_radius = 0;                           // [m]; 0: the recording's own
  std::string effects = body_effect().card().name;  // separated by commas
  std::array<std::vector<std::string>, kBatchStages.size()> options;
  std::vector<std::string> common;  // flags of hs-identify, hs-diagnose and hs-simulate alike
  // Files that these read, beside the above: by stage, and of `common`.
  std::array<std::vector<std::string>, kBatchStages.size()> option_files;
  std::vector<std::string> common_files;
  std::vector<std::string> extra;  // unknown columns
  std::string problem;             // why it cannot run: "batch.csv:7: what is wrong; what to do"
};

// The row's flags for the tool of a step.
const std::vector<std::string>& options_of(const ManifestRow& row, const std::string& step);
// The files that these flags name.
const std::vector<std::string>& option_files_of(const ManifestRow& row, const std::string& step);

struct Manifest {
  std::string name;
  std::vector<std::string> extra_header;
  std::vector<ManifestRow> rows;
};

// Columns name, data or raw, and body or scan (a raw table may state --block instead); tool,
// effects, scan_unit and the stages' options may be absent or empty. What is wrong with one row (a
// missing file, a name given twice, an open quote) becomes its `problem`. Error(kBadInput): missing
// column, malformed CSV, no rows.
Manifest read_manifest(Input& input);

// `text` as a name of plain letters; where letters had to be replaced, or cut off, a hash of the
// whole keeps different texts apart.
std::string plain_name(const std::string& text);

}  // namespace hapsim
