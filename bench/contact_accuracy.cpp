// How right the stiffness of a contact position is: the graded mesh that the models are made of
// against the converged one, on a block, a ball and an organ-like lump, the last two finely
// triangulated. Prints one row an object and Poisson's ratio: triangles of the body, the largest
// and the median mesh, what the body costs once and a position costs with one thread (its mesh; all
// of it: finer and coarser mesh, each factorised and solved); elements of the reference, worst and
// median error of the normal stiffness, worst of the sideways one, median and largest mesh
// uncertainty as stated, in how many positions it covers the error, and how many are as good as
// asked for.
//
//   bench_contact_accuracy [positions an object, default 20 [surface file (m)...]]
//   bench_contact_accuracy --elements [positions [surface file...]]: no errors, so in seconds
//
// The reference has half of every length: the edges of the surface with what it may stray from the
// body's own, the edges at the rim and their growth with the distance. Thirds instead of halves
// move the errors by 0.07 % of the stiffness.
// Recorded in bench/results/contact-accuracy*.txt (bench/record.sh).
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "base/blas.h"
#include "base/median.h"
#include "contact/contact_stiffness.h"
#include "formats/surface_io.h"
#include "solid/elastic_body.h"
#include "support/block_mesh.h"
#include "support/finer_contact.h"
#include "support/objects.h"
#include "tetmesh/body_mesh.h"

namespace {

using namespace hapsim;

constexpr double kToolRadius = 0.004;  // [m]
constexpr double kLimit = 0.015;       // relative error that is asked for

struct Object {
  std::string name;
  TetMesh body;
};

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

TetMesh body_of(const Surface& surface) {
  BodyOptions options;
  options.preserve_surface = true;
  return make_body_mesh(surface, options);
}

struct Reference {
  Eigen::Matrix3d K[2];
  std::size_t elements = 0;
};

Reference reference_at(const ContactBase& base, const Vec3& position, const double (&nus)[2]) {
  const ContactMesh contact = test::finer_mesh(base, position, kToolRadius);
  std::vector<int> handle(contact.mesh.nodes.size(), kFreeNode);
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (contact.mesh.fixed[n]) handle[n] = kHeldNode;
  for (const int n : contact.patch_nodes) handle[n] = 0;
  ElasticBody body(contact.mesh, handle, Dilatation::kElement);
  Reference result;
  result.elements = contact.mesh.tets.size();
  for (int k = 0; k < 2; ++k) {
    body.factorise(std::vector<Lame>(contact.mesh.tets.size(), lame(1, nus[k])));
    result.K[k] = body.solve(Eigen::Matrix3d::Identity()).reaction;
  }
  return result;
}

std::vector<Reference> references(const TetMesh& body, const std::vector<Vec3>& positions,
                                  const double (&nus)[2]) {
  const ContactBase base = test::finer_base(body);
  std::vector<Reference> result(positions.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t p = next++; p < positions.size(); p = next++)
      result[p] = reference_at(base, positions[p], nus);
  };
  std::thread other(work);
  work();
  other.join();
  return result;
}

struct Counts {
  int covered = 0, good = 0, all = 0;
};

