// Presses whose sensitivities are a closed form: the energy of a point load falls with the fourth
// power of the distance.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "contact/contact_library.h"
#include "contact/field_stiffness.h"
#include "support/block_mesh.h"

namespace hapsim {

inline constexpr double kTool = 4e-3, kStep = 3e-3, kDepth = 0.05, kNoise = 0.004;

class MadePresses : public ::testing::Test {
 protected:
  MadePresses() : surface(boundary_surface(test::block_mesh({0.1, 0.1, 0.06}, 10, 10, 6, 1))) {
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i < 6; ++i) {
        PreparedContact contact;
        contact.point = {0.025 + 0.01 * i, 0.025 + 0.01 * j, 0.06};
        contact.normal = Vec3::UnitZ();
        contacts.push_back(contact);
      }
    grid.step = kStep;
    grid.count = {34, 34, 21};
    J.resize(static_cast<Eigen::Index>(contacts.size()), static_cast<Eigen::Index>(grid.size()));
    for (std::size_t p = 0; p < contacts.size(); ++p)
      for (std::size_t n = 0; n < grid.size(); ++n) J(p, n) = energy(p, grid.node(n));
    whole = J.rowwise().sum() * std::pow(kStep, 3);
    for (Eigen::Index p = 0; p < J.rows(); ++p) J.row(p) /= J.row(p).sum();
  }
  double energy(std::size_t p, const Vec3& at) const {
    return std::pow((at - contacts[p].point).squaredNorm() + kTool * kTool, -2);
  }
  // What a ball that counts as `effect` of its volume does, integrated finely, and noise.
  Eigen::VectorXd gains(const Vec3& centre, double radius, double effect,
                        std::uint64_t seed) const {
    Random random(seed);
    Eigen::VectorXd data(J.rows());
    const double fine = radius / 12;
    for (Eigen::Index p = 0; p < J.rows(); ++p) {
      double inside = 0;
      for (double x = -radius; x <= radius; x += fine)
        for (double y = -radius; y <= radius; y += fine)
          for (double z = -radius; z <= radius; z += fine)
            if (x * x + y * y + z * z < radius * radius)
              inside += energy(p, centre + Vec3(x, y, z)) * std::pow(fine, 3);
      data[p] = effect * inside / whole[p] + kNoise * random.normal();
    }
    return data;
  }
  Surface surface;
  std::vector<PreparedContact> contacts;
  FieldGrid grid;
  Eigen::MatrixXd J;
  Eigen::VectorXd whole;  // energy of each press
};

}  // namespace hapsim
