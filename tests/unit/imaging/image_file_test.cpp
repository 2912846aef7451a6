// A stiffness image as a table, and as a body that other programs and hapsim itself read.
#include "imaging/image_file.h"

#include <gtest/gtest.h>

#include <sstream>

#include "containers/ply.h"
#include "containers/vtu.h"
#include "formats/mesh_file.h"
#include "io/csv.h"
#include "support/block_mesh.h"

namespace hapsim {
namespace {

class ImageFile : public ::testing::Test {
 protected:
  ImageFile() : body(test::block_mesh({0.04, 0.05, 0.03}, 2, 2, 2, 1)) {
    for (std::size_t t = 0; t < body.tets.size(); ++t) modulus.push_back(1e4 + double(t) / 3);
  }
  std::string written(ImageFormat format) const {
    std::ostringstream out;
    write_image(out, body, modulus, format);
    return out.str();
  }
  TetMesh body;
  std::vector<double> modulus;
};

TEST_F(ImageFile, TheNameSaysTheFormat) {
  EXPECT_EQ(image_format("image.vtu"), ImageFormat::kVtu);
  EXPECT_EQ(image_format("a.b/IMAGE.PLY"), ImageFormat::kPly);
  for (const char* name : {"image.csv", "-", "ply", "vtu.txt", ""})
    EXPECT_EQ(image_format(name), ImageFormat::kCsv) << name;
}

TEST_F(ImageFile, APlyIsABodyWithModuli) {
  const std::string bytes = written(ImageFormat::kPly);
  EXPECT_EQ(parse_mesh(bytes, "image.ply", false).mesh.tets, body.tets);
  const PlyFile file = parse_ply(bytes, "image.ply");
  const PlyProperty* E = file.find("tetrahedron")->find("E");
  ASSERT_NE(E, nullptr);
  EXPECT_EQ(E->values, modulus);
}

TEST_F(ImageFile, AVtuHasThemAsCellData) {
  const std::vector<VtuPiece> pieces = parse_vtu(written(ImageFormat::kVtu), "image.vtu");
  ASSERT_EQ(pieces.size(), 1u);
  const VtuArray* E = find_array(pieces[0].cell_data, "E");
  ASSERT_NE(E, nullptr);
  EXPECT_EQ(E->values, modulus);
}

TEST_F(ImageFile, ATableHasTheCentres) {
  Input input = Input::from_bytes(written(ImageFormat::kCsv), "image.csv");
  const CsvTable table = read_csv(input);
  EXPECT_EQ(table.header, (std::vector<std::string>{"x", "y", "z", "E"}));
  EXPECT_EQ(table.numbers("E"), modulus);
  const Vec3 centre = (body.nodes[body.tets[3][0]] + body.nodes[body.tets[3][1]] +
                       body.nodes[body.tets[3][2]] + body.nodes[body.tets[3][3]]) /
                      4;
  EXPECT_NEAR(table.numbers("y")[3], centre.y(), 1e-15);
}

}  // namespace
}  // namespace hapsim
