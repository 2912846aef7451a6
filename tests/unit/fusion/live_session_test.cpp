// From the bytes of a motion to those of its forces, once it is under way: no memory is taken and
// no lock, in any form of the motion and by any loop.
#include "realtime/live_session.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <mutex>

#include "acfm/acfm_loop.h"
#include "fusion/fused_loop.h"
#include "io/stream.h"
#include "realtime/force_loop.h"
#include "realtime/live_tools.h"
#include "realtime/motion_lines.h"
#include "realtime/motion_records.h"
#include "realtime/tool_lines.h"
#include "support/allocations.h"
#include "support/synthetic.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define HAPSIM_COUNTS_LOCKS 0
#else
#define HAPSIM_COUNTS_LOCKS 1
#include <dlfcn.h>
#include <pthread.h>
#endif

namespace {
using hapsim::test::allocations;
thread_local long locks = 0;
}  // namespace

#if HAPSIM_COUNTS_LOCKS
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Lock = int (*)(pthread_mutex_t*);
  static const auto lock = reinterpret_cast<Lock>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  ++locks;
  return lock(mutex);
}
#endif

namespace hapsim {
namespace {

constexpr const char* kName = "a name that is longer than a short string";
constexpr int kSamples = 5000, kFirst = 100;

// A motion that notes what was taken between its first samples and its end.
class Counting : public MotionSource {
 public:
  explicit Counting(MotionSource& source) : source_(source) {}
  bool has_contact_point() const override { return source_.has_contact_point(); }
  bool next(MotionLine& line) override {
    if (++count_ == kFirst) allocations_ = allocations, locks_ = locks;
    if (count_ == kSamples) allocations_ = allocations - allocations_, locks_ = locks - locks_;
    return source_.next(line);
  }
  void write_force(std::string& buffer, const MotionLine& line, const Vec3& force) const override {
    source_.write_force(buffer, line, force);
    largest_ = std::max(largest_, force.norm());
  }
  void expect_nothing() const {
    EXPECT_GE(count_, kSamples);
    EXPECT_GT(largest_, 0.1);  // it was pressed [N]
    EXPECT_EQ(allocations_, 0);
    EXPECT_EQ(locks_, 0);
  }

 private:
  MotionSource& source_;
  int count_ = 0;
  long allocations_ = 0, locks_ = 0;
  mutable double largest_ = 0;
};

void answer(MotionSource& source, ToolLoop& loop, double rate = 0) {
  Counting counting(source);
  Output out("/dev/null");
  LiveReport report;
  LiveOptions options;
  options.rate = rate;
  run_live(counting, out.stream(), loop, options, report);
  out.commit();
  counting.expect_nothing();
}

// The same of several tools.
class CountingTools : public ToolSource {
 public:
  explicit CountingTools(ToolSource& source) : source_(source) {}
  std::size_t tools() const override { return source_.tools(); }
  bool has_contact_point() const override { return source_.has_contact_point(); }
  bool next(ToolStep& step) override {
    if (++count_ == kFirst) allocations_ = allocations, locks_ = locks;
    if (count_ == kSamples) allocations_ = allocations - allocations_, locks_ = locks - locks_;
    return source_.next(step);
  }
  void write(std::string& buffer, const ToolStep& step,
             std::span<const ToolFeel> feel) const override {
    source_.write(buffer, step, feel);
    together_ += !feel[0].in_air && !feel[1].in_air ? 1 : 0;
  }
  void expect_nothing() const {
    EXPECT_GE(count_, kSamples);
    EXPECT_GT(together_, kSamples / 10);
    EXPECT_EQ(allocations_, 0);
    EXPECT_EQ(locks_, 0);
  }

