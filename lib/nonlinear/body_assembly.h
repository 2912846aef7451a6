// Energy, nodal forces, tangent and parameter derivatives of a deformed body, element by element.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "material/material_law.h"
#include "mesh/tetmesh.h"
#include "nonlinear/stress_response.h"
#include "solid/dilatation.h"
#include "solid/foundation.h"
#include "solid/node_system.h"

namespace hapsim {

// A spring from a node to the ground, symmetric positive semidefinite stiffness [N/m]: a compliant
// support, or (very stiff along one direction) a node that slides.
struct NodeSpring {
  int node = 0;
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
};

// Nodes that the ground holds together: symmetric positive semidefinite stiffness over all of them
// (3 nodes squared, node by node) [N/m].
struct FaceSpring {
  std::vector<int> nodes;
  Eigen::MatrixXd stiffness;
};

// What is deformed. The mesh and the laws must outlive its use.
struct BodyModel {
  const TetMesh* mesh = nullptr;
  std::vector<LawPointer> laws;  // by region number
  std::vector<int> law_of_tet;   // empty: mesh->region
  std::vector<double> scale;     // factor on the energy, one a tetrahedron; empty: 1
  Dilatation dilatation = Dilatation::kPointwise;
  Foundation foundation;
  std::vector<NodeSpring> springs;
  std::vector<FaceSpring> face_springs;
};

// Stresses that act beside the laws', fixed in the material: second Piola-Kirchhoff stress at each
// quadrature point and pressure of each dilatation group (BodyAssembly counts both) [Pa].
struct PointStresses {
  std::vector<Voigt> S;
  std::vector<double> pressure;
  Eigen::VectorXd numbers() const;  // as StressResponse has them
};

// For pictures, one a tetrahedron, means over its undeformed volume.
struct ElementFields {
  std::vector<Voigt> stress;   // Cauchy's, added stresses included [Pa]
  std::vector<double> energy;  // of the laws' elastic stresses, per undeformed volume [J/m^3]
};

// Total Lagrangian (Bonet and Wood, Nonlinear Continuum Mechanics for Finite Element Analysis,
// 2008, ch. 8-9): for each quadrature point of weight w with F = 1 + sum of u_a (x) G_a,
//   energy  = sum w s w(C) + sum over dilatation groups W U(theta) + foundation + springs
//             + sum w S0.E + sum over groups V p0 (theta - 1) of the added stresses,
//   r_a     = sum w F S G_a,
//   K_ab    = sum w (B_a' D B_b + (G_a.S G_b) 1) + W U''/V^2 b_a b_b',  b = V dtheta/du.
// Quadrature as in element_gradients(). Displacements u: 3 nodes [m].
class BodyAssembly {
 public:
  // Error(kBadInput) when a tetrahedron has no law or a scale is not positive.
  explicit BodyAssembly(const BodyModel& model);

  const TetMesh& mesh() const { return *mesh_; }
  Cliques cliques() const;  // elements, then patches, foundation faces, springs of both kinds
  void set_laws(const std::vector<LawPointer>& laws);  // as many as before, same small_strain()
  void set_scale(const std::vector<double>& scale);
  // Stresses beside the laws' (sizes as elastic_stresses(); empty: none); counts from the next
  // set_state().
  void set_added(PointStresses added) { added_ = std::move(added); }
  // The laws' own stresses at the state, their factors included.
  PointStresses elastic_stresses() const;
  // With how they and the strains change along fields (3 nodes x m).
  StressResponse stress_response(const Eigen::MatrixXd& fields, const StressPart& part) const;
  // Nodal forces of such stresses alone (StressResponse's numbers) at the displacements u: straight
  // in the stresses, of second degree in u at most.
  Eigen::VectorXd forces_of(const Eigen::VectorXd& stress, const Eigen::VectorXd& u) const;
  // The law of each quadrature point and of each group, in their order.
  void laws_of_stresses(std::vector<int>& of_point, std::vector<int>& of_group) const;
  ElementFields element_fields() const;

