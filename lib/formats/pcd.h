// PCD, the point format of the Point Cloud Library.
#pragma once

#include <string>

#include "mesh/surface.h"

namespace hapsim {

// ASCII, binary (little endian) and binary_compressed (LZF); fields x, y, z and, all three or none,
// normal_x, normal_y, normal_z, of any numeric type. Points without a place (NaN, what organised
// clouds hold where nothing was seen) are left out and counted. Error(kBadInput, name:line): a
// header that is none, truncated data, sizes that the file cannot hold.
PointCloud read_pcd(const std::string& bytes, const std::string& name, std::size_t& lost);

}  // namespace hapsim
