#include "tetmesh/even_mesh.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/block_mesh.h"

namespace hapsim {
namespace {

TEST(EvenMesh, IsTheBodyHeldWhereItWas) {
  const ContactBase base = make_contact_base(test::block_mesh({0.1, 0.1, 0.06}, 10, 10, 6, 1));
  const TetMesh mesh = make_even_mesh(base, 0.02);
  EXPECT_EQ(mesh.order, 2);
  EXPECT_NEAR(volume(mesh) / 6e-4, 1, 5e-3);
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    EXPECT_EQ(mesh.fixed[n] != 0, std::abs(mesh.nodes[n].z()) < 1e-9) << n;
}

}  // namespace
}  // namespace hapsim
