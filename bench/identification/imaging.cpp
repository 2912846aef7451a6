// A stiff ball of 12 mm below a grid of 49 positions, 10 mm apart.
#include <cmath>
#include <ctime>
#include <memory>
#include <optional>

#include "cases.h"
#include "contact/field_stiffness.h"
#include "fit/extend.h"
#include "imaging/stiffness_image.h"
#include "support/block_mesh.h"
#include "tetmesh/body_mesh.h"
#include "truth.h"

namespace hapsim::bench {
namespace {

constexpr double kModulus = 1e4, kPoisson = 0.45, kDepth = 3e-3, kRatio = 5, kRadius = 6e-3;

struct Setting {
  Vec3 centre;
  Object object;
  std::vector<TruePress> presses;
  std::vector<Vec3> forces;
  std::optional<Experiment> undrawn;  // without forces
};

std::shared_ptr<Setting> make_setting(const std::string& name, double depth,
                                      const std::string& out) {
  auto s = std::make_shared<Setting>();
  s->object.name = name;
  s->object.exact = test::block_mesh({0.12, 0.12, 0.06}, 12, 12, 6, 1);
  s->object.meshed = make_body_mesh(boundary_surface(s->object.exact), {}, name);
  s->centre = {0.0632, 0.0578, 0.06 - depth};
  std::vector<Vec3> positions;
  for (int j = 0; j < 7; ++j)
    for (int i = 0; i < 7; ++i) positions.push_back({0.03 + 0.01 * i, 0.03 + 0.01 * j, 0.06});
  Material material;
  material.nu = kPoisson;
  material.features.push_back(
      {Feature::kInclusion, {s->centre.x(), s->centre.y(), s->centre.z(), kRadius, kRatio}});
  const auto K = true_stiffness(out, name, s->object, positions, material);
  for (std::size_t p = 0; p < positions.size(); ++p)
    for (const double slant : {0.0, 0.5, -0.5}) {
      const Vec3 side = p % 2 == 0 ? Vec3::UnitX() : Vec3::UnitY();
      s->presses.push_back({static_cast<int>(p), kDepth * (-Vec3::UnitZ() + slant * side), 1, 0});
    }
  Recording r = record(positions, s->presses, 0);
  s->forces = true_forces(r, s->presses, K, kModulus, {});
  ExperimentOptions options;
  options.cache = out + "/cache";
  options.noise = 0.01 * peak(s->forces);
  options.nu_low = options.nu_high = kPoisson;
  s->undrawn = make_experiment(s->object.meshed, std::move(r), options);
  return s;
}

// Processor time of forces with the derivatives by all nodes over that of the forces alone.
double cost_of_gradient(const Setting& s) {
  FieldGrid grid;
  grid.low = {0.02, 0.02, 0.02};
  grid.step = 0.01;
  grid.count = {10, 10, 5};  // 500
  FieldBody body(make_contact_base(s.object.meshed), s.undrawn->dataset.positions[24], kToolRadius,
                 kRimEdge * kToolRadius, kGrowth, grid);
  const Eigen::VectorXd field = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(grid.size()));
  const auto seconds = [&](bool derivatives) {
    double least = 1e300;
    for (int k = 0; k < 5; ++k) {
      const std::clock_t begin = std::clock();
      const auto solution = body.solve(kPoisson, field, derivatives);
      if (derivatives) body.by_node(solution);
      least = std::min(least, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    return least;
  };
  seconds(false);
  const double alone = seconds(false);
  return seconds(true) / alone;
}

// Of this thread: draws run side by side.
double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A standard error whose 95 % are as wide.
double standard(const Interval& in) {
  return (in.high - in.low) / (2 * 1.96);
}

std::vector<Result> trial(const std::string& name, const Setting& s, bool seen, int draw) {
  const double begin = thread_seconds();
  const double noise = s.undrawn->noise.value;
  Random random(static_cast<std::uint64_t>(draw));
  const Experiment w = measured(*s.undrawn, s.presses, s.forces, 0, noise, random);
  const Selection all = all_episodes(w.dataset);
  Model model = elastic_model(w, all);
  Parameter& nu = *model.find("elastic", 0, "nu");
  nu.value = kPoisson;
  nu.state = ParameterState::kFixed;
  const Fit fitted = fit(model, w, all, {noise, w.floor, true});
  ImageOptions options;
  options.threads = 1;
  const StiffnessImage image =
      stiffness_image(fitted.model, w, fitted.about, s.object.meshed, options);
  const double none = std::nan("");
  std::vector<Result> results{
      {name, draw, "balls", seen ? 1.0 : 0.0, double(image.lumps.size()), none, 0.5},
      {name, draw, "cpu s", 0, thread_seconds() - begin, none, 30},
      {name, draw, "error %", 0, 100 * image.error, none, 0},
      {name, draw, "field left", 0, 100 * image.field.held_out, none, 0}};
  for (const Sight& sight : image.found.sight)
    if (sight.radius == kRadius && sight.ratio == kRatio)
      results.push_back({name, draw, "sight mm", 0, 1e3 * sight.depth, none, 0});
  if (draw == 1) results.push_back({name, draw, "gradient", 1, cost_of_gradient(s), none, 0.5});
  if (image.lumps.empty()) return results;
  const Lump& ball = image.lumps.front();
  const Vec3 off = ball.centre - s.centre;
  results.push_back({name, draw, "sideways mm", 0, 1e3 * off.head<2>().norm(), none, 4});
  results.push_back({name, draw, "depth mm", 1e3 * (0.06 - s.centre.z()),
                     1e3 * (0.06 - ball.centre.z()), 1e3 * standard(ball.depth_in), 4});
  results.push_back({name, draw, "radius mm", 1e3 * kRadius, 1e3 * ball.radius,
                     1e3 * standard(ball.radius_in), 0});
  results.push_back({name, draw, "ratio", kRatio, ball.ratio, standard(ball.ratio_in), 0});
  return results;
}

}  // namespace

std::vector<Case> imaging_cases() {
  std::vector<Case> cases;
  const auto add = [&](const std::string& name, double depth, bool seen) {
    cases.push_back({name, 10, [=](const std::string& out) -> Draw {
                       const auto s = make_setting(name, depth, out);
                       return [=](int draw) { return trial(name, *s, seen, draw); };
                     }});
  };
  add("ball-11-mm", 0.011, true);
  add("ball-30-mm", 0.030, false);
  return cases;
}

}  // namespace hapsim::bench
