// Contact stiffness anywhere on a body from samples of it, with its standard uncertainty.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "estimate/kriging.h"
#include "mesh/surface_window.h"
#include "realtime/far_compliance.h"

namespace hapsim {

// The compliance of a half-space under a bonded rigid disc [m/N], normal outward and unit: along it
// (1 - 2 nu) / (4 G a ln(3 - 4 nu)) (Mossakovskii, PMM 18, 1954), across it (2 - nu) / (8 G a)
// (Johnson, Contact Mechanics, 3.7 and 7.2).
Eigen::Matrix3d disc_compliance(double modulus, double nu, double radius, const Vec3& normal);

struct FieldMaterial {
  double nu = 0.3;
  std::function<double(const Vec3&)> modulus;  // E [Pa] about a place
};

// What the shape of the body about a place says of its stiffness there.
struct PlaceView {
  Vec3 point, normal;
  Eigen::VectorXd features;                        // scalars
  Eigen::Matrix<double, 6, Eigen::Dynamic> basis;  // tensors that turn with the body, packed
  Eigen::Matrix3d reference;                       // root of the stiffness to be expected
  double yields = 1;  // largest compliance over a half-space's: much above one on limbs
  double turned = 0;  // what the surface within some two tool radii lacks of facing one way
};

// Views through windows of 0.7 to 6 tool radii. The stiffness to be expected is the inverse of the
// half-space's compliance and what the body yields beyond it. Thread-safe.
class PlaceViews {
 public:
  // `bonded`: one a face; `far`: of this material, may be null.
  PlaceViews(const Surface& surface, const std::vector<std::uint8_t>& bonded, double tool_radius,
             FieldMaterial material, std::shared_ptr<const FarCompliance> far);
  PlaceView at(const Vec3& point) const;
  // The same body of another material: what it yields as a whole goes with the modulus.
  PlaceViews with(FieldMaterial material) const;
  Vec3 normal_at(const Vec3& point) const { return windows_.front().at(point).normal.normalized(); }

 private:
  std::vector<SurfaceWindow> windows_;
  double radius_;
  FieldMaterial material_, far_material_;
  std::shared_ptr<const FarCompliance> far_;
};

struct StiffnessSample {
  PlaceView view;
  Eigen::Matrix3d K;  // [N/m]
};

struct PlaceEstimate {
  Eigen::Matrix3d K;  // [N/m], positive definite
  // Relative standard uncertainty of the force, where all directions are as stiff (else times
  // direction_doubt()).
  double uncertainty = 0;
};

// L = log(R^-1 K R^-1), R the root of what is expected: a trend, linear in the views' tensors, with
// the ridge under which places that are left out are off least, and what the trend leaves as a
// Gaussian process over place, normal and features (universal kriging in two stages). Its variance
// is scaled by the squared residuals of samples that are left out: by those that are alike or by
// the nearest, whichever are larger.
class PlaceModel {
 public:
  // `noise`: standard deviation of what samples of the coarser mesh scatter about the finer ones'
  // [-, of L]. `like`: takes its covariance.
  PlaceModel(const std::vector<StiffnessSample>& samples, double noise,
             const PlaceModel* like = nullptr);
  std::vector<PlaceEstimate> at(const std::vector<PlaceView>& views, bool uncertainty) const;
  // Places of the pool whose samples would tell most, the best first.
  std::vector<std::size_t> most_wanted(const std::vector<PlaceView>& pool, std::size_t count) const;
  // Relative error of the force at samples from all others, root mean square.
  double left_out_error() const;

 private:
  Eigen::MatrixXd rows(const std::vector<PlaceView>& views) const;
  Eigen::Matrix<double, 6, 1> trend(const PlaceView& view) const;
  Eigen::VectorXd inflation(const Eigen::MatrixXd& covariance) const;

  double noise_, optimism_ = 1;
  double least_ = 1e300, most_ = -1e300;  // that an eigenvalue of L may be
  Eigen::VectorXd feature_scale_, weights_;
  Eigen::VectorXd squares_;  // of the standardised left-out residuals, by sample
  std::unique_ptr<Kriging> residual_;
};

}  // namespace hapsim
