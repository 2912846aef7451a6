// The thesis's block with regions in plan view: location samples, clusters, boundary, refined
// model.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>

#include "cases.h"
#include "fit/boundary_fit.h"
#include "fit/extend.h"
#include "fit/location_fit.h"
#include "regions/region_map.h"
#include "support/finer_contact.h"
#include "truth.h"

namespace hapsim::bench {
namespace {

constexpr double kModulus = 1.4e4, kPoisson = 0.4, kDepth = 3e-3;

struct Regions {
  std::string name;
  std::vector<double> factor;  // moduli over kModulus
  // Height of the boundaries between them, ascending in y [m].
  std::vector<std::function<double(double x)>> boundary;
  int of(const Vec3& p) const {
    int r = 0;
    for (const auto& y : boundary) r += p.y() > y(p.x());
    return r;
  }
};

struct Setting {
  Regions truth;
  Object object;
  std::vector<TruePress> presses;
  std::vector<Vec3> forces;
  double noise = 0;
  std::optional<Experiment> undrawn;  // without forces
};

std::shared_ptr<Setting> make_setting(const Regions& truth, const std::string& out) {
  auto s = std::make_shared<Setting>();
  s->truth = truth;
  s->object = make_object("block");
  std::vector<Vec3> positions;
  for (int j = 0; j < 5; ++j)
    for (int i = 0; i < 4; ++i) positions.push_back({0.015 + 0.03 * i, 0.021 + 0.042 * j, 0.06});
  Material material;
  material.nu = kPoisson;
  material.modulus = truth.factor;
  material.group_of = [truth](const Vec3& p) { return truth.of(p); };
  const auto K = true_stiffness(out, "block-" + truth.name, s->object, positions, material);
  for (std::size_t p = 0; p < positions.size(); ++p)
    s->presses.push_back({static_cast<int>(p), {0, 0, -kDepth}, 1, 0});
  Recording r = record(positions, s->presses, 0, 25);  // 500 samples
  s->forces = true_forces(r, s->presses, K, kModulus, {});
  s->noise = 0.01 * peak(s->forces);
  ExperimentOptions options;
  options.cache = out + "/cache";
  options.threads = 1;
  options.noise = s->noise;
  options.nu_low = options.nu_high = kPoisson;  // normal presses do not tell it: known
  s->undrawn = make_experiment(s->object.meshed, std::move(r), options);
  return s;
}

// Mean distance of the boundary that was found from the true one, in plan view [m].
double boundary_error(const std::vector<BoundaryLine>& lines, const Regions& truth) {
  double sum = 0;
  int count = 0;
  for (const auto& y : truth.boundary)
    for (int i = 0; i <= 100; ++i, ++count) {
      const double x = 0.12 * i / 100;
      sum += distance_to(lines, {x, y(x)});
    }
  return count > 0 ? sum / count : 0;
}

std::vector<Result> trial(const std::string& name, const Setting& s, int draw) {
  Random random(static_cast<std::uint64_t>(draw));
  const Experiment w = measured(*s.undrawn, s.presses, s.forces, 0, s.noise, random);
  const Selection all = all_episodes(w.dataset);
  const FitOptions options{s.noise, w.floor, true};
  Model start = elastic_model(w, all);
  Parameter& nu = *start.find("elastic", 0, "nu");
  nu.value = kPoisson;
  nu.state = ParameterState::kFixed;
  const Fit plain = fit(start, w, all, options);
  const LocationTable table = fit_locations(plain.model, w, options);
  const RegionEstimate regions = estimate_regions(table, {});
  const int count = static_cast<int>(regions.value.size());
  const double none = std::nan("");
  const int wanted = static_cast<int>(s.truth.factor.size());
  std::vector<Result> results{{name, draw, "regions", double(wanted), double(count), none, 0.5}};
  if (wanted == 1) return results;
  int right = 0;  // regions ascend in E, and so do the true ones
  for (std::size_t i = 0; i < table.size(); ++i)
    right += regions.label[i] == s.truth.of(table.point[i]);
  results.push_back({name, draw, "classified", 20, double(right), none, 0.5});
  results.push_back({name, draw, "cophenetic", 1, regions.correlation, none, 0.1});
  if (count != wanted) return results;
  const PlaneClassifier classify = region_classifier(table, regions.label, count, RegionRule::kQda);
  const auto lines = region_boundaries(classify, table, s.object.meshed, 20000);
  results.push_back({name, draw, "QDA mm", 0, 1e3 * boundary_error(lines, s.truth), none, 6});
  Model refined = region_model(table, regions, classify, lines, 8);
  refined.find("elastic", 0, "nu")->state = ParameterState::kFixed;
  const Fit first = fit(refined, w, all, options);
  results.push_back({name, draw, "QDA rmse N", 0, first.error.pooled, none, 0.1});
  BoundaryOptions boundary;
  boundary.threads = 1;
  boundary.fit = options;
  const BoundaryFit moved = refine_boundaries(first, w, s.object.meshed, boundary);
  results.push_back(
      {name, draw, "refined mm", 0, 1e3 * boundary_error(moved.lines, s.truth), none, 6});
  const Fit& fitted = moved.fitted;
  results.push_back({name, draw, "rmse N", 0, fitted.error.pooled, none, 0.1});
  results.push_back({name, draw, "noise N", 0, s.noise, none, 0});
  for (int r = 0; r < count; ++r) {
    const Parameter& e = *fitted.model.find("elastic", r, "E");
    results.push_back({name, draw, fmt::format("E of {}", r), kModulus * s.truth.factor[r], e.value,
                       e.std_error, 0});
  }
  return results;
}

}  // namespace

std::vector<Case> region_cases() {
  const auto wave = [](double x) { return 0.105 + 0.022 * std::sin(45 * x + 0.4); };
  const std::vector<Regions> all{{"one", {1.5}, {}},
                                 {"two", {1, 2.5}, {wave}},
                                 {"three",
                                  {1, 2.5, 5},
                                  {[](double x) { return 0.08 + 0.1 * (x - 0.06); },
                                   [](double x) { return 0.13 + 3 * (x - 0.06) * (x - 0.06); }}}};
  std::vector<Case> cases;
  for (const Regions& truth : all) {
    const std::string name = "regions: " + truth.name;
    cases.push_back({name, 5, [=](const std::string& out) -> Draw {
                       const auto s = make_setting(truth, out);
                       return [=](int draw) { return trial(name, *s, draw); };
                     }});
  }
  return cases;
}

}  // namespace hapsim::bench
