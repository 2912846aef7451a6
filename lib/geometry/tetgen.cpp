#include "geometry/tetgen.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>

#ifndef TETLIBRARY
#define TETLIBRARY
#endif
#include <tetgen.h>

#include "base/error.h"

namespace hapsim {
namespace {

constexpr const char* kMend = "mend the surface: hs-reconstruct makes a closed clean one";

// What the child sends first; the arrays follow.
struct Head {
  std::int64_t nodes = 0, tets = 0, faces = 0;
};

std::string switches(const TetgenInput& input, const TetgenOptions& options) {
  std::string text = "pQz";
  if (options.preserve_surface) text += "Y";
  if (options.radius_edge > 0)
    text += fmt::format("q{:.6f}/{:.6f}", std::max(options.radius_edge, 1.1),
                        std::clamp(options.min_dihedral, 0.0, 18.0));
  if (options.max_volume > 0) text += fmt::format("a{:.12f}", options.max_volume);
  if (!input.node_size.empty()) text += "m";
  return text;
}

// TetGen's arrays are new[]ed and owned by it.
void fill_points(tetgenio& io, const std::vector<Vec3>& points) {
  io.numberofpoints = static_cast<int>(points.size());
  io.pointlist = new REAL[3 * points.size()];
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int k = 0; k < 3; ++k) io.pointlist[3 * i + static_cast<std::size_t>(k)] = points[i][k];
}

void fill_surface(tetgenio& io, const TetgenInput& input) {
  // Seeds as points without a facet: TetGen's own way, switch i, crashes below flat surfaces.
  std::vector<Vec3> points = input.surface.vertices;
  points.insert(points.end(), input.seeds.begin(), input.seeds.end());
  fill_points(io, points);
  const std::size_t n = input.surface.faces.size();
  io.numberoffacets = static_cast<int>(n);
  io.facetlist = new tetgenio::facet[n];
  io.facetmarkerlist = new int[n];
  for (std::size_t i = 0; i < n; ++i) {
    tetgenio::facet& facet = io.facetlist[i];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(facet.polygonlist);
    facet.polygonlist->numberofvertices = 3;
    facet.polygonlist->vertexlist = new int[3];
    std::copy_n(input.surface.faces[i].begin(), 3, facet.polygonlist->vertexlist);
    io.facetmarkerlist[i] = input.face_marker.empty() ? 1 : input.face_marker[i];
  }
  if (input.node_size.empty()) return;
  io.numberofpointmtrs = 1;
  io.pointmtrlist = new REAL[points.size()];
  std::copy(input.node_size.begin(), input.node_size.end(), io.pointmtrlist);
  std::fill(io.pointmtrlist + input.node_size.size(), io.pointmtrlist + points.size(), 0.0);
}

bool write_all(int file, const void* data, std::size_t count) {
  const char* p = static_cast<const char*>(data);
  while (count > 0) {
    const ssize_t n = write(file, p, count);
    if (n <= 0) return false;
    p += n;
    count -= static_cast<std::size_t>(n);
  }
  return true;
}

// All that happens in the child. Never returns, so nothing of the parent is destroyed twice.
[[noreturn]] void run_child(const TetgenInput& input, const TetgenOptions& options, int pipe_end) {
  // The parent's handlers are not for us; a crash is expected and leaves no core.
  for (const int number : {SIGSEGV, SIGABRT, SIGFPE, SIGBUS, SIGILL, SIGPIPE, SIGTERM, SIGINT})
    signal(number, SIG_DFL);
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  // Ends the child also when the parent was killed in the meantime.
  const auto seconds = static_cast<rlim_t>(std::ceil(options.time_limit)) + 1;
  const rlimit cpu{seconds, seconds};
  setrlimit(RLIMIT_CPU, &cpu);
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  try {
    tetgenio in, out;
    fill_surface(in, input);
    std::string text = switches(input, options);
    tetrahedralize(text.data(), &in, &out);
    const Head head{out.numberofpoints, out.numberoftetrahedra, out.numberoftrifaces};
    const auto bytes = [](std::int64_t count, std::size_t size) {
      return static_cast<std::size_t>(count) * size;
    };
    const bool sent = out.numberofcorners == 4 && write_all(pipe_end, &head, sizeof head) &&
                      write_all(pipe_end, out.pointlist, bytes(head.nodes, 3 * sizeof(REAL))) &&
                      write_all(pipe_end, out.tetrahedronlist, bytes(head.tets, 4 * sizeof(int))) &&
                      write_all(pipe_end, out.trifacelist, bytes(head.faces, 3 * sizeof(int))) &&
                      write_all(pipe_end, out.trifacemarkerlist, bytes(head.faces, sizeof(int)));
    _exit(sent ? 0 : 1);
  } catch (...) {
    _exit(2);
  }
}

struct ChildEnd {
  std::string bytes;
  bool timed_out = false;
  int status = 0;
};

ChildEnd run_forked(const TetgenInput& input, const TetgenOptions& options) {
  // One fork at a time: no child may inherit the writing end of another one's pipe, or its end
  // would go unseen.
  static std::mutex mutex;
  int ends[2];
  pid_t child;
  {
    const std::lock_guard lock(mutex);
    if (pipe2(ends, O_CLOEXEC) != 0)
      throw Error(ExitCode::kIo, "TetGen", std::string("no pipe: ") + std::strerror(errno),
                  "close other programs");
    child = fork();
    if (child == 0) run_child(input, options, ends[1]);
    close(ends[1]);
  }
  if (child < 0) {
    close(ends[0]);
    throw Error(ExitCode::kIo, "TetGen", std::string("no process: ") + std::strerror(errno),
                "close other programs");
  }
  ChildEnd end;
  using Clock = std::chrono::steady_clock;
  const auto deadline = Clock::now() + std::chrono::duration<double>(options.time_limit);
  std::array<char, 1 << 16> buffer;
  while (true) {
    const auto left = std::chrono::duration<double, std::milli>(deadline - Clock::now()).count();
    if (left <= 0) {
      end.timed_out = true;
      break;
    }
    pollfd watched{ends[0], POLLIN, 0};
    if (poll(&watched, 1, static_cast<int>(std::min(left, 1e6)) + 1) <= 0) continue;
    const ssize_t n = read(ends[0], buffer.data(), buffer.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    end.bytes.append(buffer.data(), static_cast<std::size_t>(n));
  }
  close(ends[0]);
  if (end.timed_out) kill(child, SIGKILL);
  while (waitpid(child, &end.status, 0) < 0 && errno == EINTR) {
  }
  return end;
}

// Empty when the child's answer is whole.
std::string failure_of(const ChildEnd& end, const TetgenOptions& options, Head& head) {
  if (end.timed_out) return fmt::format("TetGen did not finish in {:g} s", options.time_limit);
  if (WIFSIGNALED(end.status))
    return fmt::format("TetGen crashed (signal {})", WTERMSIG(end.status));
  if (!WIFEXITED(end.status) || WEXITSTATUS(end.status) != 0 || end.bytes.size() < sizeof head)
    return "TetGen gave up";
  std::memcpy(&head, end.bytes.data(), sizeof head);
  if (head.tets <= 0) return "TetGen found no inside";
  const auto expected = sizeof head + static_cast<std::size_t>(head.nodes) * 3 * sizeof(double) +
                        static_cast<std::size_t>(head.tets) * 4 * sizeof(int) +
                        static_cast<std::size_t>(head.faces) * 4 * sizeof(int);
  return end.bytes.size() == expected ? "" : "TetGen's answer is cut off";
}

void orient(TetMesh& mesh) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    if (tet_volume(mesh, t) < 0) std::swap(mesh.tets[t][2], mesh.tets[t][3]);
}

Triangle sorted(Triangle f) {
  std::sort(f.begin(), f.end());
  return f;
}

TetgenResult unpack(const std::string& bytes, const Head& head) {
  TetgenResult result;
  TetMesh& mesh = result.mesh;
  const char* p = bytes.data() + sizeof head;
  mesh.nodes.resize(static_cast<std::size_t>(head.nodes));
  for (Vec3& node : mesh.nodes) {
    std::memcpy(node.data(), p, 3 * sizeof(double));
    p += 3 * sizeof(double);
  }
  mesh.tets.resize(static_cast<std::size_t>(head.tets));
  for (auto& t : mesh.tets) {
    t.fill(-1);
    std::memcpy(t.data(), p, 4 * sizeof(int));
    p += 4 * sizeof(int);
  }
  orient(mesh);
  mesh.region.assign(mesh.tets.size(), 0);
  mesh.fixed.assign(mesh.nodes.size(), 0);
  mesh.faces = boundary_faces(mesh);

  std::map<Triangle, int> marker;
  const char* markers = p + static_cast<std::size_t>(head.faces) * sizeof(Triangle);
  for (std::int64_t f = 0; f < head.faces; ++f) {
    Triangle face;
    int value;
    std::memcpy(face.data(), p + static_cast<std::size_t>(f) * sizeof face, sizeof face);
    std::memcpy(&value, markers + static_cast<std::size_t>(f) * sizeof value, sizeof value);
    marker[sorted(face)] = value;
  }
  for (const Triangle& face : mesh.faces) {
    const auto found = marker.find(sorted(face));
    result.face_marker.push_back(found == marker.end() ? 0 : found->second);
  }
  return result;
}

}  // namespace

TetgenResult run_tetgen(const TetgenInput& input, const TetgenOptions& options,
                        const std::string& where) {
  check_surface(input.surface, where);
  const ChildEnd end = run_forked(input, options);
  Head head;
  std::string failure = failure_of(end, options, head);
  TetgenResult result;
  if (failure.empty()) {
    result = unpack(end.bytes, head);
    const double inside = signed_volume(input.surface);
    if (!(std::abs(volume(result.mesh) - inside) < 1e-6 * inside))
      failure = fmt::format("TetGen filled {:.6g} of {:.6g} m^3", volume(result.mesh), inside);
    for (std::size_t t = 0; t < result.mesh.tets.size() && failure.empty(); ++t)
      if (!(tet_volume(result.mesh, t) > 0)) failure = "TetGen left a flat tetrahedron";
  }
  if (!failure.empty()) {
    check_self_intersection(input.surface, where);  // a better message when that is the cause
    fail_input(where, failure, kMend);
  }
  return result;
}

}  // namespace hapsim
