#include "scan/register.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <optional>

#include "base/error.h"
#include "base/median.h"
#include "io/number.h"
#include "scan/zone_surface.h"

namespace hapsim {
namespace {

constexpr std::size_t kFewest = 12;
constexpr int kRounds = 60, kSeeking = 20;
constexpr double kRest = 0.1;  // standard errors
using Vector6 = Eigen::Matrix<double, 6, 1>;

struct Match {
  int zone, other;
  int index;    // of the point in its zone
  Vec3 point;   // of the zone, in the common frame
  Vec3 normal;  // of the other's surface there
  double off;   // [m]
  double weight = 1;
};

struct Zone {
  std::vector<Vec3> points;  // as read
  Vec3 centre = Vec3::Zero();
  std::unique_ptr<ZoneSurface> surface;
  Pose pose = Pose::Identity();
};

std::vector<Match> match_all(const std::vector<Zone>& zones, double reach) {
  std::vector<Match> matches;
  for (std::size_t z = 0; z < zones.size(); ++z) {
    for (std::size_t o = 0; o < zones.size(); ++o) {
      if (o == z) continue;
      const Pose to_other = zones[o].pose.inverse() * zones[z].pose;
      for (std::size_t i = 0; i < zones[z].points.size(); ++i) {
        const Vec3& p = zones[z].points[i];
        ZoneSurface::Foot foot;
        if (!zones[o].surface->foot(to_other * p, reach, foot)) continue;
        matches.push_back({static_cast<int>(z), static_cast<int>(o), static_cast<int>(i),
                           zones[z].pose * p, zones[o].pose.linear() * foot.normal, foot.distance,
                           1});
      }
    }
  }
  return matches;
}

// The same matches at the zones' present places.
void match_again(const std::vector<Zone>& zones, std::vector<Match>& matches) {
  for (Match& m : matches) {
    const Zone &zone = zones[static_cast<std::size_t>(m.zone)],
               &other = zones[static_cast<std::size_t>(m.other)];
    m.point = zone.pose * zone.points[static_cast<std::size_t>(m.index)];
    ZoneSurface::Foot foot;
    other.surface->foot(other.pose.inverse() * m.point, 1, foot);
    m.normal = other.pose.linear() * foot.normal;
    m.off = foot.distance;
  }
}

// Tukey's weights about the matches' own scale; returns that scale [m].
double weigh(std::vector<Match>& matches) {
  std::vector<double> size;
  for (const Match& m : matches) size.push_back(std::abs(m.off));
  const double scale = std::max(1.4826 * upper_median(size), 1e-9);
  for (Match& m : matches) {
    const double r = m.off / (4.685 * scale);
    m.weight = std::abs(r) < 1 ? (1 - r * r) * (1 - r * r) : 0;
  }
  return scale;
}

// Normal equations in the small motions of all zones but the fixed one: turn about the zone's
// centre and shift.
struct Equations {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
  double squares = 0, weights = 0;
};

Equations equations(const std::vector<Zone>& zones, const std::vector<Match>& matches, int fixed) {
  const auto place = [fixed](int zone) { return zone == fixed ? -1 : 6 * (zone - (zone > fixed)); };
  const auto n = static_cast<Eigen::Index>(6 * (zones.size() - 1));
  Equations e{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (const Match& m : matches) {
    if (m.weight == 0) continue;
    const auto row = [&](int zone, double sign) {
      const Zone& z = zones[static_cast<std::size_t>(zone)];
      Vector6 r;
      r << (m.point - z.pose * z.centre).cross(m.normal), m.normal;
      return Vector6(sign * r);
    };
    const int at[2] = {place(m.zone), place(m.other)};
    const Vector6 rows[2] = {row(m.zone, 1), row(m.other, -1)};
    for (int i = 0; i < 2; ++i) {
      if (at[i] < 0) continue;
      e.b.segment<6>(at[i]) -= m.weight * m.off * rows[i];
      for (int j = 0; j < 2; ++j) {
        if (at[j] < 0) continue;
        e.A.block<6, 6>(at[i], at[j]) += m.weight * rows[i] * rows[j].transpose();
      }
    }
    e.squares += m.weight * m.off * m.off;
    e.weights += m.weight;
  }
  return e;
}

void apply(Zone& zone, const Vector6& step) {
  const Vec3 centre = zone.pose * zone.centre, turn = step.head<3>();
  Pose move = Pose::Identity();
  if (turn.norm() > 0) {
    move.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
  }
  move.translation() = centre + step.tail<3>() - move.linear() * centre;
  zone.pose = move * zone.pose;
}

std::vector<double> zone_rms(const std::vector<Match>& matches, std::size_t zones) {
  std::vector<double> squares(zones, 0), count(zones, 0);
  for (const Match& m : matches) {
    for (const int z : {m.zone, m.other}) {
      squares[static_cast<std::size_t>(z)] += m.off * m.off;
      count[static_cast<std::size_t>(z)] += 1;
    }
  }
  for (std::size_t z = 0; z < zones; ++z)
    squares[z] = std::sqrt(squares[z] / std::max(1., count[z]));
  return squares;
}

std::vector<std::size_t> overlaps(const std::vector<Match>& matches, std::size_t zones) {
  std::vector<std::size_t> count(zones, 0);
  for (const Match& m : matches) {
    ++count[static_cast<std::size_t>(m.zone)];
    ++count[static_cast<std::size_t>(m.other)];
  }
  return count;
}

// Every zone must hang together with the fixed one over pairs of enough matches.
void check_overlap(const Scan& scan, const std::vector<Match>& matches, int fixed,
                   const std::string& name) {
  const std::size_t n = scan.zone_names.size();
  std::vector<std::vector<std::size_t>> pair(n, std::vector<std::size_t>(n, 0));
  for (const Match& m : matches) {
    ++pair[static_cast<std::size_t>(m.zone)][static_cast<std::size_t>(m.other)];
    ++pair[static_cast<std::size_t>(m.other)][static_cast<std::size_t>(m.zone)];
  }
  std::vector<char> reached(n, 0);
  std::vector<std::size_t> open{static_cast<std::size_t>(fixed)};
  reached[open[0]] = 1;
  while (!open.empty()) {
    const std::size_t z = open.back();
    open.pop_back();
    for (std::size_t o = 0; o < n; ++o) {
      if (reached[o] || pair[z][o] < kFewest) continue;
      reached[o] = 1;
      open.push_back(o);
    }
  }
  for (std::size_t z = 0; z < n; ++z) {
    if (reached[z]) continue;
    const std::size_t most = *std::max_element(pair[z].begin(), pair[z].end());
    fail_input(name,
               fmt::format("zone {} overlaps the others too little to say how it drifted: {} "
                           "matches, {} are needed",
                           shown(scan.zone_names[z]), most, kFewest),
               "measure more of the overlap, or leave the zone out");
  }
}

std::vector<Zone> split(const Scan& scan, const std::string& name) {
  std::vector<Zone> zones(scan.zone_names.size());
  for (std::size_t i = 0; i < scan.cloud.points.size(); ++i) {
    zones[static_cast<std::size_t>(scan.zone[i])].points.push_back(scan.cloud.points[i]);
  }
  for (std::size_t z = 0; z < zones.size(); ++z) {
    if (zones[z].points.size() < kFewest) {
      fail_input(
          name,
          fmt::format("zone {} has {} points", shown(scan.zone_names[z]), zones[z].points.size()),
          fmt::format("at least {} are needed to place it", kFewest));
    }
    zones[z].centre =
        std::accumulate(zones[z].points.begin(), zones[z].points.end(), Vec3(0, 0, 0)) /
        static_cast<double>(zones[z].points.size());
    zones[z].surface = std::make_unique<ZoneSurface>(zones[z].points);
  }
  return zones;
}

int choose_fixed(const Scan& scan, const std::vector<Match>& matches, const std::string& wanted,
                 const std::string& name) {
  const auto& names = scan.zone_names;
  if (!wanted.empty()) {
    const auto at = std::find(names.begin(), names.end(), wanted);
    if (at != names.end()) return static_cast<int>(at - names.begin());
    std::string list;
    for (const std::string& n : names) list += " " + n;
    fail_input(name, "there is no zone " + shown(wanted), "the zones are:" + list.substr(0, 300));
  }
  const auto count = overlaps(matches, names.size());
  return static_cast<int>(std::max_element(count.begin(), count.end()) - count.begin());
}

// Standard error of each zone's shift along its least certain direction.
void standard_errors(const Equations& e, int fixed, RegisterReport& report) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(e.A);
  // Each overlap is counted from both sides, so half the weights are independent; and the errors of
  // a surface, which neighbouring matches share, do not average out as those of single points do:
  // 2 sigma^2 a pair of points instead of 1.375 (6 coefficients from 16 neighbours).
  const double freedom = std::max(1.0, e.weights / 2 - static_cast<double>(e.A.rows()));
  const double variance = 1.45 * e.squares / freedom;
  Eigen::VectorXd inverse = solver.eigenvalues();
  const double largest = inverse.maxCoeff();
  for (double& v : inverse) v = v > 1e-12 * largest ? 1 / v : 1e12 / largest;
  const Eigen::MatrixXd covariance =
      variance * solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
  for (std::size_t z = 0; z < report.zones.size(); ++z) {
    if (static_cast<int>(z) == fixed) continue;
    const Eigen::Index at = 6 * (static_cast<Eigen::Index>(z) - (static_cast<int>(z) > fixed)) + 3;
    const Eigen::Matrix3d shift = covariance.block<3, 3>(at, at);
    report.zones[z].error =
        std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(shift).eigenvalues().maxCoeff());
  }
}

// Least squares with damping: directions that the overlap leaves open do not run away.
Eigen::VectorXd solve(const Equations& e) {
  Eigen::MatrixXd A = e.A;
  A.diagonal() += 1e-6 * A.diagonal() + Eigen::VectorXd::Constant(A.rows(), 1e-12);
  return A.ldlt().solve(e.b);
}

}  // namespace

