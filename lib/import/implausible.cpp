#include "import/implausible.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "io/number.h"

namespace hapsim {
namespace {

// Of a press, and of soft bodies to steel.
constexpr double kDeepest = 0.1, kShallowest = 1e-9;     // [m]
constexpr double kLeastForce = 1e-4, kMostForce = 2000;  // [N]
constexpr double kSoftest = 100, kHardest = 1e10;        // [Pa]

struct Sizes {
  double depth = 0, force = 0;  // largest [m], [N]
};

Sizes sizes_of(const Recording& recording) {
  Sizes sizes;
  for (std::size_t i = 0; i < recording.rows(); ++i) {
    if (!recording.in_air(i)) sizes.depth = std::max(sizes.depth, recording.u[i].norm());
    sizes.force = std::max(sizes.force, recording.f[i].norm());
  }
  return sizes;
}

// Of a half-space of nu = 1/2 under a flat disc: F (1 - nu^2) / (2 a d) (Sneddon 1965).
double modulus_of(const Sizes& sizes, double radius) {
  return 0.75 * sizes.force / (2 * radius * sizes.depth);
}

bool plausible_modulus(double e) {
  return e >= kSoftest && e <= kHardest;
}

class Judge {
 public:
  Judge(const std::string& name, bool refuse, Notes& notes)
      : name_(name), refuse_(refuse), notes_(notes) {}

  void say(bool guessed, const std::string& wrong, const std::string& mend) {
    if (refuse_ && guessed) fail_input(name_, wrong, mend + ", or --yes where it is right");
    notes_.warnings.push_back(wrong + ": " + mend);
  }

 private:
  const std::string& name_;
  bool refuse_;
  Notes& notes_;
};

}  // namespace

void check_plausible(const Recording& recording, const Samples& samples,
                     const ImportOptions& options, Notes& notes) {
  if (recording.metadata.find("motion")) return;  // a tool that slides goes far
  const Sizes sizes = sizes_of(recording);
  Judge judge(recording.name, !options.units.trusted, notes);
  const bool lengths = samples.length_guessed, forces = samples.force_guessed;
  const double deepest = options.block ? options.block->z() : kDeepest;
  if (sizes.depth > deepest)
    judge.say(
        lengths,
        fmt::format(
            "the deepest press is {:.3g} m{}", sizes.depth,
            options.block ? fmt::format(" into a block of {} m", format_number(deepest)) : ""),
        sizes.depth * 1e-3 > kShallowest && lengths
            ? "in millimetres it is 1000 times less: --unit mm"
            : "is the unit of length right?");
  if (sizes.depth < kShallowest || (lengths && sizes.depth < 1e-5))
    judge.say(false, fmt::format("the deepest press is {:.3g} m", sizes.depth),
              "is the unit of length right?");
  if (sizes.force > kMostForce)
    judge.say(forces || sizes.force > 1e6,
              fmt::format("the largest force is {:.3g} N", sizes.force),
              "in mN it is 1000 times less: --force-unit mN");
  if (sizes.force < kLeastForce && sizes.force > 0 && forces)
    judge.say(forces, fmt::format("the largest force is {:.3g} N", sizes.force),
              "in kN it is 1000 times more: --force-unit kN");
  if (!options.tool_radius || !(sizes.depth > 0) || !(sizes.force > 0) || !(lengths || forces))
    return;
  const double e = modulus_of(sizes, *options.tool_radius);
  if (plausible_modulus(e)) return;
  const std::string wrong =
      fmt::format("under a tool of radius {} m the body would have a modulus of some {:.2g} Pa",
                  format_number(*options.tool_radius), e);
  if (forces && e > kHardest)
    judge.say(true, wrong, "in mN the forces are 1000 times less: --force-unit mN");
  else if (forces && e < kSoftest)
    judge.say(true, wrong, "in kN the forces are 1000 times more: --force-unit kN");
  else
    judge.say(lengths, wrong,
              e < kSoftest ? "in millimetres the depths are 1000 times less: --unit mm"
                           : "in metres the depths are 1000 times more: --unit m");
}

void check_sizes_given(const ImportOptions& options) {
  if (options.units.trusted) return;
  if (options.block && options.block->maxCoeff() > 1) {
    const Vec3& b = *options.block;
    fail_usage(fmt::format("--block: a body of {} x {} x {} m is no specimen", format_number(b.x()),
                           format_number(b.y()), format_number(b.z())),
               fmt::format("in millimetres it is {}x{}x{}mm; --yes where it is right",
                           format_number(b.x()), format_number(b.y()), format_number(b.z())));
  }
  if (options.tool_radius && *options.tool_radius > 0.1)
    fail_usage(fmt::format("--tool-radius: a tool of radius {} m is none",
                           format_number(*options.tool_radius)),
               fmt::format("in millimetres it is {}mm; --yes where it is right",
                           format_number(*options.tool_radius)));
}

}  // namespace hapsim
