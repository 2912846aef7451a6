// The forces and fields of a body's own mesh: energy, equilibrium and Hooke's law of what is
// written.
#include "simulate/own_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <sstream>

#include "containers/vtu.h"
#include "simulate/field_rows.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

Model model_of(bool relaxes) {
  Model model;
  for (const Effect* effect : catalogue()) {
    std::vector<double> values;
    if (effect->card().name == "elastic") values = {2e4, 0.4};
    if (relaxes && effect->card().name == "viscoelastic") values = {8e3, 0.3};
    if (values.empty()) continue;
    const auto rows = effect_rows(*effect, 1, values);
    model.parameters.insert(model.parameters.end(), rows.begin(), rows.end());
  }
  return model;
}

struct Field {
  std::vector<double> u, stress, energy;
};

Field written(const OwnMesh& body, const Episode& episode, std::size_t at) {
  std::ostringstream out;
  body.write_field(out, episode, at);
  const std::vector<VtuPiece> pieces = parse_vtu(out.str(), "field");
  EXPECT_EQ(pieces.size(), 1u);
  const auto values = [](const std::vector<VtuArray>& arrays, const char* name) {
    const VtuArray* found = find_array(arrays, name);
    EXPECT_NE(found, nullptr) << name;
    return found == nullptr ? std::vector<double>{} : found->values;
  };
  return {values(pieces[0].point_data, "displacement"), values(pieces[0].cell_data, "stress"),
          values(pieces[0].cell_data, "energy_density")};
}

class OwnMeshField : public ::testing::Test {
 protected:
  Dataset dataset = make_dataset(test::presses());
  double radius = 0.012;
};

TEST_F(OwnMeshField, HoldsTheWorkOfTheTool) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = test::block_mesh({0.08, 0.08, 0.04}, 8, 8, 5, order, 0.15);
    const Model model = model_of(false);
    const OwnMesh body(mesh, model, dataset.positions, radius, SolverKind::kDirect);
    for (const FieldRow& row : field_rows(dataset, "30,100,400")) {
      const Episode& episode = dataset.episodes[row.episode];
      const Vec3 u = dataset.recording.u[row.row];
      const Field field = written(body, episode, row.sample);
      double energy = 0;
      for (std::size_t t = 0; t < mesh.tets.size(); ++t)
        energy += field.energy[t] * tet_volume(mesh, t);
      const Eigen::Matrix3d K = body.at(static_cast<std::size_t>(episode.position)).K;
      EXPECT_NEAR(energy, 0.5 * u.dot(K * u), 1e-9 * energy) << "order " << order;
    }
  }
}

// In a linear tetrahedron strain is constant: from the edges and their displacements.
TEST_F(OwnMeshField, IsHookesLawOfItsDisplacements) {
  const TetMesh mesh = test::block_mesh({0.08, 0.08, 0.04}, 8, 8, 5, 1, 0.15);
  const Model model = model_of(false);
  const OwnMesh body(mesh, model, dataset.positions, radius, SolverKind::kDirect);
  const Field field = written(body, dataset.episodes[2], 20);
  const Lame constants = lame(2e4, 0.4);
  double worst = 0, largest = 0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Eigen::Matrix3d edges, moved;
    const auto displacement = [&](int n) {
      return Vec3(field.u[3 * static_cast<std::size_t>(n)],
                  field.u[3 * static_cast<std::size_t>(n) + 1],
                  field.u[3 * static_cast<std::size_t>(n) + 2]);
    };
    for (int k = 0; k < 3; ++k) {
      edges.col(k) = mesh.nodes[mesh.tets[t][k + 1]] - mesh.nodes[mesh.tets[t][0]];
      moved.col(k) = displacement(mesh.tets[t][k + 1]) - displacement(mesh.tets[t][0]);
    }
    const Eigen::Matrix3d gradient = moved * edges.inverse();
    const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
    const Eigen::Matrix3d stress =
        constants.lambda * strain.trace() * Eigen::Matrix3d::Identity() + 2 * constants.mu * strain;
    const double* s = field.stress.data() + 6 * t;
    const double expected[] = {stress(0, 0), stress(1, 1), stress(2, 2),
                               stress(0, 1), stress(1, 2), stress(0, 2)};
    for (int k = 0; k < 6; ++k) worst = std::max(worst, std::abs(s[k] - expected[k]));
    largest = std::max(largest, stress.norm());
    EXPECT_NEAR(field.energy[t], 0.5 * stress.cwiseProduct(strain).sum(),
                1e-9 * stress.norm() * strain.norm());
  }
  EXPECT_LT(worst, 1e-9 * largest);
}

// At each instant sigma = C eps of the tool's displacement and what the elements remember of it, so
// the stress scales with the force; a jump held for long is the elastic body again.
TEST_F(OwnMeshField, RelaxesAsTheForceDoes) {
  const TetMesh mesh = test::block_mesh({0.08, 0.08, 0.04}, 8, 8, 5, 1, 0.15);
  const Model elastic = model_of(false), relaxing = model_of(true);
  const OwnMesh plain(mesh, elastic, dataset.positions, radius, SolverKind::kDirect);
  const OwnMesh body(mesh, relaxing, dataset.positions, radius, SolverKind::kIterative);
  const Selection all = all_episodes(dataset);
  dataset = on_body(std::move(dataset), body.stands());
  const auto forces = [&](const Model& model, const OwnMesh& own) {
    return model_forces(
               model, dataset, [&](std::size_t p) { return own.at(p); }, all, false)
        .f;
  };
  const Eigen::VectorXd f = forces(relaxing, body), f_e = forces(elastic, plain);
  for (const std::size_t at : {5u, 20u, 40u}) {  // of the first episode, straight down
    const Field now = written(body, dataset.episodes[0], at);
    const Field then = written(plain, dataset.episodes[0], at);
    const auto row = static_cast<Eigen::Index>(3 * at) + 2;
    const double ratio = f[row] / f_e[row];
    EXPECT_GT(ratio, 1);
    double worst = 0, largest = 0;
    for (std::size_t i = 0; i < now.stress.size(); ++i) {
      worst = std::max(worst, std::abs(now.stress[i] - ratio * then.stress[i]));
      largest = std::max(largest, std::abs(now.stress[i]));
    }
    EXPECT_LT(worst, 1e-6 * largest);
    EXPECT_EQ(now.u.size(), then.u.size());
  }
}

}  // namespace
}  // namespace hapsim
