#include "diagnose/place_freedom.h"

#include <Eigen/Dense>

#include "fit/learned_field.h"

namespace hapsim {

PlaceFreedom::PlaceFreedom(const Fit& fitted, const TrialGround& g, const Eigen::VectorXd& forces,
                           const Weights& weights) {
  if (!learns_field(fitted.model)) return;
  const Selection all = all_episodes(g.dataset);
  const PlaceField field = place_field(fitted.model);
  const std::vector<Vec3> motion = motion_on_body(fitted.model, g.experiment, fitted.about, all);
  places_.resize(g.dataset.positions.size());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(forces.size(), 12);
  Eigen::Index at = 0;
  for (const int e : all) {
    const Episode& episode = g.dataset.episodes[static_cast<std::size_t>(e)];
    std::vector<Eigen::Index>& rows = places_[static_cast<std::size_t>(episode.position)].rows;
    for (std::size_t i = 0; i < episode.rows.size(); ++i, at += 3) {
      for (int k = 0; k < 3; ++k) rows.push_back(at + k);
      if (episode.view.in_air[i]) continue;
      const double depth = -motion[static_cast<std::size_t>(at / 3)].dot(episode.view.normal);
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