  // The state of later calls. False when an element is inverted or the energy is not finite; the
  // state is then unusable.
  bool set_state(const Eigen::VectorXd& u);
  double energy() const { return energy_; }                 // [J]
  const Eigen::VectorXd& forces() const { return force_; }  // that hold the nodes [N]

  // Adds the tangent at the state to `system` and keeps the dense matrices of all cliques that have
  // a node with kept[node] in `kept_matrices` (clique, matrix).
  using CliqueMatrix = std::pair<std::size_t, Eigen::MatrixXd>;
  void tangent(NodeSystem& system, const std::vector<char>& kept,
               std::vector<CliqueMatrix>& kept_matrices) const;

  // Adds to `system` a spring from each node of each element to the ground, of `share` of a modulus
  // over the element's size: what makes a tangent positive definite that is not.
  void stiffen(NodeSystem& system, double share) const;

  // Derivatives of phi'.forces() by parameters at fixed displacement, for fields phi (3 nodes x m).
  struct Derivatives {
    std::vector<Eigen::MatrixXd> constants;  // by law: m x its constants
    Eigen::MatrixXd foundation;              // m x 2: by k_n, k_t [N m / Pa]
    Eigen::MatrixXd scale;                   // m x tetrahedra [N]; empty unless asked
  };
  Derivatives derivatives(const Eigen::MatrixXd& fields, bool by_scale) const;

  // The stiffest law's for a confined compression [Pa].
  double modulus() const { return modulus_; }
  // Modulus times area [N]: what rounding is judged by.
  double force_unit() const { return force_unit_; }

 private:
  struct Point;  // kinematics of one quadrature point
  template <int N>
  bool state_pass();
  template <int N>
  void tangent_pass(NodeSystem& system, const std::vector<char>& kept,
                    std::vector<CliqueMatrix>& kept_matrices) const;
  template <int N>
  Derivatives derivative_pass(const Eigen::MatrixXd& fields, bool by_scale) const;
  template <int N>
  void stress_pass(PointStresses& stresses) const;
  template <int N>
  void load_pass(const Eigen::VectorXd& stress, const Eigen::VectorXd& u,
                 Eigen::VectorXd& force) const;
  template <int N>
  void response_pass(const Eigen::MatrixXd& fields, const StressPart& part,
                     StressResponse& response) const;
  template <int N>
  void field_pass(ElementFields& fields) const;
  template <int N>
  Point point(std::size_t tet, int q, const Eigen::Matrix<double, 3, N>& u) const;
  template <int N>
  Eigen::Matrix<double, 3, N> gather(const Eigen::VectorXd& field, std::size_t tet) const;
  int group(std::size_t tet, int q) const;
  void build_groups();

  const TetMesh* mesh_;
  std::vector<LawPointer> laws_;
  std::vector<int> law_;
  std::vector<double> scale_;
  Dilatation dilatation_;
  std::vector<FoundationFace> faces_;
  std::vector<NodeSpring> springs_;
  double k_normal_, k_tangential_;
  std::vector<FaceSpring> face_springs_;
  PointStresses added_;
  int points(std::size_t tet) const { return first_point_[tet + 1] - first_point_[tet]; }
  int nodes_;                        // a tetrahedron
  std::vector<int> first_point_{0};  // of each tetrahedron, and one past the last
  std::vector<double> gradient_;     // 3 x nodes of each point, one after the other
  std::vector<double> weight_;       // of each point [m^3]

  struct Group {
    double volume = 0, weight = 0;       // V and W = sum of s w [m^3]
    double theta = 0;                    // mean
    double pressure = 0, stiffness = 0;  // W U'/V [Pa], W U''/V^2 [Pa/m^3]
    int law = 0;
  };
  std::vector<Group> groups_;
  std::vector<int> patch_;               // one a tetrahedron, with kPatch
  Cliques patch_nodes_;                  // with kPatch
  std::vector<std::vector<int>> local_;  // with kPatch: place of the element's nodes in its patch

  Eigen::VectorXd u_, force_;
  double energy_ = 0, force_unit_ = 0, modulus_ = 0;
};

}  // namespace hapsim
