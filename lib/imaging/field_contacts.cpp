#include "imaging/field_contacts.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace hapsim {

FieldContacts::FieldContacts(const TetMesh& body, const Places& places, double tool_radius,
                             double nu, const FieldGrid& grid, std::size_t keep)
    : places_(places),
      base_(make_contact_base(body)),
      tool_radius_(tool_radius),
      nu_(nu),
      grid_(grid),
      keep_(keep) {}

FieldContacts::Prepared FieldContacts::take(std::size_t position) {
  {
    const std::lock_guard lock(mutex_);
    if (auto node = kept_.extract(position); !node.empty()) return std::move(node.mapped());
  }
  return {std::make_unique<FieldBody>(base_, places_.position(position), tool_radius_,
                                      kFieldRim * tool_radius_, kGrowth, grid_),
          {},
          false};
}

Eigen::Matrix3d FieldContacts::scale(std::size_t position, const Eigen::Matrix3d& K_coarse) const {
  Eigen::Matrix3d fine, by_nu;
  places_.contact(position).stiffness.evaluate(nu_, fine, by_nu);
  return fine.llt().matrixL().toDenseMatrix() * K_coarse.llt().matrixL().toDenseMatrix().inverse();
}

FieldContacts::Contact FieldContacts::at(std::size_t position, const Eigen::VectorXd& field) {
  Prepared prepared = take(position);
  const Eigen::VectorXd homogeneous = Eigen::VectorXd::Zero(field.size());
  if (!prepared.has_S && field != homogeneous)
    prepared.S = scale(position, prepared.body->solve(nu_, homogeneous, false).K);
  const FieldBody::Solution solution = prepared.body->solve(nu_, field, true);
  if (!prepared.has_S && field == homogeneous) prepared.S = scale(position, solution.K);
  prepared.has_S = true;
  Contact contact{prepared.S, solution.K, prepared.body->by_node(solution)};
  const std::lock_guard lock(mutex_);
  if (kept_.size() < keep_) kept_.emplace(position, std::move(prepared));
  return contact;
}

Eigen::Matrix3d FieldContacts::Contact::change_of(const Eigen::Matrix<double, 6, 1>& v) const {
  Eigen::Matrix3d d;
  d << v[0], v[3], v[5], v[3], v[1], v[4], v[5], v[4], v[2];
  return S * d * S.transpose();
}

}  // namespace hapsim
