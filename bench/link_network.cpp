// bench_link_network BIN [NAME...]: what a hand feels while somebody on the network does harm, or a
// process is killed or stopped, between the two processes of hs-link as users run them (BIN: the
// folder of the tools), in real time, on this machine's own network. A relay between them, which
// has no key, loses, repeats, keeps, turns and floods. From 2 s on the fault is there, until 3 s or
// for 10 s. One row a fault (or each whose name contains a NAME):
//   fault; most force and most change from line to line at the hand; longest time in which a line
//   with a force came though no datagram of the peer had reached the operator [ms]; datagrams a
//   second of a flood; exit codes of the operator and of the last teleoperator; whether all is as
//   it must be: no NaN, no force or step above its limit, zero within hold + ramp and what the
//   machine's scheduler adds (100 ms here), and the session goes on (a force in its last second,
//   exit code 0) or ends with its code.
// Exit code 1 where one is not. bench_link_faults has more faults, of who has the key too, on a
// clock of its own.
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>

#include "base/random.h"
#include "link/handshake.h"
#include "link/session.h"
#include "link/udp.h"
#include "safety/limits.h"

namespace hapsim {
namespace {

constexpr double kFrom = 2, kAfter = 3, kScheduler = 0.1;  // [s]
constexpr int kFloodsPerSecond = 100'000;

std::string tools, folder;

std::int64_t clock_ns() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

// One hs-link; what it says goes to a file, what it prints is read here.
class Process {
 public:
  Process(const std::vector<std::string>& arguments, const std::string& log) : log_(log) {
    std::filesystem::remove(log);  // what an earlier one said
    int ends[2];
    if (pipe(ends) != 0) std::abort();
    process_ = fork();
    if (process_ == 0) {
      dup2(ends[1], STDOUT_FILENO);
      dup2(open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), STDERR_FILENO);
      close(ends[0]);
      close(ends[1]);
      std::vector<std::string> words{tools + "/hs-link"};
      words.insert(words.end(), arguments.begin(), arguments.end());
      std::vector<char*> raw;
      for (std::string& word : words) raw.push_back(word.data());
      raw.push_back(nullptr);
      execv(raw[0], raw.data());
      _exit(127);
    }
    close(ends[1]);
    from_ = ends[0];
    fcntl(from_, F_SETFL, O_NONBLOCK);
    fcntl(from_, F_SETFD, FD_CLOEXEC);
  }
  ~Process() {
    if (is_alive()) signal(SIGKILL), wait_for_end();
    close(from_);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  void signal(int number) { kill(process_, number); }
  bool is_alive() {
    if (!ended_ && waitpid(process_, &status_, WNOHANG) == process_) ended_ = true;
    return !ended_;
  }
  int wait_for_end() {
    if (!ended_) waitpid(process_, &status_, 0);
    ended_ = true;
    return code();
  }
  int code() const { return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_); }
  // The whole lines that have come since the last call.
  std::vector<std::string> lines() {
    char buffer[65536];
    for (ssize_t n; (n = read(from_, buffer, sizeof buffer)) > 0;)
      rest_.append(buffer, static_cast<std::size_t>(n));
    std::vector<std::string> all;
    for (std::size_t end; (end = rest_.find('\n')) != std::string::npos; rest_.erase(0, end + 1))
      all.push_back(rest_.substr(0, end));
    return all;
  }
  std::string said() const {
    std::ifstream file(log_);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  std::string log_, rest_;
  pid_t process_ = -1;
  int from_ = -1, status_ = 0;
  bool ended_ = false;
};

std::unique_ptr<Process> teleoperator(UdpAddress& at, const std::string& port = "0") {
  auto far = std::make_unique<Process>(
      std::vector<std::string>{"--listen", port, "--accuracy", "0.3", "--body", "body.ply",
                               "--model", "model.csv", "--tool-radius", "0.004", "--idle", "60",
                               "--key", "key"},
      "far.err");
  for (;; usleep(20'000)) {
    const std::string said = far->said();
    const auto found = said.find("listening at ");
    if (found != std::string::npos && said.find('\n', found) != std::string::npos) {
      at = parse_address(said.substr(found + 13, said.find('\n', found) - found - 13));
      return far;
    }
    if (!far->is_alive()) {
      fmt::print(stderr, "bench_link_network: no teleoperator: {}\n", said);
      std::exit(4);
    }
  }
}

std::unique_ptr<Process> start_operator(const UdpAddress& peer, const std::string& log = "near.err",
                                        const std::string& key = "key",
                                        const std::string& body = "body.ply") {
  return std::make_unique<Process>(
      std::vector<std::string>{"motion.csv", "--peer", to_text(peer), "--accuracy", "0.3", "--body",
                               body, "--key", key, "--patience", "2"},
      log);
}

// Between the two, and what is seen there.
struct Relay {
  UdpAddress of_far, of_near;
  UdpSocket to_near{parse_address("127.0.0.1:0")};
  std::unique_ptr<UdpSocket> to_far = std::make_unique<UdpSocket>(parse_address("127.0.0.1:0"));
  UdpSocket stranger{parse_address("127.0.0.1:0")};
  std::deque<Datagram> out, back;  // what went by, the newest last
  Random random{5};
  std::int64_t heard = 0, lasts_since = 0;
  long flooded = 0;
  std::unique_ptr<Process> near, far, other;

  void send_far(const Datagram& d) { to_far->send(of_far, d.view()); }
  void send_near(const Datagram& d) {
    to_near.send(of_near, d.view());
    if (std::ranges::equal(d.view(), back.back().view())) heard = clock_ns();
  }
  // As many as are due by the clock.
  void flood(const std::function<void()>& one) {
    const double lasted = 1e-9 * static_cast<double>(clock_ns() - lasts_since);
    const auto due = static_cast<long>(kFloodsPerSecond * lasted);
    for (int i = 0; i < 500 && flooded < due; ++i, ++flooded) one();
  }
};

using Passed = std::function<void(Relay&, const Datagram&)>;

struct Fault {
  std::string name;
  Passed out = {}, back = {};  // instead of passing a datagram on
  std::function<void(Relay&)> begins = {}, each = {}, ends = {};
  double lasts = 1;
  bool goes_on = true;
  int near_code = 0;
};

Datagram noise(Relay& r, std::size_t size) {
  Datagram d;
  d.size = size;
  for (std::size_t i = 0; i < size; ++i)
    d.bytes[i] = static_cast<unsigned char>(r.random.integer(256));
  return d;
}

Datagram forged(Relay& r, Message message) {
  Datagram d = noise(r, message == Message::kPacket ? kSealedBytes : kHandshakeBytes);
  put_header(d.bytes.data(), message, message == Message::kPacket ? r.random.integer(1u << 31) : 0);
  return d;
}

Datagram turned(Relay& r, Datagram d) {
  d.bytes[r.random.integer(d.size)] ^= static_cast<unsigned char>(1U << r.random.integer(8));
  return d;
}

Datagram any(Relay& r, const std::deque<Datagram>& seen) {
  return seen[r.random.integer(seen.size())];
}

void far_again(Relay& r) {
  r.far = nullptr;
  r.far = teleoperator(r.of_far, std::to_string(r.of_far.port));
}

std::vector<Fault> faults() {
  const auto far = [](Relay& r, const Datagram& d) { r.send_far(d); };
  const auto near = [](Relay& r, const Datagram& d) { r.send_near(d); };
  const auto none = [](Relay&, const Datagram&) {};
  const auto lossy = [](double share, const Passed& pass) {
    return [=](Relay& r, const Datagram& d) {
      if (r.random.uniform() > share) pass(r, d);
    };
  };
  const auto twice = [](const Passed& pass) {
    return [=](Relay& r, const Datagram& d) { pass(r, d), pass(r, d); };
  };
  const auto damaged = [](const Passed& pass) {
    return [=](Relay& r, const Datagram& d) { pass(r, turned(r, d)), pass(r, d); };
  };
  const auto old = [](const Passed& pass, std::deque<Datagram> Relay::*seen) {
    return [=](Relay& r, const Datagram& d) {
      pass(r, any(r, r.*seen)), pass(r, d), pass(r, any(r, r.*seen));
    };
  };
  std::vector<Fault> all{
      {"none"},
      {"loss of 50 % each way", lossy(0.5, far), lossy(0.5, near)},
      {"loss of 90 % each way", lossy(0.9, far), lossy(0.9, near)},
      {"outage of 1 s", none, none},
      {"outage of 4 s", none, none, {}, {}, {}, 4},
      {"forces alone are lost for 1 s", {}, none},
      {"every datagram twice", twice(far), twice(near)},
      {"a bit turned, before each datagram", damaged(far), damaged(near)},
      {"old datagrams around each", old(far, &Relay::out), old(near, &Relay::back)},
      {"datagrams sent back to who sent them",
       [](Relay& r, const Datagram& d) { r.send_near(d), r.send_far(d); },
       [](Relay& r, const Datagram& d) { r.send_far(d), r.send_near(d); }}};
  const auto flood = [&](const std::string& name, const std::function<void(Relay&)>& one) {
    all.push_back({"flood for 10 s: " + name});
    all.back().each = [=](Relay& r) { r.flood([&] { one(r); }); };
    all.back().lasts = 10;
  };
  flood("noise, to the teleoperator",
        [](Relay& r) { r.stranger.send(r.of_far, noise(r, r.random.integer(257)).view()); });
  flood("noise, to the operator from its peer's address",
        [](Relay& r) { r.send_near(noise(r, r.random.integer(257))); });
  flood("forged packets, to the teleoperator",
        [](Relay& r) { r.stranger.send(r.of_far, forged(r, Message::kPacket).view()); });
  flood("forged packets, to the operator from its peer's address",
        [](Relay& r) { r.send_near(forged(r, Message::kPacket)); });
  flood("forged hellos, to the teleoperator",
        [](Relay& r) { r.stranger.send(r.of_far, forged(r, Message::kHello).view()); });
  flood("forged welcomes, to the operator from its peer's address",
        [](Relay& r) { r.send_near(forged(r, Message::kWelcome)); });
  flood("repeated motions, to the teleoperator", [](Relay& r) { r.send_far(any(r, r.out)); });
  flood("repeated forces, to the operator", [](Relay& r) { r.send_near(any(r, r.back)); });
  flood("the first hello, to the teleoperator from elsewhere", [](Relay& r) {
    static Datagram first;
    if (r.flooded == 0) first = r.out.front();
    r.stranger.send(r.of_far, first.view());
  });

  const auto process = [&](const std::string& name, const std::function<void(Relay&)>& begins,
                           const std::function<void(Relay&)>& ends) {
    all.push_back({name, {}, {}, begins, {}, ends});
  };
  process("teleoperator killed for good", [](Relay& r) { r.far->signal(SIGKILL); }, {});
  all.back().goes_on = false;
  all.back().near_code = 5;
  process(
      "teleoperator killed, another begun", [](Relay& r) { r.far->signal(SIGKILL); }, far_again);
  process(
      "teleoperator ended by SIGTERM, another begun", [](Relay& r) { r.far->signal(SIGTERM); },
      far_again);
  process(
      "teleoperator stopped for 1 s", [](Relay& r) { r.far->signal(SIGSTOP); },
      [](Relay& r) { r.far->signal(SIGCONT); });
  process(
      "operator stopped for 1 s", [](Relay& r) { r.near->signal(SIGSTOP); },
      [](Relay& r) { r.near->signal(SIGCONT); });
  process("operator ended by SIGTERM", [](Relay& r) { r.near->signal(SIGTERM); }, {});
  all.back().goes_on = false;
  process("operator's address changes",
          [](Relay& r) { r.to_far = std::make_unique<UdpSocket>(parse_address("127.0.0.1:0")); },
          {});
  const auto beside = [&](const std::string& name, const std::string& key,
                          const std::string& body) {
    process(name, [=](Relay& r) { r.other = start_operator(r.of_far, "other.err", key, body); },
            {});
    all.back().lasts = 3;
  };
  beside("a second operator with the key", "key", "body.ply");
  beside("a second operator with another key", "other-key", "body.ply");
  beside("a second operator with another body", "key", "other.ply");
  return all;
}

struct Row {
  double force = 0, step = 0, silent = 0, late_force = 0, last_force = 0, rate = 0;
  long lines = 0;
  bool finite = true;
  int near_code = -1, far_code = -1, other_code = -1;
};

// The columns of a line; none of the header's.
std::vector<double> numbers(const std::string& line) {
  std::vector<double> all;
  std::stringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');)
    all.push_back(cell == "nan" ? NAN : std::strtod(cell.c_str(), nullptr));
  return all;
}

Row run(const Fault& fault) {
  const double end = kFrom + fault.lasts + kAfter;
  {
    std::ofstream motion("motion.csv");
    motion << "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz\n";
    for (int ms = 0; ms < 1000 * end; ++ms)
      motion << fmt::format("1,{:.3f},0.03,0.025,0.04,0,0,{:.9g}\n", 1e-3 * ms,
                            -0.002 * std::min(1.0, 1e-3 * ms) * (1 + 0.5 * std::sin(4e-3 * ms)));
  }
  Relay r;
  r.far = teleoperator(r.of_far);
  r.near = start_operator(r.to_near.address());
  Row row;
  Vec3 before = Vec3::Zero();
  std::int64_t begun = 0;
  bool lasts = false, over = false;
  int column = -1;
  while (r.near->is_alive() || column < 0) {
    r.to_near.wait(clock_ns() + 200'000);
    const std::int64_t now = clock_ns();
    const double t = begun ? 1e-9 * static_cast<double>(now - begun) : 0;
    if (!lasts && !over && t >= kFrom) {
      lasts = true;
      r.lasts_since = now;
      if (fault.begins) fault.begins(r);
    }
    if (lasts && fault.each) fault.each(r);
    if (lasts && t >= kFrom + fault.lasts) {
      lasts = false;
      over = true;
      row.rate = static_cast<double>(r.flooded) / fault.lasts;
      if (fault.ends) fault.ends(r);
    }
    Datagram d;
    UdpAddress from;
    while ((d.size = r.to_near.receive(d.bytes, from)) > 0) {
      r.of_near = from;
      r.out.push_back(d);
      if (r.out.size() > 20'000) r.out.pop_front();
      lasts&& fault.out ? fault.out(r, d) : r.send_far(d);
    }
    while ((d.size = r.to_far->receive(d.bytes, from)) > 0) {
      r.back.push_back(d);
      if (r.back.size() > 20'000) r.back.pop_front();
      lasts&& fault.back ? fault.back(r, d) : r.send_near(d);
    }
    for (const std::string& line : r.near->lines()) {
      if (line.starts_with('#')) continue;
      if (column < 0) {  // the header
        const std::string head = line.substr(0, line.find(",fx,"));
        column = 1 + static_cast<int>(std::count(head.begin(), head.end(), ','));
        continue;
      }
      if (!begun) begun = now;
      const std::vector<double> all = numbers(line);
      const Vec3 f(all.at(column), all.at(column + 1), all.at(column + 2));
      ++row.lines;
      row.finite = row.finite && f.allFinite();
      row.force = std::max(row.force, f.norm());
      row.step = std::max(row.step, (f - before).norm());
      before = f;
      row.last_force = f.norm();
      if (f != Vec3::Zero() && r.heard)
        row.silent = std::max(row.silent, 1e-6 * static_cast<double>(now - r.heard));
      if (all.at(1) > end - 1) row.late_force = std::max(row.late_force, f.norm());
    }
    if (!r.near->is_alive() && column < 0) break;
  }
  row.near_code = r.near->wait_for_end();
  r.far->signal(SIGCONT);
  r.far->signal(SIGTERM);
  row.far_code = r.far->wait_for_end();
  if (r.other) row.other_code = r.other->wait_for_end();
  return row;
}

bool told(const Fault& fault, const Row& row) {
  const SafetyLimits limits;
  const bool far_killed = fault.name.find("killed for good") != std::string::npos;
  const bool good = row.lines > 0 && row.finite && row.force <= limits.force * (1 + 1e-6) &&
                    row.step <= limits.rate * 1e-3 * (1 + 1e-6) &&
                    row.silent <= 1e3 * (limits.hold + limits.ramp + kScheduler) &&
                    (fault.goes_on ? row.late_force > 0.5 : row.last_force == 0) &&
                    row.near_code == fault.near_code && (far_killed || row.far_code == 0) &&
                    row.other_code != 0;
  fmt::print("{:<62} {:>7.3f} N {:>7.4f} N {:>5.0f} ms {:>8.0f}/s {:>4} {:>4}{}  {}\n", fault.name,
             row.force, row.step, row.silent, row.rate, row.near_code, row.far_code,
             row.other_code >= 0 ? fmt::format(" (other {})", row.other_code) : "",
             good ? "ok" : "WRONG");
  std::fflush(stdout);
  return good;
}

void tool(const std::string& words) {
  if (std::system((tools + "/" + words).c_str()) != 0) std::exit(4);
}

void prepare() {
  std::ofstream("box.off")
      << "OFF\n8 12 0\n0 0 0\n.06 0 0\n.06 .05 0\n0 .05 0\n0 0 .04\n.06 0 .04\n"
         ".06 .05 .04\n0 .05 .04\n3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n"
         "3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";
  std::ofstream("model.csv") << "effect,region,parameter,value,unit\nelastic,0,E,20000,Pa\n"
                                "elastic,0,nu,0.45,1\n";
  tool("hs-tetmesh box.off --edge 0.015 -q -o body.ply");
  std::ofstream("tall.off")
      << "OFF\n8 12 0\n0 0 0\n.06 0 0\n.06 .05 0\n0 .05 0\n0 0 .08\n.06 0 .08\n"
         ".06 .05 .08\n0 .05 .08\n3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n"
         "3 0 5 4\n3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";
  tool("hs-tetmesh tall.off --edge 0.015 -q -o other.ply");
  tool("hs-link --make-key key -q");
  tool("hs-link --make-key other-key -q");
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  using namespace hapsim;
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_link_network BIN [NAME...]\n");
    return 2;
  }
  signal(SIGPIPE, SIG_IGN);
  tools = std::filesystem::canonical(argv[1]).string();
  folder = std::filesystem::temp_directory_path() / fmt::format("link-network-{}", getpid());
  std::filesystem::create_directories(folder);
  std::filesystem::current_path(folder);
  prepare();
  const std::vector<std::string> wanted(argv + 2, argv + argc);
  int count = 0, wrong = 0;
  for (const Fault& fault : faults()) {
    bool asked = wanted.empty();
    for (const std::string& part : wanted)
      asked = asked || fault.name.find(part) != std::string::npos;
    if (!asked) continue;
    ++count;
    wrong += told(fault, run(fault)) ? 0 : 1;
  }
  std::filesystem::current_path("/");
  std::filesystem::remove_all(folder);
  fmt::print("{} faults, {} not as they must be\n", count, wrong);
  return wrong == 0 ? 0 : 1;
}
