#include "fit/extend_regions.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "effects/catalogue.h"
#include "experiment/labels.h"
#include "model/body_parameters.h"
#include "regions/region_boundary.h"
#include "regions/region_map.h"

namespace hapsim {
namespace {

constexpr int kOldBoundaryPoints = 20000;  // of a boundary

Model with_labels(const Model& fitted, const std::vector<LocationSample>& samples,
                  const std::vector<int>& label) {
  const int regions = 1 + *std::max_element(label.begin(), label.end());
  std::vector<double> weight(regions, 0), log_gain(regions, 0);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double w = std::pow(samples[i].gain / samples[i].error, 2);
    weight[label[i]] += w;
    log_gain[label[i]] += w * std::log(samples[i].gain);
  }
  for (int r = 0; r < regions; ++r) log_gain[r] /= weight[r];
  Model model = with_moduli(fitted, log_gain);
  KeyPoints points(model);
  for (int r = 0; r < regions; ++r)
    for (std::size_t i = 0; i < samples.size(); ++i)
      if (label[i] == r) points.add(samples[i].point.head<2>(), r);
  return model;
}

// Nothing where no boundary lies on the body.
std::optional<Model> with_boundary(const Model& fitted, const RegionBoundary& boundary,
                                   const PlanGrid& grid) {
  Model model = with_moduli(fitted, {boundary.log_gain[0], boundary.log_gain[1]});
  const Eigen::Vector2d low(grid.x0, grid.y0);
  const Eigen::Vector2d high =
      low + Eigen::Vector2d(grid.columns * grid.step_x, grid.rows * grid.step_y);
  const auto lines = class_boundaries(boundary.side, low, high, kOldBoundaryPoints);
  if (lines.empty()) return std::nullopt;
  place_key_points(model, boundary.side, lines, boundary.keys);
  if (material_of(model).key_point.size() < 2) return std::nullopt;
  return model;
}

// One modulus for each number of the bodies' tetrahedra, all alike; what no tetrahedron is of is
// not fitted.
Model with_body_labels(const Fit& base, const Experiment& experiment) {
  std::set<int> numbers;
  for (std::size_t s = 0; s < experiment.places.setups(); ++s)
    if (const auto& labels = experiment.places.setup(s)->labels())
      numbers.insert(labels->numbers().begin(), labels->numbers().end());
    else
      numbers.insert(0);
  if (numbers == std::set<int>{0})
    fail_input("", "all tetrahedra of the body are of region 0",
               "number them (hs-tetmesh --region tumour.stl), or leave out --regions labels");
  for (const int region : numbers) require_label(region);
  Model model = base.model;
  const Parameter modulus = *modulus_of(model);
  for (const int region : numbers) {
    if (modulus_of(model, region) != nullptr) continue;
    Parameter added = modulus;
    added.region = region;
    const auto last = std::find_if(model.parameters.rbegin(), model.parameters.rend(), is_modulus);
    model.parameters.insert(last.base(), added);
  }
  if (numbers.count(0) == 0) modulus_of(model)->state = ParameterState::kFixed;
  if (model.has(map_effect().card().name))
    fail_usage("the model has regions in plan view already, beside which labels do not act",
               "remove them first (--remove " + map_effect().card().name + ")");
  return model;
}

}  // namespace

Model with_moduli(const Model& fitted, const std::vector<double>& log_gain) {
  Model model = fitted;
  const Parameter modulus = *modulus_of(fitted);
  std::erase_if(model.parameters, [](const Parameter& p) { return is_modulus(p) && p.region > 0; });
  for (std::size_t r = 0; r < log_gain.size(); ++r) {
    const int region = static_cast<int>(r);
    const double value = modulus.value * std::exp(log_gain[r]);
    if (Parameter* row = modulus_of(model, region)) {
      row->value = value;
      continue;
    }
    Parameter added = modulus;
    added.region = region;
    added.value = value;
    const auto last = std::find_if(model.parameters.rbegin(), model.parameters.rend(), is_modulus);
    model.parameters.insert(last.base(), added);
  }
  return model;
}

Model with_regions(const Fit& base, const Experiment& experiment, const Selection& selection,
                   const ExtendOptions& options) {
  if (options.regions == kByLabel) return with_body_labels(base, experiment);
  if (experiment.places.has_labels(material_of(base.model)))
    fail_usage("the model has regions that are the body's own, beside which none in plan view act",
               "take E of all regions but 0 out of the model first");
  constexpr int kMost = 8;  // groups tried; the criterion decides how many there are
  const auto samples = merged_places(location_samples(base.model, experiment, base.about, selection,
                                                      {options.noise, options.floor}));
  const RegionLabels labels = region_labels(samples, options.regions, kMost);
  if (options.regions == kAutomaticRegions && !samples.empty()) {
    std::vector<std::vector<float>> share;
    for (const LocationSample& s : samples)
      share.push_back(experiment.places.contact(static_cast<std::size_t>(s.position)).plan_share);
    const PlanGrid grid = experiment.places.setup(0)->grid();
    const auto boundary = find_boundary(samples, share, grid);
    const bool more = *std::max_element(labels.label.begin(), labels.label.end()) > 1;
    if (boundary && boundary->criterion < labels.criterion + (more ? kStrongEvidence : 0))
      if (auto model = with_boundary(base.model, *boundary, grid)) return *model;
  }
  Model model = with_labels(base.model, samples, labels.label);
  if (options.regions == kEverySite) {
    // So many neighbouring moduli cannot be told apart through the body; each stands for its site.
    Parameter local = effect_rows(map_effect(), 1, {0, 0, 1}).back();
    local.name = "local";
    local.state = ParameterState::kFixed;
    model.parameters.push_back(local);
  }
  return model;
}

}  // namespace hapsim
