// Meshes inside models of FEBio and scenes of SOFA, as their manuals write them.
#include <gtest/gtest.h>

#include "formats/mesh_file.h"
#include "support/shapes.h"

namespace hapsim {
namespace {

// A part of two tetrahedra and another of one; `rest` after the elements, `boundary` after the
// mesh.
std::string febio(const std::string& version, const std::string& section, const std::string& rest,
                  const std::string& boundary) {
  return "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>\n<!-- by hand -->\n<febio_spec "
         "version=\"" +
         version + "\">\n<" + section +
         ">\n<Nodes name=\"all\">\n<node id=\"1\">0.0,0.0,0.0</node>\n"
         "<node id=\"2\"> 1e-2, 0.0, 0.0</node>\n<node id=\"3\">0,0.01,0</node>\n"
         "<node id=\"10\">0,0,0.01</node>\n<node id=\"11\">0.01,0.01,0.01</node>\n"
         "<node id=\"12\">0,0.01,0.02</node>\n</Nodes>\n"
         "<Elements type=\"tet4\" mat=\"1\" name=\"liver\">\n<elem id=\"1\">1,2,3,10</elem>\n"
         "<elem id=\"2\">2,11,3,10</elem>\n</Elements>\n"
         "<Elements type=\"tet4\" mat=\"2\" name=\"tumour\">\n<elem id=\"1\">3,11,12,10</elem>\n"
         "</Elements>\n<Elements type=\"tri3\" name=\"skin\"><elem "
         "id=\"9\">1,2,3</elem></Elements>\n" +
         rest + "</" + section + ">\n" + boundary + "</febio_spec>\n";
}

std::string fixed_of(const std::string& bytes) {
  const MeshFile file = parse_mesh(bytes, "f", false);
  EXPECT_TRUE(file.has_fixed);
  std::string fixed;
  for (const std::uint8_t f : file.mesh.fixed) fixed += f != 0 ? '1' : '0';
  return fixed;
}

void refuse(const std::string& bytes, const std::string& part) {
  const auto [code, what] = test::error_of([&] { parse_mesh(bytes, "f", true); });
  EXPECT_EQ(code, 3) << part;
  EXPECT_NE(what.find(part), std::string::npos) << what;
}

TEST(Febio, PartsAreRegionsAndShellsAreLeftOut) {
  const MeshFile file = parse_mesh(febio("4.0", "Mesh", "", ""), "f", false);
  EXPECT_EQ(file.format, "FEBio");
  EXPECT_FALSE(file.has_fixed);
  EXPECT_EQ(file.mesh.order, 1);
  ASSERT_EQ(file.mesh.tets.size(), 3U);
  EXPECT_EQ(file.mesh.region, (std::vector<int>{0, 0, 1}));
  EXPECT_EQ(file.mesh.nodes[4], Vec3(0.01, 0.01, 0.01));
  EXPECT_EQ(file.mesh.tets[1][1], 4);
}

TEST(Febio, SupportOfEveryVersion) {
  const std::string ids =
      "<NodeSet name=\"low\"><n id=\"1\"/><n id=\"2\"/><n id=\"3\"/></NodeSet>\n";
  EXPECT_EQ(
      fixed_of(febio("4.0", "Mesh", "<NodeSet name=\"low\">1:3,10</NodeSet>",
                     "<Boundary><bc type=\"zero displacement\" node_set=\"low\"><x_dof>1</x_dof>"
                     "<y_dof>1</y_dof><z_dof>1</z_dof></bc></Boundary>")),
      "111100");
  EXPECT_EQ(
      fixed_of(febio("3.0", "Mesh", ids,
                     "<Boundary><bc type=\"fix\" node_set=\"low\"><dofs>x,y,z,u,v,w</dofs></bc>"
                     "</Boundary>")),
      "111000");
  EXPECT_EQ(fixed_of(febio("2.5", "Geometry", ids,
                           "<Boundary><fix bc=\"x,y,z\" node_set=\"low\"/></Boundary>")),
            "111000");
  EXPECT_EQ(
      fixed_of(febio("3.0", "Mesh", "<Surface name=\"s\"><tri3 id=\"1\">1,3,2</tri3></Surface>",
                     "<Boundary><bc type=\"fix\" node_set=\"@surface:s\"><dofs>x,y,z</dofs></bc>"
                     "</Boundary>")),
      "111000");
}

TEST(Febio, OnlyAllThreeDirectionsHold) {
  const std::string sets = "<NodeSet name=\"a\">1:3:2,2</NodeSet><NodeSet name=\"b\">2,3</NodeSet>";
  EXPECT_EQ(
      fixed_of(febio("2.5", "Geometry", sets,
                     "<Boundary><fix bc=\"x,y\" node_set=\"a\"/><fix bc=\"z\" node_set=\"b\"/>"
                     "<fix bc=\"sx,sy,sz\" node_set=\"a\"/></Boundary>")),
      "011000");
  // What a step holds is no support.
  EXPECT_FALSE(
      parse_mesh(febio("4.0", "Mesh", sets,
                       "<Step><Boundary><fix bc=\"x,y,z\" node_set=\"a\"/></Boundary></Step>"),
                 "f", false)
          .has_fixed);
}

TEST(Febio, SecondOrder) {
  const std::string corners[4] = {"0,0,0", "2,0,0", "0,2,0", "0,0,2"};
  std::string nodes;
  for (int k = 0; k < 4; ++k)
    nodes += "<node id=\"" + std::to_string(k + 1) + "\">" + corners[k] + "</node>";
  nodes +=  // between 1 2, 2 3, 3 1, 1 4, 2 4, 3 4
      "<node id=\"5\">1,0,0</node><node id=\"6\">1,1,0</node><node id=\"7\">0,1,0</node>"
      "<node id=\"8\">0,0,1</node><node id=\"9\">1,0,1</node><node id=\"10\">0,1,1</node>";
  const MeshFile file = parse_mesh(
      "<febio_spec version=\"4.0\"><Mesh><Nodes>" + nodes +
          "</Nodes><Elements type=\"tet10\" name=\"Region_4\"><elem id=\"1\">1,2,3,4,5,6,7,8,9,10"
          "</elem></Elements></Mesh></febio_spec>",
      "f", false);
  EXPECT_EQ(file.mesh.order, 2);
  EXPECT_EQ(file.mesh.region[0], 4);
}

TEST(Febio, RefusesWithTheLine) {
  const std::string good = febio("4.0", "Mesh", "", "");
  const auto with = [&](const std::string& what, const std::string& by) {
    std::string bad = good;
    bad.replace(bad.find(what), what.size(), by);
    return bad;
  };
  refuse(with("1,2,3,10", "1,2,3,99"), "f:14: there is no node 99");
  refuse(with("1,2,3,10", "1,2,3"), "f:14: an element has 3 nodes, not 4");
  refuse(with("id=\"2\"> 1e-2", "id=\"1\"> 1e-2"), "f:7: node 1 is given twice");
  refuse(with(" 1e-2", "nan"), "f:7: 'nan' is no coordinate");
  refuse(with("0.0,0.0,0.0", "0.0,0.0"), "f:6: node 1 has 2 coordinates");
  refuse(with("</Nodes>", "<Nodes>"), "the XML is not well formed");
  refuse(with("4.0", "1.2"), "f:3: febio_spec has no version of at least 2.0");
  refuse(with("tet4", "hex8"), "are no tetrahedra");
  refuse(febio("4.0", "Mesh from=\"part.feb\"", "", ""), "not well formed");
  refuse(febio("4.0", "Mesh", "<NodeSet name=\"fixed\">1:2000000000</NodeSet>", ""),
         "has more members than there are nodes");
  refuse(febio("2.5", "Mesh", "", "<Boundary><fix bc=\"x,y,z\" node_set=\"low\"/></Boundary>"),
         "there is no node set 'low'");
}

const char* const kScene =
    "<?xml version=\"1.0\"?>\n<Node name=\"root\" dt=\"0.01\">\n<Node name=\"liver\">\n"
    "<TetrahedronSetTopologyContainer name=\"mesh\" position=\"0 0 0  1 0 0  0 1 0  0 0 1  1 1 1\" "
    "tetrahedra=\"0 1 2 3  1 4 2 3\"/>\n<MechanicalObject scale=\"1\" translation=\"0 0 0\"/>\n"
    "<FixedConstraint indices=\"0 1 2\"/>\n</Node>\n</Node>\n";

std::string scene_with(const std::string& what, const std::string& by) {
  std::string scene = kScene;
  scene.replace(scene.find(what), what.size(), by);
  return scene;
}

TEST(Sofa, MeshAndSupport) {
  const MeshFile file = parse_mesh(kScene, "f", false);
  EXPECT_EQ(file.format, "SOFA");
  EXPECT_EQ(file.mesh.tets.size(), 2U);
  EXPECT_EQ(file.mesh.nodes[4], Vec3(1, 1, 1));
  EXPECT_EQ(fixed_of(kScene), "11100");
  // Positions in the state, what is held by a box whose corners stand in any order.
  EXPECT_EQ(
      fixed_of("<Node><BoxROI name=\"floor\" box=\"-1 -1 0.1 2 2 -1\"/><MechanicalObject "
               "position=\"0 0 0 1 0 0 0 1 0 0 0 1\"/><MeshTopology position=\"@state.position\" "
               "tetras=\"0 1 2 3\"/><FixedProjectiveConstraint indices=\"@floor.indices\"/>"
               "</Node>"),
      "1110");
}

TEST(Sofa, ChildNodesAreRegions) {
  const MeshFile file = parse_mesh(
      scene_with("</Node>\n</Node>",
                 "<Node name=\"region_3\"><TetrahedronSetTopologyContainer "
                 "position=\"@../mesh.position\" tetrahedra=\"3 4 2 1\"/></Node></Node></Node>"),
      "f", false);
  EXPECT_EQ(file.mesh.region, (std::vector<int>{0, 3}));
}

TEST(Sofa, RefusesWithTheLine) {
  refuse(scene_with("1 4 2 3", "1 4 2 9"), "f:4: there is no node 9");
  refuse(scene_with("1 4 2 3", "1 4 2"), "f:4: 7 nodes are no tetrahedra");
  refuse(scene_with("1 1 1\"", "1 1\""), "f:4: 14 coordinates are no points");
  refuse(scene_with("\"0 0 0\"/", "\"0 0 1\"/"), "f:5: the scene moves its mesh by 'translation'");
  refuse(scene_with("indices=\"0", "indices=\"7"), "f:6: there is no node 7");
  refuse(scene_with("\"0 1 2\"", "\"@roi.indices\""), "f:6: what is fixed, '@roi.indices'");
  refuse(scene_with("0 1 2 3  1 4 2 3", "@loader.tetrahedra"), "there is no tetrahedron");
  refuse(
      "<Node><MeshGmshLoader name=\"loader\" filename=\"liver.msh\"/><MeshTopology "
      "src=\"@loader\"/></Node>",
      "f:1: the scene loads its mesh from liver.msh; give that file");
}

}  // namespace
}  // namespace hapsim
