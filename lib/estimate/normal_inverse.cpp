#include "estimate/normal_inverse.h"

#include <Eigen/QR>

namespace hapsim {

Eigen::MatrixXd normal_inverse(Eigen::MatrixXd J) {
  const Eigen::Index m = J.cols();
  if (J.rows() > m) {
    Eigen::HouseholderQR<Eigen::Ref<Eigen::MatrixXd>> qr(J);  // in place
    J = Eigen::MatrixXd(J.topRows(m).triangularView<Eigen::Upper>());
  }
  const Eigen::MatrixXd inverse = J.completeOrthogonalDecomposition().pseudoInverse();
  return inverse * inverse.transpose();
}

}  // namespace hapsim
