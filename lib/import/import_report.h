// What came of an import: sentences, and the touched points as a scan; and where a machine presses.
#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "cli/summary.h"
#include "import/import.h"

namespace hapsim {

// On a screen: the sizes of the recording, what was understood and changed, and warnings.
Summary import_summary(const ImportResult& result);

// The touched points as a table x,y,z [m], with normals nx,ny,nz where they are known.
void write_scan(std::ostream& out, const ImportResult& result);

// `at`, or the middle of the top of a block (its size [m]). Error(kUsage): `at` is not on the top
// of the block.
std::optional<Vec3> contact_place(const std::optional<Vec3>& at, const std::optional<Vec3>& block);

}  // namespace hapsim
