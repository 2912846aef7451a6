// VTU, the unstructured grids of VTK and ParaView: cell types 10 and 24; cell data `region`, point
// data `fixed`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>
#include <ostream>

#include "base/error.h"
#include "containers/vtu.h"
#include "formats/field_vtu.h"
#include "formats/format.h"
#include "formats/mesh_file.h"
#include "formats/tetmesh_io.h"
#include "formats/vtk_cells.h"

namespace hapsim {
namespace {

constexpr const char* kMend = "write the mesh again";

const VtuArray& needed(const std::vector<VtuArray>& arrays, const char* name, std::size_t count,
                       const std::string& where) {
  const VtuArray* found = find_array(arrays, name);
  if (found == nullptr) fail_input(where, fmt::format("there is no array '{}'", name), kMend);
  if (found->values.size() < count)
    fail_input(where,
               fmt::format("array '{}' has {} values of {}", name, found->values.size(), count),
               kMend);
  return *found;
}

void add_points(const VtuPiece& piece, const std::string& where, RawMesh& mesh) {
  if (piece.points == 0) return;
  if (piece.position.empty() || piece.position[0].components != 3 ||
      piece.position[0].values.size() / 3 < piece.points)
    fail_input(where, fmt::format("there are not {} points of 3 coordinates", piece.points), kMend);
  const auto& x = piece.position[0].values;
  for (std::size_t i = 0; i < piece.points; ++i)
    mesh.nodes.emplace_back(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
  if (const VtuArray* fixed = find_array(piece.point_data, "fixed");
      fixed != nullptr && fixed->values.size() == piece.points) {
    mesh.fixed.resize(mesh.nodes.size() - piece.points, 0);
    for (const double value : fixed->values) mesh.fixed.push_back(value != 0);
  }
}

void add_cells(const VtuPiece& piece, std::size_t first, const std::string& where, RawMesh& mesh) {
  if (piece.cells == 0) return;
  const auto& types = needed(piece.cell, "types", piece.cells, where).values;
  const auto& offsets = needed(piece.cell, "offsets", piece.cells, where).values;
  const auto& nodes = needed(piece.cell, "connectivity", 0, where).values;
  const VtuArray* region = find_array(piece.cell_data, "region");
  if (region != nullptr && region->values.size() != piece.cells) region = nullptr;
  double begin = 0;
  for (std::size_t c = 0; c < piece.cells; ++c) {
    const double end = offsets[c], count = end - begin;
    if (!(count >= 0 && end <= static_cast<double>(nodes.size())))
      fail_input(where, fmt::format("the offset of cell {} is out of range", c), kMend);
    const auto at = static_cast<std::size_t>(begin);
    begin = end;
    mesh.other_cells += vtk::is_other_volume(types[c]);
    if (types[c] != vtk::kTetra && types[c] != vtk::kQuadraticTetra) continue;
    const std::size_t width = types[c] == vtk::kTetra ? 4 : 10;
    if (count != static_cast<double>(width))
      fail_input(where, fmt::format("tetrahedron {} has {} nodes", c, count), kMend);
    int own[10];
    for (std::size_t k = 0; k < width; ++k) {
      const double n = nodes[at + k];
      if (!(n >= 0 && n < static_cast<double>(piece.points)) || n != std::floor(n))
        fail_input(where,
                   fmt::format("cell {}: node {} is out of range (0 to {})", c, n,
                               static_cast<double>(piece.points) - 1),
                   kMend);
      own[k] = static_cast<int>(first) + static_cast<int>(n);
    }
    const double number = region != nullptr ? region->values[c] : 0;
    if (!mesh.add(own, width, std::abs(number) < 2e9 ? static_cast<int>(number) : 0))
      fail_input(where, "tetrahedra of first and second order are mixed", kMend);
  }
}

// Arrays as text where they stand, or raw behind the grid.
class VtuWriter {
 public:
  VtuWriter(std::ostream& out, bool ascii) : out_(out), ascii_(ascii) {}

  template <class T>
  void array(const char* type, const char* name, int components, const std::vector<T>& values) {
    out_ << fmt::format("<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" ", type, name,
                        components);
    if (!ascii_) {
      out_ << fmt::format("format=\"appended\" offset=\"{}\"/>\n", appended_.size());
      const std::uint64_t size = values.size() * sizeof(T);
      append(&size, sizeof size);
      append(values.data(), size);
      return;
    }
    out_ << "format=\"ascii\">\n";
    fmt::memory_buffer text;
    int column = 0;
    for (const T value : values)
      fmt::format_to(std::back_inserter(text), "{}{}", value, ++column % 12 == 0 ? '\n' : ' ');
    out_.write(text.data(), static_cast<std::streamsize>(text.size()));
    out_ << "\n</DataArray>\n";
  }

  void finish() {
    if (ascii_) return;
    out_ << "<AppendedData encoding=\"raw\">\n_";
    out_.write(appended_.data(), static_cast<std::streamsize>(appended_.size()));
    out_ << "\n</AppendedData>\n";
  }

 private:
  void append(const void* bytes, std::size_t count) {
    if (count > 0) appended_.append(static_cast<const char*>(bytes), count);
  }
  std::ostream& out_;
  bool ascii_;
  std::string appended_;
};

Content sniff(const std::string& bytes) {
  const std::string_view text = bytes;
  const std::size_t first = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  const bool is_vtk = text.substr(first).starts_with("<VTKFile") ||
                      (text.substr(first).starts_with("<?xml") &&
                       text.substr(0, 4096).find("<VTKFile") != text.npos);
  return is_vtk ? Content::kTetrahedra : Content::kNothing;
}

RawMesh read_mesh(const std::string& bytes, const std::string& where) {
  RawMesh mesh;
  mesh.format = "VTU";
  for (const VtuPiece& piece : parse_vtu(bytes, where)) {
    const std::size_t first = mesh.nodes.size();
    add_points(piece, where, mesh);
    add_cells(piece, first, where, mesh);
  }
  if (!mesh.fixed.empty()) mesh.fixed.resize(mesh.nodes.size(), 0);
  return mesh;
}

void write_vtu(std::ostream& out, const TetMesh& mesh, bool ascii,
               const std::vector<VtuArray>& point_data, const std::vector<VtuArray>& cell_data) {
  const std::size_t width = mesh.order == 1 ? 4 : 10;
  std::vector<double> points;
  points.reserve(3 * mesh.nodes.size());
  for (const Vec3& p : mesh.nodes) points.insert(points.end(), p.data(), p.data() + 3);
  std::vector<int> connectivity, offsets;
  connectivity.reserve(width * mesh.tets.size());
  for (const auto& t : mesh.tets) {
    connectivity.insert(connectivity.end(), t.begin(), t.begin() + static_cast<long>(width));
    offsets.push_back(static_cast<int>(connectivity.size()));
  }
  const std::vector<std::uint8_t> types(mesh.tets.size(), mesh.order == 1 ? 10 : 24);
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
         "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n"
      << fmt::format("<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n", mesh.nodes.size(),
                     mesh.tets.size());
  VtuWriter writer(out, ascii);
  out << "<Points>\n";
  writer.array("Float64", "Points", 3, points);
  out << "</Points>\n<Cells>\n";
  writer.array("Int32", "connectivity", 1, connectivity);
  writer.array("Int32", "offsets", 1, offsets);
  writer.array("UInt8", "types", 1, types);
  out << "</Cells>\n<PointData>\n";
  writer.array("UInt8", "fixed", 1, mesh.fixed);
  for (const VtuArray& a : point_data)
    writer.array("Float64", a.name.c_str(), a.components, a.values);
  out << "</PointData>\n<CellData>\n";
  writer.array("Int32", "region", 1, mesh.region);
  for (const VtuArray& a : cell_data)
    writer.array("Float64", a.name.c_str(), a.components, a.values);
  out << "</CellData>\n</Piece>\n</UnstructuredGrid>\n";
  writer.finish();
  out << "</VTKFile>\n";
}

}  // namespace

void write_mesh_vtu(std::ostream& out, const TetMesh& mesh, bool ascii) {
  write_vtu(out, mesh, ascii, {}, {});
}

void write_field_vtu(std::ostream& out, const TetMesh& mesh,
                     const std::vector<VtuArray>& point_data,
                     const std::vector<VtuArray>& cell_data) {
  write_vtu(out, mesh, false, point_data, cell_data);
}

void write_body_vtu(std::ostream& out, const TetMesh& mesh) {
  write_mesh_vtu(out, mesh, true);
}

const Format& vtu_format() {
  static const Format format{
      .name = "VTU",
      .extensions = {"vtu"},
      .sniff = sniff,
      .read_mesh = read_mesh,
      .write_mesh = [](std::ostream& out, const TetMesh& mesh, const WriteOptions& options) {
        write_mesh_vtu(out, mesh, options.ascii);
      }};
  return format;
}

}  // namespace hapsim
