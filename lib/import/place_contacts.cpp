#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "base/median.h"
#include "import/contact_onset.h"
#include "import/press_track.h"

namespace hapsim {
namespace {

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

// The tip where its travel reaches `depth`; beyond the ends along the normal.
Vec3 displacement_at(const PressTrack& track, double depth) {
  for (std::size_t i = 0; i + 1 < track.travel.size(); ++i) {
    const double a = track.travel[i], b = track.travel[i + 1];
    if (a <= depth && depth <= b && b > a)
      return track.u[i] + (depth - a) / (b - a) * (track.u[i + 1] - track.u[i]);
  }
  return track.u.front() - (depth - track.travel.front()) * track.outward;
}

// Makes `depth` of the travel the point of contact. `moves` is whether the tip's path says where
// that is.
void set_zero(PressTrack& track, double depth, bool moves) {
  const Vec3 shift = displacement_at(track, depth);
  if (moves) track.contact += shift;
  for (Vec3& u : track.u) u -= shift;
  for (double& s : track.travel) s -= depth;
}

// A ball's centre is outside the surface by its radius when the ball touches: much force while the
// centre has not reached the contact point. Returns the median height of the centre at contact, 0
// when the tip itself was recorded. (Contact points declared at a small force leave little force
// before them.)
double centre_height(const std::vector<PressTrack>& tracks) {
  std::vector<double> heights;
  std::size_t outside = 0;
  for (const PressTrack& track : tracks) {
    const ContactOnset onset = find_contact_onset(track.travel, track.force);
    if (!onset.found) continue;
    heights.push_back(-onset.depth);
    double before = 0;
    for (std::size_t i = 0; i < track.travel.size(); ++i)
      if (track.travel[i] < 0) before = std::max(before, track.force[i] - onset.baseline);
    outside += before > 0.25 * (largest(track.force) - onset.baseline);
  }
  return !heights.empty() && 2 * outside > heights.size() ? std::max(0.0, median(heights)) : 0;
}

void correct_ball_centres(std::vector<PressTrack>& tracks, const ImportOptions& options,
                          Notes& notes) {
  double height = 0;
  if (options.tip == "centre" && options.tool_radius) {
    height = *options.tool_radius;
  } else if (options.tip == "auto" || options.tip == "centre") {
    height = centre_height(tracks);
    if (height <= 0) return;
    if (options.tool_radius && std::abs(height - *options.tool_radius) < 0.5 * *options.tool_radius)
      height = *options.tool_radius;
    notes.warnings.push_back(
        fmt::format("the tip stays {:.2f} mm outside the contact points: taken for the centre of a "
                    "ball, and moved by that "
                    "(--tip surface keeps it; --tool-radius says it exactly)",
                    1e3 * height));
  }
  for (PressTrack& track : tracks) {
    for (Vec3& u : track.u) u -= height * track.outward;
    for (double& s : track.travel) s += height;
  }
}

// A depth whose zero means contact keeps it, unless the force says that the tool was still in the
// air.
bool trusts_zero(const PressTrack& track, const ContactOnset& onset) {
  const double reach = largest(track.travel);
  return !(onset.air_samples >= 5 && onset.depth > 0.08 * reach) && reach > 0;
}

}  // namespace

void place_contacts(std::vector<PressTrack>& tracks, const TrackPlan& plan,
                    const ImportOptions& options, bool travel_zero_is_arbitrary, Notes& notes) {
  const bool tip_given = plan.method == TrackMethod::kTipAndContact && !plan.ball_centres;
  if (tip_given && options.tip != "surface") correct_ball_centres(tracks, options, notes);

  const bool machine = plan.method == TrackMethod::kDepth && (!plan.contact || plan.plane);
  const bool no_zero =
      plan.method == TrackMethod::kTipAlone || (machine && travel_zero_is_arbitrary);
  const bool doubtful = machine && !travel_zero_is_arbitrary;
  const bool find =
      options.contact == "find" || (options.contact == "auto" && (no_zero || doubtful));
  std::vector<PressTrack> kept;
  std::map<int, double> zero_of_recording;  // a machine's zero holds for all of one recording
  std::vector<double> early, extrapolated;
  std::size_t untouched = 0;
  for (PressTrack& track : tracks) {
    if (track.segment.sliding) {
      const double some = 0.2 * largest(track.force);
      const auto first = std::find_if(track.force.begin(), track.force.end(),
                                      [some](double f) { return f >= some; });
      set_zero(track, track.travel[static_cast<std::size_t>(first - track.force.begin())], true);
      kept.push_back(std::move(track));
      continue;
    }
    const ContactOnset onset = find_contact_onset(track.travel, track.force);
    const double top = largest(track.force);
    const bool shared =
        plan.method == TrackMethod::kDepth && zero_of_recording.count(track.segment.recording) > 0;
    // A recording of a hold alone has no onset, but a depth below the surface and a force.
    const bool holds = doubtful && options.contact == "auto" && top > 6 * onset.noise && top > 0;
    if (!onset.found && find && !shared && !holds) {
      ++untouched;
      continue;
    }
    double zero = onset.depth;
    if (shared)
      zero = zero_of_recording[track.segment.recording];
    else if (doubtful && options.contact == "auto" && (!onset.found || trusts_zero(track, onset)))
      zero = 0;
    if (find) {
      zero_of_recording[track.segment.recording] = zero;
      if (!shared && zero != 0 && onset.air_samples < 3) extrapolated.push_back(zero);
      set_zero(track, zero, !machine);
    } else if (onset.found && top > 0) {
      early.push_back(onset.depth / std::max(1e-9, largest(track.travel)));
    }
    kept.push_back(std::move(track));
  }
  tracks = std::move(kept);
  if (untouched)
    notes.warnings.push_back(fmt::format(
        "{} presses never touch (the force stays within its noise): left out", untouched));
  if (!extrapolated.empty() && !tracks.empty())
    notes.facts.push_back(fmt::format(
        "{} of {} presses begin in contact: the contact point was extrapolated from the force",
        extrapolated.size(), tracks.size()));
  if (find && plan.tip != nullptr && options.tip == "centre")
    for (PressTrack& track : tracks)
      track.contact -= options.tool_radius.value_or(0) * track.outward;
  if (early.size() >= 3 && std::abs(median(early)) > 0.15)
    notes.warnings.push_back(
        fmt::format("by the force, contact begins at {:.0f} % of the depth from the given contact "
                    "points (median); "
                    "--contact find moves them there",
                    100 * median(early)));
}

}  // namespace hapsim
