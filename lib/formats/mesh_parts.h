// What the readers of mesh formats share: private to mesh_*.cpp.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "formats/mesh_file.h"

namespace hapsim {

// A mesh as a file has it: indices are within range, nothing else is checked.
struct RawMesh {
  std::string format;
  std::vector<Vec3> nodes;
  std::vector<std::array<int, 10>> tets;
  std::vector<int> region;          // empty: 0
  std::vector<std::uint8_t> fixed;  // empty: not said
  std::vector<Triangle> faces;      // empty: the boundary
  std::vector<Triangle> fixed_faces;
  int order = 0;  // 0: no tetrahedron yet
  std::size_t other_cells = 0;

  // Adds a tetrahedron of `count` corners; false when its order is not that of the others.
  bool add(const int* corners, std::size_t count, int number_of_region);
};

RawMesh parse_ply_mesh(const std::string& bytes, const std::string& where);
RawMesh parse_vtu_mesh(const std::string& bytes, const std::string& where);
RawMesh parse_gmsh_mesh(const std::string& bytes, const std::string& where);
RawMesh parse_tetgen_mesh(const std::string& bytes, const std::string& where);
bool is_tetgen_file(const std::string& bytes);
RawMesh parse_abaqus_mesh(const std::string& bytes, const std::string& where);
bool is_abaqus_deck(const std::string& bytes);
RawMesh parse_febio_mesh(const std::string& bytes, const std::string& where);
bool is_febio_model(const std::string& bytes);
RawMesh parse_sofa_mesh(const std::string& bytes, const std::string& where);
bool is_sofa_scene(const std::string& bytes);

// Words of a text file with the line they stand in.
class TextScanner {
 public:
  TextScanner(std::string_view text, const std::string& name, char comment = '\0')
      : rest_(text), name_(name), comment_(comment) {}
  bool done();              // nothing but blanks and comments is left
  std::string_view word();  // "" at the end
  std::string_view line();  // the rest of the line, without its newline
  double number(const char* what);
  // A whole number within [low, high]; `what` begins the message.
  long integer(const char* what, long low, long high);
  // A count of things that take at least `bytes` bytes each in what is left.
  std::size_t count(const char* what, std::size_t bytes);
  long line_number() const { return line_; }
  std::string where() const { return name_ + ":" + std::to_string(line_); }
  [[noreturn]] void fail(const std::string& wrong) const;

 private:
  void skip();
  std::string_view rest_;
  const std::string& name_;
  char comment_;
  long line_ = 1;
};

}  // namespace hapsim
