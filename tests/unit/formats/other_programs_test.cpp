// Files of other programs that hapsim reads and does not write itself.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "expect_error.h"
#include "formats/format_table.h"
#include "formats/mesh_file.h"
#include "formats/surface_io.h"
#include "support/needs.h"

namespace hapsim {
namespace {

std::string file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

template <class T>
std::string big(std::initializer_list<T> values) {
  std::string bytes;
  for (const T value : values) {
    const char* at = reinterpret_cast<const char*>(&value);
    bytes.append(std::reverse_iterator(at + sizeof value), std::reverse_iterator(at));
  }
  return bytes;
}

TEST(OtherPrograms, ObjHasPolygonsTexturesAndIndicesFromBehind) {
  const std::string bytes =
      "# made by hand\nmtllib a.mtl\no box\nv 0 0 0 1.0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 "
      "1\n"
      "g top\nusemtl red\ns off\nf 1/1/1 2/1/1 3//1 4 # a square\nf -4 -3 -1\n";
  EXPECT_STREQ(recognise(bytes).format->name, "OBJ");
  const Surface surface = parse_surface(bytes, "a.obj");
  ASSERT_EQ(surface.faces.size(), 3u);
  EXPECT_EQ(surface.faces[1], (Triangle{0, 2, 3}));
  EXPECT_EQ(surface.faces[2], (Triangle{0, 1, 3}));
  EXPECT_EQ(parse_points("v 1 2 3\nv 4 5 6\n", "p.obj").points.size(), 2u);
  const auto refused = [](const std::string& text, const std::string& what) {
    EXPECT_EQ(error_of([&] {
                parse_surface("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + text, "a.obj");
              }).rfind(what, 0),
              0u)
        << text;
  };
  refused("f 1 2 4\n", "a.obj:4: '4' is no vertex: 3 stand before this face");
  refused("f 1 2 0\n", "a.obj:4: '0' is no vertex");
  refused("f 1 2 x\n", "a.obj:4: 'x' is no vertex");
  refused("f 1 2\n", "a.obj:4: a face has fewer than three corners");
  refused("v 1 nan\n", "a.obj:4:");
}

TEST(OtherPrograms, TablesAreNotTakenForObj) {
  for (const char* table : {"s x y z\n0.1 1 2 3\n", "v x y z\n0.1 1 2 3\n", "p,v,f\n1,2,3\n"}) {
    const Format* found = recognise(table).format;
    EXPECT_TRUE(found == nullptr || found->name != std::string("OBJ")) << table;
  }
}

const std::string kHead = "# vtk DataFile Version 3.0\nby hand\n";

TEST(OtherPrograms, VtkMeshesAsTextAndBinary) {
  const std::string text =
      kHead +
      "ASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0 1 0 0\n0 1 0 0 0 1 1 1 0.7\n"
      "CELLS 3 14\n4 0 1 2 3\n4 1 4 2 3\n3 0 1 2\nCELL_TYPES 3\n10 10 5\nCELL_DATA 3\nFIELD f 1\n"
      "region 1 3 int\n0 7 0\nPOINT_DATA 5\nSCALARS fixed unsigned_char\nLOOKUP_TABLE default\n"
      "1 1 1 0 0\nVECTORS u float\n" +
      std::string("0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n");
  const std::string binary =
      "# vtk DataFile Version 5.1\nvtk output\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 "
      "float\n" +
      big<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0.7F}) +
      "\nMETADATA\nINFORMATION 0\n\nCELLS 4 11\nOFFSETS vtktypeint64\n" +
      big<std::int64_t>({0, 4, 8, 11}) + "\nCONNECTIVITY vtktypeint64\n" +
      big<std::int64_t>({0, 1, 2, 3, 1, 4, 2, 3, 0, 1, 2}) + "\nCELL_TYPES 3\n" +
      big<std::int32_t>({10, 10, 5}) +
      "\nCELL_DATA 3\nSCALARS region int 1\nLOOKUP_TABLE default\n" + big<std::int32_t>({0, 7, 0}) +
      "\nPOINT_DATA 5\nFIELD FieldData 1\nfixed 1 5 unsigned_char\n" +
      big<std::uint8_t>({1, 1, 1, 0, 0}) + "\n";
  for (const std::string& bytes : {text, binary}) {
    EXPECT_STREQ(recognise(bytes).format->name, "VTK");
    const TetMesh mesh = parse_mesh(bytes, "m.vtk", false).mesh;
    EXPECT_EQ(mesh.tets.size(), 2u);
    EXPECT_EQ(mesh.region, (std::vector<int>{0, 7}));
    EXPECT_EQ(mesh.fixed, (std::vector<std::uint8_t>{1, 1, 1, 0, 0}));
    EXPECT_NEAR(mesh.nodes[4].z(), 0.7, 1e-7);
    EXPECT_EQ(parse_surface(bytes, "m.vtk").faces.size(), 6u);
    // Cut anywhere it is refused or is another mesh, never more.
    for (std::size_t cut = 0; cut < bytes.size(); cut += 7) {
      try {
        parse_mesh(bytes.substr(0, cut), "m.vtk", true);
      } catch (const Error& e) {
        EXPECT_EQ(e.code(), ExitCode::kBadInput);
      }
    }
  }
}

TEST(OtherPrograms, VtkSurfacesHavePolygonsAndStrips) {
  const std::string points = "ASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 1 0 0 1 1 0 0 1 0\n";
  EXPECT_EQ(parse_surface(kHead + points + "POLYGONS 1 5\n4 0 1 2 3\n", "s.vtk").faces.size(), 2u);
  const Surface strip = parse_surface(kHead + points + "TRIANGLE_STRIPS 1 5\n4 0 1 3 2\n", "s.vtk");
  ASSERT_EQ(strip.faces.size(), 2u);
  EXPECT_NEAR(face_normal(strip, 0).dot(face_normal(strip, 1)), 1, 1e-15);  // both upwards
  EXPECT_EQ(recognise(kHead + points).content, Content::kPoints);
  EXPECT_EQ(parse_points(kHead + points, "s.vtk").points.size(), 4u);
  EXPECT_EQ(error_of([&] {
              parse_surface(kHead + points + "POLYGONS 1 4\n3 0 1 4\n", "s.vtk");
            }).rfind("s.vtk:", 0),
            0u);
  EXPECT_NE(error_of([] {
              parse_surface(kHead + "ASCII\nDATASET STRUCTURED_POINTS\n\nPOLYGONS ", "s");
            }).find("a STRUCTURED_POINTS is no body"),
            std::string::npos);
}

TEST(OtherPrograms, GmshOfTheFirstFormat) {
  const std::string bytes =
      "$NOD\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n9 1 1 0.7\n$ENDNOD\n"
      "$ELM\n3\n1 4 2 1 4 1 2 3 4\n2 4 0 1 4 2 9 3 4\n3 2 0 1 3 1 2 3\n$ENDELM\n";
  EXPECT_STREQ(recognise(bytes).format->name, "Gmsh");
  const TetMesh mesh = parse_mesh(bytes, "m.msh", false).mesh;
  EXPECT_EQ(mesh.tets.size(), 2u);
  EXPECT_EQ(mesh.region, (std::vector<int>{2, 0}));
  EXPECT_NE(error_of([&] {
              parse_mesh(bytes.substr(0, bytes.find("$ENDNOD")), "m.msh", false);
            }).find("$ENDNOD should follow"),
            std::string::npos);
}

TEST(OtherPrograms, OrgansAndTheBunnyAreRead) {
  const std::string root = test::shared_path("realdata");
  HAPSIM_NEEDS_SHARED(root);
  const std::string scans = root + "/scans/";
  // SOFA's liver as a mesh and its hull, the same organ in the same unit.
  const TetMesh liver = parse_mesh(file(scans + "liver.msh"), "liver.msh", true).mesh;
  EXPECT_EQ(liver.nodes.size(), 181u);
  EXPECT_EQ(liver.tets.size(), 596u);
  const Surface hull = parse_surface(file(scans + "liver.obj"), "liver.obj");
  EXPECT_EQ(hull.faces.size(), 274u);
  EXPECT_NEAR(signed_volume(boundary_surface(liver)), signed_volume(hull),
              0.02 * signed_volume(hull));
  EXPECT_FALSE(parse_mesh(file(scans + "liver2.msh"), "liver2.msh", true).mesh.tets.empty());
  const Surface scanned = parse_surface(file(scans + "liver.vtk"), "liver.vtk");
  EXPECT_EQ(scanned.vertices.size(), 5008u);
  EXPECT_TRUE(is_closed(scanned));
  const std::string bunny = file(scans + "stanford-bunny.obj");
  EXPECT_EQ(parse_surface(bunny, "bunny").faces.size(), 69451u);
  EXPECT_EQ(parse_points(bunny, "bunny").points.size(), 35947u);
}

}  // namespace
}  // namespace hapsim
