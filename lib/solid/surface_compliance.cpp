#include "solid/surface_compliance.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <cstdint>

#include "base/error.h"
#include "solid/elastic_assembly.h"

namespace hapsim {
namespace {

std::uint64_t edge_key(int a, int b) {
  const auto [low, high] = std::minmax(a, b);
  return static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
}

NodeSystem make_system(const TetMesh& mesh) {
  std::vector<char> free(mesh.nodes.size());
  for (std::size_t n = 0; n < free.size(); ++n) free[n] = mesh.fixed[n] ? 0 : 1;
  NodeSystem system(std::move(free), element_cliques(mesh));
  if (system.unknowns() == 0)
    fail_input("", "all nodes of the body are fixed", "fix its support only");
  return system;
}

std::vector<int> corner_nodes(const TetMesh& mesh) {
  std::vector<int> nodes;
  for (const Triangle& f : mesh.faces.empty() ? boundary_faces(mesh) : mesh.faces)
    nodes.insert(nodes.end(), f.begin(), f.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

std::vector<int> free_surface_nodes(const TetMesh& mesh, const NodeSystem& system,
                                    SurfaceNodes kept) {
  std::vector<int> nodes =
      kept == SurfaceNodes::kCorners ? corner_nodes(mesh) : surface_nodes(mesh);
  nodes.erase(std::remove_if(nodes.begin(), nodes.end(), [&](int n) { return !system.is_free(n); }),
              nodes.end());
  return nodes;
}

// One a free node, as the matrix numbers them.
std::vector<char> kept_blocks(const NodeSystem& system, const std::vector<int>& index) {
  std::vector<char> kept;
  for (std::size_t n = 0; n < index.size(); ++n)
    if (system.is_free(static_cast<int>(n))) kept.push_back(index[n] >= 0 ? 1 : 0);
  return kept;
}

std::vector<int> index_over(const std::vector<int>& nodes, std::size_t count) {
  std::vector<int> index(count, -1);
  for (std::size_t k = 0; k < nodes.size(); ++k) index[nodes[k]] = static_cast<int>(k);
  return index;
}

}  // namespace

std::vector<int> surface_nodes(const TetMesh& mesh) {
  const std::vector<Triangle> faces = mesh.faces.empty() ? boundary_faces(mesh) : mesh.faces;
  std::vector<char> on(mesh.nodes.size(), 0);
  for (const Triangle& f : faces)
    for (const int n : f) on[n] = 1;
  if (mesh.order == 2) {
    std::vector<std::uint64_t> edges;
    for (const Triangle& f : faces)
      for (int k = 0; k < 3; ++k) edges.push_back(edge_key(f[k], f[(k + 1) % 3]));
    std::sort(edges.begin(), edges.end());
    for (const auto& tet : mesh.tets)
      for (int e = 0; e < 6; ++e) {
        const int a = tet[kTetEdges[e][0]], b = tet[kTetEdges[e][1]];
        if (on[a] && on[b] && std::binary_search(edges.begin(), edges.end(), edge_key(a, b)))
          on[tet[4 + e]] = 1;
      }
  }
  std::vector<int> nodes;
  for (std::size_t n = 0; n < on.size(); ++n)
    if (on[n]) nodes.push_back(static_cast<int>(n));
  return nodes;
}

SurfaceCompliance::SurfaceCompliance(const TetMesh& mesh, Dilatation dilatation, SurfaceNodes kept)
    : mesh_(mesh),
      dilatation_(dilatation),
      system_(make_system(mesh)),
      nodes_(free_surface_nodes(mesh, system_, kept)),
      index_(index_over(nodes_, mesh.nodes.size())),
      schur_(system_.matrix(), kept_blocks(system_, index_)) {
  assert(dilatation != Dilatation::kPatch);
}

void SurfaceCompliance::factorise(const std::vector<Lame>& lame_of_tet, int threads) {
  assemble_elastic(system_, mesh_, lame_of_tet, dilatation_);
  if (!schur_.invert(system_.matrix(), matrix_, threads))
    fail_numerics("", "the stiffness matrix is not positive definite",
                  "check that the body has fixed nodes, nu < 0.5 and all moduli are positive");
}

void SurfaceCompliance::scale_modulus(double factor) {
  assert(factor > 0);
  matrix_ /= factor;
}

Eigen::Matrix3d SurfaceCompliance::patch_stiffness(const std::vector<int>& patch) const {
  if (patch.size() == 1) {
    const Eigen::Matrix3d k = block(patch[0], patch[0]).inverse();
    return 0.5 * (k + k.transpose());
  }
  const Eigen::Index n = static_cast<Eigen::Index>(patch.size());
  Eigen::MatrixXd c(3 * n, 3 * n), together(3 * n, 3);
  for (Eigen::Index a = 0; a < n; ++a) {
    together.middleRows<3>(3 * a).setIdentity();
    for (Eigen::Index b = 0; b < n; ++b) c.block<3, 3>(3 * a, 3 * b) = block(patch[a], patch[b]);
  }
  return together.transpose() * c.llt().solve(together);
}

}  // namespace hapsim
