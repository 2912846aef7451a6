#include "diagnose/place_freedom.h"

#include <Eigen/Dense>
#include <algorithm>

#include "fit/learned_field.h"

namespace hapsim {
namespace {

// A sample that is called air may be the first touch of its place where it lies no further above
// the place than that share of the press's depth.
constexpr double kFirstTouch = 0.2;

// As deep as the deepest sample, where no field says it.
PlaceField field_of(const Fit& fitted, const TrialGround& g) {
  if (learns_field(fitted.model)) return place_field(fitted.model);
  PlaceField field;
  for (const Vec3& u : g.dataset.recording.u) field.depth = std::max(field.depth, u.norm());
  return field;
}

}  // namespace

PlaceFreedom::PlaceFreedom(const Fit& fitted, const TrialGround& g, const Eigen::VectorXd& forces,
                           const Weights& weights, bool asked) {
  if (!asked && !learns_field(fitted.model)) return;
  const Selection all = all_episodes(g.dataset);
  const PlaceField field = field_of(fitted, g);
  const std::vector<Vec3> motion = motion_on_body(fitted.model, g.experiment, fitted.about, all);
  places_.resize(g.dataset.positions.size());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(forces.size(), 12);
  Eigen::Index at = 0;
  for (const int e : all) {
    const Episode& episode = g.dataset.episodes[static_cast<std::size_t>(e)];
    std::vector<Eigen::Index>& rows = places_[static_cast<std::size_t>(episode.position)].rows;
    const auto depth_of = [&](Eigen::Index row) {
      return -motion[static_cast<std::size_t>(row / 3)].dot(episode.view.normal);
    };
    double deepest = 0;
    for (std::size_t i = 0; i < episode.rows.size(); ++i)
      deepest = std::max(deepest, depth_of(at + 3 * static_cast<Eigen::Index>(i)));
    for (std::size_t i = 0; i < episode.rows.size(); ++i, at += 3) {
      for (int k = 0; k < 3; ++k) rows.push_back(at + k);
      const double depth = depth_of(at);
      if (episode.view.in_air[i] && depth < -kFirstTouch * deepest) continue;
      const double f = forces.segment<3>(at).norm(), power = field.log_depth(depth)[0];
      const double laws[] = {1, f, f * power, f * power * power};
      for (Eigen::Index k = 0; k < 4; ++k)
        columns.block<3, 3>(at, 3 * k).diagonal().setConstant(laws[k]);
    }
  }
  weights.whiten(columns);
  for (Place& place : places_) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns(place.rows, Eigen::all));
    place.Q = qr.householderQ() *
              Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(place.rows.size()), qr.rank());
  }
}

void PlaceFreedom::take_out(Eigen::Ref<Eigen::MatrixXd> columns) const {
  for (const Place& place : places_) {
    const Eigen::MatrixXd part = columns(place.rows, Eigen::all);
    columns(place.rows, Eigen::all) = part - place.Q * (place.Q.transpose() * part);
  }
}

}  // namespace hapsim
