#include "tetmesh/tetgen_child.h"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <utility>

#ifndef TETLIBRARY
#define TETLIBRARY
#endif
#include <tetgen.h>

#include "base/byte_stream.h"
#include "base/error.h"
#include "tetmesh/process_spawner.h"

namespace hapsim {
namespace {

// What the worker answers first; the arrays follow.
struct Head {
  std::int64_t nodes = 0, tets = 0, faces = 0;
};

// Exit status of a child that TetGen left by throwing its number n: kThrew + n.
constexpr int kThrew = 10;
// A worker whose time is that of the processor waits for a processor up to so many times that
// limit.
constexpr double kMostWaiting = 60;
constexpr auto kBeat = std::chrono::milliseconds(200);
constexpr int kMostWorkers = 5;  // where a worker waits for ever, or there is none

std::string switches(const TetgenInput& input, const TetgenOptions& options) {
  std::string text = "pQz";
  if (options.preserve_surface) text += "Y";
  if (options.radius_edge > 0)
    text += fmt::format("q{:.6f}/{:.6f}", std::max(options.radius_edge, 1.1),
                        std::clamp(options.min_dihedral, 0.0, 18.0));
  if (options.max_volume > 0) text += fmt::format("a{:.18f}", options.max_volume);
  if (!input.node_size.empty()) text += "m";
  return text;
}

// TetGen's arrays are new[]ed and owned by it. Sizes belong to the outer surface's vertices.
void fill_points(tetgenio& io, const TetgenInput& input) {
  std::size_t count = input.surface.vertices.size() + input.seeds.size();
  for (const Surface& inner : input.inner) count += inner.vertices.size();
  io.numberofpoints = static_cast<int>(count);
  io.pointlist = new REAL[3 * count];
  REAL* to = io.pointlist;
  const auto add = [&to](const std::vector<Vec3>& points) {
    for (const Vec3& p : points) to = std::copy_n(p.data(), 3, to);
  };
  add(input.surface.vertices);
  for (const Surface& inner : input.inner) add(inner.vertices);
  // Seeds as points without a facet: TetGen's own way, switch i, crashes below flat surfaces.
  add(input.seeds);
  if (input.node_size.empty()) return;
  io.numberofpointmtrs = 1;
  io.pointmtrlist = new REAL[count];
  std::fill_n(io.pointmtrlist, count, 0.0);
  std::copy(input.node_size.begin(), input.node_size.end(), io.pointmtrlist);
}

void fill_facets(tetgenio& io, const TetgenInput& input) {
  std::size_t count = input.surface.faces.size();
  for (const Surface& inner : input.inner) count += inner.faces.size();
  io.numberoffacets = static_cast<int>(count);
  io.facetlist = new tetgenio::facet[count];
  io.facetmarkerlist = new int[count];
  std::size_t at = 0;
  const auto add = [&](const Triangle& face, int first, int marker) {
    tetgenio::facet& facet = io.facetlist[at];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(facet.polygonlist);
    facet.polygonlist->numberofvertices = 3;
    facet.polygonlist->vertexlist = new int[3];
    for (int k = 0; k < 3; ++k) facet.polygonlist->vertexlist[k] = first + face[k];
    io.facetmarkerlist[at++] = marker;
  };
  for (std::size_t f = 0; f < input.surface.faces.size(); ++f)
    add(input.surface.faces[f], 0, input.face_marker.empty() ? 1 : input.face_marker[f]);
  auto first = static_cast<int>(input.surface.vertices.size());
  for (const Surface& inner : input.inner) {
    for (const Triangle& face : inner.faces) add(face, first, -1);
    first += static_cast<int>(inner.vertices.size());
  }
}

// What the worker is asked for.
struct Task {
  TetgenInput input;
  std::string switches;
  double time_limit = 0;
  bool processor_time = false;
};

bool put_surface(const ByteStream& stream, const Surface& surface) {
  return stream.put_all(surface.vertices) && stream.put_all(surface.faces);
}

bool get_surface(const ByteStream& stream, Surface& surface) {
  return stream.get_all(surface.vertices) && stream.get_all(surface.faces);
}

bool put_task(const ByteStream& stream, const TetgenInput& input, const TetgenOptions& options) {
  const std::uint64_t inner = input.inner.size();
  bool good = stream.put_all(switches(input, options)) &&
              stream.put(&options.time_limit, sizeof options.time_limit) &&
              stream.put(&options.processor_time, sizeof options.processor_time) &&
              stream.put_all(input.face_marker) && stream.put_all(input.seeds) &&
              stream.put_all(input.node_size) && put_surface(stream, input.surface) &&
              stream.put(&inner, sizeof inner);
  for (const Surface& surface : input.inner) good = good && put_surface(stream, surface);
  return good;
}

bool get_task(const ByteStream& stream, Task& task) {
  std::uint64_t inner = 0;
  TetgenInput& input = task.input;
  bool good = stream.get_all(task.switches) &&
              stream.get(&task.time_limit, sizeof task.time_limit) &&
              stream.get(&task.processor_time, sizeof task.processor_time) &&
              stream.get_all(input.face_marker) && stream.get_all(input.seeds) &&
              stream.get_all(input.node_size) && get_surface(stream, input.surface) &&
              stream.get(&inner, sizeof inner);
  input.inner.resize(good ? inner : 0);
  for (Surface& surface : input.inner) good = good && get_surface(stream, surface);
  return good;
}

bool put_mesh(const ByteStream& stream, const tetgenio& out) {
  const Head head{out.numberofpoints, out.numberoftetrahedra, out.numberoftrifaces};
  const auto bytes = [](std::int64_t count, std::size_t size) {
    return static_cast<std::size_t>(count) * size;
  };
  return out.numberofcorners == 4 && stream.put(&head, sizeof head) &&
         stream.put(out.pointlist, bytes(head.nodes, 3 * sizeof(REAL))) &&
         stream.put(out.tetrahedronlist, bytes(head.tets, 4 * sizeof(int))) &&
         stream.put(out.trifacelist, bytes(head.faces, 3 * sizeof(int))) &&
         stream.put(out.trifacemarkerlist, bytes(head.faces, sizeof(int)));
}

// All that happens in the worker.
[[noreturn]] void work(int socket) {
  const ByteStream stream(socket);
  // A crash is expected and leaves no core.
  const rlimit none{0, 0};
  setrlimit(RLIMIT_CORE, &none);
  try {
    Task task;
    if (!get_task(stream, task)) _exit(2);
    const auto seconds = static_cast<rlim_t>(std::ceil(task.time_limit));
    const rlimit cpu{seconds + (task.processor_time ? 0 : 1), seconds + 1};
    setrlimit(RLIMIT_CPU, &cpu);
    tetgenio out;
    {
      tetgenio in;
      fill_points(in, task.input);
      fill_facets(in, task.input);
      tetrahedralize(task.switches.data(), &in, &out);
    }
    _exit(put_mesh(stream, out) ? 0 : 1);
  } catch (int number) {
    _exit(kThrew + std::clamp(number, 0, 20));
  } catch (const std::bad_alloc&) {
    _exit(kThrew + 1);
  } catch (...) {
    _exit(2);
  }
}

// The reading end, with the deadline and the heartbeat.
class Reader {
 public:
  Reader(int file, pid_t child, const TetgenOptions& options)
      : file_(file),
        child_(child),
        options_(options),
        deadline_(Clock::now() +
                  std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(
                      options.time_limit * (options.processor_time ? kMostWaiting : 1)))) {}
  bool timed_out() const { return timed_out_; }
  bool stalled() const { return stalled_; }

