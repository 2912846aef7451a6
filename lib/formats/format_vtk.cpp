// Legacy VTK files, text and binary (VTK file formats, "Simple legacy formats", to version 5.1):
// polygons of POLYDATA as a surface, cell types 10 and 24 of an UNSTRUCTURED_GRID as a mesh, with
// cell data `region` and point data `fixed`.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "base/error.h"
#include "containers/byte_order.h"
#include "containers/text_scanner.h"
#include "formats/format.h"
#include "formats/vtk_cells.h"
#include "mesh/drop_unused.h"

namespace hapsim {
namespace {

constexpr std::string_view kMark = "# vtk DataFile Version ";
constexpr double kTriangleStrip = 6;  // as a cell's type
constexpr std::size_t kMost = std::size_t{1} << 40;

template <class T>
double big_endian(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  swap_bytes(value);
  return static_cast<double>(value);
}

struct NumberType {
  std::string_view name;
  std::size_t size;
  double (*value)(const char*);
};
constexpr NumberType kTypes[] = {
    {"float", 4, big_endian<float>},
    {"double", 8, big_endian<double>},
    {"int", 4, big_endian<std::int32_t>},
    {"vtkIdType", 4, big_endian<std::int32_t>},
    {"vtktypeint64", 8, big_endian<std::int64_t>},
    {"long", 8, big_endian<std::int64_t>},
    {"unsigned_long", 8, big_endian<std::uint64_t>},
    {"unsigned_int", 4, big_endian<std::uint32_t>},
    {"short", 2, big_endian<std::int16_t>},
    {"unsigned_short", 2, big_endian<std::uint16_t>},
    {"char", 1, big_endian<std::int8_t>},
    {"unsigned_char", 1, big_endian<std::uint8_t>},
};

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

struct VtkFile {
  std::vector<Vec3> points;
  std::vector<std::vector<int>> cells;  // of the kinds of CELLS, or POLYGONS and strips
  std::vector<double> types;            // by cell; of polygons 0
  std::vector<double> region, fixed;    // empty: none
};

class VtkReader {
 public:
  VtkReader(const std::string& bytes, const std::string& name) : scan_(bytes, name) {}

  VtkFile read() {
    scan_.line();  // the mark
    scan_.line();  // a title
    const std::string_view kind = scan_.word();
    if (kind != "ASCII" && kind != "BINARY")
      scan_.fail("ASCII or BINARY should stand in the third line");
    binary_ = kind == "BINARY";
    while (!scan_.done()) section(std::string(scan_.word()));
    return std::move(file_);
  }

