#include "formats/surface_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <unordered_map>

#include "base/error.h"
#include "formats/ply.h"
#include "formats/stl.h"
#include "io/csv.h"
#include "mesh/drop_unused.h"
#include "mesh/surface.h"

namespace hapsim {
namespace {

struct PointHash {
  std::size_t operator()(const Vec3& p) const {
    std::size_t h = 0;
    for (int k = 0; k < 3; ++k) h = h * 0x9E3779B97F4A7C15u + std::hash<double>()(p[k]);
    return h;
  }
};

const PlyElement& required_element(const PlyFile& file, const char* element,
                                   const std::string& name) {
  const PlyElement* found = file.find(element);
  if (found == nullptr || found->count == 0) {
    fail_input(name, fmt::format("the PLY file has no element '{}'", element),
               "give a file with points" + std::string(element[0] == 'f' ? " and faces" : ""));
  }
  return *found;
}

// Three scalar properties as vectors; empty when any is absent.
std::vector<Vec3> vectors(const PlyElement& element, const std::array<const char*, 3>& names) {
  std::array<const PlyProperty*, 3> column;
  for (int k = 0; k < 3; ++k) {
    column[k] = element.find(names[k]);
    if (column[k] == nullptr || column[k]->is_list) return {};
  }
  std::vector<Vec3> result(element.count);
  for (std::size_t i = 0; i < element.count; ++i) {
    for (int k = 0; k < 3; ++k) result[i][k] = column[k]->values[i];
  }
  return result;
}

std::vector<Vec3> ply_points(const PlyFile& file, const std::string& name) {
  std::vector<Vec3> points = vectors(required_element(file, "vertex", name), {"x", "y", "z"});
  if (points.empty()) {
    fail_input(name, "the PLY element 'vertex' has no x, y, z", "name the coordinates x, y and z");
  }
  return points;
}

Surface surface_from_ply(const PlyFile& file, const std::string& name) {
  Surface surface;
  surface.vertices = ply_points(file, name);
  const PlyElement& element = required_element(file, "face", name);
  const PlyProperty* list = element.find("vertex_indices");
  if (list == nullptr) list = element.find("vertex_index");
  if (list == nullptr || !list->is_list) {
    fail_input(name, "the PLY element 'face' has no list 'vertex_indices'",
               "write faces as 'property list uchar int vertex_indices'");
  }
  const auto vertices = static_cast<double>(surface.vertices.size());
  for (std::size_t i = 0; i < element.count; ++i) {
    const std::size_t begin = list->offset[i];
    const std::size_t corners = list->offset[i + 1] - begin;
    if (corners < 3) {
      fail_input(name, fmt::format("face {} has {} corners", i, corners), "give at least three");
    }
    for (std::size_t k = begin; k < begin + corners; ++k) {
      if (!(list->values[k] >= 0 && list->values[k] < vertices)) {
        fail_input(name, fmt::format("face {} names vertex {} of {}", i, list->values[k], vertices),
                   "vertices count from 0");
      }
    }
    for (std::size_t k = 2; k < corners; ++k) {
      surface.faces.push_back({static_cast<int>(list->values[begin]),
                               static_cast<int>(list->values[begin + k - 1]),
                               static_cast<int>(list->values[begin + k])});
    }
  }
  return surface;
}

Surface surface_from_soup(const TriangleSoup& soup) {
  Surface surface;
  std::unordered_map<Vec3, int, PointHash> number;
  for (const auto& corners : soup) {
    Triangle face;
    for (int k = 0; k < 3; ++k) {
      const Vec3 p = corners[k] + Vec3::Zero();  // -0 becomes 0, which hashes alike
      const auto [at, added] = number.try_emplace(p, static_cast<int>(surface.vertices.size()));
      if (added) surface.vertices.push_back(p);
      face[k] = at->second;
    }
    surface.faces.push_back(face);
  }
  return surface;
}

// Fields of a line without header: numbers between spaces, tabs, commas or semicolons.
std::vector<double> plain_numbers(const std::string& line, bool& clean) {
  std::vector<double> numbers;
  clean = true;
  std::size_t at = 0;
  while (true) {
    at = line.find_first_not_of(" \t\r,;", at);
    if (at == std::string::npos) return numbers;
    const std::size_t end = std::min(line.find_first_of(" \t\r,;", at), line.size());
    double value = 0;
    if (parse_number(std::string_view(line).substr(at, end - at), value)) {
      numbers.push_back(value);
    } else {
      clean = false;
    }
    at = end;
  }
}

// x y z [nx ny nz] without a header.
class PlainPoints {
 public:
  explicit PlainPoints(const std::string& name) : name_(name) {}

  void add(const std::string& line, long number) {
    if (!line.empty() && line[0] == '#') return;
    bool clean = true;
    const std::vector<double> v = plain_numbers(line, clean);
    if (v.empty() && clean) return;
    if (cloud_.points.empty()) normals_ = v.size() == 6;
    if (!clean || v.size() < (normals_ ? 6u : 3u)) {
      fail_input(fmt::format("{}:{}", name_, number), "not a row of finite x y z",
                 "remove or mend the row");
    }
    cloud_.points.emplace_back(v[0], v[1], v[2]);
    if (normals_) cloud_.normals.emplace_back(v[3], v[4], v[5]);
  }
  PointCloud take() { return std::move(cloud_); }

