#include "imaging/image_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include "base/error.h"
#include "containers/ply.h"
#include "formats/field_vtu.h"
#include "formats/mesh_file.h"
#include "formats/tetmesh_io.h"
#include "io/csv.h"
#include "io/number.h"

namespace hapsim {
namespace {

constexpr const char *kModulus = "E", *kError = "log_E_std", *kResolution = "resolution";
constexpr const char* kModelModulus = "model_modulus";

// The model's modulus by a comment of the header; 0: there is none.
double model_modulus(const PlyFile& file) {
  double value = 0;
  for (const std::string& comment : file.comments)
    if (comment.rfind(kModelModulus, 0) == 0)
      parse_number(comment.substr(std::string(kModelModulus).size() + 1), value);
  return value;
}

}  // namespace

ImageFormat image_format(const std::string& path) {
  std::string end = path.substr(path.size() - std::min<std::size_t>(4, path.size()));
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end == ".vtu" ? ImageFormat::kVtu : end == ".ply" ? ImageFormat::kPly : ImageFormat::kCsv;
}

void write_image(std::ostream& out, const TetMesh& body, const ImageValues& values,
                 ImageFormat format) {
  const std::pair<const char*, const std::vector<double>*> columns[]{
      {kModulus, &values.modulus}, {kError, &values.log_std}, {kResolution, &values.resolution}};
  if (format == ImageFormat::kVtu) {
    std::vector<VtuArray> cells;
    for (const auto& [name, column] : columns) cells.push_back({name, 1, *column});
    return write_field_vtu(out, body, {}, cells);
  }
  if (format == ImageFormat::kPly) {
    std::ostringstream bytes;
    write_body_ply(bytes, body);
    PlyFile file = parse_ply(bytes.str(), "body");
    file.comments.push_back(
        fmt::format("{} {}", kModelModulus, format_number(values.model_modulus)));
    for (PlyElement& element : file.elements)
      for (const auto& [name, column] : columns)
        if (element.name == "tetrahedron")
          element.properties.push_back(
              {name, PlyType::kFloat64, false, PlyType::kUint8, *column, {}});
    return write_ply(out, file);
  }
  Metadata metadata;
  metadata.set(kModelModulus, format_number(values.model_modulus));
  CsvWriter writer(out, metadata, {"x", "y", "z", kModulus, kError, kResolution});
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    Vec3 centre = Vec3::Zero();
    for (int k = 0; k < 4; ++k) centre += 0.25 * body.nodes[body.tets[t][k]];
    std::vector<std::string> row;
    for (int c = 0; c < 3; ++c) row.push_back(format_number(centre[c]));
    for (const auto& [name, column] : columns) row.push_back(format_number((*column)[t]));
    writer.row(row);
  }
}

ImageOnBody read_image(Input& input) {
  const std::string bytes = input.read_all();
  const std::string again = "make it by hs-identify --image image.ply";
  if (!is_ply(bytes)) fail_input(input.name(), "not a PLY with an image of the stiffness", again);
  const PlyFile file = parse_ply(bytes, input.name());
  const PlyElement* element = file.find("tetrahedron");
  if (element == nullptr || element->find(kModulus) == nullptr)
    fail_input(input.name(), "its tetrahedra have no modulus E: not an image of the stiffness",
               again);
  ImageOnBody image;
  image.values.model_modulus = model_modulus(file);
  const std::pair<const char*, std::vector<double>*> columns[]{
      {kModulus, &image.values.modulus},
      {kError, &image.values.log_std},
      {kResolution, &image.values.resolution}};
  for (const auto& [name, column] : columns) {
    const PlyProperty* property = element->find(name);
    if (property == nullptr || property->is_list || !(image.values.model_modulus > 0))
      fail_input(input.name(),
                 "an image without its standard errors, as earlier versions of hapsim wrote it",
                 again + "; without them nobody could tell what it is sure of");
    *column = property->values;
    for (std::size_t t = 0; t < column->size(); ++t)
      if (!((*column)[t] >= 0) || !std::isfinite((*column)[t]) ||
          (column == &image.values.modulus && (*column)[t] == 0))
        fail_input(input.name(), fmt::format("{} of tetrahedron {} is {}", name, t, (*column)[t]),
                   again);
  }
  image.body = parse_mesh(bytes, input.name(), false).mesh;
  return image;
}

}  // namespace hapsim