 private:
  ToolSource& source_;
  int count_ = 0;
  long allocations_ = 0, locks_ = 0;
  mutable int together_ = 0;
};

TetMesh mesh() {
  return test::block_mesh({0.08, 0.08, 0.04}, 6, 6, 4, 1);
}

Model relaxing() {
  Model model;
  model.parameters = effect_rows(*find_effect("elastic"), 1, {2e4, 0.4});
  for (const Parameter& p :
       effect_rows(*find_effect("viscoelastic"), 4, {8e3, 0.07, 4e3, 0.35, 2e3, 1.7, 1e3, 9}))
    model.parameters.push_back(p);
  return model;
}

PreparedBodyOptions tool() {
  PreparedBodyOptions options;
  options.tool_radius = 0.004;
  options.most_samples = 16;
  options.rim_edge = 0.5;  // no test of it: quick
  return options;
}

// Up and down all over the top, in and out of contact.
Vec3 tip(int i) {
  const double a = 1e-3 * i;
  return {0.04 + 0.03 * std::cos(a), 0.04 + 0.03 * std::sin(1.3 * a),
          0.039 + 0.0025 * std::sin(7 * a)};
}

std::string tips_as_lines() {
  std::string text = "t,x,y,z\n";
  for (int i = 0; i < kSamples; ++i)
    text += fmt::format("{},{},{},{}\n", 1e-3 * i, tip(i).x(), tip(i).y(), tip(i).z());
  return text;
}

// Ten presses.
double depth(int i) {
  return -0.002 * (1 - std::cos(0.01256637 * i));
}

std::string presses_as_lines() {
  std::string text = "press,t,x,y,z,ux,uy,uz\n";
  for (int i = 0; i < kSamples; ++i)
    text += fmt::format("{},{},0.04,0.04,0.04,{},0,{}\n", i / 500, 1e-3 * i, 1e-7 * (i % 500),
                        depth(i));
  return text;
}

std::string tips_as_records() {
  std::string bytes;
  for (int i = 0; i < kSamples; ++i)
    for (const double v : {1e-3 * i, tip(i).x(), tip(i).y(), tip(i).z()}) {
      char raw[sizeof v];
      std::memcpy(raw, &v, sizeof v);
      bytes.append(raw, sizeof v);
    }
  return bytes;
}

#if HAPSIM_COUNTS_LOCKS
TEST(LiveSession, LocksAreCounted) {
  const long before = locks;
  std::mutex mutex;
  const std::lock_guard<std::mutex> held(mutex);
  EXPECT_EQ(locks, before + 1);
}
#endif

TEST(LiveSession, TakesNoMemoryAndNoLock) {
  const Model model = relaxing();
  const PreparedBody body(mesh(), model, tool());
  ToolLoopOptions sliding;
  sliding.contact.slides = true;
  {
    SCOPED_TRACE("lines of the tip, sliding");
    Input input = Input::from_bytes(tips_as_lines(), kName);
    MotionLines source(input);
    ForceLoop loop(body, sliding);
    answer(source, loop);
  }
  {
    SCOPED_TRACE("lines of presses, by the clock");
    Input input = Input::from_bytes(presses_as_lines(), kName);
    MotionLines source(input);
    ForceLoop loop(body);
    answer(source, loop, 20000);
  }
  {
    SCOPED_TRACE("records of the tip");
    Input input = Input::from_bytes(tips_as_records(), kName);
    MotionRecords source(input, MotionRecords::Kind::kTip);
    ForceLoop loop(body);
    answer(source, loop);
  }
}

TEST(LiveSession, SeveralToolsTakeNoMemoryAndNoLock) {
  const Model model = relaxing();
  const PreparedBody body(mesh(), model, tool());
  const ToolCoupling coupling(mesh(), model, 0.004);
  std::string text = "t,tool_id,x,y,z,thx,thy,thz\n";
  for (int i = 0; i < kSamples; ++i)
    for (int k = 0; k < 2; ++k)
      text += fmt::format("{},tool{},{},0.04,{},0,0,{}\n", 1e-3 * i, k, 0.034 + 0.012 * k,
                          0.039 + 0.0025 * std::sin(7e-3 * i + 0.4 * k), 0.1 * std::sin(1e-3 * i));
  for (const std::size_t count : {0, 2}) {
    Input input = Input::from_bytes(text, kName);
    ToolLines source(CsvReader(input), kName, count);
    CountingTools counting(source);
    SeveralTools tools(body, &coupling, source.tools());
    Output out("/dev/null");
    LiveReport report;
    run_live_tools(counting, out.stream(), tools, {}, report);
    out.commit();
    counting.expect_nothing();
    EXPECT_EQ(report.latency.count(), kSamples);
  }
}

Acfm live_springs() {
  Acfm model;
  model.positions.resize(1);
  for (AcfmAxis& axis : model.positions[0].axis) axis.value[0] = 400;
  return model;
}

TEST(LiveSession, NorDoesTheAnalyticalModel) {
  const Acfm model = live_springs();
  Input input = Input::from_bytes(presses_as_lines(), kName);
  MotionLines source(input);
  AcfmLoop loop(model);
  answer(source, loop);
}

// A stiffer body, solved beside the loop.
class Stiff : public SlowPress {
 public:
  Vec3 step(const Vec3& u, double) override { return -500 * u; }
};

TEST(LiveSession, NorDoesTheFusedForce) {
  const Acfm model = live_springs();
  Input input = Input::from_bytes(presses_as_lines(), kName);
  MotionLines source(input);
  AcfmLoop fast(model);
  FusedLoop loop(fast, [](const Vec3&) { return std::make_unique<Stiff>(); }, {});
  answer(source, loop);
  loop.stop();
  EXPECT_EQ(loop.failure(), "");
}

}  // namespace
}  // namespace hapsim