RegisterReport register_zones(Scan& scan, const RegisterOptions& options, const std::string& name) {
  if (scan.zone_names.size() < 2) {
    fail_input(name, "there is only one zone",
               "name the zone of each point in a column 'zone', or give further files by --zone");
  }
  std::vector<Zone> zones = split(scan, name);
  std::vector<Match> matches = match_all(zones, options.most_drift);
  RegisterReport report;
  const int fixed = choose_fixed(scan, matches, options.fixed, name);
  check_overlap(scan, matches, fixed, name);
  report.fixed = scan.zone_names[static_cast<std::size_t>(fixed)];
  const std::vector<double> before = zone_rms(matches, zones.size());

  // Matches are sought anew until the zones lie close, then kept, so that the optimum stands still.
  // At rest: the step is a small part of what the noise leaves uncertain.
  bool at_rest = false;
  double moved = 0;
  for (report.rounds = 0; report.rounds < kRounds && !at_rest; ++report.rounds) {
    const double scale = weigh(matches);
    const Equations e = equations(zones, matches, fixed);
    // Shrinking steps even out that neighbours, and so surfaces, jump a little as zones move.
    const double part = 1 / (1 + std::max(0, report.rounds - kSeeking) / 4.0);
    const Eigen::VectorXd step = part * solve(e);
    moved = 0;
    for (std::size_t z = 0, at = 0; z < zones.size(); ++z) {
      if (static_cast<int>(z) == fixed) continue;
      const Vector6 own = step.segment<6>(static_cast<Eigen::Index>(6 * at++));
      apply(zones[z], own);
      moved = std::max(moved, own.tail<3>().norm());
    }
    const double variance = std::max(e.squares / std::max(e.weights, 1e-9), 1e-24);
    at_rest = step.dot(e.A * step) < kRest * kRest * variance * static_cast<double>(step.size());
    if (report.rounds < kSeeking) {
      matches = match_all(zones, std::clamp(8 * scale, 1e-6, options.most_drift));
      if (matches.size() < kFewest) break;
      at_rest = false;
    } else {
      match_again(zones, matches);
    }
  }
  check_overlap(scan, matches, fixed, name);
  weigh(matches);
  const Equations last = equations(zones, matches, fixed);
  const std::vector<double> after = zone_rms(matches, zones.size());
  const std::vector<std::size_t> overlap = overlaps(matches, zones.size());
  for (std::size_t z = 0; z < zones.size(); ++z) {
    const Pose& pose = zones[z].pose;
    report.zones.push_back({scan.zone_names[z], zones[z].points.size(), overlap[z], pose,
                            pose * zones[z].centre - zones[z].centre,
                            Eigen::AngleAxisd(pose.linear()).angle(), before[z], after[z], 0});
  }
  standard_errors(last, fixed, report);
  for (const ZoneMotion& zone : report.zones) {
    if (zone.error <= options.most_error) continue;
    fail_input(name,
               fmt::format("the overlap leaves the shift of zone {} uncertain by {:.2g} mm",
                           shown(zone.name), 1e3 * zone.error),
               "measure more overlap where the surface bends, or raise --most-shift-error");
  }
  if (!at_rest) {
    fail_numerics(name,
                  fmt::format("the zones do not come to rest ({:.2g} mm a round)", 1e3 * moved),
                  "check that they overlap, or give the largest drift by --most-drift");
  }
  for (std::size_t i = 0; i < scan.cloud.points.size(); ++i) {
    const Pose& pose = zones[static_cast<std::size_t>(scan.zone[i])].pose;
    scan.cloud.points[i] = pose * scan.cloud.points[i];
    if (!scan.cloud.normals.empty()) scan.cloud.normals[i] = pose.linear() * scan.cloud.normals[i];
    if (!scan.to_sensor.empty()) scan.to_sensor[i] = pose.linear() * scan.to_sensor[i];
  }
  return report;
}

}  // namespace hapsim
