#include "import/press_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/median.h"
#include "import/contact_onset.h"
#include "import/sliding.h"

namespace hapsim {
namespace {

std::vector<Vec3> pick(const std::vector<Vec3>& all, const std::vector<int>& rows) {
  std::vector<Vec3> some;
  for (const int row : rows) some.push_back(all[at(row)]);
  return some;
}

// How strongly two series rise together: covariance about their medians.
double common_rise(const std::vector<double>& a, const std::vector<double>& b) {
  const double ma = median(a), mb = median(b);
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - ma) * (b[i] - mb);
  return sum;
}

// The same over the way to the force that differs most from the first: a long hold in which the
// force relaxes says nothing of the direction.
double loading_rise(std::vector<double> travel, std::vector<double> force) {
  std::size_t way = 0;
  for (std::size_t i = 0; i < force.size(); ++i)
    if (std::abs(force[i] - force[0]) >= std::abs(force[way] - force[0])) way = i;
  if (++way >= 5) {
    travel.resize(way);
    force.resize(way);
  }
  return common_rise(travel, force);
}

std::vector<double> force_sizes(const Samples& samples, const std::vector<int>& rows) {
  std::vector<double> sizes;
  for (const int row : rows)
    sizes.push_back(samples[VectorRole::kForce].empty()
                        ? samples[ScalarRole::kForce][at(row)]
                        : samples[VectorRole::kForce][at(row)].norm());
  if (!samples[VectorRole::kForce].empty()) return sizes;
  // A scalar may count either way, and from an offset: its size is its distance from where it
  // starts.
  const double start = sizes.front();
  for (double& size : sizes) size = std::abs(size - start);
  return sizes;
}

Vec3 path_direction(const std::vector<Vec3>& path, const std::vector<double>& force) {
  const auto peak = std::max_element(force.begin(), force.end()) - force.begin();
  const auto low = std::min_element(force.begin(), force.begin() + peak + 1) - force.begin();
  const Vec3 way = path[static_cast<std::size_t>(peak)] - path[static_cast<std::size_t>(low)];
  return way.norm() > 1e-9 ? Vec3(way.normalized()) : Vec3(0, 0, -1);
}

Vec3 mean_normal(const std::vector<Vec3>& normals, const std::vector<int>& rows) {
  Vec3 sum = Vec3::Zero();
  for (const int row : rows) sum += normals[at(row)].stableNormalized();
  return sum.norm() > 1e-9 ? Vec3(sum.normalized()) : Vec3::UnitZ();
}

class TrackMaker {
 public:
  TrackMaker(const Samples& samples, const TrackPlan& plan, const ImportOptions& options,
             Notes& notes)
      : samples_(samples), plan_(plan), options_(options), notes_(notes) {}

  std::vector<PressTrack> make(std::vector<Segment> segments) {
    std::vector<PressTrack> tracks;
    for (Segment& segment : segments) {
      PressTrack track;
      track.segment = std::move(segment);
      set_direction(track);
      set_travel(track);
      tracks.push_back(std::move(track));
    }
    turn_normals(tracks);
    for (PressTrack& track : tracks) set_contact(track);
    for (PressTrack& track : tracks) set_force(track);
    turn_forces(tracks);
    return tracks;
  }

 private:
  void set_direction(PressTrack& track) const {
    const auto& rows = track.segment.rows;
    if (track.segment.sliding)
      track.outward = mean_force_direction(samples_, rows);
    else if (plan_.has_normal)
      track.outward = mean_normal(samples_[VectorRole::kNormal], rows);
    else if (plan_.tip)
      track.outward = -path_direction(pick(*plan_.tip, rows), force_sizes(samples_, rows));
    else if (plan_.method == TrackMethod::kDisplacement)
      track.outward = -path_direction(pick(samples_[VectorRole::kDisplacement], rows),
                                      force_sizes(samples_, rows));
    else
      track.outward = -options_.direction.normalized();
  }

  void set_travel(PressTrack& track) const {
    track.travel.clear();
    for (const int row : track.segment.rows) {
      double inward = 0;
      if (plan_.method == TrackMethod::kDisplacement)
        inward = -samples_[VectorRole::kDisplacement][at(row)].dot(track.outward);
      else if (plan_.tip)
        inward =
            ((plan_.origin ? (*plan_.origin)[at(row)] : Vec3(Vec3::Zero())) - (*plan_.tip)[at(row)])
                .dot(track.outward);
      else
        inward = samples_[ScalarRole::kDepth][at(row)];
      track.travel.push_back(inward);
    }
  }

