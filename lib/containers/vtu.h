// VTK's XML files of unstructured grids (.vtu), as arrays of numbers.
#pragma once

#include <string>
#include <vector>

namespace hapsim {

struct VtuArray {
  std::string name;
  std::size_t components = 1;
  std::vector<double> values;
};

struct VtuPiece {
  std::size_t points = 0, cells = 0;
  std::vector<VtuArray> position;  // one array of three components
  std::vector<VtuArray> cell;      // connectivity, offsets, types
  std::vector<VtuArray> point_data, cell_data;
};

// Arrays as text, base64 or raw at the end of the file; either byte order; plain or compressed by
// zlib. Error(kBadInput) with the name and, where the file is text, the line: no unstructured grid,
// truncated, an array shorter than it claims, another compressor.
std::vector<VtuPiece> parse_vtu(const std::string& bytes, const std::string& name);

// The array of that name, null when there is none.
const VtuArray* find_array(const std::vector<VtuArray>& arrays, const std::string& name);

}  // namespace hapsim
