// The table itself, and every format in it: what one writes is recognised and comes back.
#include "formats/format_table.h"

#include <gtest/gtest.h>

#include <cstring>
#include <set>
#include <sstream>

#include "expect_error.h"
#include "formats/body_input.h"
#include "formats/mesh_file.h"
#include "formats/surface_io.h"
#include "support/shapes.h"

namespace hapsim {
namespace {

constexpr Content kContents[] = {Content::kPoints, Content::kTriangles, Content::kTetrahedra};

TetMesh two_tetrahedra() {
  TetMesh mesh;
  mesh.nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0.7}};
  mesh.tets = {{0, 1, 2, 3}, {1, 4, 2, 3}};
  mesh.region = {0, 2};
  mesh.fixed = {1, 1, 1, 0, 0};
  mesh.faces = boundary_faces(mesh);
  return mesh;
}

TEST(FormatTable, NamesAndExtensionsAreOfOneFormat) {
  std::set<std::string> names, extensions;
  for (const Format* format : all_formats()) {
    EXPECT_TRUE(names.insert(format->name).second) << format->name;
    EXPECT_TRUE(format->read_points || format->read_surface || format->read_mesh) << format->name;
    EXPECT_FALSE(format->extensions.empty()) << format->name;
    for (const std::string& extension : format->extensions)
      EXPECT_TRUE(extensions.insert(extension).second) << extension;
  }
}

TEST(FormatTable, PointsComeBack) {
  PointCloud cloud{{{1, 2, 3}, {-0.1, 1e-7, 5}}, {{0, 0, 1}, {0, 1, 0}}};
  for (const std::string& extension : extensions_to_write(Content::kPoints)) {
    const Format& format = format_to_write("p." + extension, Content::kPoints);
    for (const bool ascii : {false, true}) {
      std::ostringstream out;
      format.write_points(out, cloud, {.ascii = ascii, .comments = {"a comment"}});
      EXPECT_EQ(recognise(out.str()).format, &format) << extension;
      EXPECT_EQ(recognise(out.str()).content, Content::kPoints) << extension;
      const PointCloud back = parse_points(out.str(), "p");
      EXPECT_EQ(back.points, cloud.points) << extension;
      EXPECT_EQ(back.normals, cloud.normals) << extension;
    }
  }
}

TEST(FormatTable, SurfacesComeBack) {
  const Surface box = test::box({0.5, 0.25, 1});
  for (const std::string& extension : extensions_to_write(Content::kTriangles)) {
    const Format& format = format_to_write("s." + extension, Content::kTriangles);
    for (const bool ascii : {false, true}) {
      std::ostringstream out;
      format.write_surface(out, box, {.ascii = ascii});
      EXPECT_EQ(recognise(out.str()).format, &format) << extension;
      EXPECT_EQ(recognise(out.str()).content, Content::kTriangles) << extension;
      const Surface back = parse_surface(out.str(), "s");
      EXPECT_TRUE(is_closed(back)) << extension;
      EXPECT_EQ(back.vertices.size(), box.vertices.size()) << extension;
      EXPECT_NEAR(signed_volume(back), 0.125, 1e-15) << extension;
      EXPECT_EQ(parse_points(out.str(), "s").points.size() % 4, 0u) << extension;
    }
  }
}

TEST(FormatTable, MeshesComeBack) {
  const TetMesh mesh = two_tetrahedra();
  for (const std::string& extension : extensions_to_write(Content::kTetrahedra)) {
    const Format& format = format_to_write("m." + extension, Content::kTetrahedra);
    for (const bool ascii : {false, true}) {
      std::ostringstream out;
      format.write_mesh(out, mesh, {.ascii = ascii});
      EXPECT_EQ(recognise(out.str()).format, &format) << extension;
      EXPECT_EQ(recognise(out.str()).content, Content::kTetrahedra) << extension;
      const TetMesh back = parse_mesh(out.str(), "m", false).mesh;
      EXPECT_EQ(back.nodes, mesh.nodes) << extension;
      EXPECT_EQ(back.tets.size(), 2u) << extension;
      EXPECT_EQ(back.fixed, mesh.fixed) << extension;
      // Whoever asks for triangles gets its boundary.
      Input input = Input::from_bytes(out.str(), "m");
      EXPECT_NEAR(signed_volume(read_outside(input)), signed_volume(boundary_surface(mesh)), 1e-15);
      EXPECT_EQ(parse_surface(out.str(), "m").faces.size(), 6u) << extension;
    }
  }
}

