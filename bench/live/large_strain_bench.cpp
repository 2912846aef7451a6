// Large strain at 1 kHz: the sampled response against finite elements, on presses at places that
// its samples do not have. Each press goes down to a share of the thickness with a way sideways,
// holds, goes on sideways, and comes back; the loop is asked every millisecond, the elements every
// 50, or 20 where they relax. Rows: of all samples in contact where the elements are asked, the
// error over the force (floor 5 % of the press's peak), its median, 95th percentile and worst, and
// the share within 2 %
//   same      of the elements that samples are made with, times the ratio of normal stiffnesses:
//             what is lost between places and by the few numbers of a place,
//   finer     of elements two thirds as large, as they are, on the first presses: meshes' errors
//             with it,
//   full      of hs-simulate --full as it is, there, up to where that converges,
//   law       of the closed law that --live has without --large-strain, against `finer`,
// then how often 1.96 times the stated uncertainty covers the error against `finer`, how often it
// is above 2 % (where the force is more than that off, too), and the latencies of steps in contact.
//
//   bench_large_strain BODY.ply MODEL.csv CONTACTS.csv PLACES [SAMPLES [SHARE [SEED]]]
// (large_strain.sh makes them)
//
// CONTACTS: places (x,y,z in metres, without a header) about which is sampled. HAPSIM_BENCH_CACHE:
// where samples stay. SEED draws the presses (2026).
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/random.h"
#include "contact/contact_library.h"
#include "experiment/forces.h"
#include "formats/tetmesh_io.h"
#include "io/stream.h"
#include "mesh/way_through.h"
#include "model/model.h"
#include "realtime/force_loop.h"
#include "simulate/full_simulation.h"

