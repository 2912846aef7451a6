#include "imaging/field_contacts.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <string>

namespace hapsim {

FieldContacts::FieldContacts(const TetMesh& body, const Places& places, double tool_radius,
                             double nu, const FieldGrid& grid, std::size_t memory, double rim)
    : places_(places),
      base_(make_contact_base(body)),
      tool_radius_(tool_radius),
      rim_edge_(rim * tool_radius),
      nu_(nu),
      grid_(grid),
      memo_(memory) {}

std::shared_ptr<FieldContacts::Prepared> FieldContacts::take(std::size_t position) {
  if (auto kept = memo_.take<Prepared>(std::to_string(position))) return kept;
  auto prepared = std::make_shared<Prepared>();
  prepared->body = std::make_unique<FieldBody>(base_, places_.position(position), tool_radius_,
                                               rim_edge_, kGrowth, grid_);
  return prepared;
}

Eigen::Matrix3d FieldContacts::scale(std::size_t position, const Eigen::Matrix3d& K_coarse) const {
  Eigen::Matrix3d fine, by_nu;
  places_.contact(position).stiffness.evaluate(nu_, fine, by_nu);
  return fine.llt().matrixL().toDenseMatrix() * K_coarse.llt().matrixL().toDenseMatrix().inverse();
}

FieldContacts::Contact FieldContacts::at(std::size_t position, const Eigen::VectorXd& field) {
  std::shared_ptr<Prepared> prepared = take(position);
  const Eigen::VectorXd homogeneous = Eigen::VectorXd::Zero(field.size());
  if (!prepared->has_S && field != homogeneous)
    prepared->S = scale(position, prepared->body->solve(nu_, homogeneous, false).K);
  const FieldBody::Solution solution = prepared->body->solve(nu_, field, true);
  if (!prepared->has_S && field == homogeneous) prepared->S = scale(position, solution.K);
  prepared->has_S = true;
  Contact contact{prepared->S, solution.K, prepared->body->by_node(solution)};
  memo_.put_if_room(std::to_string(position), std::move(prepared));
  return contact;
}

Eigen::Matrix3d FieldContacts::Contact::change_of(const Eigen::Matrix<double, 6, 1>& v) const {
  Eigen::Matrix3d d;
  d << v[0], v[3], v[5], v[3], v[1], v[4], v[5], v[4], v[2];
  return S * d * S.transpose();
}

}  // namespace hapsim
