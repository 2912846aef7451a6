// A flat tool that slips on a body of finite strain: the held response at the way that its contact
// has not slipped, and what friction leaves of that (strain_slip.h).
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "realtime/force_loop.h"

namespace hapsim {
namespace {

constexpr int kParts = StrainSlip::kSliders + 1;  // the sliders, and one for all of them
constexpr int kWhole = kParts - 1;
constexpr int kSlides = 8;          // rounds until the bounds follow the force
constexpr double kSlideEnd = 1e-4;  // of the tool's radius: of a slider's way then
// Standard, over the force: what is taken as the same for all depths and directions, and is not.
constexpr double kSlipDoubt = 0.008, kSlidDoubt = 0.012, kRetreatDoubt = 0.06;
constexpr double kTurns = 0.02;  // tool radii of another way, or of one at all
constexpr double kAllSlid = 0.1, kLeastSlid = 0.3;
constexpr double kSlippedFar = 0.5;  // tool radii, from which on the contact is elsewhere

// While the tool goes in, its rim slips inwards too, and of what friction bears a part has that
// direction: by how much the tool goes aside and in (tool radii), as a share of mu N. `held`: the
// way aside that the body is held at, which goes with the depth.
double drawn_along(double aside, double deeper, double held, double depth) noexcept {
  constexpr double kInwards = 0.08, kLeast = 0.9;  // slip of the rim over the way in
  if (!(deeper > 0)) return 1;
  const double slips = std::max(0.0, aside / deeper - held / depth);
  return std::max(kLeast, slips / std::hypot(slips, kInwards));
}

using Ways = Eigen::Matrix<double, 3, kParts>;

}  // namespace

LargeStrain::Force ForceLoop::slide(const StepSample& sample, const Vec3& u) noexcept {
  const LargeStrain& strain = *body_.large_strain();
  const StrainSlip& law = *strain.slip();
  const double a = body_.tool_radius();
  const Vec3& n = state_.place.normal;
  const Eigen::Matrix3d flat = Eigen::Matrix3d::Identity() - n * n.transpose();
  double* const memory = state_.memory.data() + slip_memory_;
  Eigen::Map<Ways> slipped(memory);
  Eigen::Map<Vec3> last_along(memory + 3 * kParts);
  Eigen::Map<Vec3> farthest(memory + 3 * kParts + 3);
  double &deepest = memory[3 * kParts + 6], &slid = memory[3 * kParts + 7],
         &turned = memory[3 * kParts + 8];
  const Vec3 along = flat * u;
  const double d = -u.dot(n) / a;
  if (sample.first || sample.in_air) {
    slipped.setZero();
    farthest.setZero();
    deepest = slid = turned = 0;
    last_along = along;
  }
  const Ways trial = (-(flat * slipped)).colwise() + along;
  const double aside = (along - last_along).norm() / a, deeper = d - deepest;
  last_along = along;
  // Another way than it came, out, back or across, the rim sticks, and is as stiff as the rest.
  const double far = farthest.norm();
  double back = 0;
  if (far > kTurns * a) {
    const Vec3 since = trial.col(kWhole) - farthest;
    back = since.norm() - std::max(0.0, since.dot(farthest) / far);
  }
  turned = std::max(turned, std::min(1.0, (back / a - deeper) / kTurns));
  if (deeper > 0) {
    // What goes on in slips at its rim anew.
    slid *= deepest / d;
    turned *= deepest / d;
    deepest = d;
  }
  const double slid_before = slid, sticks = law.sticks(d);
  double* const remembered = state_.memory.data() + strain_memory_;
  std::copy_n(remembered, before_.size(), before_.data());
  LargeStrain::Force f;
  Ways way = trial;
  Vec3 sideways = Vec3::Zero();
  double factor = 1, pushes = 0, bears = 0;
  for (int round = 0; round < kSlides; ++round) {
    if (round > 0) std::copy_n(before_.data(), before_.size(), remembered);
    const Vec3 mean = way.col(kWhole);  // at which the body is held
    const Vec3 held = u - along + mean;
    const double still = -n.dot(strain.force(strain_, held).f);
    f = strained(sample, held);
    pushes = -n.dot(f.f);
    // Sideways a body that relaxes is as much stiffer than at rest as it is along the normal, where
    // it is.
    const double ratio = still > 0 ? std::clamp(pushes / still, 1.0, 10.0) : 1;
    const Eigen::Matrix3d K = ratio * (flat * strain.tangent(strain_, held) * flat);
    const Eigen::Matrix3d give = flat * (K + K.trace() * n * n.transpose()).inverse() * flat;
    const Vec3 across = flat * f.f;
    factor = law.normal(d, deepest, slid);
    bears = law.friction * std::max(0.0, factor * pushes);
    sideways.setZero();
    for (int j = 0; j < kParts; ++j) {
      const auto slider = static_cast<std::size_t>(j % kWhole);
      const bool whole = j == kWhole;
      const double share = whole ? law.share_slid : sticks * law.share[slider],
                   most = bears * (whole ? 1 / law.share_slid : law.bound[slider] / sticks);
      Vec3 own = across + K * (trial.col(j) - mean);
      const double size = own.norm();
      if (!whole) way.col(j) = trial.col(j);
      if (size > most) {
        if (!whole) way.col(j) -= (1 - most / size) * (give * own);
        own *= most / size;
      }
      sideways += (whole ? turned : 1 - turned) * share * own;
    }
    const double most = bears * drawn_along(aside, deeper, mean.norm() / a, d);
    if (sideways.norm() > most) sideways *= most / sideways.norm();
    slid = std::max(slid_before, StrainSlip::slid_at(bears > 0 ? sideways.norm() / bears : 1));
    way.col(kWhole) = mean + give * (sideways / law.share_slid - across);
    if (round > 0 && (way.col(kWhole) - mean).norm() <= kSlideEnd * a) break;
  }
  if (StrainSlip::slid_at(1) <= slid + kAllSlid) turned = 1;
  if (way.col(kWhole).norm() > farthest.norm() || turned >= 1) farthest = way.col(kWhole);
  slipped = (-way).colwise() + along;
  const double size = f.f.norm();
  f.f = sideways - factor * pushes * n;
  if (f.f.norm() > 0) {
    const double out = deepest > 0 ? 1 - std::clamp(d / deepest, 0.0, 1.0) : 0;
    const double way_out = kRetreatDoubt * out * out * std::max(slid, kLeastSlid);
    f.doubt = std::hypot(f.doubt * size / f.f.norm(), law.doubt_at(d),
                         std::hypot(kSlipDoubt + kSlidDoubt * slid, way_out));
  }
  constexpr double kSeenAll = 0.95;  // then it was seen to slip as a whole
  if (law.seen < kSeenAll && sideways.norm() > law.seen * bears) f.within = false;
  if (d > law.deepest() || slipped.col(kWhole).norm() > kSlippedFar * a) f.within = false;
  return f;
}

}  // namespace hapsim
