// What meshes, matrices and their factors say that they hold is what the heap says.
#include <gtest/gtest.h>
#include <malloc.h>

#include "contact/contact_library.h"
#include "contact/field_stiffness.h"
#include "support/block_mesh.h"

// Sanitizers have a heap of their own, of which malloc.h knows nothing.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

namespace hapsim {
namespace {

double heap_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

constexpr double kHeldRadius = 0.004;

const ContactBase& base() {
  static const ContactBase base =
      make_contact_base(test::block_mesh({0.06, 0.05, 0.03}, 6, 6, 4, 1));
  return base;
}

// Within a twentieth: what malloc adds to each, and CHOLMOD's own book.
void expect_true(std::size_t held, double heap) {
  EXPECT_NEAR(static_cast<double>(held), heap, 0.05 * heap);
}

TEST(HeldBytes, OfABodysMatrixWithItsFactor) {
  const auto surface = free_surface(base());
  ContactBodies(base(), {0.033, 0.024, 0.03}, kHeldRadius, 0.3, surface)
      .solve_featured({0.4, {1.0}, nullptr, {}});  // what libraries keep from the first call on
  const double before = heap_in_use();
  ContactBodies bodies(base(), {0.033, 0.024, 0.03}, kHeldRadius, 0.3, surface);
  EXPECT_EQ(bodies.held_bytes(), 0u);
  bodies.solve_featured({0.4, {1.0}, nullptr, {}});
  const std::size_t with_factor = bodies.held_bytes();
  expect_true(with_factor, heap_in_use() - before);
  bodies.forget_systems();
  expect_true(bodies.held_bytes(), heap_in_use() - before);
  EXPECT_LT(bodies.held_bytes(), with_factor / 10);
}

TEST(HeldBytes, OfAnEstimateWithItsMesh) {
  const auto surface = free_surface(base());
  const auto make = [&] {
    return ContactBodies(base(), {0.033, 0.024, 0.03}, kHeldRadius, 0.3, surface).estimate(0.42);
  };
  make();  // malloc keeps some of what small parts leave
  const double before = heap_in_use();
  const auto estimate = make();
  expect_true(held_bytes(estimate), heap_in_use() - before);
}

TEST(HeldBytes, OfABodyWithAField) {
  FieldGrid grid;
  grid.count = {13, 11, 7};
  const double before = heap_in_use();
  FieldBody body(base(), {0.033, 0.024, 0.03}, kHeldRadius, 0.3 * kHeldRadius, kGrowth, grid);
  body.solve(0.4, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(grid.size())), false);
  expect_true(body.held_bytes(), heap_in_use() - before);
}

// With any memory the same stiffnesses; no more of it than is given.
TEST(HeldBytes, BoundALibrarysMemory) {
  const TetMesh block = test::block_mesh({0.06, 0.05, 0.03}, 6, 6, 4, 1);
  const std::vector<Vec3> places{{0.033, 0.024, 0.03}, {0.02, 0.024, 0.03}, {0.033, 0.03, 0.03}};
  std::vector<Eigen::Matrix3d> first;
  for (const std::size_t memory : {1'000'000'000u, 3'000'000u, 0u}) {
    ContactLibraryOptions options;
    options.threads = 2;
    options.rim_edge = 0.3;
    options.memo = std::make_shared<Memo>(memory);
    const ContactLibrary library(block, kHeldRadius, options);
    const auto contacts = library.prepare(places, 0.4, 0.4);
    std::vector<Eigen::Matrix3d> K;
    for (const double ratio : {2.0, 3.0, 2.0}) {
      const Material skin{0.4, {1.0}, nullptr, {{Feature::kLayer, {0.003, ratio}}}};
      for (const auto& s : library.solve(places, contacts, skin, "")) K.push_back(s.K);
      EXPECT_LE(options.memo->bytes(), memory);
    }
    if (first.empty()) first = K;
    EXPECT_EQ(K, first) << memory;
    EXPECT_EQ(options.memo->bytes() > 0, memory > 0);
  }
}

}  // namespace
}  // namespace hapsim

#endif
