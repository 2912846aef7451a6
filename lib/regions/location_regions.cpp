#include "regions/location_regions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/error.h"
#include "cluster/pca.h"
#include "regions/border_samples.h"

namespace hapsim {
namespace {

struct Features {
  Eigen::MatrixXd value, error;  // samples x parameters
};

Features features_of(const LocationTable& t, const RegionOptions& options) {
  const bool with_nu = options.use_nu && t.nu_std.front() > 0;
  const auto n = static_cast<Eigen::Index>(t.size());
  Features f{Eigen::MatrixXd(n, with_nu ? 2 : 1), Eigen::MatrixXd(n, with_nu ? 2 : 1)};
  for (Eigen::Index i = 0; i < n; ++i) {
    f.value(i, 0) = std::log(t.E[i]);
    f.error(i, 0) = t.E_std[i] / t.E[i];
    if (!with_nu) continue;
    f.value(i, 1) = t.nu[i];
    f.error(i, 1) = t.nu_std[i];
  }
  if (options.components == 0) return f;
  if (options.components > f.value.cols())
    fail_usage(fmt::format("--components {} is more than the {} parameters of a sample",
                           options.components, f.value.cols()),
               "ask for fewer");
  const Eigen::RowVectorXd unit = f.error.array().square().colwise().mean().sqrt();
  f.value = (f.value.array().rowwise() / unit.array()).eval();
  f.error = (f.error.array().rowwise() / unit.array()).eval();
  const PrincipalComponents pc = principal_components(f.value);
  return {project(pc, f.value, options.components),
          project_errors(pc, f.error, options.components)};
}

// Thesis Algorithm 5.2, accepting above the threshold: the first linkage that keeps the distances,
// else the one that keeps them best.
void choose_linkage(const Eigen::MatrixXd& distances, const RegionOptions& options,
                    RegionEstimate& result) {
  bool first = true;
  for (const Linkage linkage :
       {Linkage::kAverage, Linkage::kWard, Linkage::kComplete, Linkage::kSingle}) {
    if (options.linkage && *options.linkage != linkage) continue;
    Dendrogram tree = agglomerate(distances, linkage);
    const double correlation = cophenetic_correlation(distances, tree);
    if (!first && !(correlation > result.correlation)) continue;
    first = false;
    result.linkage = linkage;
    result.correlation = correlation;
    result.tree = std::move(tree);
    if (correlation >= options.least_correlation) return;
  }
}

struct Mean {
  double value, error;
};
Mean weighted_mean(const std::vector<double>& values, const std::vector<double>& errors) {
  double weight = 0, sum = 0, squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    weight += 1 / (errors[i] * errors[i]);
    sum += values[i] / (errors[i] * errors[i]);
  }
  for (std::size_t i = 0; i < values.size(); ++i)
    squares += std::pow((values[i] - sum / weight) / errors[i], 2);
  const double freedom = std::max(1.0, static_cast<double>(values.size()) - 1);
  return {sum / weight, std::sqrt(std::max(1.0, squares / freedom) / weight)};
}

RegionValue region_value(const LocationTable& t, const std::vector<int>& label, int region) {
  RegionValue result;
  std::vector<double> log_e, log_error, nu, nu_error;
  const bool held = t.nu_std.front() == 0;
  for (std::size_t i = 0; i < label.size(); ++i) {
    if (label[i] != region) continue;
    ++result.samples;
    log_e.push_back(std::log(t.E[i]));
    log_error.push_back(t.E_std[i] / t.E[i]);
    nu.push_back(t.nu[i]);
    nu_error.push_back(held ? 1 : t.nu_std[i]);
  }
  const Mean e = weighted_mean(log_e, log_error), v = weighted_mean(nu, nu_error);
  result.E = std::exp(e.value);
  result.E_std = result.E * e.error;
  result.nu = v.value;
  result.nu_std = held ? 0 : v.error;
  return result;
}

// A sample that the natural division leaves alone joins the cluster that is nearest on average: it
// is more often a press across a boundary than a region. Returns how many did.
int join_lone_samples(const Eigen::MatrixXd& distances, std::vector<int>& label) {
  const int clusters = 1 + *std::max_element(label.begin(), label.end());
  std::vector<int> size(clusters, 0);
  for (const int k : label) ++size[k];
  if (*std::max_element(size.begin(), size.end()) < 2) return 0;
  const std::vector<int> before = label;
  int joined = 0;
  for (std::size_t i = 0; i < label.size(); ++i) {
    if (size[before[i]] > 1) continue;
    std::vector<double> sum(clusters, 0);
    for (std::size_t j = 0; j < label.size(); ++j)
      sum[before[j]] += distances(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    double least = std::numeric_limits<double>::infinity();
    for (int k = 0; k < clusters; ++k)
      if (size[k] > 1 && sum[k] / size[k] < least) least = sum[k] / size[k], label[i] = k;
    ++joined;
  }
  return joined;
}

// Clusters that are empty are left out, in order of their first samples.
void number_anew(std::vector<int>& label) {
  std::vector<int> number(1 + *std::max_element(label.begin(), label.end()), -1);
  int next = 0;
  for (int& k : label) {
    if (number[k] < 0) number[k] = next++;
    k = number[k];
  }
}

}  // namespace

RegionEstimate estimate_regions(const LocationTable& table, const RegionOptions& options) {
  if (options.regions > static_cast<int>(table.size()))
    fail_input(
        "", fmt::format("--regions {} is more than the {} samples", options.regions, table.size()),
        "ask for fewer regions, or press at more places");
  const Features f = features_of(table, options);
  RegionEstimate result;
  const Eigen::MatrixXd distances = scaled_distances(f.value, f.error);
  choose_linkage(distances, options, result);
  std::vector<int> label;
  if (options.regions > 0) {
    label = cut(result.tree, options.regions);
  } else {
    Random random(options.seed);
    DivisionOptions division;
    division.significance = options.significance;
    Division d = natural_division(f.value, f.error, result.linkage, random, division);
    label = std::move(d.label);
    result.tests = std::move(d.tests);
    result.joined = join_lone_samples(distances, label);
    number_anew(label);
    const Eigen::Map<const Eigen::ArrayXd> E(table.E.data(),
                                             static_cast<Eigen::Index>(table.size()));
    result.bordering = dissolve_borders(table.point, E.log(), label);
    number_anew(label);
  }
  const int regions = 1 + *std::max_element(label.begin(), label.end());
  std::vector<RegionValue> value;
  for (int r = 0; r < regions; ++r) value.push_back(region_value(table, label, r));
  std::vector<int> order(regions), rank(regions);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return value[a].E < value[b].E; });
  for (int k = 0; k < regions; ++k) rank[order[k]] = k;
  for (const int k : label) result.label.push_back(rank[k]);
  for (const int r : order) result.value.push_back(value[r]);
  return result;
}

const char* linkage_name(Linkage linkage) {
  switch (linkage) {
    case Linkage::kAverage:
      return "average";
    case Linkage::kWard:
      return "ward";
    case Linkage::kComplete:
      return "complete";
    case Linkage::kSingle:
      return "single";
  }
  return "";
}

}  // namespace hapsim
