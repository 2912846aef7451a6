// A file of identified models and of what they describe: where a new identification may start.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/database.h"
#include "mesh/tetmesh.h"
#include "model/model.h"
#include "recording/recording.h"

namespace hapsim {

// What was pressed, with what, and on what mesh (thesis 5.6).
struct Described {
  std::string material, object;  // "" when not told
  double element_size = 0;       // [m]: edge of the regular tetrahedron of the mean volume
  std::string tool;              // "flat" or "sphere"
  double tool_radius = 0;        // [m]
};

// Names are the recording's metadata `material` and `object`.
Described describe(const Recording& recording, const TetMesh& body);

struct LibraryEntry {
  int id = 0;          // given by the library, never again
  std::string stored;  // UTC, "2026-11-21T20:55:00Z"
  Described described;
  Model model;  // with its metadata: rmse, force_noise, heldout
};

// Errors as those of Database, and Error(kBadInput) for an entry whose model cannot be read.
class ModelLibrary {
 public:
  ModelLibrary(const std::string& path, Database::Mode mode, double patience = 10);
  std::vector<LibraryEntry> entries();
  LibraryEntry entry(int id);  // Error(kUsage) when there is none
  // The new entry's number. Within a Transaction of database() it is there once that is committed.
  int add(const Described& described, const Model& model);
  void remove(const std::vector<int>& ids);  // all, or Error(kUsage) and none
  Database& database() { return database_; }

 private:
  Database database_;
};

// The entry to start from, in the order of what counts: the same material (where one is wanted),
// the same object, most effects of `effects` among its own, the same kind of tool, the nearest tool
// radius and element size (by their ratios), the latest. Null without entries.
const LibraryEntry* nearest_entry(const std::vector<LibraryEntry>& entries, const Described& wanted,
                                  const std::vector<std::string>& effects);

// "entry 3 (pig liver, flat tool of 4 mm, elements of 6 mm, elastic+viscoelastic)".
std::string words_of(const LibraryEntry& entry);

// `start` with the values of `known` in its free parameters where both have them, within the bounds
// of `start`. Effects with another number of terms, of each press or position by itself, and
// (unless the object is the same) features inside the body are left as they are. Empty when there
// is nothing to take.
std::optional<Model> with_values_of(const Model& start, const Model& known, bool same_object);

}  // namespace hapsim
