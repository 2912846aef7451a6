#include "solid/element_moments.h"

namespace hapsim {
namespace {

struct MeanGradients {
  double volume = 0;
  Eigen::Matrix<double, 3, 10> mean = Eigen::Matrix<double, 3, 10>::Zero();
  explicit MeanGradients(const ElementGradients& e) {
    for (int q = 0; q < e.points; ++q) {
      volume += e.weight[q];
      mean += e.weight[q] * e.gradient[q];
    }
    mean /= volume;
  }
};

}  // namespace

BlockMaker::BlockMaker(const VoigtMatrix& D) {
  constexpr int kVoigt[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) by_gradients_[i][j](k, l) = D(kVoigt[i][k], kVoigt[j][l]);
}

Eigen::Matrix3d BlockMaker::operator()(const Eigen::Matrix3d& g) const {
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) block += g(i, j) * by_gradients_[i][j];
  return block;
}

void element_matrix(const ElementGradients& e, const BlockMaker& block, double kappa, double scale,
                    Eigen::Matrix<double, 30, 30>& K) {
  const MeanGradients m(e);
  for (int a = 0; a < 10; ++a)
    for (int b = a; b < 10; ++b) {
      Eigen::Matrix3d g = Eigen::Matrix3d::Zero();
      for (int q = 0; q < e.points; ++q)
        g.noalias() += e.weight[q] * e.gradient[q].col(a) * e.gradient[q].col(b).transpose();
      Eigen::Matrix3d k = block(g);
      k.noalias() += kappa * m.volume * m.mean.col(a) * m.mean.col(b).transpose();
      K.block<3, 3>(3 * a, 3 * b) = scale * k;
      if (a != b) K.block<3, 3>(3 * b, 3 * a) = scale * k.transpose();
    }
}

FieldMoments::FieldMoments() {
  for (auto& row : strain)
    for (VoigtMatrix& m : row) m.setZero();
}

FieldMoments::FieldMoments(const ElementGradients& e, const Eigen::Matrix<double, 30, 3>& fields)
    : FieldMoments() {
  Eigen::Vector3d dilated = Eigen::Vector3d::Zero();
  double volume_of_element = 0;
  for (int q = 0; q < e.points; ++q) {
    Voigt eps[3];
    for (int i = 0; i < 3; ++i) {
      Eigen::Matrix3d g = Eigen::Matrix3d::Zero();  // d u_r / d x_c
      for (int a = 0; a < 10; ++a)
        g.noalias() += fields.block<3, 1>(3 * a, i) * e.gradient[q].col(a).transpose();
      eps[i] << g(0, 0), g(1, 1), g(2, 2), g(0, 1) + g(1, 0), g(1, 2) + g(2, 1), g(0, 2) + g(2, 0);
      dilated[i] += e.weight[q] * g.trace();
    }
    volume_of_element += e.weight[q];
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) strain[i][j] += e.weight[q] * eps[i] * eps[j].transpose();
  }
  volume = dilated * dilated.transpose() / volume_of_element;
}

void FieldMoments::add(double weight, const FieldMoments& other) {
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) strain[i][j] += weight * other.strain[i][j];
  volume += weight * other.volume;
}

Eigen::Matrix3d FieldMoments::energy(const VoigtMatrix& D, double kappa) const {
  Eigen::Matrix3d k = kappa * volume;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) {
      const double value = strain[i][j].cwiseProduct(D).sum();
      k(i, j) += value;
      if (i != j) k(j, i) += value;
    }
  return k;
}

}  // namespace hapsim
