#include "realtime/place_model.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "realtime/direction_doubt.h"

namespace hapsim {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Packed = Eigen::Matrix<double, 6, 1>;

constexpr std::array<double, 4> kWidths{0.7, 1.5, 3, 6};  // of the windows, in tool radii
// L keeps within the samples' eigenvalues by so much: beyond, a trend that was not asked for
// explodes.
constexpr double kBeyondSamples = 1;
constexpr double kPrior = 4;  // samples that stand for the global variance where few are near

constexpr Index kNearest = 6;  // samples that count in full, at least

constexpr double kThin = 0.5;  // of a half-space's compliance may be missing, without more ado

// Symmetric tensors as vectors of the same norm.
Packed pack(const Matrix3d& m) {
  const double s = std::sqrt(2.0);
  Packed v;
  v << m(0, 0), m(1, 1), m(2, 2), s * m(0, 1), s * m(1, 2), s * m(0, 2);
  return v;
}

Matrix3d unpack(const Packed& v) {
  const double s = std::sqrt(0.5);
  Matrix3d m;
  m << v[0], s * v[3], s * v[5], s * v[3], v[1], s * v[4], s * v[5], s * v[4], v[2];
  return m;
}

template <class Function>
Matrix3d of_eigenvalues(const Matrix3d& m, const Function& f) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(m);
  const Vec3 values = eigen.eigenvalues().unaryExpr(f);
  return eigen.eigenvectors() * values.asDiagonal() * eigen.eigenvectors().transpose();
}

// Compliance over the half-space's where the body has x of it beyond: 1 + x, but positive. On a
// thin part x is about -1, and the coarse mesh errs.
double positive_share(double x) {
  return x > -kThin ? 1 + x : (1 - kThin) * std::exp((x + kThin) / (1 - kThin));
}

// The trend with the ridge under which places that are left out, with all six components of each,
// are off least (Allen, Technometrics 16, 1974, by blocks): its weights, and by how much their
// squared residuals are larger than those of places that are not.
struct Ridge {
  VectorXd weights;
  double optimism = 1;
};

Ridge ridge_fit(const std::vector<StiffnessSample>& samples, const std::vector<Packed>& values) {
  const Index columns = samples.front().view.basis.cols();
  const auto n = static_cast<Index>(samples.size());
  MatrixXd A(6 * n, columns);
  VectorXd y(6 * n);
  for (Index i = 0; i < n; ++i) {
    A.middleRows<6>(6 * i) = samples[static_cast<std::size_t>(i)].view.basis;
    y.segment<6>(6 * i) = values[static_cast<std::size_t>(i)];
  }
  VectorXd scale = (A.colwise().squaredNorm() / static_cast<double>(6 * n)).cwiseSqrt().transpose();
  scale = scale.unaryExpr([](double s) { return s < 1e-9 ? 0 : 1 / s; });
  A = A * scale.asDiagonal();
  const MatrixXd H = A.transpose() * A;
  const VectorXd b = A.transpose() * y;
  Ridge best;
  double least = std::numeric_limits<double>::infinity();
  for (double trial = 1e-6; trial < 2; trial *= 10) {
    MatrixXd regular = H;
    regular.diagonal().array() += trial * static_cast<double>(6 * n);
    const Eigen::LLT<MatrixXd> factor(regular);
    const VectorXd w = factor.solve(b);
    const VectorXd off = y - A * w;
    const MatrixXd leverage = factor.matrixL().solve(A.transpose());
    double outside = 0;
    for (Index i = 0; i < n; ++i) {
      const auto own = leverage.middleCols<6>(6 * i);
      const Eigen::Matrix<double, 6, 6> left =
          Eigen::Matrix<double, 6, 6>::Identity() - own.transpose() * own;
      outside += left.ldlt().solve(off.segment<6>(6 * i)).squaredNorm();
    }
    if (outside >= least) continue;
    least = outside;
    best.weights = w.cwiseProduct(scale);
    best.optimism = off.squaredNorm() > 0 ? std::clamp(outside / off.squaredNorm(), 1.0, 9.0) : 1;
  }
  return best;
}

}  // namespace

Matrix3d disc_compliance(double modulus, double nu, double radius, const Vec3& normal) {
  const double shear = modulus / (2 * (1 + nu)), x = 1 - 2 * nu;
  const double along =
      x < 1e-6 ? 1 / (8 * shear * radius) : x / (4 * shear * radius * std::log1p(2 * x));
  const double across = (2 - nu) / (8 * shear * radius);
  const Matrix3d n = normal * normal.transpose();
  return along * n + across * (Matrix3d::Identity() - n);
}

PlaceViews::PlaceViews(const Surface& surface, const std::vector<std::uint8_t>& bonded,
                       double tool_radius, FieldMaterial material,
                       std::shared_ptr<const FarCompliance> far)
    : radius_(tool_radius),
      material_(std::move(material)),
      far_material_(material_),
      far_(std::move(far)) {
  for (const double width : kWidths) windows_.emplace_back(surface, bonded, width * tool_radius);
}

