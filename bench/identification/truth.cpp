#include "truth.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "io/csv.h"
#include "io/stream.h"
#include "support/block_mesh.h"
#include "support/finer_contact.h"
#include "support/objects.h"
#include "tetmesh/body_mesh.h"

namespace hapsim::bench {

Object make_object(const std::string& name) {
  Object object{name, {}, {}};
  BodyOptions as_it_is;
  as_it_is.preserve_surface = true;
  if (name == "block")
    object.exact = test::block_mesh({0.12, 0.21, 0.06}, 12, 21, 6, 1);
  else
    object.exact =
        make_body_mesh(name == "ball" ? test::half_ball(35) : test::lump(50), as_it_is, name);
  object.meshed = make_body_mesh(boundary_surface(object.exact), {}, name);
  return object;
}

std::vector<Eigen::Matrix3d> true_stiffness(const std::string& out, const std::string& name,
                                            const Object& object,
                                            const std::vector<Vec3>& positions,
                                            const Material& material) {
  const std::string path = out + "/" + name + ".csv";
  std::vector<Eigen::Matrix3d> K(positions.size());
  if (std::filesystem::exists(path)) {
    Input input(path);
    const CsvTable table = read_csv(input);
    for (int c = 0; c < 9; ++c) {
      const std::vector<double> column = table.numbers(fmt::format("k{}", c));
      for (std::size_t p = 0; p < K.size(); ++p) K[p](c / 3, c % 3) = column.at(p);
    }
    return K;
  }
  K = test::finer_stiffness(test::finer_base(object.exact, kFiner), positions, kToolRadius,
                            material, kFiner);
  Output output(path);
  CsvWriter writer(output.stream(), {}, {"k0", "k1", "k2", "k3", "k4", "k5", "k6", "k7", "k8"});
  for (const Eigen::Matrix3d& k : K) {
    std::vector<std::string> row;
    for (int c = 0; c < 9; ++c) row.push_back(format_number(k(c / 3, c % 3)));
    writer.row(row);
  }
  output.commit();
  return K;
}

Recording record(const std::vector<Vec3>& positions, const std::vector<TruePress>& presses,
                 double step, int depths) {
  Recording r;
  r.name = "recording";
  r.metadata.set("tool_radius", format_number(kToolRadius));
  for (std::size_t p = 0; p < presses.size(); ++p) {
    const TruePress& press = presses[p];
    const int samples =
        step > 0 ? static_cast<int>(std::lround((press.ramp + press.hold) / step)) : depths;
    for (int i = step > 0 ? 0 : 1; i <= samples; ++i) {
      const double t = step * i;
      r.line.push_back(static_cast<long>(r.line.size()) + 2);
      r.press.push_back(static_cast<int>(p));
      if (step > 0) r.t.push_back(t);
      r.position.push_back(positions[press.position]);
      r.u.push_back((step > 0 ? std::min(1.0, t / press.ramp) : i / double(depths)) * press.u);
      r.f.push_back(Vec3::Zero());
    }
  }
  return r;
}

std::vector<Vec3> true_forces(const Recording& r, const std::vector<TruePress>& presses,
                              const std::vector<Eigen::Matrix3d>& K, double modulus,
                              const Relaxation& relaxation) {
  std::vector<Vec3> forces;
  for (std::size_t i = 0; i < r.rows(); ++i) {
    const TruePress& press = presses[r.press[i]];
    Vec3 stress = modulus * r.u[i];  // K is that of E = 1
    if (!r.t.empty()) {
      const double T = press.ramp, t = r.t[i];
      for (const auto& [share, tau] : relaxation)
        stress += share * tau / T *
                  (t <= T ? -std::expm1(-t / tau) : std::exp(-(t - T) / tau) - std::exp(-t / tau)) *
                  press.u;
    }
    forces.push_back(-K[press.position] * stress);
  }
  return forces;
}

void measure(Recording& r, const std::vector<TruePress>& presses, const std::vector<Vec3>& forces,
             double gain, double noise, Random& random) {
  int positions = 0;
  for (const TruePress& p : presses) positions = std::max(positions, p.position + 1);
  std::vector<Eigen::Matrix3d> error;
  for (int p = 0; p < positions; ++p) {
    Eigen::Matrix3d S;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j)
        S(i, j) = S(j, i) = gain * (i == j ? 1 : std::sqrt(0.5)) * random.normal();
    error.push_back(Eigen::Matrix3d::Identity() + S);
  }
  for (std::size_t i = 0; i < forces.size(); ++i) {
    r.f[i] = error[presses[r.press[i]].position] * forces[i];
    for (int k = 0; k < 3; ++k) r.f[i][k] += noise * random.normal();
  }
}

Experiment measured(Experiment experiment, const std::vector<TruePress>& presses,
                    const std::vector<Vec3>& forces, double gain, double noise, Random& random) {
  Dataset& dataset = experiment.dataset;
  measure(dataset.recording, presses, forces, gain, noise, random);
  return experiment;
}

double peak(const std::vector<Vec3>& forces) {
  double most = 0;
  for (const Vec3& f : forces) most = std::max(most, f.norm());
  return most;
}

}  // namespace hapsim::bench
