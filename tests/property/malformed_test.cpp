// Truncated and flipped files: the readers throw Error or give a result, and nothing else.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <functional>
#include <sstream>

#include "base/error.h"
#include "base/random.h"
#include "containers/ply.h"
#include "containers/stl.h"
#include "io/csv.h"
#include "recording/recording.h"

namespace hapsim {
namespace {

using Reader = std::function<void(const std::string&)>;

// 2 GB of address space for the tests of readers would not do under a sanitizer.
#if !defined(__SANITIZE_ADDRESS__)
struct MemoryLimit {
  MemoryLimit() {
    getrlimit(RLIMIT_AS, &old);
    rlimit lower = old;
    lower.rlim_cur = 2UL << 30;
    setrlimit(RLIMIT_AS, &lower);
  }
  ~MemoryLimit() { setrlimit(RLIMIT_AS, &old); }
  rlimit old{};
};
#else
struct MemoryLimit {
  ~MemoryLimit() {}
};
#endif

void read_or_refuse(const Reader& read, const std::string& bytes) {
  try {
    read(bytes);
  } catch (const Error& error) {
    EXPECT_NE(error.code(), ExitCode::kDone);
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not an Error: " << error.what();
  }
}

void damage(const Reader& read, const std::string& good) {
  const MemoryLimit limit;
  ASSERT_NO_THROW(read(good));
  for (std::size_t n = 0; n < good.size(); ++n) read_or_refuse(read, good.substr(0, n));
  Random random(11);
  for (int trial = 0; trial < 5000; ++trial) {
    std::string bad = good;
    const std::uint64_t flips = 1 + random.integer(4);
    for (std::uint64_t k = 0; k < flips; ++k)
      bad[random.integer(bad.size())] = static_cast<char>(random.integer(256));
    if (random.coin()) bad.erase(random.integer(bad.size()), 1 + random.integer(8));
    if (random.coin()) bad.insert(random.integer(bad.size()), bad, 0, random.integer(bad.size()));
    read_or_refuse(read, bad);
  }
}

const std::string kRecording =
    "\xef\xbb\xbf# tool_radius: 0.004\n# force_noise: "
    "0.01\npress,t,x,y,z,ux,uy,uz,fx,fy,fz,note\r\n"
    "1,0,0.1,0.2,0.3,0,0,-0.001,0.1,0.2,1.5,\"a, \"\"b\"\"\"\n"
    "1,0.01,0.1,0.2,0.3,0,0,-0.002,0.1,0.2,3.0,c\n# note: end\n";

PlyFile body() {
  PlyFile file;
  PlyElement vertex{"vertex", 4, {}};
  for (const char* name : {"x", "y", "z"})
    vertex.properties.push_back(
        {name, PlyType::kFloat64, false, PlyType::kUint8, {0.5, 1, 0.25, 2}, {}});
  vertex.properties.push_back({"fixed", PlyType::kUint8, false, PlyType::kUint8, {0, 1, 1, 0}, {}});
  PlyElement tetrahedron{"tetrahedron", 2, {}};
  tetrahedron.properties.push_back({"vertex_indices",
                                    PlyType::kInt32,
                                    true,
                                    PlyType::kUint32,
                                    {0, 1, 2, 3, 3, 2, 1, 0},
                                    {0, 4, 8}});
  file.elements = {vertex, tetrahedron};
  return file;
}

TEST(Malformed, Csv) {
  damage(
      [](const std::string& bytes) {
        Input input = Input::from_bytes(bytes, "t.csv");
        const CsvTable table = read_csv(input);
        for (const std::string& name : table.header)
          if (name != "note") table.numbers(name);
      },
      kRecording);
}

TEST(Malformed, SemicolonCsv) {
  damage(
      [](const std::string& bytes) {
        Input input = Input::from_bytes(bytes, "t.csv");
        read_csv(input);
      },
      "a;b;\"c\"\n1,5;-2,5e-3;\"x;\"\"y\"\n,5;3;\"two\nlines\"\n");
}

TEST(Malformed, Recording) {
  damage(
      [](const std::string& bytes) {
        Input input = Input::from_bytes(bytes, "d.csv");
        std::ostringstream out;
        write_recording(out, read_recording(input));
      },
      kRecording);
}

TEST(Malformed, Ply) {
  for (const PlyFormat format :
       {PlyFormat::kAscii, PlyFormat::kBinaryLittle, PlyFormat::kBinaryBig}) {
    PlyFile file = body();
    file.format = format;
    std::ostringstream out;
    write_ply(out, file);
    damage(
        [](const std::string& bytes) {
          std::ostringstream again;
          write_ply(again, parse_ply(bytes, "m.ply"));
        },
        out.str());
  }
}

TEST(Malformed, Stl) {
  const TriangleSoup soup(3, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0.5, 0)});
  std::ostringstream binary;
  write_stl_binary(binary, soup);
  std::string text = "solid a\n";
  for (const auto& corners : soup) {
    text += "facet normal 0 0 1\nouter loop\n";
    for (const Vec3& c : corners)
      text += "vertex " + format_number(c.x()) + " " + format_number(c.y()) + " 0\n";
    text += "endloop\nendfacet\n";
  }
  text += "endsolid a\n";
  for (const std::string& good : {binary.str(), text})
    damage([](const std::string& bytes) { parse_stl(bytes, "s.stl"); }, good);
}

// What is written is read back, whatever printable text the fields hold.
TEST(Malformed, CsvRoundTripsRandomFields) {
  constexpr std::string_view kLetters = "ab \t\n,;\"#:.-0";
  Random random(17);
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<std::vector<std::string>> rows(1 + random.integer(3));
    for (auto& row : rows) {
      row.resize(3);
      for (std::string& field : row)
        for (std::uint64_t n = random.integer(5); n > 0; --n)
          field += kLetters[random.integer(kLetters.size())];
    }
    std::ostringstream out;
    CsvWriter writer(out, {}, {"a", "b", "c"});
    for (const auto& row : rows) writer.row(row);
    Input input = Input::from_bytes(out.str(), "t.csv");
    const CsvTable table = read_csv(input);
    ASSERT_EQ(table.rows(), rows.size()) << out.str();
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(table.columns[c][r], rows[r][c]) << out.str();
  }
}

TEST(Malformed, RandomBytes) {
  const MemoryLimit limit;
  Random random(5);
  for (int trial = 0; trial < 2000; ++trial) {
    std::string bytes = trial % 3 == 0 ? "ply\n" : trial % 3 == 1 ? "solid " : "";
    const std::uint64_t n = random.integer(400);
    for (std::uint64_t k = 0; k < n; ++k) bytes += static_cast<char>(random.integer(256));
    read_or_refuse([](const std::string& b) { parse_ply(b, "m.ply"); }, bytes);
    read_or_refuse([](const std::string& b) { parse_stl(b, "s.stl"); }, bytes);
    read_or_refuse(
        [](const std::string& b) {
          Input input = Input::from_bytes(b, "t.csv");
          read_csv(input);
        },
        bytes);
  }
}

}  // namespace
}  // namespace hapsim
