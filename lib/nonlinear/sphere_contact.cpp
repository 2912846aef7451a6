#include "nonlinear/sphere_contact.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "nonlinear/tip_surface.h"

namespace hapsim {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

struct SphereContact::Impl {
  BodyAssembly assembly;
  NodeSystem system;
  Vec3 point, normal;
  const TetMesh* mesh;
  TipSurface surface;
  VectorXd moment;  // integral of each hat times r^2 about the axis
  MatrixXd fields;  // displacements of unit pressure on each hat
  MatrixXd compliance;

  Impl(const BodyModel& model, const std::vector<std::uint8_t>& held, const Vec3& at,
       const Vec3& outward, double reach)
      : assembly(model),
        system(free_nodes(held), assembly.cliques()),
        point(at),
        normal(outward),
        mesh(model.mesh),
        surface(*model.mesh, at, outward, reach) {}

  // Distance from the axis and height above the point.
  std::pair<double, double> place(const TipSurface::Point& p) const {
    const Vec3 x = p.position - point;
    const double z = x.dot(normal);
    return {(x - z * normal).norm(), z};
  }

  static std::vector<char> free_nodes(const std::vector<std::uint8_t>& held) {
    std::vector<char> free;
    for (const auto h : held) free.push_back(h == 0);
    return free;
  }

  void find_compliance() {
    const Index hats = surface.area.size();
    MatrixXd load = MatrixXd::Zero(3 * static_cast<Index>(mesh->nodes.size()), hats);
    moment = VectorXd::Zero(hats);
    for (const TipSurface::Point& p : surface.points) {
      const std::vector<int>& f = surface.faces[p.face];
      const double r = place(p).first;
      for (std::size_t i = 0; i < 3; ++i) {
        const double share = p.area * p.corner[i];
        moment[p.hat[i]] += share * r * r;
        for (std::size_t b = 0; b < f.size(); ++b)
          load.block<3, 1>(3 * f[b], p.hat[i]) -= share * p.shape[b] * normal;
      }
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
  // derivative by the tip's radius.
  void gaps(double R, VectorXd& gap, VectorXd& by_radius) const {
    gap = by_radius = VectorXd::Zero(surface.area.size());
    for (const TipSurface::Point& p : surface.points) {
      const auto [r, z] = place(p);
      const SphereHeight sphere = sphere_height(R, r);
      for (std::size_t i = 0; i < 3; ++i) {
        gap[p.hat[i]] += p.area * p.corner[i] * (sphere.height - z);
        by_radius[p.hat[i]] += p.area * p.corner[i] * sphere.by_radius;
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
    : impl_(std::make_unique<Impl>(model, held, point, normal.normalized(), reach)) {
  for (const LawPointer& law : model.laws)
    if (law && !law->small_strain())
      fail_input("", "a sphere's contact needs laws of small strain",
                 "use isotropic or transverse");
  impl_->find_compliance();
}

SphereContact::~SphereContact() = default;

int SphereContact::hats() const {
  return static_cast<int>(impl_->surface.area.size());
}

SpherePress SphereContact::press(double radius, double depth) {
  Impl& c = *impl_;
  VectorXd gap, by_radius, pressure;
  c.gaps(radius, gap, by_radius);
  const std::vector<Index> active = c.active_set(gap - depth * c.surface.area, pressure);
  SpherePress result;
  result.field = c.fields * pressure;
  result.force = c.surface.area.dot(pressure);
  // Pressures by depth on the same active set; they carry every other derivative.
  VectorXd by_depth = VectorXd::Zero(pressure.size());
  if (!active.empty())
    by_depth(active) =
        VectorXd(c.compliance(active, active).llt().solve(VectorXd(c.surface.area(active))));
  result.stiffness = c.surface.area.dot(by_depth);
  result.by_radius = -by_depth.dot(by_radius);
  for (const Index i : active)
    result.fits = result.fits && !c.surface.rim[static_cast<std::size_t>(i)];
  if (result.force > 0)
    result.contact_radius = std::sqrt(2.5 * c.moment.dot(pressure) / result.force);
  // d force / dc = (d field / d depth)' dK/dc field.
  c.assembly.set_state(result.field);
  for (const MatrixXd& d : c.assembly.derivatives(c.fields * by_depth, false).constants)
    result.by_constants.push_back(d.row(0).transpose());
  return result;
}

}  // namespace hapsim
