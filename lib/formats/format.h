// A format of points, surfaces and meshes: how it is recognised, read and written. Each stands in
// one file, format_NAME.cpp, and in one list, format_table.cpp.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "formats/raw_mesh.h"
#include "mesh/surface.h"

namespace hapsim {

enum class Content { kNothing, kPoints, kTriangles, kTetrahedra };

struct WriteOptions {
  bool ascii = false;                 // text where the format is binary too
  std::vector<std::string> comments;  // left out where the format has no place for them
  std::string version;                // of the format, "4.1"; empty: the usual one
};

// What it cannot do is null. Errors of readers are Error(kBadInput) with the line or the byte.
struct Format {
  const char* name;                     // as messages say it: "PLY"
  std::vector<std::string> extensions;  // in lower case, the usual one first
  // What bytes of this format hold; kNothing: they are of another. Looks at the beginning alone,
  // and is not fooled by damage behind it: the reader says what is wrong there.
  Content (*sniff)(const std::string& bytes);
  // What a message says of points in these bytes: "a PLY without faces"; null: the name.
  std::string (*describe_points)(const std::string& bytes) = nullptr;
  // `notes`: what was left out, in words.
  PointCloud (*read_points)(const std::string& bytes, const std::string& name,
                            std::vector<std::string>& notes) = nullptr;
  // As the file has it: with unused vertices and triangles of two equal corners.
  Surface (*read_surface)(const std::string& bytes, const std::string& name) = nullptr;
  RawMesh (*read_mesh)(const std::string& bytes, const std::string& name) = nullptr;
  void (*write_points)(std::ostream&, const PointCloud&, const WriteOptions&) = nullptr;
  void (*write_surface)(std::ostream&, const Surface&, const WriteOptions&) = nullptr;
  void (*write_mesh)(std::ostream&, const TetMesh&, const WriteOptions&) = nullptr;
};

}  // namespace hapsim
