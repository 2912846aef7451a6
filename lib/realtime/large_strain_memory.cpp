// What bodies that relax remember at places between samples.
#include "realtime/large_strain.h"
#include "realtime/least_turn.h"

namespace hapsim {
namespace {

constexpr double kOtherSide = -0.9;  // cosine of the normals

}  // namespace

void LargeStrain::remember(const Place& place, const Vec3& before, Memory& memory) const noexcept {
  const double a = options_.tool_radius;
  const Vec3& n = place.normal;
  // Turned on from the place before as little as can be, so that what is remembered stays as it was
  // under a tool that slides; the other side of a body is a new place.
  if (before.squaredNorm() > 0 && n.dot(before) > kOtherSide) {
    memory.frame = (memory.frame * least_turn(n, before)).eval();
  } else {
    const Vec3 e = n.unitOrthogonal();
    memory.frame << -n.transpose(), e.transpose(), n.cross(e).transpose();
  }
  const Eigen::Matrix3d& frame = memory.frame;
  memory.at = StrainMemory();
  for (int k = 0; k < place.count; ++k) {
    const StrainMemory& known = *samples_[static_cast<std::size_t>(place.sample[k])].sample.memory;
    add_turned(known, a * place.A[k] * frame.transpose(), place.weight[k], memory.at);
  }
  memory.at.C.topLeftCorner<3, 3>() += frame * place.K * frame.transpose() / place.stiffness;
  memory.at.C *= place.stiffness * a;
  memory.at.inside.scale(place.stiffness * a);
}

MemoryPoint LargeStrain::memory_point(const Place& place, const Memory& memory,
                                      const Vec3& u) const noexcept {
  const Held at = hold(place, u);
  return hapsim::memory_point(memory.frame * at.held / options_.tool_radius,
                              memory.frame * at.rest / options_.tool_radius);
}

}  // namespace hapsim
