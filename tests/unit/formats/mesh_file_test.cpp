// Meshes in the formats of other programs: round trips, repairs, damage, and the programs
// themselves.
#include "formats/mesh_file.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <zlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "base/random.h"
#include "containers/vtu.h"
#include "formats/format_table.h"
#include "formats/tetmesh_io.h"
#include "support/needs.h"
#include "support/shapes.h"
#include "tetmesh/body_mesh.h"

namespace hapsim {
namespace {

TetMesh two_regions(int order) {
  BodyOptions options;
  options.edge = 0.02;
  options.order = order;
  TetMesh mesh = make_body_mesh(test::box({0.06, 0.05, 0.04}), options);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (mesh.nodes[mesh.tets[t][0]].x() > 0.03) mesh.region[t] = 7;
  return mesh;
}

using Writer = std::function<void(std::ostream&, const TetMesh&)>;
const std::vector<std::pair<std::string, Writer>> kFormats{
    {"ply", [](std::ostream& out, const TetMesh& m) { write_body_ply(out, m); }},
    {"ply", [](std::ostream& out, const TetMesh& m) { write_body_ply(out, m, true); }},
    {"vtu", [](std::ostream& out, const TetMesh& m) { write_mesh_vtu(out, m); }},
    {"vtu", [](std::ostream& out, const TetMesh& m) { write_mesh_vtu(out, m, true); }},
    {"msh", [](std::ostream& out, const TetMesh& m) { write_mesh_gmsh(out, m, 22); }},
    {"msh", [](std::ostream& out, const TetMesh& m) { write_mesh_gmsh(out, m, 41); }}};

std::string written(const Writer& writer, const TetMesh& mesh) {
  std::ostringstream out;
  writer(out, mesh);
  return out.str();
}

void expect_same(const TetMesh& a, const TetMesh& b, const std::string& what) {
  EXPECT_EQ(a.order, b.order) << what;
  EXPECT_EQ(a.nodes, b.nodes) << what;
  EXPECT_EQ(a.fixed, b.fixed) << what;
  // Formats may sort tetrahedra by region.
  const auto sorted = [](const TetMesh& m) {
    std::vector<std::pair<std::array<int, 10>, int>> all;
    for (std::size_t t = 0; t < m.tets.size(); ++t) all.emplace_back(m.tets[t], m.region[t]);
    std::sort(all.begin(), all.end());
    return all;
  };
  EXPECT_EQ(sorted(a), sorted(b)) << what;
}

TEST(MeshFile, RoundTripsInEveryFormatAndOrder) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = two_regions(order);
    for (const auto& [name, writer] : kFormats) {
      const std::string bytes = written(writer, mesh);
      EXPECT_EQ(recognise(bytes).content, Content::kTetrahedra) << name;
      const MeshFile file = parse_mesh(bytes, "m." + name, true);
      expect_same(file.mesh, mesh, name + " of order " + std::to_string(order));
      EXPECT_TRUE(file.has_fixed) << name;
      EXPECT_EQ(file.repairs.turned + file.repairs.unused_nodes + file.repairs.doubled, 0u);
      expect_same(parse_mesh(bytes, "m." + name, false).mesh, mesh, name);
    }
  }
}

TEST(MeshFile, TetGenFilesStandBesideEachOther) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("hapsim-tetgen-" + std::to_string(::getpid()));
  std::filesystem::create_directory(folder);
  for (const int order : {1, 2}) {
    const TetMesh mesh = two_regions(order);
    {
      std::ofstream node(folder / "m.node"), ele(folder / "m.ele");
      write_mesh_tetgen(node, ele, mesh);
    }
    for (const char* name : {"m.node", "m.ele"}) {
      Input input((folder / name).string());
      expect_same(parse_mesh(input.read_all(), input.name(), true).mesh, mesh, name);
    }
  }
  EXPECT_EQ(test::error_of([] { parse_mesh("4 3 0 0\n", "stdin", true); }).first, 3);
  std::filesystem::remove(folder / "m.ele");
  Input input((folder / "m.node").string());
  EXPECT_EQ(test::error_of([&] { parse_mesh(input.read_all(), input.name(), true); }).first, 5);
  std::filesystem::remove_all(folder);
}

// As VTK writes: base64 with its header apart, and blocks compressed by zlib.
std::string base64(const std::string& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned all = 0;
    for (std::size_t k = 0; k < 3; ++k)
      all = all << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : digits[all >> (18 - 6 * k) & 63];
  }
  return text;
}