 private:
  std::string name_;
  PointCloud cloud_;
  bool normals_ = false;
};

std::vector<Vec3> zip(const std::vector<double>& x, const std::vector<double>& y,
                      const std::vector<double>& z) {
  std::vector<Vec3> v(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) v[i] = {x[i], y[i], z[i]};
  return v;
}

PointCloud points_from_table(const CsvTable& table) {
  // Comments, then numbers between spaces: the first row was taken for the header.
  bool clean = false;
  if (table.header.size() == 1 && plain_numbers(table.header[0], clean).size() >= 3 && clean) {
    PlainPoints plain(table.name);
    plain.add(table.header[0], table.line.empty() ? 1 : table.line[0] - 1);
    for (std::size_t r = 0; r < table.rows(); ++r) plain.add(table.columns[0][r], table.line[r]);
    return plain.take();
  }
  PointCloud cloud;
  cloud.points = zip(table.numbers("x"), table.numbers("y"), table.numbers("z"));
  if (table.find("nx") >= 0 && table.find("ny") >= 0 && table.find("nz") >= 0) {
    cloud.normals = zip(table.numbers("nx"), table.numbers("ny"), table.numbers("nz"));
  }
  return cloud;
}

PointCloud points_from_ply(const PlyFile& file, const std::string& name) {
  PointCloud cloud;
  cloud.points = ply_points(file, name);
  cloud.normals = vectors(*file.find("vertex"), {"nx", "ny", "nz"});
  return cloud;
}

// Whether the bytes are a PLY file, looking at no more than can be put back on any stream.
bool starts_like_ply(std::istream& in) {
  if (in.peek() != 'p') return false;
  in.get();
  const bool ply = in.peek() == 'l';
  in.unget();
  return ply;
}

void add_vectors(PlyElement& element, const std::array<const char*, 3>& names,
                 const std::vector<Vec3>& v) {
  for (int k = 0; k < 3; ++k) {
    PlyProperty property;
    property.name = names[k];
    property.values.reserve(v.size());
    for (const Vec3& p : v) property.values.push_back(p[k]);
    element.properties.push_back(std::move(property));
  }
}

PlyFile ply_of_points(const std::vector<Vec3>& points, bool ascii) {
  PlyFile file;
  file.format = ascii ? PlyFormat::kAscii : PlyFormat::kBinaryLittle;
  PlyElement vertex;
  vertex.name = "vertex";
  vertex.count = points.size();
  add_vectors(vertex, {"x", "y", "z"}, points);
  file.elements.push_back(std::move(vertex));
  return file;
}

}  // namespace

Surface read_surface(Input& input) {
  Surface surface = read_surface_as_given(input);
  // A corner that met another leaves no area, only an edge that would look open.
  std::erase_if(surface.faces,
                [](const Triangle& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; });
  drop_unused(surface);
  return surface;
}

Surface read_surface_as_given(Input& input) {
  const std::string bytes = input.read_all();
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) {
    return surface_from_ply(parse_ply(bytes, input.name()), input.name());
  }
  return surface_from_soup(parse_stl(bytes, input.name()));
}

PointCloud read_points(Input& input) {
  std::istream& in = input.stream();
  PointCloud cloud;
  const int first = in.peek();
  if (starts_like_ply(in)) {
    cloud = points_from_ply(parse_ply(input.read_all(), input.name()), input.name());
  } else if (first == ' ' || first == '+' || first == '-' || first == '.' ||
             (first >= '0' && first <= '9')) {
    PlainPoints plain(input.name());
    std::string line;
    for (long number = 1; std::getline(in, line); ++number) plain.add(line, number);
    cloud = plain.take();
  } else {
    cloud = points_from_table(read_csv(input));
  }
  if (cloud.points.empty()) {
    fail_input(input.name(), "there are no points", "give rows of x,y,z");
  }
  return cloud;
}

void write_surface_ply(std::ostream& out, const Surface& surface, bool ascii,
                       const std::vector<std::string>& comments) {
  PlyFile file = ply_of_points(surface.vertices, ascii);
  file.comments = comments;
  PlyElement face;
  face.name = "face";
  face.count = surface.faces.size();
  PlyProperty list;
  list.name = "vertex_indices";
  list.type = PlyType::kInt32;
  list.is_list = true;
  list.offset.push_back(0);
  for (const Triangle& f : surface.faces) {
    for (const int v : f) list.values.push_back(v);
    list.offset.push_back(list.values.size());
  }
  face.properties.push_back(std::move(list));
  file.elements.push_back(std::move(face));
  write_ply(out, file);
}

void write_points_ply(std::ostream& out, const PointCloud& cloud, bool ascii,
                      const std::vector<std::string>& comments) {
  PlyFile file = ply_of_points(cloud.points, ascii);
  file.comments = comments;
  if (!cloud.normals.empty()) {
    add_vectors(file.elements.front(), {"nx", "ny", "nz"}, cloud.normals);
  }
  write_ply(out, file);
}

}  // namespace hapsim
