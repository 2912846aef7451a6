#include "made_recordings.h"

#include <cmath>
#include <vector>

#include "experiment/forces.h"
#include "formats/tetmesh_io.h"

namespace hapsim::bench {
namespace {

constexpr double kStiffnessError = 0.01;  // relative, of each position and direction
constexpr double kTrueRim = 0.08;         // finer than what is diagnosed

Recording first_presses(const Recording& all, int count) {
  Recording some = all;
  const std::vector<Press> presses = all.presses();
  std::vector<std::size_t> rows;
  for (int k = 0; k < count; ++k)
    rows.insert(rows.end(), presses[k].rows.begin(), presses[k].rows.end());
  const auto keep = [&](auto& values) {
    if (values.empty()) return;
    const auto before = values;
    values.resize(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) values[i] = before[rows[i]];
  };
  keep(some.line), keep(some.press), keep(some.t), keep(some.position), keep(some.u), keep(some.f);
  keep(some.temp), keep(some.contact);
  return some;
}

Recording motion(const std::string& path, const Truth& truth) {
  Input input(path);
  Recording r = read_recording(input, false);
  r.f.assign(r.rows(), Vec3::Zero());
  if (truth.open) r.contact.clear();
  // Each press at its own temperature, in no order; the thermometer has noise.
  Random random(5);
  r.temp.resize(r.rows());
  for (const Press& press : r.presses()) {
    const double t = 20 + 10 * random.uniform();
    for (const int row : press.rows) r.temp[row] = t + 0.05 * random.normal();
  }
  return truth.presses > 0 ? first_presses(r, truth.presses) : r;
}

TetMesh body(const std::string& path) {
  Input input(path);
  return read_body(input);
}

// What the sensor adds.
void add_noise(const Truth& truth, const Episode& e, Random& random,
               Eigen::Ref<Eigen::VectorXd> f) {
  constexpr double kMemory = 0.9, kOutliers = 0.01, kFarOff = 15;
  Vec3 last = Vec3::Zero();
  for (std::size_t i = 0; i < e.rows.size(); ++i) {
    Vec3 n(random.normal(), random.normal(), random.normal());
    if (truth.noise == NoiseKind::kCorrelated && i > 0)
      n = kMemory * last + std::sqrt(1 - kMemory * kMemory) * n;
    last = n;
    if (truth.noise == NoiseKind::kOutliers && random.uniform() < kOutliers) n *= kFarOff;
    f.segment<3>(3 * static_cast<Eigen::Index>(i)) += truth.noisier * kNoise * n;
  }
}

}  // namespace

Pairs::Pairs(const std::string& diagnosed, const std::string& truth, const std::string& motion)
    : diagnosed_(body(diagnosed)), truth_(body(truth)), motion_(motion) {}

const Pair& Pairs::of(const Truth& truth) {
  const std::tuple<bool, int, double> kind{truth.open, truth.presses, truth.noisier};
  if (const auto known = pairs_.find(kind); known != pairs_.end()) return known->second;
  ExperimentOptions options;
  options.noise = kNoise * truth.noisier;
  options.cache = default_cache_directory();
  ExperimentOptions finer = options;
  finer.rim_edge = kTrueRim;
  finer.nu_low = finer.nu_high = true_base({}).find("elastic", 0, "nu")->value;
  options.draft = true;  // as hs-diagnose
  const Pair pair{make_experiment(truth_, motion(motion_, truth), finer),
                  make_experiment(diagnosed_, motion(motion_, truth), options)};
  return pairs_.emplace(kind, pair).first->second;
}

void measure(const Truth& truth, const Experiment& w, int seed, Eigen::VectorXd& f) {
  Random random(static_cast<std::uint64_t>(seed));
  std::vector<Eigen::Matrix3d> error;
  for (std::size_t p = 0; p < w.dataset.positions.size(); ++p) {
    Eigen::Matrix3d S;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j)
        S(i, j) = S(j, i) = kStiffnessError * (i == j ? 1 : std::sqrt(0.5)) * random.normal();
    error.push_back(Eigen::Matrix3d::Identity() + S);
  }
  Eigen::Index at = 0;
  for (const Episode& e : w.dataset.episodes) {
    const auto n = 3 * static_cast<Eigen::Index>(e.rows.size());
    for (Eigen::Index i = at; i < at + n; i += 3)
      f.segment<3>(i) = (error[e.position] * f.segment<3>(i)).eval();
    add_noise(truth, e, random, f.segment(at, n));
    at += n;
  }
}

Experiment with_forces(Experiment w, const Eigen::VectorXd& forces) {
  const std::vector<int> rows = stacked_rows(w.dataset, all_episodes(w.dataset));
  for (std::size_t i = 0; i < rows.size(); ++i)
    w.dataset.recording.f[rows[i]] = forces.segment<3>(3 * static_cast<Eigen::Index>(i));
  return w;
}

}  // namespace hapsim::bench