TEST(FormatTable, TheExtensionSaysWhatIsWritten) {
  for (const Content content : kContents) {
    for (const char* any : {"-", "", "out", "a.b/out", "out.PLY"})
      EXPECT_STREQ(format_to_write(any, content).name, "PLY") << any;
    for (const Format* format : all_formats())
      for (const std::string& extension : format->extensions) {
        const auto known = extensions_to_write(content);
        if (std::find(known.begin(), known.end(), extension) != known.end())
          EXPECT_EQ(&format_to_write("out." + extension, content), format) << extension;
        else
          error_of([&] { format_to_write("out." + extension, content); }, ExitCode::kUsage);
      }
  }
  const std::string what =
      error_of([] { format_to_write("out.zip", Content::kTriangles); }, ExitCode::kUsage);
  EXPECT_EQ(what.rfind("out.zip: a surface is not written as .zip; give .ply", 0), 0u) << what;
}

std::string ply(const std::string& elements) {
  return "ply\nformat ascii 1.0\n" + elements + "end_header\n";
}

std::string stl_of(std::uint32_t claimed, std::size_t triangles) {
  std::string bytes(84 + 50 * triangles, '\0');
  bytes.replace(0, 12, "solid binary");
  std::memcpy(bytes.data() + 80, &claimed, sizeof claimed);
  const float facet[12] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0};
  for (std::size_t t = 0; t < triangles; ++t)
    std::memcpy(bytes.data() + 84 + 50 * t, facet, sizeof facet);
  return bytes;
}

TEST(FormatTable, TellsByContentWhatLooksAlike) {
  const auto expect = [](const std::string& bytes, const std::string& name, Content content) {
    const Recognised found = recognise(bytes);
    EXPECT_EQ(found.format == nullptr ? "" : found.format->name, name) << bytes.substr(0, 60);
    EXPECT_EQ(found.content, content) << bytes.substr(0, 60);
  };
  expect(ply("element vertex 4\nelement tetrahedron 1\n"), "PLY", Content::kTetrahedra);
  expect(ply("element vertex 3\nelement face 1\n"), "PLY", Content::kTriangles);
  expect(ply("element vertex 3\nelement face 0\n"), "PLY", Content::kPoints);
  expect(ply("comment element face 1\nelement vertex 3\n"), "PLY", Content::kPoints);
  expect("plywood,x,y,z\n1,2,3,4\n", "CSV", Content::kPoints);
  expect("OFFSET,x,y,z\n1,2,3,4\n", "CSV", Content::kPoints);
  expect("OFF\n4 4 0\n", "OFF", Content::kTriangles);
  // Rows of points whose first looks like TetGen's header.
  expect("10 3 0\n1 2 3\n4 5 6\n", "XYZ", Content::kPoints);
  expect("5 4 2\n1 2 3\n", "XYZ", Content::kPoints);
  expect("2 3 0\n1 0 0 0\n2 1 0 0\n", "TetGen", Content::kTetrahedra);
  expect("# .PCD v0.7\nVERSION 0.7\n", "PCD", Content::kPoints);
  expect("# a scan\n\n 1.5;2;3\n", "XYZ", Content::kPoints);
  // A binary STL may begin with "solid", be cut, or be longer than it says.
  expect(stl_of(2, 2), "STL", Content::kTriangles);
  expect(stl_of(9, 2).replace(0, 5, "other"), "STL", Content::kTriangles);
  expect(stl_of(1, 2).replace(0, 5, "other"), "STL", Content::kTriangles);
  expect("SOLID a\nfacet", "STL", Content::kTriangles);
  expect("solidity,x,y,z\n", "CSV", Content::kPoints);
  for (const std::string& unknown : {std::string("hello"), std::string(), std::string(500, '\0'),
                                     std::string("\x7f"
                                                 "ELF,\0,",
                                                 7)})
    expect(unknown, "", Content::kNothing);
}

TEST(FormatTable, WhatIsNotReadIsToldInOneLine) {
  EXPECT_EQ(error_of([] { parse_surface("hello", "f"); }),
            "f: not a " + names_to_read(Content::kTriangles) +
                " surface; give triangles, or points to hs-reconstruct");
  EXPECT_EQ(error_of([] { parse_mesh("solid\nendsolid\n", "f", true); }),
            "f: not a " + names_to_read(Content::kTetrahedra) +
                " mesh but STL; write it with hs-tetmesh");
  EXPECT_EQ(error_of([] { parse_points("$MeshFormat\n", "f"); }),
            "f: not a " + names_to_read(Content::kPoints) +
                " file of points but Gmsh; give rows of x,y,z");
  EXPECT_EQ(error_of([] { parse_points("", "f"); }), "f: the file is empty; give rows of x,y,z");
}

}  // namespace
}  // namespace hapsim