PlaceViews PlaceViews::with(FieldMaterial material) const {
  PlaceViews other = *this;
  other.material_ = std::move(material);
  return other;
}

PlaceView PlaceViews::at(const Vec3& point) const {
  PlaceView view;
  view.point = point;
  std::vector<SurfaceView> seen;
  for (const SurfaceWindow& window : windows_) seen.push_back(window.at(point));
  view.normal = seen.front().normal.normalized();
  const Vec3& n = view.normal;
  view.turned = 1 - seen[1].normal.dot(n);
  const Matrix3d along = n * n.transpose(), across = Matrix3d::Identity() - along;
  std::vector<double> f;
  for (const SurfaceView& s : seen) {
    f.push_back(s.normal.dot(n) - 1);
    f.push_back(s.shape.trace());
    f.push_back(std::sqrt(s.marked));
  }
  const double modulus = material_.modulus(point);
  const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
  for (const double width : {1.0, 2.5, 6.0}) {  // what lies around, over what lies here
    double sum = 0;
    for (int k = 0; k < 12; ++k) {
      const double angle = k * 0.5235987755982988;
      sum += material_.modulus(point + width * radius_ *
                                           (std::cos(angle) * u + std::sin(angle) * v - 0.5 * n));
    }
    f.push_back(std::log(sum / (12 * modulus)));
  }
  view.features = Eigen::Map<VectorXd>(f.data(), static_cast<Index>(f.size()));

  const Matrix3d disc = disc_compliance(modulus, material_.nu, radius_, n);
  const auto root = [](double c) { return std::sqrt(c); };
  Matrix3d expected = disc;
  Packed beyond = Packed::Zero();
  if (far_) {
    const double scale = far_material_.modulus(point) / modulus;
    const Matrix3d C = of_eigenvalues(disc, root), back = C.inverse();
    const Matrix3d over = back * (scale * far_->at(point, n)) * back;
    const Matrix3d share = of_eigenvalues(over, [](double x) { return positive_share(x); });
    view.yields = Eigen::SelfAdjointEigenSolver<Matrix3d>(share).eigenvalues()[2];
    beyond = pack(of_eigenvalues(share, [](double x) { return std::log(x); }));
    expected = C * share * C;
  }
  view.reference = of_eigenvalues(expected, [](double c) { return 1 / std::sqrt(c); });
  std::vector<Packed> basis;
  std::vector<double> first{1}, second{1};
  first.insert(first.end(), f.begin(), f.end());
  second = first;
  for (std::size_t i = 0; i < f.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) second.push_back(f[i] * f[j]);
  const Packed nn = pack(along), tt = pack(across) / std::sqrt(2.0);
  for (const double s : second) {
    basis.push_back(s * nn);
    basis.push_back(s * tt);
  }
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const Vec3 m = across * seen[k].normal;
    const Matrix3d tilt = n * m.transpose(), square = m * m.transpose();
    const Packed tilted = pack(tilt + tilt.transpose());
    const Packed drawn = pack(square - 0.5 * square.trace() * across) / std::max(0.05, m.norm());
    const Matrix3d bent = across * seen[k].shape * across;
    const Packed curved = pack(bent - 0.5 * bent.trace() * across);
    for (const double s : first) {
      if (k > 0) {  // the normal is the first window's own
        basis.push_back(s * tilted);
        basis.push_back(s * drawn);
      }
      basis.push_back(s * curved);
    }
  }
  // Beside the support and where the coarse mesh errs, the expected is off by a share of this.
  if (far_)
    for (const double s : first) basis.push_back(s * beyond);
  view.basis.resize(6, static_cast<Index>(basis.size()));
  for (std::size_t b = 0; b < basis.size(); ++b) view.basis.col(static_cast<Index>(b)) = basis[b];
  return view;
}

PlaceModel::PlaceModel(const std::vector<StiffnessSample>& samples, double noise,
                       const PlaceModel* like)
    : noise_(noise) {
  std::vector<Packed> values;
  std::vector<PlaceView> views;
  for (const StiffnessSample& s : samples) {
    const Matrix3d back = s.view.reference.inverse();
    values.push_back(pack(of_eigenvalues(back * s.K * back, [this](double k) {
      const double l = std::log(k);
      least_ = std::min(least_, l - kBeyondSamples);
      most_ = std::max(most_, l + kBeyondSamples);
      return l;
    })));
    views.push_back(s.view);
  }
  Ridge ridge = ridge_fit(samples, values);
  weights_ = std::move(ridge.weights);
  optimism_ = ridge.optimism;
  const auto n = static_cast<Index>(samples.size());
  VectorXd mean = VectorXd::Zero(views.front().features.size()), squares = mean;
  for (const PlaceView& v : views) mean += v.features / static_cast<double>(n);
  for (const PlaceView& v : views)
    squares += (v.features - mean).cwiseAbs2() / static_cast<double>(n);
  feature_scale_ = squares.unaryExpr([&](double s) {
    return s < 1e-12 ? 0 : 1 / std::sqrt(s * static_cast<double>(mean.size()));
  });
  MatrixXd left(n, 6);
  for (Index i = 0; i < n; ++i) {
    const auto s = static_cast<std::size_t>(i);
    left.row(i) = (values[s] - trend(views[s])).transpose();
  }
  KrigingCoordinates places{rows(views), {3, 6, 6 + mean.size()}};
  residual_ = std::make_unique<Kriging>(std::move(places), left,
                                        like == nullptr ? nullptr : &like->residual_->scales());
  squares_ = (residual_->left_out().rowwise().squaredNorm().array() /
              (6 * residual_->variance() * residual_->left_out_variance().array()))
                 .matrix();
}

