#include "fuzz/readers.h"

#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "acfm/acfm.h"
#include "base/error.h"
#include "batch/manifest.h"
#include "calibrate/static_poses.h"
#include "containers/ply.h"
#include "containers/stl.h"
#include "containers/vtu.h"
#include "formats/mesh_file.h"
#include "formats/off.h"
#include "formats/pcd.h"
#include "fusion/fuse_recordings.h"
#include "fusion/fusion_file.h"
#include "import/import.h"
#include "io/csv.h"
#include "io/stream.h"
#include "link/ends.h"
#include "link/packets.h"
#include "mesh/surface.h"
#include "model/model.h"
#include "model/search_state.h"
#include "realtime/motion_lines.h"
#include "realtime/motion_records.h"
#include "recording/recording.h"
#include "regions/location_file.h"
#include "rig/calibration.h"
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

void calibration(const std::string& bytes) {
  there_and_back(bytes, read_calibration, write_calibration);
}

void poses(const std::string& bytes) {
  Input input = input_of(bytes);
  read_static_poses(input, nullptr);
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

std::span<const unsigned char> raw(const std::string& bytes) {
  return {reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()};
}

// The text of a packet, as it is after its seal was opened. What is taken for one must be the same
// when it is written.
void packets(const std::string& bytes) {
  Packet packet;
  if (!read_packet(raw(bytes), packet)) fail_input(kName, "no packet", "send packets");
  const PacketBytes back = write_packet(packet);
  if (!std::equal(back.begin(), back.end(), raw(bytes).begin())) std::abort();
}

// A datagram to both ends of a link, as it comes and as one of somebody who has the key: with the
// tag, or the seal, that it should have. No fuzzer finds that.
void datagrams(const std::string& bytes) {
  static const Secret key{1, 2, 3};
  static const Terms terms;
  OperatorEnd near(key, terms);
  TeleoperatorEnd far(key, terms);
  Datagram hello, out, tagged;
  near.tick(1, hello);
  bool taken = far.receive(1, {}, raw(bytes), out).reply;
  near.receive(1, raw(bytes));
  std::string content = bytes;
  content.resize(kHandshakeBytes);
  put_header(reinterpret_cast<unsigned char*>(content.data()), Message::kHello, 0);
  tagged = Datagram(raw(content));
  const Tag tag = tag_of(derive(key, 1), tagged.view().first(kHandshakeBytes - sizeof(Tag)));
  std::copy(tag.begin(), tag.end(), tagged.bytes.begin() + kHandshakeBytes - sizeof(Tag));
  taken = far.receive(10'000'000, {}, tagged.view(), out).reply || taken;
  near.receive(2, out.view());
  // A session, and what the peer seals in it.
  const SessionKeys keys{key, key};
  Session session(keys, Side::kTeleoperator);
  std::string text = bytes;
  text.resize(kPacketBytes);
  put_header(out.bytes.data(), Message::kPacket, 1);
  seal(key, 1, {out.bytes.data(), kHeaderBytes}, raw(text), out.bytes.data() + kHeaderBytes);
  out.size = kSealedBytes;
  Packet packet;
  bool newest = false;
  const Session::Result result = session.read(out.view(), packet, newest);
  if (result != Session::Result::kTaken && result != Session::Result::kMalformed) std::abort();
  if (!taken && result != Session::Result::kTaken) fail_input(kName, "nothing", "send datagrams");
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
                                       {"packets", packets},   {"datagrams", datagrams},
                                       {"poses", poses},       {"calibration", calibration}};
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