void measure(const Object& object, int count, bool errors, Counts& counts) {
  const double nus[2] = {0.3, 0.45};
  const double start = seconds();
  const ContactBase base = make_contact_base(object.body);
  const double base_seconds = seconds() - start;
  const PlanGrid grid = plan_grid(base.surface);
  const std::vector<Vec3> positions = test::positions_on(object.body, count, 5, kToolRadius);
  std::vector<Reference> reference;
  if (errors) reference = references(object.body, positions, nus);
  std::vector<std::vector<StiffnessSolution>> usual(2);
  std::vector<double> elements, mesh_seconds, all_seconds;
  for (const Vec3& p : positions) {
    double begin = seconds();
    elements.push_back(static_cast<double>(
        make_contact_mesh(base, p, kToolRadius, kRimEdge * kToolRadius, kGrowth).mesh.tets.size()));
    mesh_seconds.push_back(seconds() - begin);
    begin = seconds();
    ContactBodies bodies(base, p, kToolRadius);
    usual[0].push_back(bodies.solve({nus[0], {1.0}, nullptr}, grid));
    all_seconds.push_back(seconds() - begin);
    if (errors) usual[1].push_back(bodies.solve({nus[1], {1.0}, nullptr}, grid));
  }
  for (int k = 0; k < (errors ? 2 : 1); ++k) {
    double worst = 0, worst_side = 0;
    int covered = 0, good = 0;
    std::vector<double> off, stated;
    for (std::size_t p = 0; p < positions.size(); ++p) {
      const StiffnessSolution& s = usual[k][p];
      stated.push_back(mesh_uncertainty(s));
      if (!errors) continue;
      const Eigen::Matrix3d& R = reference[p].K[k];
      const Vec3 n = s.normal, side = n.unitOrthogonal();
      const double error = n.dot(s.K * n) / n.dot(R * n) - 1;
      off.push_back(std::abs(error));
      worst = std::max(worst, std::abs(error));
      worst_side = std::max(worst_side, std::abs(side.dot(s.K * side) / side.dot(R * side) - 1));
      covered += std::abs(error) <= stated.back();
      good += std::abs(error) <= kLimit;
    }
    counts.covered += covered;
    counts.good += good;
    counts.all += errors ? count : 0;
    fmt::print("{:16} {:7} {:9.0f} {:7.0f} {:7.2f} {:7.2f} {:7.2f}", object.name,
               base.fine.faces.size(), *std::max_element(elements.begin(), elements.end()),
               median(elements), base_seconds, median(mesh_seconds), median(all_seconds));
    std::size_t most = 0;
    for (const Reference& r : reference) most = std::max(most, r.elements);
    if (errors)
      fmt::print(" {:9} {:5.2f} {:6.2f}% {:6.2f}% {:6.2f}% {:6.2f}% {:6.2f}% {:4}/{:<3} {:4}/{:<3}",
                 most, nus[k], 100 * worst, 100 * median(off), 100 * worst_side,
                 100 * median(stated), 100 * *std::max_element(stated.begin(), stated.end()),
                 covered, count, good, count);
    fmt::print("\n");
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  const bool errors = words.empty() || words[0] != "--elements";
  if (!errors) words.erase(words.begin());
  const int count = words.empty() ? 20 : std::atoi(words[0].c_str());
  prepare_blas_for_many_threads();
  std::vector<Object> objects;
  if (words.size() < 2) {
    objects.push_back({"block", test::block_mesh({0.12, 0.21, 0.06}, 12, 21, 6, 1)});
    objects.push_back({"ball", body_of(test::half_ball(35))});
    objects.push_back({"organ", body_of(test::lump(50))});
  }
  for (std::size_t i = 1; i < words.size(); ++i) {
    Input input(words[i]);
    const auto name = words[i].substr(words[i].find_last_of('/') + 1);
    objects.push_back({name, body_of(read_surface(input))});
  }
  fmt::print("blas: {}; tool radius {} m; {} positions an object\n", blas_name(), kToolRadius,
             count);
  fmt::print("{:16} {:>7} {:>9} {:>7} {:>7} {:>7} {:>7}", "object", "faces", "elements", "median",
             "base s", "mesh s", "all s");
  if (errors)
    fmt::print(" {:>9} {:>5} {:>7} {:>7} {:>7} {:>7} {:>7} {:>8} {:>8}", "reference", "nu", "worst",
               "median", "side", "stated", "most", "covered", "in 1.5 %");
  fmt::print("\n");
  Counts counts;
  for (const Object& object : objects) measure(object, count, errors, counts);
  if (errors)
    fmt::print("the stated uncertainty covers the error in {} of {}; within 1.5 %: {}\n",
               counts.covered, counts.all, counts.good);
}