 private:
  void section(const std::string& word) {
    if (word == "DATASET") {
      const std::string_view set = scan_.word();
      if (set != "POLYDATA" && set != "UNSTRUCTURED_GRID")
        scan_.fail(fmt::format("a {} is no body; POLYDATA and UNSTRUCTURED_GRID are read",
                               std::string(set.substr(0, 40))));
    } else if (word == "POINTS") {
      const std::size_t count = scan_.count("the number of points", 3);
      const std::vector<double> x = numbers("the coordinates", 3 * count, scan_.word());
      for (std::size_t i = 0; i < count; ++i)
        file_.points.emplace_back(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
    } else if (word == "CELLS" || word == "POLYGONS") {
      add_cells(0);
    } else if (word == "TRIANGLE_STRIPS") {
      add_cells(kTriangleStrip);
    } else if (word == "VERTICES" || word == "LINES") {
      cell_list();
    } else if (word == "CELL_TYPES") {
      const std::size_t count = scan_.count("the number of types", 1);
      file_.types = numbers("the types of the cells", count, "int");
    } else if (word == "CELL_DATA" || word == "POINT_DATA") {
      of_points_ = word == "POINT_DATA";
      values_ = scan_.count("the number of values", 1);
    } else if (word == "METADATA") {
      skip_metadata();
    } else {
      data(word);
    }
  }

  void data(const std::string& word) {
    if (word == "SCALARS") {
      const std::string name(scan_.word());
      const std::string_view type = scan_.word();
      const std::string_view rest = scan_.line();
      const std::size_t width = rest.size() == 1 && rest[0] > '0' && rest[0] <= '9'
                                    ? static_cast<std::size_t>(rest[0] - '0')
                                    : 1;
      if (scan_.word() != "LOOKUP_TABLE") scan_.fail("LOOKUP_TABLE should follow SCALARS");
      scan_.word();
      keep(name, width, numbers("the scalars", values_ * width, type));
    } else if (word == "VECTORS" || word == "NORMALS" || word == "TENSORS") {
      scan_.word();
      numbers("the vectors", values_ * (word == "TENSORS" ? 9 : 3), scan_.word());
    } else if (word == "TEXTURE_COORDINATES") {
      scan_.word();
      const auto width = static_cast<std::size_t>(scan_.integer("a dimension", 1, 3));
      numbers("the texture's coordinates", values_ * width, scan_.word());
    } else if (word == "LOOKUP_TABLE") {
      scan_.word();
      numbers("the colours", 4 * scan_.count("the number of colours", 4),
              binary_ ? "unsigned_char" : "float");
    } else if (word == "COLOR_SCALARS") {
      scan_.word();
      const auto width = static_cast<std::size_t>(scan_.integer("the number of colours", 1, 9));
      numbers("the colours", values_ * width, binary_ ? "unsigned_char" : "float");
    } else if (word == "FIELD") {
      scan_.word();
      for (std::size_t left = scan_.count("the number of arrays", 4); left > 0; --left) {
        std::string name(scan_.word());
        if (name == "METADATA") {  // of the array before
          skip_metadata();
          name = scan_.word();
        }
        const std::size_t width = scan_.count("the number of components", 1);
        const std::size_t tuples = scan_.count("the number of tuples", 1);
        keep(name, width, numbers("an array", width * tuples, scan_.word()));
      }
    } else {
      scan_.fail(fmt::format("'{}' is no section of a VTK file", word.substr(0, 40)));
    }
  }

  // It ends with an empty line, or with the file.
  void skip_metadata() {
    scan_.line();
    while (!scan_.line().empty()) {
    }
  }

  void keep(const std::string& name, std::size_t width, std::vector<double> values) {
    if (width != 1) return;
    if (of_points_ && name == "fixed") file_.fixed = std::move(values);
    if (!of_points_ && name == "region") file_.region = std::move(values);
  }

  std::vector<double> numbers(const char* what, std::size_t count, std::string_view type) {
    const std::string name = lower(type);
    const auto* known = std::find_if(std::begin(kTypes), std::end(kTypes),
                                     [&](const NumberType& t) { return lower(t.name) == name; });
    if (known == std::end(kTypes))
      scan_.fail(fmt::format("'{}' is no type of numbers that is read", name.substr(0, 40)));
    if (count > kMost)
      scan_.fail(fmt::format("{} numbers of {} are more than a file holds", count, what));
    std::vector<double> values;
    if (!binary_) {
      for (std::size_t i = 0; i < count; ++i) values.push_back(scan_.number(what));
      return values;
    }
    if (count == 0) return values;
    scan_.line();  // what is left of the line before
    const std::string_view bytes = scan_.bytes(what, count * known->size);
    values.reserve(count);
    for (std::size_t i = 0; i < count; ++i)
      values.push_back(known->value(bytes.data() + i * known->size));
    return values;
  }

  // Each cell's nodes: a list of counts and nodes, or (from 5.1 on) OFFSETS and CONNECTIVITY.
  std::vector<std::vector<int>> cell_list() {
    const std::size_t count = scan_.count("the number of cells", 1);
    const std::size_t size = scan_.count("the size of the cells", 1);
    std::vector<std::vector<int>> cells;
    std::vector<double> offsets, nodes;
    if (TextScanner ahead = scan_; ahead.word() == "OFFSETS") {
      scan_.word();
      offsets = numbers("the offsets", count, scan_.word());
      if (scan_.word() != "CONNECTIVITY") scan_.fail("CONNECTIVITY should follow OFFSETS");
      nodes = numbers("the nodes of the cells", size, scan_.word());
    } else {
      const std::vector<double> list = numbers("the nodes of the cells", size, "int");
      offsets.push_back(0);
      for (std::size_t at = 0; at < list.size();) {
        const double width = list[at++];
        if (!(width >= 0 && width <= static_cast<double>(list.size() - at)))
          scan_.fail(
              fmt::format("cell {} has {} nodes, more than are there", offsets.size() - 1, width));
        nodes.insert(nodes.end(), list.begin() + static_cast<long>(at),
                     list.begin() + static_cast<long>(at) + static_cast<long>(width));
        at += static_cast<std::size_t>(width);
        offsets.push_back(static_cast<double>(nodes.size()));
      }
    }
    for (std::size_t c = 0; c + 1 < offsets.size(); ++c) {
      if (!(offsets[c] >= 0 && offsets[c] <= offsets[c + 1] &&
            offsets[c + 1] <= static_cast<double>(nodes.size())))
        scan_.fail(fmt::format("the offset of cell {} is out of range", c));
      std::vector<int>& cell = cells.emplace_back();
      for (auto k = static_cast<std::size_t>(offsets[c]);
           k < static_cast<std::size_t>(offsets[c + 1]); ++k) {
        if (!(nodes[k] >= 0 && nodes[k] < static_cast<double>(file_.points.size())) ||
            nodes[k] != std::floor(nodes[k]))
          scan_.fail(fmt::format("cell {}: node {} is out of range (0 to {})", c, nodes[k],
                                 static_cast<double>(file_.points.size()) - 1));
        cell.push_back(static_cast<int>(nodes[k]));
      }
    }
    return cells;
  }

  void add_cells(double type) {
    for (std::vector<int>& cell : cell_list()) {
      file_.cells.push_back(std::move(cell));
      file_.types.push_back(type);
    }
  }

  TextScanner scan_;
  VtkFile file_;
  bool binary_ = false, of_points_ = false;
  std::size_t values_ = 0;  // of the data that follow
};

Content sniff(const std::string& bytes) {
  if (!bytes.starts_with(kMark)) return Content::kNothing;
  const std::string_view text = bytes;
  if (text.substr(0, 1024).find("UNSTRUCTURED_GRID") != text.npos) return Content::kTetrahedra;
  for (const char* faces : {"\nPOLYGONS ", "\nTRIANGLE_STRIPS "})
    if (text.find(faces) != text.npos) return Content::kTriangles;
  return Content::kPoints;
}

Surface read_surface(const std::string& bytes, const std::string& name) {
  VtkFile file = VtkReader(bytes, name).read();
  Surface surface;
  surface.vertices = std::move(file.points);
  for (std::size_t c = 0; c < file.cells.size(); ++c) {
    const std::vector<int>& cell = file.cells[c];
    for (std::size_t k = 2; k < cell.size(); ++k) {
      if (file.types[c] != kTriangleStrip)
        surface.faces.push_back({cell[0], cell[k - 1], cell[k]});
      else if (k % 2 == 0)
        surface.faces.push_back({cell[k - 2], cell[k - 1], cell[k]});
      else
        surface.faces.push_back({cell[k - 1], cell[k - 2], cell[k]});
    }
  }
  drop_unused(surface);
  return surface;
}

PointCloud read_points(const std::string& bytes, const std::string& name,
                       std::vector<std::string>&) {
  PointCloud cloud;
  cloud.points = VtkReader(bytes, name).read().points;
  return cloud;
}

RawMesh read_mesh(const std::string& bytes, const std::string& name) {
  VtkFile file = VtkReader(bytes, name).read();
  RawMesh mesh;
  mesh.format = "VTK";
  if (file.types.size() != file.cells.size())
    fail_input(name, fmt::format("{} cells have {} types", file.cells.size(), file.types.size()),
               "write the mesh again");
  mesh.nodes = std::move(file.points);
  for (std::size_t c = 0; c < file.cells.size(); ++c) {
    const double type = file.types[c];
    mesh.other_cells += vtk::is_other_volume(type);
    if (type != vtk::kTetra && type != vtk::kQuadraticTetra) continue;
    const std::size_t width = type == vtk::kTetra ? 4 : 10;
    if (file.cells[c].size() != width)
      fail_input(name, fmt::format("tetrahedron {} has {} nodes", c, file.cells[c].size()),
                 "write the mesh again");
    const double region = c < file.region.size() ? file.region[c] : 0;
    if (!mesh.add(file.cells[c].data(), width,
                  std::abs(region) < 2e9 ? static_cast<int>(region) : 0))
      fail_input(name, "tetrahedra of first and second order are mixed", "write the mesh again");
  }
  if (file.fixed.size() == mesh.nodes.size())
    for (const double value : file.fixed) mesh.fixed.push_back(value != 0);
  return mesh;
}

}  // namespace

const Format& vtk_format() {
  static const Format format{.name = "VTK",
                             .extensions = {"vtk"},
                             .sniff = sniff,
                             .read_points = read_points,
                             .read_surface = read_surface,
                             .read_mesh = read_mesh};
  return format;
}

}  // namespace hapsim
