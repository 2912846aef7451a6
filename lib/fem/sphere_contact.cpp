#include "fem/sphere_contact.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "fem/face_quadrature.h"

namespace hapsim {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct SphereContact::Impl {
  BodyAssembly assembly;
  NodeSystem system;
  Vec3 point, normal;
  const TetMesh* mesh;
  std::vector<Triangle> faces;
  struct SurfacePoint {
    std::array<int, 3> hat;
    std::array<double, 3> corner;  // values of the hats
    double area, r, z;             // share of the area; from the axis; above `point`
  };
  std::vector<SurfacePoint> points;
  std::vector<int> hat;   // one a node, -1: none
  std::vector<char> rim;  // one a hat, 1: on the boundary of the prepared surface
  VectorXd area, moment;  // integrals of each hat, and of it times r^2 about the axis
  MatrixXd fields;        // displacements of unit pressure on each hat
  MatrixXd compliance;
  mutable VectorXd field;

  Impl(const BodyModel& model, const std::vector<std::uint8_t>& held)
      : assembly(model), system(free_nodes(held), assembly.cliques()), mesh(model.mesh) {}

  static std::vector<char> free_nodes(const std::vector<std::uint8_t>& held) {
    std::vector<char> free;
    for (const auto h : held) free.push_back(h == 0);
    return free;
  }

  void choose_faces(double reach) {
    std::vector<int> uses(mesh->nodes.size(), 0), all(mesh->nodes.size(), 0);
    for (const Triangle& f : mesh->faces) {
      for (const int n : f) ++all[n];
      const Vec3 cross =
          (mesh->nodes[f[1]] - mesh->nodes[f[0]]).cross(mesh->nodes[f[2]] - mesh->nodes[f[0]]);
      const bool near = std::all_of(f.begin(), f.end(),
                                    [&](int n) { return (mesh->nodes[n] - point).norm() < reach; });
      if (!near || cross.dot(normal) < 0.5 * cross.norm()) continue;
      faces.push_back(f);
      for (const int n : f) ++uses[n];
    }
    if (faces.empty())
      fail_input("", "the mesh has no face within reach of the contact",
                 "refine the mesh there or raise the reach");
    hat.assign(mesh->nodes.size(), -1);
    int count = 0;
    for (std::size_t n = 0; n < uses.size(); ++n) {
      if (uses[n] == 0) continue;
      hat[n] = count++;
      rim.push_back(uses[n] != all[n]);
    }
  }

  void find_compliance() {
    const Index hats = static_cast<Index>(rim.size());
    MatrixXd load = MatrixXd::Zero(3 * static_cast<Index>(mesh->nodes.size()), hats);
    area = moment = VectorXd::Zero(hats);
    for (const std::vector<int>& f : face_nodes(*mesh, faces))
      for (const FacePoint& p : face_points(*mesh, f)) {
        const Vec3 x = p.position - point;
        SurfacePoint s{{}, p.corner, p.area.norm(), 0, x.dot(normal)};
        s.r = (x - s.z * normal).norm();
        for (std::size_t i = 0; i < 3; ++i) {
          const int h = s.hat[i] = hat[f[i]];
          const double share = s.area * s.corner[i];
          area[h] += share;
          moment[h] += share * s.r * s.r;
          for (std::size_t b = 0; b < f.size(); ++b)
            load.block<3, 1>(3 * f[b], h) -= share * p.shape[b] * normal;
        }
        points.push_back(s);
      }
    assembly.set_state(VectorXd::Zero(load.rows()));
    std::vector<BodyAssembly::CliqueMatrix> none;
    system.clear();
    assembly.tangent(system, std::vector<char>(mesh->nodes.size(), 0), none);
    if (!system.factorise())
      fail_numerics("", "the stiffness matrix is not positive definite",
                    "check that the body has fixed nodes");
    fields = system.solve(load);
    compliance = load.transpose() * fields;
    compliance = (0.5 * (compliance + compliance.transpose())).eval();
  }