template <class T>
std::string raw(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::string vtu_array(const std::string& attributes, const std::string& data, bool compressed) {
  std::string inside;
  if (compressed) {
    uLongf size = compressBound(data.size());
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size,
             reinterpret_cast<const Bytef*>(data.data()), data.size());
    packed.resize(size);
    const auto all = static_cast<std::uint32_t>(data.size());
    inside = base64(raw<std::uint32_t>({1, all, all, static_cast<std::uint32_t>(size)})) +
             base64(packed);
  } else {
    inside = base64(raw<std::uint32_t>({static_cast<std::uint32_t>(data.size())})) + base64(data);
  }
  return "<DataArray " + attributes + " format=\"binary\">\n  " + inside + "\n</DataArray>\n";
}

std::string one_tet_vtu(bool compressed) {
  const auto array = [&](const char* attributes, const std::string& data) {
    return vtu_array(attributes, data, compressed);
  };
  return std::string(
             "<?xml version='1.0'?>\n<!-- a > comment -->\n"
             "<VTKFile type=\"UnstructuredGrid\" byte_order='LittleEndian'") +
         (compressed ? " compressor=\"vtkZLibDataCompressor\"" : "") +
         ">\n<UnstructuredGrid><Piece NumberOfPoints=\"5\" NumberOfCells=\"2\">\n<PointData>" +
         array("type=\"Int8\" Name=\"fixed\"", raw<std::int8_t>({0, 1, 1, 1, 0})) +
         "</PointData><CellData>" +
         array("type=\"Int64\" Name=\"region\"", raw<std::int64_t>({9, 4})) +
         "</CellData>\n<Points>" +
         array("type=\"Float32\" Name=\"Points\" NumberOfComponents=\"3\"",
               raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 5, 5, 5})) +
         "</Points><Cells>" +
         array("type=\"Int64\" Name=\"connectivity\"", raw<std::int64_t>({0, 1, 2, 0, 1, 2, 3})) +
         array("type=\"Int64\" Name=\"offsets\"", raw<std::int64_t>({3, 7})) +
         array("type=\"UInt8\" Name=\"types\"", raw<std::uint8_t>({5, 10})) +
         "</Cells></Piece></UnstructuredGrid></VTKFile>\n";
}

TEST(MeshFile, ReadsWhatVtkPacks) {
  for (const bool compressed : {false, true}) {
    const MeshFile file = parse_mesh(one_tet_vtu(compressed), "v.vtu", true);
    ASSERT_EQ(file.mesh.tets.size(), 1u);
    EXPECT_EQ(file.mesh.region[0], 4);  // the triangle before it is left out
    EXPECT_EQ(file.mesh.nodes.size(), 4u);
    EXPECT_EQ(file.repairs.unused_nodes, 1u);
    EXPECT_EQ(file.mesh.fixed, (std::vector<std::uint8_t>{0, 1, 1, 1}));
  }
}

TEST(MeshFile, MendsOrRefusesWithThePlace) {
  const TetMesh good = two_regions(2);
  TetMesh bad = good;
  const auto turn = [](std::array<int, 10>& t) {
    std::swap(t[2], t[3]);
    std::swap(t[5], t[8]);
    std::swap(t[6], t[7]);
  };
  turn(bad.tets[3]);
  bad.tets.push_back(good.tets[0]);
  bad.region.push_back(good.region[0]);
  bad.nodes.emplace_back(9, 9, 9);
  bad.fixed.push_back(0);
  for (const auto& [name, writer] : kFormats) {
    const std::string bytes = written(writer, bad);
    const MeshFile file = parse_mesh(bytes, name, true);
    EXPECT_EQ(file.repairs.turned, 1u) << name;
    EXPECT_EQ(file.repairs.doubled, 1u) << name;
    EXPECT_EQ(file.repairs.unused_nodes, 1u) << name;
    expect_same(file.mesh, good, name);
    const auto [code, what] = test::error_of([&] { parse_mesh(bytes, name, false); });
    EXPECT_EQ(code, 3);
    EXPECT_NE(what.find("is inverted; run hs-tetmesh"), std::string::npos) << what;
  }
  const auto refuse = [&](const TetMesh& mesh, const std::string& part) {
    const std::string bytes = written(kFormats[3].second, mesh);
    const auto [code, what] = test::error_of([&] { parse_mesh(bytes, "m.vtu", true); });
    EXPECT_EQ(code, 3) << part;
    EXPECT_NE(what.find(part), std::string::npos) << what;
  };
  bad = good;
  std::swap(bad.tets[0][4], bad.tets[0][9]);  // another order of the middles
  refuse(bad, "is not near the middle of the edge");
  bad = good;
  bad.nodes[static_cast<std::size_t>(bad.tets[5][0])] =
      bad.nodes[static_cast<std::size_t>(bad.tets[5][1])];
  refuse(bad, "is flat");
  bad = two_regions(1);
  bad.tets.push_back(bad.tets[0]);
  bad.region.push_back(0);
  bad.nodes.push_back(2 * bad.nodes[static_cast<std::size_t>(bad.tets[0][3])] -
                      bad.nodes[static_cast<std::size_t>(bad.tets[0][0])] + Vec3(0.1, 0.2, 0.3));
  bad.fixed.push_back(0);
  bad.tets.back()[0] = static_cast<int>(bad.nodes.size()) - 1;
  bad.tets.push_back(bad.tets.back());
  bad.region.push_back(0);
  bad.nodes.emplace_back(-1, -2, -3);
  bad.fixed.push_back(0);
  bad.tets.back()[0] = static_cast<int>(bad.nodes.size()) - 1;
  refuse(bad, "tetrahedra");
}