  // False at the end of the stream, at the deadline, and where the child does not run.
  bool read(void* to, std::size_t count) {
    char* p = static_cast<char*>(to);
    while (count > 0) {
      const auto left = deadline_ - Clock::now();
      timed_out_ = left <= Clock::duration::zero();
      if (timed_out_) return false;
      pollfd watched{file_, POLLIN, 0};
      const auto wait = std::chrono::duration_cast<std::chrono::milliseconds>(
          std::min<Clock::duration>(left, kBeat));
      if (poll(&watched, 1, static_cast<int>(wait.count()) + 1) <= 0) {
        if (options_.heartbeat) options_.heartbeat();
        if ((stalled_ = does_not_run())) return false;
        continue;
      }
      const ssize_t n = ::read(file_, p, count);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      p += n;
      count -= static_cast<std::size_t>(n);
    }
    return true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  // Whether it has used no processor time for so long.
  bool does_not_run() {
    clockid_t clock;
    timespec used{};
    if (clock_getcpuclockid(child_, &clock) != 0 || clock_gettime(clock, &used) != 0) return false;
    const auto spent = std::chrono::seconds(used.tv_sec) + std::chrono::nanoseconds(used.tv_nsec);
    if (spent != spent_) {
      spent_ = spent;
      ran_ = Clock::now();
    }
    return Clock::now() - ran_ > std::chrono::duration<double>(options_.stall);
  }

  int file_;
  pid_t child_;
  Clock::time_point ran_ = Clock::now();
  std::chrono::nanoseconds spent_{-1};
  bool stalled_ = false;
  const TetgenOptions& options_;
  Clock::time_point deadline_;
  bool timed_out_ = false;
};

bool receive(Reader& reader, TetgenAnswer& answer) {
  Head head;
  if (!reader.read(&head, sizeof head)) return false;
  answer.nodes.resize(static_cast<std::size_t>(head.nodes));
  if (!reader.read(answer.nodes.data(), answer.nodes.size() * sizeof(Vec3))) return false;
  answer.tets.reserve(static_cast<std::size_t>(head.tets));
  std::vector<std::array<int, 4>> block(1 << 14);
  for (auto left = static_cast<std::size_t>(head.tets); left > 0; left -= block.size()) {
    block.resize(std::min(block.size(), left));
    if (!reader.read(block.data(), block.size() * sizeof block[0])) return false;
    for (const auto& [a, b, c, d] : block)
      answer.tets.push_back({a, b, c, d, -1, -1, -1, -1, -1, -1});
  }
  answer.faces.resize(static_cast<std::size_t>(head.faces));
  answer.marker.resize(answer.faces.size());
  return reader.read(answer.faces.data(), answer.faces.size() * sizeof(Triangle)) &&
         reader.read(answer.marker.data(), answer.marker.size() * sizeof(int));
}

std::string why(int status) {
  if (WIFSIGNALED(status)) return fmt::format("TetGen crashed (signal {})", WTERMSIG(status));
  switch (WIFEXITED(status) ? WEXITSTATUS(status) - kThrew : -1) {
    case 1:
      return "TetGen ran out of memory";
    case 3:
      return "TetGen found facets that cut each other";
    case 4:
      return "TetGen found a feature too small to mesh";
    case 5:
      return "TetGen found two facets too close to each other";
    default:
      return "TetGen gave up";
  }
}

// The process that forks all workers of this one, begun with the first.
class Workers {
 public:
  Worker spawn(double patience) {
    for (int trial = 0; trial < kMostWorkers; ++trial) {
      if (auto worker = current()->spawn(patience)) return std::move(*worker);
      renew();
    }
    throw Error(ExitCode::kIo, "TetGen", "no process", "close other programs");
  }
  // Another one from now on: the fork of this one may have taken a lock along that some thread of
  // ours held (libc's of random(), which TetGen calls, is not put right in children).
  void renew() {
    const std::lock_guard lock(mutex_);
    spawner_.reset();
  }

