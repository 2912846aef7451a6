// Files that hold a table: one format a file, told apart by their first bytes.
#pragma once

#include <string>
#include <vector>

#include "tables/raw_table.h"

namespace hapsim {

struct Container {
  const char* name;
  bool (*sniff)(const std::string& bytes);
  RawTable (*read)(const std::string& bytes, const std::string& name, const TableOptions& options);
};

extern const Container kMatlabFile;  // MATLAB 5 and 7.3, by libmatio
extern const Container kHdf5File;    // HDF5, by libhdf5
extern const Container kBagFile;     // ROS 1 bags of format 2.0
extern const Container kLvmFile;     // LabVIEW measurements as text
extern const Container kTextFile;    // anything else: rows of cells

// In the order in which they are asked; the last takes all.
const std::vector<const Container*>& all_containers();

}  // namespace hapsim