TEST(MeshFile, SaysTheLineOfWhatIsWrong) {
  const auto refuse = [](const std::string& bytes, const std::string& part) {
    const auto [code, what] = test::error_of([&] { parse_mesh(bytes, "f", true); });
    EXPECT_EQ(code, 3) << part;
    EXPECT_NE(what.find(part), std::string::npos) << what;
  };
  const std::string head = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
  refuse(head + "$Nodes\n2000000000\n", "f:5: the file claims 2000000000");
  refuse(head + "$Nodes\n1\n1 0 0 nan\n$EndNodes\n", "f:6: 'nan' stands where a coordinate should");
  refuse(head + "$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 4 0 1 1 1 2\n$EndElements\n",
         "f:10: there is no node 2");
  refuse("$MeshFormat\n2.2 1 8\n", "is binary; write it as text");
  refuse("$MeshFormat\n3 0 8\n$EndMeshFormat\n", "2.2 and 4.1 are read");
  refuse(head + "$Elements\n1\n1 5 0 1 1 1 1 1 1 1 1\n$EndElements\n", "only tetrahedra are read");
  refuse("<VTKFile type=\"PolyData\">", "no VTK unstructured grid but 'PolyData'");
  refuse("hello", "not a PLY, VTU, VTK, Gmsh, TetGen, Abaqus, FEBio or SOFA mesh");
  std::string vtu = one_tet_vtu(true);
  vtu.replace(vtu.find("vtkZLib"), 7, "vtkLZMA");
  refuse(vtu, "zlib and plain are read");
}

TEST(MeshFile, SurvivesDamage) {
  std::vector<std::string> good{one_tet_vtu(false), one_tet_vtu(true)};
  TetMesh mesh = two_regions(1);
  for (const auto& [name, writer] : kFormats) good.push_back(written(writer, mesh));
  Random random(11);
  for (const std::string& bytes : good) {
    const std::size_t step = std::max<std::size_t>(1, bytes.size() / 300);
    for (int trial = 0; trial < 600; ++trial) {
      std::string bad = bytes;
      if (trial < 300) {
        bad.resize(static_cast<std::size_t>(trial) * step);
      } else {
        for (std::uint64_t k = 0; k <= random.integer(4); ++k)
          bad[random.integer(bad.size())] = static_cast<char>(random.integer(256));
        if (random.coin()) bad.erase(random.integer(bad.size()), 1 + random.integer(8));
        if (random.coin()) bad.insert(random.integer(bad.size()), "9");
      }
      try {
        parse_mesh(bad, "bad", trial % 2 == 0);
      } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      }
    }
  }
}

// The output of a command, and whether it ended well.
std::pair<bool, std::string> shell(const std::string& command) {
  std::string text;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  if (pipe == nullptr) return {false, ""};
  for (char block[4096]; std::size_t n = fread(block, 1, sizeof block, pipe);)
    text.append(block, n);
  const int status = pclose(pipe);
  return {WIFEXITED(status) && WEXITSTATUS(status) == 0, text};
}

