// What came of an import: sentences, and the touched points as a scan; and where a machine presses.
#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "import/import.h"

namespace hapsim {

// What was understood and changed, warnings, and the sizes of the recording.
std::vector<std::string> import_lines(const ImportResult& result);

// The touched points as a table x,y,z [m], with normals nx,ny,nz where they are known.
void write_scan(std::ostream& out, const ImportResult& result);

// `at`, or the middle of the top of a block (its size [m]). Error(kUsage): `at` is not on the top
// of the block.
std::optional<Vec3> contact_place(const std::optional<Vec3>& at, const std::optional<Vec3>& block);

}  // namespace hapsim