  // Integral over each hat of the undeformed gap to a tip that just touches `point`, and of its
  // derivative by the tip's radius. Beyond the tip's equator the gap is that of its slope there.
  void gaps(double R, VectorXd& gap, VectorXd& by_radius) const {
    gap = by_radius = VectorXd::Zero(area.size());
    const double edge = 0.99 * R;
    for (const SurfacePoint& p : points) {
      const double inside = std::min(p.r, edge), root = std::sqrt(R * R - inside * inside);
      const double height = R - root + (p.r - inside) * inside / root;
      const double slope = p.r < edge ? 1 - R / root : 0;
      for (std::size_t i = 0; i < 3; ++i) {
        gap[p.hat[i]] += p.area * p.corner[i] * (height - p.z);
        by_radius[p.hat[i]] += p.area * p.corner[i] * slope;
      }
    }
  }

  // Pressures >= 0 with gap + compliance * pressure >= 0 and complementary: primal-dual active set
  // (Hintermueller, Ito and Kunisch, SIAM J. Optim. 13, 2002).
  std::vector<Index> active_set(const VectorXd& gap, VectorXd& pressure) const {
    std::vector<Index> active;
    for (Index i = 0; i < gap.size(); ++i)
      if (gap[i] < 0) active.push_back(i);
    for (int iteration = 0; iteration < 100; ++iteration) {
      pressure = VectorXd::Zero(gap.size());
      if (active.empty()) return active;
      const VectorXd p = compliance(active, active).llt().solve(VectorXd(-gap(active)));
      pressure(active) = p;
      const VectorXd open = gap + compliance * pressure;
      std::vector<Index> next;
      std::vector<char> was(static_cast<std::size_t>(gap.size()), 0);
      for (const Index i : active) was[static_cast<std::size_t>(i)] = 1;
      for (Index i = 0; i < gap.size(); ++i)
        if (was[static_cast<std::size_t>(i)] ? pressure[i] > 0 : open[i] < 0) next.push_back(i);
      if (next == active) return active;
      active = next;
    }
    fail_numerics("", "the contact's active set does not settle",
                  "refine the mesh under the tip or change the depth a little");
  }
};

SphereContact::SphereContact(const BodyModel& model, const std::vector<std::uint8_t>& held,
                             const Vec3& point, const Vec3& normal, double reach)
    : impl_(std::make_unique<Impl>(model, held)) {
  for (const LawPointer& law : model.laws)
    if (law && !law->small_strain())
      fail_input("", "a sphere's contact needs laws of small strain",
                 "use isotropic or transverse");
  impl_->point = point;
  impl_->normal = normal.normalized();
  impl_->choose_faces(reach);
  impl_->find_compliance();
}

SphereContact::~SphereContact() = default;

int SphereContact::hats() const {
  return static_cast<int>(impl_->area.size());
}

VectorXd SphereContact::field() const {
  return impl_->field;
}

SpherePress SphereContact::press(double radius, double depth) const {
  const Impl& c = *impl_;
  VectorXd gap, by_radius, pressure;
  c.gaps(radius, gap, by_radius);
  const std::vector<Index> active = c.active_set(gap - depth * c.area, pressure);
  SpherePress result;
  c.field = c.fields * pressure;
  result.force = c.area.dot(pressure);
  // Pressures by depth on the same active set; they carry every other derivative.
  VectorXd by_depth = VectorXd::Zero(pressure.size());
  if (!active.empty())
    by_depth(active) = VectorXd(c.compliance(active, active).llt().solve(VectorXd(c.area(active))));
  result.stiffness = c.area.dot(by_depth);
  result.by_radius = -by_depth.dot(by_radius);
  for (const Index i : active) result.fits = result.fits && !c.rim[static_cast<std::size_t>(i)];
  if (result.force > 0)
    result.contact_radius = std::sqrt(2.5 * c.moment.dot(pressure) / result.force);
  // d force / dc = (d field / d depth)' dK/dc field.
  impl_->assembly.set_state(c.field);
  for (const MatrixXd& d : c.assembly.derivatives(c.fields * by_depth, false).constants)
    result.by_constants.push_back(d.row(0).transpose());
  return result;
}

}  // namespace hapsim