namespace {

using namespace hapsim;
using Clock = std::chrono::steady_clock;

constexpr double kRadius = 0.004;  // [m]
// Steps of the loop a step of the elements, which of relaxing ones is of second order in time.
constexpr int kEvery = 50, kEveryRelaxing = 20;
constexpr int kSteps = 1000;      // of a press
constexpr int kFinerPresses = 2;  // that finer elements solve too
constexpr int kFullPresses = 1;   // and those of --full

double seconds_since(Clock::time_point t) {
  return std::chrono::duration<double>(Clock::now() - t).count();
}

// Down to `deep` in 0.4 s, `aside` with it; held 0.1 s; half a radius on in 0.2 s; held 0.1 s;
// back.
Vec3 way(int step, const Vec3& into, const Vec3& aside) {
  const auto share = [&](int from, int to) {
    return std::clamp(static_cast<double>(step - from) / (to - from), 0.0, 1.0);
  };
  const double out = 1 - share(800, kSteps);
  return out *
         (share(0, 400) * (into + aside) + share(500, 700) * 0.5 * kRadius * aside.normalized());
}

struct Errors {
  std::vector<double> all;
  void add(const Vec3& f, const Vec3& truth, double peak) {
    all.push_back((f - truth).norm() / std::max(truth.norm(), 0.05 * peak));
  }
  std::string words() {
    if (all.empty()) return "none";
    std::sort(all.begin(), all.end());
    const auto at = [&](double share) {
      return 100 * all[static_cast<std::size_t>(share * static_cast<double>(all.size() - 1))];
    };
    const auto within = std::count_if(all.begin(), all.end(), [](double e) { return e <= 0.02; });
    return fmt::format(
        "median {:5.2f} %  95 % {:5.2f} %  worst {:5.2f} %  within 2 %: {:5.1f} % of {}", at(0.5),
        at(0.95), 100 * all.back(),
        100.0 * static_cast<double>(within) / static_cast<double>(all.size()), all.size());
  }
};

// Forces of elements at every kEvery-th step, as far as they converge.
std::vector<Vec3> by_elements(const TetMesh& body, const Model& model, const Vec3& at,
                              const FullOptions& options, const Vec3& into, const Vec3& aside,
                              int every, bool timed, double& normal_stiffness) {
  std::vector<Vec3> forces;
  FullPress press(body, model, at, kRadius, options);
  const Vec3 n = press.normal();
  if (const auto K = press.stiffness()) normal_stiffness = n.dot(*K * n);
  try {
    for (int i = every; i < kSteps; i += every)
      forces.push_back(press.step(way(i, into, aside), timed ? 1e-3 * every : 0));
  } catch (const Error& error) {
    if (error.code() != ExitCode::kNoConvergence) throw;
  }
  return forces;
}

void run(int argc, char** argv) {
  Input body_file(argv[1]), model_file(argv[2]);
  const TetMesh body = read_body(body_file);
  const Model model = read_model(model_file);
  const int places = std::atoi(argv[4]);
  const double share = argc > 6 ? std::atof(argv[6]) : 0.3;
  std::vector<Vec3> near;
  std::ifstream contacts(argv[3]);
  for (Vec3 p; (contacts >> p[0]).ignore() && (contacts >> p[1]).ignore() && (contacts >> p[2]);)
    near.push_back(p);
  PreparedBodyOptions options;
  options.tool_radius = kRadius;
  options.threads = 2;
  options.tolerance = 0.02;
  if (const char* cache = std::getenv("HAPSIM_BENCH_CACHE")) options.cache = cache;
  options.contacts = [&](const MaterialSpec& material) {
    ContactLibraryOptions how;
    how.threads = 1;
    how.cache = options.cache;
    const ContactLibrary library(body, kRadius, how);
    Material unit;
    unit.nu = material.nu;
    std::vector<KnownStiffness> known;
    for (const auto& s : library.sample(near, unit, "", ContactLevel::kFine, false))
      if (s) known.push_back({s->point, s->normal, material.modulus[0] * s->K});
    return known;
  };
  const PreparedBody law(body, model, options);
  fmt::print("linear stiffness: {} samples, {:.2f} % expected between them\n",
             law.field().samples(), 100 * law.field().expected_error());
  std::fflush(stdout);
  options.large_strain = true;
  if (argc > 5) options.most_strain_samples = static_cast<std::size_t>(std::atoi(argv[5]));
  const Clock::time_point start = Clock::now();
  const std::clock_t begun = std::clock();
  const PreparedBody prepared(body, model, options);
  const LargeStrain& strain = *prepared.large_strain();
  fmt::print(
      "{} tetrahedra; {} places pressed beforehand, those left out {:.2f} % off; {:.0f} s, "
      "{:.0f} s of a processor{}\n",
      body.tets.size(), strain.samples(), 100 * strain.left_out_error(), seconds_since(start),
      static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC,
      options.cache.empty() ? "" : " (what the cache has not)");
  std::fflush(stdout);

  const bool relaxes_too = static_part(model).parameters.size() < model.parameters.size();
  const int every = relaxes_too ? kEveryRelaxing : kEvery;
  const ContactBase base = make_contact_base(body);
  Random random(argc > 7 ? static_cast<std::uint64_t>(std::atoll(argv[7])) : 2026);
  Errors same, finer, full, closed;
  std::vector<double> latencies;
  std::size_t covered = 0, told = 0, beyond = 0, full_all = 0, off = 0, off_and_said = 0, said = 0;
  double full_depth = 1e9;
  ForceLoop loop(prepared), law_loop(law);
  for (int p = 0; p < places; ++p) {
    // Within two radii of a contact.
    const Vec3& contact = near[static_cast<std::size_t>(random.integer(near.size()))];
    const double angle = 2 * M_PI * random.uniform(),
                 far = 2 * kRadius * std::sqrt(random.uniform());
    const SurfaceSide about = prepared.distance().at(contact);
    const Vec3 e = about.normal.unitOrthogonal(), g = about.normal.cross(e);
    const SurfaceSide at =
        prepared.distance().at(contact + far * (std::cos(angle) * e + std::sin(angle) * g));
    const Vec3 n = at.normal, t = n.unitOrthogonal(), s = n.cross(t);
    const double deep = share * way_through(prepared.distance(), at.point, -n);
    const double turn = 2 * M_PI * random.uniform(), aside_by = 0.4 * random.uniform() * kRadius;
    const Vec3 into = -deep * n,
               aside = std::max(aside_by, 1e-6) * (std::cos(turn) * t + std::sin(turn) * s);

    FullOptions elements;
    elements.base = &base;
    elements.quarter_points = false;
    elements.solve.past_instability = true;
    elements.rim_edge = 0.5, elements.growth = 0.6;
    double k_same = 1, k_other = 1;
    std::vector<Vec3> f_same =
        by_elements(body, model, at.point, elements, into, aside, every, relaxes_too, k_same);
    const StepPlace here = prepared.facts().at(at.face, at.point, n);
    for (Vec3& f : f_same) f *= n.dot(here.contact.K * n) / k_same;
    std::vector<Vec3> f_finer, f_full;
    if (p < kFinerPresses) {
      elements.rim_edge = 1.0 / 3, elements.growth = 0.4;
      elements.solve.least_step = 1.0 / 32;
      f_finer =
          by_elements(body, model, at.point, elements, into, aside, every, relaxes_too, k_other);
    }
    if (p < kFullPresses) {
      FullOptions usual;
      usual.base = &base;
      usual.solve.least_step = 1.0 / 32;
      f_full = by_elements(body, model, at.point, usual, into, aside, every, relaxes_too, k_other);
      full_all += static_cast<std::size_t>(kSteps / every - 1);
      full_depth = std::min(full_depth,
                            deep * std::min(1.0, every * static_cast<double>(f_full.size()) / 400));
    }

    fmt::print(stderr, "press {} of {}\n", p + 1, places);
    double peak = 0;
    for (const Vec3& f : f_same) peak = std::max(peak, f.norm());
    loop.begin(at.point);
    law_loop.begin(at.point);
    for (int i = 0; i < kSteps; ++i) {
      const Vec3 u = way(i, into, aside);
      const Clock::time_point before = Clock::now();
      const Vec3 f = loop.press(1e-3 * i, u);
      latencies.push_back(1e6 * seconds_since(before));
      const Vec3 f_law = law_loop.press(1e-3 * i, u);
      if (i % every != 0 || i == 0) continue;
      const auto k = static_cast<std::size_t>(i / every - 1);
      if (loop.beyond() & kBeyondLaw) ++beyond;
      if (k < f_same.size()) same.add(f, f_same[k], peak);
      if (k < f_full.size()) full.add(f, f_full[k], peak);
      if (k >= f_finer.size()) continue;
      finer.add(f, f_finer[k], peak);
      closed.add(f_law, f_finer[k], peak);
      ++told;
      const double error = (f - f_finer[k]).norm(), stated = 1.96 * loop.uncertainty() * f.norm();
      const double allowed = 0.02 * std::max(f_finer[k].norm(), 0.05 * peak);
      covered += error <= stated ? 1 : 0;
      off += error > allowed ? 1 : 0;
      off_and_said += error > allowed && stated > allowed ? 1 : 0;
      said += stated > allowed ? 1 : 0;
    }
  }
  fmt::print("{} presses to {:.0f} % of the thickness\n", places, 100 * share);
  fmt::print("  same   {}\n", same.words());
  fmt::print("  finer  {}\n", finer.words());
  fmt::print("  full   {}; it converges in {} of {}, to {:.1f} mm everywhere\n", full.words(),
             full.all.size(), full_all, 1e3 * full_depth);
  fmt::print("  law    {}\n", closed.words());
  std::sort(latencies.begin(), latencies.end());
  const auto latency = [&](double q) {
    return latencies[static_cast<std::size_t>(q * static_cast<double>(latencies.size() - 1))];
  };
  fmt::print(
      "  1.96 times the uncertainty covers {} of {}, and is above 2 % at {}, at {} of {} that are "
      "so "
      "far off;\n  beyond the range {}; a step: median {:.2f} us, 99.9 % {:.2f}, longest {:.1f} of "
      "{}\n",
      covered, told, said, off_and_said, off, beyond, latency(0.5), latency(0.999),
      latencies.back(), latencies.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    fmt::print(stderr,
               "usage: bench_large_strain BODY.ply MODEL.csv CONTACTS.csv PLACES [SAMPLES [SHARE "
               "[SEED]]]\n");
    return 2;
  }
  try {
    run(argc, argv);
  } catch (const Error& error) {
    fmt::print(stderr, "bench_large_strain: {}\n", error.what());
    return 1;
  }
  return 0;
}
