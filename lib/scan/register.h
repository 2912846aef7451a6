// Zones of one surface that drifted against each other, brought together as rigid bodies.
#pragma once

#include <string>
#include <vector>

#include "robot/pose.h"
#include "scan/scan.h"

namespace hapsim {

struct RegisterOptions {
  std::string fixed;          // zone that stays; "" for the one with most overlap
  double most_drift = 0.01;   // shifts looked for [m]
  double most_error = 0.001;  // largest standard error of a shift that is accepted [m]
};

struct ZoneMotion {
  std::string name;
  std::size_t points = 0;
  std::size_t overlap = 0;         // matches with other zones, both ways
  Pose motion = Pose::Identity();  // applied to its points
  Vec3 shift = Vec3::Zero();       // of its centre [m]
  double turn = 0;                 // [rad]
  double rms_before = 0;           // of its matches' distance from the other zones' surface [m]
  double rms_after = 0;
  double error = 0;  // standard error of its shift in the least certain direction [m]
};

struct RegisterReport {
  std::vector<ZoneMotion> zones;
  std::string fixed;
  int rounds = 0;
};

// Moves all zones but one so that they agree where they overlap: every point is matched with the
// surface of each other zone near it (a quadric through that zone's nearest points; not beyond the
// zone's rim), and the squared distances along that surface's normal of all matches of all pairs
// are minimised together over all zones' motions (point to plane: Chen, Medioni 1992; all views at
// once: Pulli 1999), with Tukey's weights and a reach that shrinks from `most_drift`. Standard
// errors are those of the least squares. Error(kBadInput, name): a zone that overlaps with fewer
// than 12 matches or is not connected with the rest, a shift that the overlap leaves uncertain by
// more than `most_error` (a flat overlap slides); Error(kNoConvergence): no convergence.
RegisterReport register_zones(Scan& scan, const RegisterOptions& options, const std::string& name);

}  // namespace hapsim
