// A small body whose large strain is sampled, made once for all tests of a process, and one that
// relaxes beside.
#pragma once

#include "effects/catalogue.h"
#include "model/model.h"
#include "realtime/prepared_body.h"
#include "support/block_mesh.h"
#include "support/shared_cache.h"

namespace hapsim::test {

constexpr double kStrainedRadius = 0.01;
const inline Vec3 kStrainedPlace(0.05, 0.05, 0.06);

inline TetMesh strained_mesh() {
  return block_mesh({0.1, 0.1, 0.06}, 4, 4, 3, 1);
}

inline Model strained_model(double relaxing = 0, double friction = 0) {
  Model model;
  const auto add = [&](const char* effect, const std::vector<double>& values) {
    for (const Effect* e : catalogue())
      if (e->card().name == effect) {
        const auto rows = effect_rows(*e, 1, values);
        model.parameters.insert(model.parameters.end(), rows.begin(), rows.end());
      }
  };
  add("elastic", {2e4, 0.4});
  if (relaxing > 0) add("viscoelastic", {relaxing, 0.2});
  add("hyperelastic", {0.2, 1});
  if (friction > 0) add("friction", {friction});
  return model;
}

inline PreparedBodyOptions strained_options() {
  PreparedBodyOptions options;
  options.tool_radius = kStrainedRadius;
  options.most_samples = 16;
  options.rim_edge = 0.5;
  options.threads = 2;
  options.cache = shared_cache();
  options.contacts = [](const MaterialSpec& material) {
    const double E = material.modulus[0];
    return std::vector<KnownStiffness>{
        {kStrainedPlace, Vec3::UnitZ(), E * Vec3(0.0185, 0.0185, 0.0275).asDiagonal()}};
  };
  options.large_strain = true;
  options.most_strain_samples = 5;
  return options;
}

inline const PreparedBody& relaxing_body() {
  static const PreparedBody body(strained_mesh(), strained_model(8e3), strained_options());
  return body;
}

// Of the samples of the one that relaxes, which have all that this one asks for.
inline const PreparedBody& strained_body() {
  relaxing_body();
  static const PreparedBody body(strained_mesh(), strained_model(), strained_options());
  return body;
}

}  // namespace hapsim::test
