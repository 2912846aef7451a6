#include "model/field_contacts.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace hapsim {

FieldContacts::FieldContacts(const TetMesh& body, const BodyStiffness& stiffness,
                             double tool_radius, double nu, const FieldGrid& grid)
    : stiffness_(stiffness),
      base_(make_contact_base(body)),
      tool_radius_(tool_radius),
      nu_(nu),
      grid_(grid) {}

FieldContacts::Prepared FieldContacts::prepare(std::size_t position) const {
  {
    const std::lock_guard lock(mutex_);
    if (auto node = kept_.extract(position); !node.empty()) return std::move(node.mapped());
  }
  Prepared prepared{
      std::make_unique<FieldBody>(base_, stiffness_.positions()[position], tool_radius_,
                                  kFieldRim * tool_radius_, kGrowth, grid_),
      {}};
  const Eigen::VectorXd homogeneous =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(grid_.size()));
  const Eigen::Matrix3d coarse = prepared.body->solve(nu_, homogeneous, false).K;
  Eigen::Matrix3d fine, by_nu;
  stiffness_.contacts()[position].stiffness.evaluate(nu_, fine, by_nu);
  prepared.S =
      fine.llt().matrixL().toDenseMatrix() * coarse.llt().matrixL().toDenseMatrix().inverse();
  return prepared;
}

FieldContacts::Contact FieldContacts::at(std::size_t position, const Eigen::VectorXd& field) const {
  Prepared prepared = prepare(position);
  const FieldBody::Solution solution = prepared.body->solve(nu_, field, true);
  Contact contact{prepared.S, solution.K, prepared.body->by_node(solution)};
  const std::lock_guard lock(mutex_);
  if (kept_.size() < kKept) kept_.emplace(position, std::move(prepared));
  return contact;
}

Eigen::Matrix3d FieldContacts::Contact::change_of(const Eigen::Matrix<double, 6, 1>& v) const {
  Eigen::Matrix3d d;
  d << v[0], v[3], v[5], v[3], v[1], v[4], v[5], v[4], v[2];
  return S * d * S.transpose();
}

}  // namespace hapsim
