// Location samples as files: what material each contact position asks for by itself.
#pragma once

#include <string>
#include <vector>

#include "base/vec3.h"
#include "io/metadata.h"
#include "io/stream.h"

namespace hapsim {

// Columns x,y,z,E,nu,E_std,nu_std[,n][,region], one entry a row, SI units.
struct LocationTable {
  std::string name;  // of the source, for error messages
  Metadata metadata;
  std::vector<Vec3> point;                      // contact position [m]
  std::vector<double> E, nu;                    // [Pa], 1
  std::vector<double> E_std;                    // standard error [Pa], positive
  std::vector<double> nu_std;                   // 0 in all rows: nu was held, not estimated
  std::vector<int> n;                           // force components behind the sample
  std::vector<int> region;                      // thesis (5.11); empty: not classified
  std::vector<std::string> extra_header;        // unknown columns, carried through
  std::vector<std::vector<std::string>> extra;  // extra[c][row]

  std::size_t size() const { return point.size(); }
};

// Error(kBadInput): missing column, NaN or text (lines), E or E_std not positive, nu outside
// [0, 0.5), nu_std negative or zero in some rows only, positions beyond 10 m, fewer than four
// samples, all samples at one place. A column `region` is not read: it will be found anew.
LocationTable read_locations(Input& input);

void write_locations(std::ostream& out, const LocationTable& table);

}  // namespace hapsim