MatrixXd PlaceModel::rows(const std::vector<PlaceView>& views) const {
  MatrixXd result(static_cast<Index>(views.size()), 6 + feature_scale_.size());
  for (std::size_t i = 0; i < views.size(); ++i)
    result.row(static_cast<Index>(i)) << views[i].point.transpose(), views[i].normal.transpose(),
        views[i].features.cwiseProduct(feature_scale_).transpose();
  return result;
}

Packed PlaceModel::trend(const PlaceView& view) const {
  return view.basis * weights_;
}

VectorXd PlaceModel::inflation(const MatrixXd& covariance) const {
  // By the samples that are alike, and by the nearest however little these have in common: what
  // varies fast, as on rough limbs, has none that are alike. The larger holds.
  MatrixXd alike = covariance, nearest = covariance;
  const Index nth = std::min<Index>(kNearest, covariance.cols()) - 1;
  for (Index i = 0; i < covariance.rows(); ++i) {
    VectorXd row = covariance.row(i).transpose();
    std::nth_element(row.data(), row.data() + nth, row.data() + row.size(), std::greater<>());
    nearest.row(i) = (nearest.row(i).array() / std::max(row[nth], 1e-12)).min(1.0);
  }
  const auto mean_square = [this](MatrixXd& weights) -> VectorXd {
    weights = weights.array().pow(4);
    return ((weights * squares_).array() + kPrior) / (weights.rowwise().sum().array() + kPrior);
  };
  return optimism_ * mean_square(alike).cwiseMax(mean_square(nearest));
}

std::vector<PlaceEstimate> PlaceModel::at(const std::vector<PlaceView>& views,
                                          bool uncertainty) const {
  std::vector<PlaceEstimate> result(views.size());
  if (views.empty()) return result;
  const MatrixXd covariance = residual_->covariance(rows(views));
  const MatrixXd mean = residual_->mean(covariance);
  VectorXd variance;
  if (uncertainty)
    // An error D of L, of variance s^2 in each packed component, changes the force K u by
    // |R D R u| / |K u|: sqrt(2) s, all directions alike.
    variance = 2 * (residual_->variance() *
                        (residual_->posterior_variance(covariance).array() + residual_->nugget()) *
                        inflation(covariance).array() +
                    noise_ * noise_)
                       .matrix();
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto row = static_cast<Index>(i);
    const Packed L = trend(views[i]) + mean.row(row).transpose();
    result[i].K =
        views[i].reference *
        of_eigenvalues(unpack(L),
                       [this](double l) { return std::exp(std::clamp(l, least_, most_)); }) *
        views[i].reference;
    if (uncertainty) result[i].uncertainty = std::sqrt(variance[row]);
  }
  return result;
}

std::vector<std::size_t> PlaceModel::most_wanted(const std::vector<PlaceView>& pool,
                                                 std::size_t count) const {
  const MatrixXd where = rows(pool);
  MatrixXd C = residual_->posterior_covariance(where);
  VectorXd scale = inflation(residual_->covariance(where)).cwiseSqrt();
  const std::vector<PlaceEstimate> stiffness = at(pool, false);
  for (Index i = 0; i < scale.size(); ++i)
    scale[i] *= mean_direction_doubt(stiffness[static_cast<std::size_t>(i)].K);
  C = scale.asDiagonal() * C * scale.asDiagonal();
  // Each choice takes its share of the variance of all others: Cholesky with pivots.
  std::vector<std::size_t> chosen;
  VectorXd rest = C.diagonal();
  const double noise = residual_->nugget();
  MatrixXd L(C.rows(), static_cast<Index>(count));
  for (Index k = 0; k < static_cast<Index>(count); ++k) {
    Index best = 0;
    if (rest.maxCoeff(&best) <= 0) break;
    L.col(k) = (C.col(best) - L.leftCols(k) * L.row(best).head(k).transpose()) /
               std::sqrt(rest[best] + noise * scale[best] * scale[best]);
    rest -= L.col(k).cwiseAbs2();
    rest[best] = 0;
    chosen.push_back(static_cast<std::size_t>(best));
  }
  return chosen;
}

double PlaceModel::left_out_error() const {
  return std::sqrt(2 * optimism_ * residual_->left_out().squaredNorm() /
                   static_cast<double>(residual_->left_out().size()));
}

}  // namespace hapsim
