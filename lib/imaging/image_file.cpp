#include "imaging/image_file.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include "containers/ply.h"
#include "formats/field_vtu.h"
#include "formats/tetmesh_io.h"
#include "io/csv.h"

namespace hapsim {

ImageFormat image_format(const std::string& path) {
  std::string end = path.substr(path.size() - std::min<std::size_t>(4, path.size()));
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return end == ".vtu" ? ImageFormat::kVtu : end == ".ply" ? ImageFormat::kPly : ImageFormat::kCsv;
}

void write_image(std::ostream& out, const TetMesh& body, const std::vector<double>& modulus,
                 ImageFormat format) {
  if (format == ImageFormat::kVtu) return write_field_vtu(out, body, {}, {{"E", 1, modulus}});
  if (format == ImageFormat::kPly) {
    std::ostringstream bytes;
    write_body_ply(bytes, body);
    PlyFile file = parse_ply(bytes.str(), "body");
    for (PlyElement& element : file.elements)
      if (element.name == "tetrahedron")
        element.properties.push_back({"E", PlyType::kFloat64, false, PlyType::kUint8, modulus, {}});
    return write_ply(out, file);
  }
  CsvWriter writer(out, {}, {"x", "y", "z", "E"});
  for (std::size_t t = 0; t < body.tets.size(); ++t) {
    Vec3 centre = Vec3::Zero();
    for (int k = 0; k < 4; ++k) centre += 0.25 * body.nodes[body.tets[t][k]];
    writer.row({format_number(centre.x()), format_number(centre.y()), format_number(centre.z()),
                format_number(modulus[t])});
  }
}

}  // namespace hapsim
