#include "fuzz/readers.h"

#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "acfm/acfm.h"
#include "base/error.h"
#include "batch/manifest.h"
#include "containers/ply.h"
#include "containers/stl.h"
#include "containers/vtu.h"
#include "formats/mesh_file.h"
#include "formats/off.h"
#include "formats/pcd.h"
#include "fusion/fuse_recordings.h"
#include "import/import.h"
#include "io/csv.h"
#include "io/stream.h"
#include "link/packets.h"
#include "mesh/surface.h"
#include "model/model.h"
#include "model/search_state.h"
#include "realtime/motion_lines.h"
#include "realtime/motion_records.h"
#include "recording/recording.h"
#include "regions/location_file.h"
#include "robot/robot.h"
#include "scan/scan_file.h"
#include "scan/sections.h"
#include "volume/volume.h"

namespace hapsim::fuzz {
namespace {

constexpr const char* kName = "input";

Input input_of(const std::string& bytes) {
  return Input::from_bytes(bytes, kName);
}

void csv(const std::string& bytes) {
  Input input = input_of(bytes);
  const CsvTable table = read_csv(input);
  if (!table.header.empty()) table.numbers(table.header[0]);
}

// Tables of other machines and robots, and what becomes of them.
void import(const std::string& bytes) {
  Input input = input_of(bytes);
  ImportOptions options;
  options.at = Vec3(0, 0, 0);
  import_recording(read_raw_table(input), options);
}

void locations(const std::string& bytes) {
  Input input = input_of(bytes);
  read_locations(input);
}

// What was read is written, and that must be read again.
template <typename Read, typename Write>
void there_and_back(const std::string& bytes, const Read& read, const Write& write) {
  Input input = input_of(bytes);
  std::ostringstream out;
  write(out, read(input));
  Input again = input_of(out.str());
  read(again);
}

void recording(const std::string& bytes) {
  there_and_back(
      bytes, [](Input& input) { return read_recording(input, false); }, write_recording);
}

void model(const std::string& bytes) {
  const auto read = [](Input& input) {
    Model model = read_model(input);
    unfinished_search(model, input.name());
    return model;
  };
  there_and_back(bytes, read, write_model);
}

void manifest(const std::string& bytes) {
  Input input = input_of(bytes);
  read_manifest(input);
}

void ply(const std::string& bytes) {
  std::ostringstream out;
  write_ply(out, parse_ply(bytes, kName));
}

void stl(const std::string& bytes) {
  parse_stl(bytes, kName);
}

void off(const std::string& bytes) {
  parse_off(bytes, kName);
}

// Every mesh format by content; mended where that is possible.
void mesh(const std::string& bytes) {
  std::ostringstream out;
  write_mesh_gmsh(out, parse_mesh(bytes, kName, true).mesh);
}

void vtu(const std::string& bytes) {
  parse_vtu(bytes, kName);
}

void pcd(const std::string& bytes) {
  std::size_t lost = 0;
  read_pcd(bytes, kName, lost);
}

void urdf(const std::string& bytes) {
  const Robot robot(bytes, kName, "", "");
  robot.forward(robot.middle());
}

void scan(const std::string& bytes) {
  Input input = input_of(bytes);
  read_scan(input, {});
}

void volume(const std::string& bytes) {
  if (looks_like_volume(bytes)) read_volume(bytes, kName);
}

void follow(MotionSource& source) {
  MotionLine line;
  while (source.next(line)) {
  }
}

void acfm(const std::string& bytes) {
  there_and_back(bytes, read_acfm, write_acfm);
}

void fusion(const std::string& bytes) {
  there_and_back(bytes, read_fusion, write_fusion);
}

void motion(const std::string& bytes) {
  Input input = input_of(bytes);
  MotionLines lines(input);
  follow(lines);
}

// Contours in parallel sections.
void sections(const std::string& bytes) {
  Input input = input_of(bytes);
  sections_scan(read_sections(read_csv(input), 1, 0.01));
}

// A datagram, also with the sum that it should end with: no fuzzer finds that. What is taken for a
// packet must be the same when it is written.
void packets(const std::string& bytes) {
  PacketBytes summed{};
  std::uint64_t sum = 14695981039346656037ULL;
  for (std::size_t i = 0; i + 8 < kPacketBytes; ++i) {
    summed[i] = i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0;
    sum = (sum ^ summed[i]) * 1099511628211ULL;
  }
  for (std::size_t i = 0; i < 8; ++i)
    summed[kPacketBytes - 8 + i] = static_cast<unsigned char>(sum >> (8 * i));
  const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
  Packet packet;
  read_packet({data, bytes.size()}, packet);
  if (read_packet(summed, packet) != PacketFault::kNone)
    fail_input(kName, "no packet", "send packets");
  if (write_packet(packet) != summed) std::abort();
}

void records(const std::string& bytes) {
  for (const auto kind : {MotionRecords::Kind::kTip, MotionRecords::Kind::kPress}) {
    Input input = input_of(bytes);
    MotionRecords source(input, kind);
    follow(source);
  }
}

}  // namespace

// What users write by hand or get from other programs comes first.
const std::vector<Reader>& readers() {
  static const std::vector<Reader> all{{"csv", csv},           {"recording", recording},
                                       {"import", import},     {"scan", scan},
                                       {"mesh", mesh},         {"ply", ply},
                                       {"stl", stl},           {"model", model},
                                       {"manifest", manifest}, {"locations", locations},
                                       {"vtu", vtu},           {"pcd", pcd},
                                       {"records", records},   {"motion", motion},
                                       {"urdf", urdf},         {"off", off},
                                       {"volume", volume},     {"acfm", acfm},
                                       {"fusion", fusion},     {"sections", sections},
                                       {"packets", packets}};
  return all;
}

const Reader* find_reader(const std::string& name) {
  for (const Reader& reader : readers())
    if (name == reader.name) return &reader;
  return nullptr;
}

bool read_or_refuse(const Reader& reader, const std::string& bytes) {
  try {
    reader.read(bytes);
    return true;
  } catch (const Error& error) {
    if (std::string(error.what()).find('\n') == std::string::npos) return false;
    std::fprintf(stderr, "%s: more than one line: %s\n", reader.name, error.what());
    std::abort();
  }
}

}  // namespace hapsim::fuzz
