// The stiffness of a body whose modulus is a field, with its derivative by every value of the
// field.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "solid/elastic_body.h"
#include "tetmesh/contact_mesh.h"

namespace hapsim {

// A regular grid of nodes over a box; between them values are trilinear, outside constant.
struct FieldGrid {
  Vec3 low = Vec3::Zero();
  double step = 5e-3;                 // [m], alike along all axes
  std::array<int, 3> count{1, 1, 1};  // nodes along x, y, z
  std::size_t size() const {
    return static_cast<std::size_t>(count[0]) * static_cast<std::size_t>(count[1]) *
           static_cast<std::size_t>(count[2]);
  }
  std::size_t index(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(count[1]) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(count[0]) +
           static_cast<std::size_t>(i);
  }
  Vec3 node(std::size_t n) const;
  // Adds `factor` times the trilinear weights of a point to a vector of size().
  void add_weights(const Vec3& p, double factor, Eigen::Ref<Eigen::VectorXd> weights) const;
  double value(const Eigen::VectorXd& field, const Vec3& p) const;
};

// One contact mesh, to be solved for many fields log E(x). Not to be shared between threads.
class FieldBody {
 public:
  // The logarithm of an element's modulus is the mean of the field over it (8 or 64 parts of equal
  // volume), so that the stiffness depends smoothly on every value whatever the mesh. `growth`: as
  // in make_contact_mesh(). Cost: one mesh and the analysis of its matrix.
  FieldBody(const ContactBase& base, const Vec3& position, double radius, double rim_edge,
            double growth, const FieldGrid& grid);

  struct Solution {
    Eigen::Matrix3d K;                        // [N/m]
    std::vector<Eigen::Matrix3d> by_element;  // dK / dlog E of each element [N/m]; their sum is K
  };
  // K alone, or with the energies of the unit fields in every element, which are its derivatives:
  // one factorisation and one solution either way. `log_modulus`: at the grid's nodes.
  Solution solve(double nu, const Eigen::VectorXd& log_modulus, bool derivatives);
  // From derivatives by element to those by node: 6 x nodes, rows xx, yy, zz, xy, yz, xz.
  Eigen::MatrixXd by_node(const Solution& solution) const;

  std::size_t elements() const { return contact_.mesh.tets.size(); }
  const Vec3& normal() const { return contact_.normal; }
  std::size_t held_bytes() const {
    return hapsim::held_bytes(contact_) + hapsim::held_bytes(body_) + hapsim::held_bytes(weights_);
  }

 private:
  ContactMesh contact_;
  FieldGrid grid_;
  std::unique_ptr<ElasticBody> body_;
  // For each element the nodes of the grid that it lies between, and their weights.
  std::vector<std::vector<std::pair<int, double>>> weights_;
};

}  // namespace hapsim
