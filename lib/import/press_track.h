// One press in its own frame: how deep the tip is, and how hard the body pushes back.
#pragma once

#include <vector>

#include "base/vec3.h"
#include "import/import.h"
#include "import/segments.h"

namespace hapsim {

// How displacement comes about, by what the table has.
enum class TrackMethod {
  kDisplacement,   // it is in the table
  kTipAndContact,  // tip minus contact point
  kTipAlone,       // contact is found on the path of the tip
  kDepth,          // depth along the normal (or --direction) from a contact point
};

struct TrackPlan {
  TrackMethod method = TrackMethod::kDepth;
  const std::vector<Vec3>* tip = nullptr;      // kTip*
  const std::vector<Vec3>* origin = nullptr;   // point from which the tip's displacement counts
  const std::vector<Vec3>* contact = nullptr;  // contact point on the surface; null: --at
  bool ball_centres = false;                   // tip and origin are both centres of the tool's ball
  bool has_normal = false;
  bool plane = false;  // contact is x and y on a flat top
};

// Error(kBadInput) when the table has neither displacement, tip nor depth, or no force.
TrackPlan plan_tracks(const Samples& samples, const ColumnMap& map, const std::string& file);

struct PressTrack {
  Segment segment;
  Vec3 outward = Vec3::UnitZ();  // normal of the undeformed surface
  Vec3 contact = Vec3::Zero();   // contact point on it [m]
  std::vector<Vec3> u;           // displacement of the tip from there [m]
  std::vector<Vec3> f;           // force of the body on the tool [N]
  std::vector<double> travel;    // inward way of the tip, zero as in the table [m]
  std::vector<double> force;     // outward part of the force [N]
};

// Tracks of all presses with signs put right: travel grows as the force does, the force points
// outward. Contact is still where the table says; see place_contacts.
std::vector<PressTrack> make_tracks(const Samples& samples, const TrackPlan& plan,
                                    std::vector<Segment> segments, const ImportOptions& options,
                                    Notes& notes);

// Finds the contact of each press where the table does not give it (or as options.contact says),
// sets u = 0 there, and drops presses that never touch. `travel_zero_is_arbitrary`: the depth is a
// machine's.
void place_contacts(std::vector<PressTrack>& tracks, const TrackPlan& plan,
                    const ImportOptions& options, bool travel_zero_is_arbitrary, Notes& notes);

}  // namespace hapsim
