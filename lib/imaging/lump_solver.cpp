#include "imaging/lump_solver.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "base/error.h"
#include "base/parallel.h"
#include "imaging/stiffness_image.h"
#include "solid/affine_sweep.h"
#include "solid/elastic_assembly.h"
#include "tetmesh/contact_mesh_around.h"

namespace hapsim {
namespace {

// Which tetrahedra have their middle inside a convex surface.
std::vector<char> inside_convex(const TetMesh& mesh, const Surface& convex) {
  std::vector<char> inside;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Vec3 p = tet_centroid(mesh, t);
    bool in = true;
    for (std::size_t f = 0; in && f < convex.faces.size(); ++f)
      in =
          face_normal(convex, static_cast<int>(f)).dot(p - convex.vertices[convex.faces[f][0]]) < 0;
    inside.push_back(in);
  }
  return inside;
}

// The stiffness of some elements alone.
class ElementPart {
 public:
  ElementPart(const TetMesh& mesh, const std::vector<char>& of, const Lame& constants)
      : mesh_(mesh) {
    for (std::size_t t = 0; t < of.size(); ++t) {
      if (!of[t]) continue;
      tet_.push_back(t);
      matrix_.push_back(element_matrix(mesh, t, constants, Dilatation::kElement));
    }
  }

  AffineSweep::Fields forces(const AffineSweep::Fields& fields) const {
    AffineSweep::Fields result = AffineSweep::Fields::Zero(fields.rows(), 3);
    for (std::size_t k = 0; k < tet_.size(); ++k) {
      const auto& nodes = mesh_.tets[tet_[k]];
      AffineSweep::Fields own(matrix_[k].rows(), 3);
      for (Eigen::Index a = 0; a < own.rows(); a += 3)
        own.middleRows<3>(a) = fields.middleRows<3>(3 * nodes[static_cast<std::size_t>(a / 3)]);
      own = matrix_[k] * own;
      for (Eigen::Index a = 0; a < own.rows(); a += 3)
        result.middleRows<3>(3 * nodes[static_cast<std::size_t>(a / 3)]) += own.middleRows<3>(a);
    }
    return result;
  }

 private:
  const TetMesh& mesh_;
  std::vector<std::size_t> tet_;
  std::vector<Eigen::MatrixXd> matrix_;
};

}  // namespace

Surface ball_surface(const Vec3& centre, double radius) {
  // An icosahedron, its faces cut in four, on the unit ball.
  const double g = std::numbers::phi;
  Surface s;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-g, g}) {
      s.vertices.push_back({0, a, b});
      s.vertices.push_back({a, b, 0});
      s.vertices.push_back({b, 0, a});
    }
  std::vector<Triangle> faces;
  for (int i = 0; i < 12; ++i)
    for (int j = i + 1; j < 12; ++j)
      for (int k = j + 1; k < 12; ++k) {
        const Vec3 &a = s.vertices[i], &b = s.vertices[j], &c = s.vertices[k];
        if (std::max({(a - b).norm(), (b - c).norm(), (c - a).norm()}) > 2.1) continue;
        faces.push_back((b - a).cross(c - a).dot(a) > 0 ? Triangle{i, j, k} : Triangle{i, k, j});
      }
  std::map<std::pair<int, int>, int> middle;
  const auto between = [&](int a, int b) {
    const auto [it, fresh] = middle.emplace(std::minmax(a, b), static_cast<int>(s.vertices.size()));
    if (fresh) s.vertices.push_back(s.vertices[a] + s.vertices[b]);
    return it->second;
  };
  for (const auto& [a, b, c] : faces) {
    const int ab = between(a, b), bc = between(b, c), ca = between(c, a);
    for (const Triangle& t : {Triangle{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}})
      s.faces.push_back(t);
  }
  for (Vec3& v : s.vertices) v.normalize();
  const double wanted = 4.0 / 3 * std::numbers::pi;
  const double scale = radius * std::cbrt(wanted / signed_volume(s));
  for (Vec3& v : s.vertices) v = centre + scale * v;
  return s;
}

LumpSolver::LumpSolver(const ContactBase& base, const Places& places, double tool_radius, double nu,
                       const std::vector<ImageView>& views, int threads)
    : base_(base),
      places_(places),
      tool_radius_(tool_radius),
      nu_(nu),
      views_(views),
      threads_(threads) {}

Eigen::MatrixXd LumpSolver::operator()(const Vec3& centre, double radius,
                                       const std::vector<double>& ratios,
                                       const std::vector<int>& positions) const {
  Eigen::MatrixXd gains = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(views_.size()),
                                                    static_cast<Eigen::Index>(ratios.size()),
                                                    std::numeric_limits<double>::quiet_NaN());
  in_parallel(positions.size(), threads_, [&](std::size_t k) {
    try {
      solve(positions[k], centre, radius, ratios, gains);
    } catch (const Error&) {
      // No mesh holds this ball and the tool here: the other places tell.
    }
  });
  return gains;
}

void LumpSolver::solve(int position, const Vec3& centre, double radius,
                       const std::vector<double>& ratios, Eigen::MatrixXd& gains) const {
  const auto p = static_cast<std::size_t>(position);
  const Surface ball = ball_surface(centre, radius);
  const ContactMesh contact = make_contact_mesh_around(base_, places_.position(p), tool_radius_,
                                                       kFieldRim * tool_radius_, kGrowth, {ball});
  const std::vector<char> inside = inside_convex(contact.mesh, ball);
  std::vector<int> handle(contact.mesh.nodes.size(), kFreeNode);
  for (std::size_t n = 0; n < handle.size(); ++n)
    if (contact.mesh.fixed[n]) handle[n] = kHeldNode;
  for (const int n : contact.patch_nodes) handle[n] = 0;
  ElasticBody body(contact.mesh, handle, Dilatation::kElement);
  const Lame unit = lame(1, nu_);
  body.factorise(std::vector<Lame>(inside.size(), unit));
  const ElasticBody::Response without = body.solve(Eigen::Matrix3d::Identity());
  const Eigen::Matrix3d bare = without.reaction;
  const ElementPart within(contact.mesh, inside, unit);
  std::vector<double> more;
  for (const double ratio : ratios) more.push_back(ratio - 1);
  const AffineSweep sweep(
      body, bare, without.field,
      [&](const AffineSweep::Fields& fields) { return within.forces(fields); }, more);
  Eigen::Matrix3d fine, by_nu;
  places_.contact(p).stiffness.evaluate(nu_, fine, by_nu);
  const Eigen::Matrix3d S =
      fine.llt().matrixL().toDenseMatrix() * bare.llt().matrixL().toDenseMatrix().inverse();
  for (std::size_t r = 0; r < ratios.size(); ++r) {
    const Eigen::Matrix3d K = sweep.at(more[r]).K;
    for (std::size_t v = 0; v < views_.size(); ++v) {
      if (views_[v].position != position) continue;
      const Eigen::Matrix3d C = S.transpose() * views_[v].B * S;
      gains(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(r)) =
          std::log((C * K).trace() / (C * bare).trace());
    }
  }
}

}  // namespace hapsim
