#include "regions/locations.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "cluster/clustering.h"
#include "effects/catalogue.h"

namespace hapsim {

std::vector<LocationSample> location_samples(const Model& model, const Experiment& experiment,
                                             const Linearisation& about, const Selection& selection,
                                             const Allowance& allowance) {
  const Dataset& dataset = experiment.dataset;
  const auto& [noise, floor] = allowance;
  Model without_sensor = model;
  std::erase_if(without_sensor.parameters, [](const Parameter& p) {
    return require_effect(p.effect).card().stage == Stage::kSensor;
  });
  const Eigen::VectorXd full = model_forces(model, experiment, about, selection, false).f;
  const Eigen::VectorXd f = model_forces(without_sensor, experiment, about, selection, false).f;
  const Eigen::VectorXd target = measured_forces(dataset, selection) - (full - f);

  struct Sums {
    double ff = 0, ft = 0, tt = 0;
    double n = 0;
  };
  std::vector<Sums> sums(dataset.positions.size());
  Eigen::Index at = 0;
  for (const int e : selection) {
    const Eigen::Index n = 3 * static_cast<Eigen::Index>(dataset.episodes[e].rows.size());
    Sums& s = sums[dataset.episodes[e].position];
    s.ff += f.segment(at, n).squaredNorm();
    s.ft += f.segment(at, n).dot(target.segment(at, n));
    s.tt += target.segment(at, n).squaredNorm();
    s.n += static_cast<double>(n);
    at += n;
  }
  std::vector<LocationSample> samples;
  for (std::size_t p = 0; p < sums.size(); ++p) {
    const Sums& s = sums[p];
    if (s.ff <= 0) continue;
    LocationSample sample{static_cast<int>(p), dataset.positions[p], s.ft / s.ff, 0};
    const double variance =
        std::max(noise * noise, (s.tt - s.ft * s.ft / s.ff) / std::max(1.0, s.n - 1));
    sample.gain = std::max(sample.gain, 1e-3);  // a modulus is positive
    sample.error = std::hypot(std::sqrt(variance / s.ff), dataset.floor_at(p, floor) * sample.gain);
    samples.push_back(sample);
  }
  return samples;
}

std::vector<LocationSample> merged_places(const std::vector<LocationSample>& samples) {
  std::vector<LocationSample> merged;
  for (const LocationSample& s : samples) {
    const auto known = std::find_if(merged.begin(), merged.end(), [&](const LocationSample& m) {
      return (m.point - s.point).norm() <= kSamePlace;
    });
    if (known == merged.end()) {
      merged.push_back(s);
      continue;
    }
    const double a = std::pow(known->gain / known->error, 2), b = std::pow(s.gain / s.error, 2);
    known->gain = std::exp((a * std::log(known->gain) + b * std::log(s.gain)) / (a + b));
    known->error = known->gain / std::sqrt(a + b);
  }
  return merged;
}

double labels_criterion(const std::vector<LocationSample>& samples, const std::vector<int>& label) {
  const std::size_t n = samples.size();
  std::map<int, std::pair<double, double>> sums;  // by label: of weights, of weighted values
  const auto weight = [&](std::size_t i) {
    return std::pow(samples[i].gain / samples[i].error, 2);
  };
  for (std::size_t i = 0; i < n; ++i) {
    sums[label[i]].first += weight(i);
    sums[label[i]].second += weight(i) * std::log(samples[i].gain);
  }
  double criterion = 2 * static_cast<double>(sums.size()) *
                     std::log(static_cast<double>(std::max<std::size_t>(1, n)));
  for (std::size_t i = 0; i < n; ++i) {
    const auto& [w, sum] = sums[label[i]];
    criterion += weight(i) * std::pow(std::log(samples[i].gain) - sum / w, 2);
  }
  return criterion;
}

RegionLabels region_labels(const std::vector<LocationSample>& samples, int count, int most) {
  const int n = static_cast<int>(samples.size());
  RegionLabels best;
  best.label.resize(samples.size());
  std::iota(best.label.begin(), best.label.end(), 0);
  best.criterion = 2 * n * std::log(std::max(1, n));
  if (count == kEverySite || n < 2) return best;
  std::vector<double> value, error;
  for (const LocationSample& s : samples) {
    value.push_back(std::log(s.gain));
    error.push_back(s.error / s.gain);
  }
  const int fewest = count == kAutomaticRegions ? 2 : std::min(count, n);
  const int largest = count == kAutomaticRegions ? std::max(2, std::min(most, n / 2)) : fewest;
  for (int k = fewest; k <= largest; ++k) {
    const std::vector<int> label = ward_clusters(value, error, k);
    const double criterion = labels_criterion(samples, label);
    if (k == fewest || criterion < best.criterion) best = {label, criterion};
  }
  return best;
}

}  // namespace hapsim