class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              ("hapsim-peer-" + std::to_string(::getpid()))) {
    std::filesystem::create_directory(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  std::string operator/(const char* name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

TetMesh read(const std::string& path) {
  Input input(path);
  return parse_mesh(input.read_all(), path, true).mesh;
}

TEST(Peer, GmshReadsAndWritesTheSameMesh) {
  HAPSIM_NEEDS_PROGRAM("gmsh");
  const Folder folder;
  for (const int order : {1, 2}) {
    const TetMesh mesh = two_regions(order);
    for (const int version : {22, 41}) {
      {
        std::ofstream out(folder / "a.msh");
        write_mesh_gmsh(out, mesh, version);
      }
      for (const char* format : {"msh22", "msh41"}) {
        const auto [fine, text] = shell("gmsh " + (folder / "a.msh") + " -save -format " + format +
                                        " -o " + (folder / "b.msh"));
        ASSERT_TRUE(fine) << text;
        EXPECT_EQ(text.find("Error"), std::string::npos) << text;
        const TetMesh back = read(folder / "b.msh");
        EXPECT_EQ(back.order, order);
        EXPECT_EQ(back.tets.size(), mesh.tets.size());
        EXPECT_EQ(back.nodes.size(), mesh.nodes.size());
        EXPECT_NEAR(volume(back), volume(mesh), 1e-15);
        EXPECT_EQ(std::count(back.region.begin(), back.region.end(), 7),
                  std::count(mesh.region.begin(), mesh.region.end(), 7));
        EXPECT_EQ(std::count(back.fixed.begin(), back.fixed.end(), 1),
                  std::count(mesh.fixed.begin(), mesh.fixed.end(), 1));
      }
    }
  }
}

TEST(Peer, TetgenMeshesOfBothOrdersAreRead) {
  HAPSIM_NEEDS_PROGRAM("tetgen");
  const Folder folder;
  {
    std::ofstream out(folder / "c.node");
    out << "8 3 0 0\n";
    for (int i = 0; i < 8; ++i)
      out << i + 1 << ' ' << (i & 1) << ' ' << (i >> 1 & 1) << ' ' << (i >> 2) << '\n';
  }
  for (const char* order : {"", "o2"}) {
    const auto [fine, text] = shell("cd " + (folder / ".") + " && tetgen -Q" + order + " c.node");
    ASSERT_TRUE(fine) << text;
    const TetMesh mesh = read(folder / "c.1.ele");
    EXPECT_EQ(mesh.order, *order == '\0' ? 1 : 2);
    EXPECT_NEAR(volume(mesh), 1, 1e-12);
  }
}

// A block under its own weight along z, held at the bottom: what CalculiX's fixed nodes carry is
// the weight but for the share that acts on them directly, so nodes, elements of both regions,
// their turn, their volumes and the fixed set came across.
double carried_volume(const TetMesh& mesh) {
  double sum = volume(mesh);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (int k = 0; k < (mesh.order == 1 ? 4 : 10); ++k)
      if (mesh.fixed[static_cast<std::size_t>(mesh.tets[t][k])])
        sum -= tet_volume(mesh, t) * (mesh.order == 1 ? 0.25 : k < 4 ? -0.05 : 0.2);
  return sum;
}

TEST(Peer, CalculixTakesTheDeck) {
  HAPSIM_NEEDS_PROGRAM("ccx");
  const Folder folder;
  for (const int order : {1, 2}) {
    const TetMesh mesh = two_regions(order);
    {
      std::ofstream out(folder / "deck.inp");
      write_mesh_abaqus(out, mesh);
      out << "*MATERIAL, NAME=SOFT\n*ELASTIC\n1e5, 0.3\n*DENSITY\n1000\n"
             "*SOLID SECTION, ELSET=REGION_0, MATERIAL=SOFT\n"
             "*SOLID SECTION, ELSET=REGION_7, MATERIAL=SOFT\n*BOUNDARY\nFIXED, 1, 3\n"
             "*STEP\n*STATIC\n*DLOAD\nREGION_0, GRAV, 10, 0, 0, -1\nREGION_7, GRAV, 10, 0, 0, -1\n"
             "*NODE PRINT, NSET=FIXED, TOTALS=ONLY\nRF\n*END STEP\n";
    }
    const auto [fine, text] = shell("cd " + (folder / ".") + " && ccx deck");
    ASSERT_TRUE(fine) << text;
    std::ifstream dat(folder / "deck.dat");
    double force = 0, value;
    for (std::string line; std::getline(dat, line);) {
      std::istringstream words(line);
      double x, y;
      if (words >> x >> y >> value) force = value;
    }
    EXPECT_NEAR(force, 1000 * 10 * carried_volume(mesh), 1e-4) << order;
  }
}

}  // namespace
}  // namespace hapsim
