// A stiffness image as a table, and as a body that other programs and hapsim itself read.
#include "imaging/image_file.h"

#include <gtest/gtest.h>

#include <sstream>

#include "base/error.h"
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
    values.model_modulus = 9e3;
    for (std::size_t t = 0; t < body.tets.size(); ++t) {
      values.modulus.push_back(1e4 + double(t) / 3);
      values.log_std.push_back(0.1 + double(t) / 7);
      values.resolution.push_back(0.01 + double(t) / 11);
    }
  }
  std::string written(ImageFormat format) const {
    std::ostringstream out;
    write_image(out, body, values, format);
    return out.str();
  }
  TetMesh body;
  ImageValues values;
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
  EXPECT_EQ(E->values, values.modulus);
}

TEST_F(ImageFile, AVtuHasThemAsCellData) {
  const std::vector<VtuPiece> pieces = parse_vtu(written(ImageFormat::kVtu), "image.vtu");
  ASSERT_EQ(pieces.size(), 1u);
  const VtuArray* E = find_array(pieces[0].cell_data, "E");
  ASSERT_NE(E, nullptr);
  EXPECT_EQ(E->values, values.modulus);
}

TEST_F(ImageFile, ATableHasTheCentres) {
  Input input = Input::from_bytes(written(ImageFormat::kCsv), "image.csv");
  const CsvTable table = read_csv(input);
  EXPECT_EQ(table.header,
            (std::vector<std::string>{"x", "y", "z", "E", "log_E_std", "resolution"}));
  EXPECT_EQ(table.numbers("E"), values.modulus);
  EXPECT_EQ(table.numbers("log_E_std"), values.log_std);
  EXPECT_EQ(table.metadata.find("model_modulus"), "9000");
  const Vec3 centre = (body.nodes[body.tets[3][0]] + body.nodes[body.tets[3][1]] +
                       body.nodes[body.tets[3][2]] + body.nodes[body.tets[3][3]]) /
                      4;
  EXPECT_NEAR(table.numbers("y")[3], centre.y(), 1e-15);
}

std::string said_of(const std::string& bytes) {
  Input input = Input::from_bytes(bytes, "image.ply");
  try {
    read_image(input);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST_F(ImageFile, APlyIsReadAsItWasWritten) {
  Input input = Input::from_bytes(written(ImageFormat::kPly), "image.ply");
  const ImageOnBody image = read_image(input);
  EXPECT_EQ(image.body.tets, body.tets);
  EXPECT_EQ(image.values.model_modulus, 9e3);
  EXPECT_EQ(image.values.modulus, values.modulus);
  EXPECT_EQ(image.values.log_std, values.log_std);
  EXPECT_EQ(image.values.resolution, values.resolution);
}

TEST_F(ImageFile, WhatIsNoImageIsToldInALine) {
  EXPECT_NE(said_of(written(ImageFormat::kCsv)).find("image.ply: not a PLY with an image"),
            std::string::npos);
  PlyFile file = parse_ply(written(ImageFormat::kPly), "image.ply");
  const auto with = [&](const PlyFile& changed) {
    std::ostringstream out;
    write_ply(out, changed);
    return said_of(out.str());
  };
  const auto tetrahedra = [](PlyFile& f) -> std::vector<PlyProperty>& {
    for (PlyElement& element : f.elements)
      if (element.name == "tetrahedron") return element.properties;
    return f.elements.back().properties;
  };
  PlyFile body_alone = file, older = file, broken = file;
  std::erase_if(tetrahedra(body_alone), [](const PlyProperty& p) { return p.name == "E"; });
  EXPECT_NE(with(body_alone).find("its tetrahedra have no modulus E"), std::string::npos);
  std::erase_if(tetrahedra(older), [](const PlyProperty& p) { return p.name == "log_E_std"; });
  EXPECT_NE(with(older).find("an image without its standard errors"), std::string::npos);
  for (PlyProperty& p : tetrahedra(broken))
    if (p.name == "log_E_std") p.values[3] = -1;
  EXPECT_NE(with(broken).find("log_E_std of tetrahedron 3 is -1"), std::string::npos);
}

}  // namespace
}  // namespace hapsim