  // The force must grow as the tip goes inward; else normals point inward, or the depth counts
  // outward.
  void turn_normals(std::vector<PressTrack>& tracks) {
    double rise = 0;
    for (const PressTrack& track : tracks)
      if (!track.segment.sliding)
        rise += loading_rise(track.travel, force_sizes(samples_, track.segment.rows));
    if (rise >= 0) return;
    if (plan_.method == TrackMethod::kDepth) {
      notes_.facts.push_back("the depth grows outward: its sign was changed");
    } else if (plan_.has_normal) {
      notes_.facts.push_back("the normals point inward: they were turned");
    }
    for (PressTrack& track : tracks) {
      if (plan_.method != TrackMethod::kDepth) track.outward = -track.outward;
      for (double& s : track.travel) s = -s;
    }
  }

  void set_contact(PressTrack& track) const {
    const auto& rows = track.segment.rows;
    const int first = rows.front();
    if (plan_.contact)
      track.contact = (*plan_.contact)[at(first)];
    else if (plan_.origin)
      track.contact = (*plan_.origin)[at(first)];
    else if (plan_.tip)
      track.contact = (*plan_.tip)[at(first)];
    else
      track.contact = options_.at.value_or(Vec3::Zero());
    if (plan_.ball_centres && !plan_.contact)
      track.contact -= options_.tool_radius.value_or(0) * track.outward;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (plan_.method == TrackMethod::kDisplacement)
        track.u.push_back(samples_[VectorRole::kDisplacement][at(rows[i])]);
      else if (plan_.method == TrackMethod::kTipAndContact)
        track.u.push_back((*plan_.tip)[at(rows[i])] - (*plan_.origin)[at(rows[i])]);
      else if (plan_.tip)
        track.u.push_back((*plan_.tip)[at(rows[i])] - track.contact);
      else
        track.u.push_back(-track.travel[i] * track.outward);
    }
  }

  void set_force(PressTrack& track) const {
    for (const int row : track.segment.rows) {
      if (samples_[VectorRole::kForce].empty()) {
        track.f.push_back(samples_[ScalarRole::kForce][at(row)] * track.outward);
        continue;
      }
      const Vec3& force = samples_[VectorRole::kForce][at(row)];
      if (options_.force == "normal")
        track.f.push_back(force.dot(track.outward) * track.outward);
      else if (options_.force == "magnitude")
        track.f.push_back(force.norm() * track.outward);
      else
        track.f.push_back(force);
    }
  }

  // What the body does to the tool points outward. Sensors that count the other way are turned.
  void turn_forces(std::vector<PressTrack>& tracks) {
    double outward = 0;
    std::size_t against = 0;
    for (const PressTrack& track : tracks) outward += rise_of(track);
    const double sign = outward < 0 ? -1 : 1;
    for (const PressTrack& track : tracks) against += sign * rise_of(track) < 0;
    if (sign < 0) notes_.facts.push_back("forces pointed into the body: their sign was changed");
    if (10 * against > tracks.size())
      notes_.warnings.push_back(fmt::format(
          "in {} of {} presses the force points against the others", against, tracks.size()));
    double along = 0, total = 0;
    for (PressTrack& track : tracks)
      for (Vec3& force : track.f) {
        force *= sign;
        track.force.push_back(force.dot(track.outward));
        along += std::abs(track.force.back());
        total += force.norm();
      }
    if (along < 0.6 * total)
      notes_.warnings.push_back(fmt::format(
          "only {:.0f} % of the force is along the normal: is it in the sensor's frame? "
          "--force magnitude puts it along the normal",
          100 * along / total));
  }

  // Growth of the outward force over the press, so an offset of the sensor does not decide.
  double rise_of(const PressTrack& track) const {
    std::vector<double> force;
    for (const Vec3& f : track.f) force.push_back(f.dot(track.outward));
    const double together = loading_rise(track.travel, force);
    double sum = 0;
    for (const double f : force) sum += f;
    if (track.segment.sliding) return sum;
    const double spread = *std::max_element(track.travel.begin(), track.travel.end()) -
                          *std::min_element(track.travel.begin(), track.travel.end());
    return spread > 1e-9 ? together / spread : sum;
  }

  const Samples& samples_;
  const TrackPlan& plan_;
  const ImportOptions& options_;
  Notes& notes_;
};

}  // namespace

std::vector<PressTrack> make_tracks(const Samples& samples, const TrackPlan& plan,
                                    std::vector<Segment> segments, const ImportOptions& options,
                                    Notes& notes) {
  return TrackMaker(samples, plan, options, notes).make(std::move(segments));
}

}  // namespace hapsim
