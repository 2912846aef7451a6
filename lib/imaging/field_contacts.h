// The contact stiffness of a model's positions when the modulus is a field over the body.
#pragma once

#include <memory>
#include <vector>

#include "base/memo.h"
#include "contact/field_stiffness.h"
#include "experiment/places.h"

namespace hapsim {

// Edge length at the tool's rim over its radius, on the meshes of fields: coarser than a model's,
// whose homogeneous stiffness it is brought to.
constexpr double kFieldRim = 0.25;
// And of an image's sensitivities, which vary over the tool's radius and not within its rim.
constexpr double kSensedRim = 1.0 / 3;

class FieldContacts {
 public:
  // `places` gives the positions and their homogeneous stiffness at `nu`. Meshes and matrices
  // (some 40 MB a position) are kept for the next field, up to `memory` bytes. `rim`: edge length
  // at the tool's rim over its radius.
  FieldContacts(const TetMesh& body, const Places& places, double tool_radius, double nu,
                const FieldGrid& grid, std::size_t memory, double rim = kFieldRim);

  // At one position, for a body whose modulus is exp(field) at the nodes of the grid [N/m]:
  // K = S K_c S' of the coarser mesh's K_c, with S such that a homogeneous body has the model's own
  // K. The derivative by the field's values is `by_node` (rows xx, yy, zz, xy, yz, xz of K_c)
  // within the same S. Thread-safe.
  struct Contact {
    Eigen::Matrix3d S, K_coarse;
    Eigen::MatrixXd by_node;  // 6 x nodes
    Eigen::Matrix3d K() const { return S * K_coarse * S.transpose(); }
    // dK in a direction of the field: `change` = by_node times the change at the nodes.
    Eigen::Matrix3d change_of(const Eigen::Matrix<double, 6, 1>& change) const;
  };
  Contact at(std::size_t position, const Eigen::VectorXd& field);

  const ContactBase& base() const { return base_; }
  const FieldGrid& grid() const { return grid_; }

 private:
  struct Prepared {
    std::unique_ptr<FieldBody> body;
    Eigen::Matrix3d S;
    bool has_S = false;
    std::size_t held_bytes() const { return hapsim::held_bytes(body); }
  };
  std::shared_ptr<Prepared> take(std::size_t position);
  // S of K_coarse, that of the homogeneous body.
  Eigen::Matrix3d scale(std::size_t position, const Eigen::Matrix3d& K_coarse) const;

  Places places_;
  ContactBase base_;
  double tool_radius_, rim_edge_, nu_;
  FieldGrid grid_;
  Memo memo_;
};

}  // namespace hapsim
