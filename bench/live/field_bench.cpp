// The live force against the converged batch force at random places of the touchable surface, edges
// too, in random directions: what hs-simulate --live interpolates. A row a body and Poisson's
// ratio: samples, entries of the table, wall and processor seconds to prepare it with two threads,
// what the field expects of itself, then over the places root mean square, 95th percentile and
// worst of |F_live - F_batch| / |F_batch|, the share within 1.96 times the stated uncertainty, and
// the places that the batch mode refuses, of which so many are flagged as not sampled.
//
//   bench_field [places, default 200 [NU,NU... [tolerance [block|ball|organ|body.ply...]]]]
//
// Recorded in bench/results/live-field*.txt (bench/record.sh).
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

#include "base/blas.h"
#include "base/error.h"
#include "base/random.h"
#include "contact/contact_library.h"
#include "formats/tetmesh_io.h"
#include "mesh/surface_tree.h"
#include "realtime/direction_doubt.h"
#include "realtime/stiffness_field.h"
#include "support/block_mesh.h"
#include "support/objects.h"
#include "tetmesh/body_mesh.h"

namespace {

using namespace hapsim;

constexpr double kRadius = 0.004;  // [m]
constexpr int kThreads = 2;

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

TetMesh body_named(const std::string& name) {
  BodyOptions options;
  options.preserve_surface = true;
  if (name == "block") return test::block_mesh({0.12, 0.21, 0.06}, 12, 21, 6, 1);
  if (name == "ball") return make_body_mesh(test::half_ball(35), options);
  if (name == "organ") return make_body_mesh(test::lump(50), options);
  Input input(name);
  return read_body(input);
}

std::vector<Vec3> random_places(const ContactLibrary& library, int count, Random& random) {
  const Surface& surface = library.surface();
  std::vector<double> up_to;
  for (std::size_t f = 0; f < surface.faces.size(); ++f)
    up_to.push_back((f > 0 ? up_to.back() : 0) +
                    (library.bonded()[f] ? 0 : face_normal(surface, static_cast<int>(f)).norm()));
  std::vector<Vec3> places;
  for (int i = 0; i < count; ++i) {
    const auto f = static_cast<std::size_t>(
        std::upper_bound(up_to.begin(), up_to.end() - 1, random.uniform() * up_to.back()) -
        up_to.begin());
    const Triangle& t = surface.faces[f];
    const double a = std::sqrt(random.uniform()), b = random.uniform();
    places.push_back((1 - a) * surface.vertices[t[0]] + a * (1 - b) * surface.vertices[t[1]] +
                     a * b * surface.vertices[t[2]]);
  }
  return places;
}

void measure(const std::string& name, double nu, int count, double tolerance) {
  const TetMesh body = body_named(name);
  const double start = seconds();
  const std::clock_t begun = std::clock();
  ContactLibraryOptions options;
  options.threads = kThreads;
  if (const char* cache = std::getenv("HAPSIM_BENCH_CACHE")) options.cache = cache;
  const auto library = std::make_shared<const ContactLibrary>(body, kRadius, options);
  SampledMaterial material;
  material.field = {nu, [](const Vec3&) { return 1.0; }};
  material.solid.nu = nu;
  FieldSamplingOptions how;
  how.tolerance = tolerance;
  const FieldSampling sampling(library, kRadius, material, {}, how);
  const double sampled = seconds() - start;
  const StiffnessField field(library->surface(), sampling, {}, kRadius, kThreads);
  const double wall = seconds() - start;
  const double processor = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;

  Random random(12345);
  const std::vector<Vec3> places = random_places(*library, count, random);
  const auto truth =
      library->sample(places, material.solid, material.description, ContactLevel::kFine, false);
  const SurfaceTree tree(field.surface());
  std::vector<std::pair<double, std::size_t>> errors;
  std::vector<double> stated(places.size(), 0);
  double squares = 0;
  int covered = 0, refused = 0, flagged = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const SurfacePoint at = tree.nearest(places[i]);
    const FieldEntry live = field.entry_at(field.locate(at.face, at.point));
    if (!truth[i]) {
      ++refused;
      flagged += live.sampled ? 0 : 1;
      continue;
    }
    const Vec3 u = Vec3(random.normal(), random.normal(), random.normal()).normalized();
    const double error = ((live.K - truth[i]->K) * u).norm() / (truth[i]->K * u).norm();
    squares += error * error;
    stated[i] = live.uncertainty * direction_doubt(live.K, u);
    covered += error <= 1.96 * stated[i] ? 1 : 0;
    errors.emplace_back(error, i);
  }
  std::sort(errors.begin(), errors.end());
  const auto n = static_cast<double>(errors.size());
  fmt::print(
      "{:12} {:6.3f} {:7} {:7} {:6.1f} {:6.1f} {:6.1f} {:7.2f}% {:6.2f}% {:6.2f}% {:6.2f}% "
      "{:6.1f}% {:5}/{}\n",
      name.substr(name.find_last_of('/') + 1), nu, field.samples(), field.entries().size(), sampled,
      wall, processor, 100 * field.expected_error(), 100 * std::sqrt(squares / n),
      100 * errors[static_cast<std::size_t>(0.95 * n)].first, 100 * errors.back().first,
      100 * covered / n, flagged, refused);
  if (std::getenv("HAPSIM_BENCH_WORST") != nullptr) {
    options.rim_edge = kRimEdge / 2;
    const ContactLibrary finer(body, kRadius, options);
    for (std::size_t k = 0; k < 6; ++k) {
      const auto& [error, i] = errors[errors.size() - 1 - k];
      const auto better = finer.sample({places[i]}, material.solid, material.description,
                                       ContactLevel::kFine, false);
      const SurfacePoint at = tree.nearest(places[i]);
      const Eigen::Matrix3d live = field.entry_at(field.locate(at.face, at.point)).K;
      const auto apart = [&](const Eigen::Matrix3d& K) {
        return better[0] ? 100 * (K - better[0]->K).norm() / better[0]->K.norm() : NAN;
      };
      fmt::print(
          "    {:.1f} % (stated {:.1f} %) at ({:.4f}, {:.4f}, {:.4f}); of half the edges batch is "
          "{:.1f} % off, live {:.1f} %\n",
          100 * error, 100 * stated[i], places[i].x(), places[i].y(), places[i].z(),
          apart(truth[i]->K), apart(live));
    }
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  const int count = words.empty() ? 200 : std::atoi(words[0].c_str());
  std::vector<double> nus;
  const std::string list = words.size() > 1 ? words[1] : "0.3,0.45,0.49,0.499";
  for (std::size_t i = 0; i < list.size();) {
    const std::size_t end = std::min(list.find(',', i), list.size());
    nus.push_back(std::atof(list.substr(i, end - i).c_str()));
    i = end + 1;
  }
  const double tolerance = words.size() > 2 ? std::atof(words[2].c_str()) : 0.02;
  std::vector<std::string> bodies{"block", "ball", "organ"};
  if (words.size() > 3) bodies.assign(words.begin() + 3, words.end());
  prepare_blas_for_many_threads();
  fmt::print("{:12} {:>6} {:>7} {:>7} {:>6} {:>6} {:>6} {:>8} {:>7} {:>7} {:>7} {:>7} {:>7}\n",
             "body", "nu", "samples", "entries", "sampl.", "wall s", "cpu s", "expects", "rms",
             "95 %", "worst", "covers", "flagged");
  for (const std::string& body : bodies)
    for (const double nu : nus) measure(body, nu, count, tolerance);
}