 private:
  std::shared_ptr<ProcessSpawner> current() {
    const std::lock_guard lock(mutex_);
    if (!spawner_) spawner_ = std::make_shared<ProcessSpawner>(work);
    return spawner_;
  }
  std::mutex mutex_;
  std::shared_ptr<ProcessSpawner> spawner_;
};

Workers& workers() {
  static Workers all;
  return all;
}

// One worker; nothing where it waits for ever.
std::optional<TetgenAnswer> try_tetgen_child(const TetgenInput& input,
                                             const TetgenOptions& options) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(Triangle) == 3 * sizeof(int));
  Worker worker = workers().spawn(options.stall);
  TetgenAnswer answer;
  Reader reader(worker.data(), worker.process(), options);
  const bool whole = put_task(ByteStream(worker.data()), input, options) && receive(reader, answer);
  const int status = worker.finish(!reader.timed_out() && !reader.stalled());
  if (reader.stalled()) return std::nullopt;
  const bool worked_out = WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU;
  if (reader.timed_out() || worked_out)
    answer.failure = fmt::format("TetGen did not finish in {:g} s", options.time_limit);
  else if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    answer.failure = why(status);
  else if (!whole)
    answer.failure = "TetGen's answer is cut off";
  else if (answer.tets.empty())
    answer.failure = "TetGen found no inside";
  return answer;
}

}  // namespace

TetgenAnswer run_tetgen_child(const TetgenInput& input, const TetgenOptions& options) {
  for (int trial = 0; trial < kMostWorkers; ++trial) {
    if (auto answer = try_tetgen_child(input, options)) return *std::move(answer);
    workers().renew();
  }
  TetgenAnswer none;
  none.failure = "TetGen's process does not run";
  return none;
}

}  // namespace hapsim
