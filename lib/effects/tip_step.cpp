#include "effects/tip_step.h"

#include <algorithm>
#include <optional>

#include "effects/tip_law.h"

namespace hapsim::tip {
namespace {

// The way in as numbers in a loop's memory: their count, then the rings. When it is full every
// second ring is forgotten, those at its ends apart.
class PathMemory {
 public:
  static constexpr std::size_t kMost = 4096, kNumbers = 1 + 7 * kMost;
  explicit PathMemory(double* memory) : memory_(memory) {}
  std::size_t size() const { return static_cast<std::size_t>(memory_[0]); }
  bool empty() const { return memory_[0] == 0; }
  void clear() { memory_[0] = 0; }
  Ring operator[](std::size_t k) const {
    const double* ring = at(k);
    return {ring[0], Eigen::Map<const Vec3>(ring + 1), Eigen::Map<const Vec3>(ring + 4)};
  }
  void pop_back() { --memory_[0]; }
  void push_back(const Ring& ring) {
    if (size() == kMost) forget_half();
    put(size(), ring);
    ++memory_[0];
  }
  // The same, in stead of a last ring as deep as this and as the one before it, which no other asks
  // for: a tool that is held still adds nothing.
  void go_on(const Ring& ring, double still) {
    if (size() > 1 && ring.z - at(size() - 2)[0] <= still) pop_back();
    push_back(ring);
  }

 private:
  double* at(std::size_t k) const { return memory_ + 1 + 7 * k; }
  void put(std::size_t k, const Ring& ring) {
    at(k)[0] = ring.z;
    Eigen::Map<Vec3>(at(k) + 1) = ring.side;
    Eigen::Map<Vec3>(at(k) + 4) = ring.force;
  }
  void forget_half() {
    std::size_t kept = 1;
    for (std::size_t k = 2; k < kMost - 1; k += 2) put(kept++, (*this)[k]);
    put(kept++, (*this)[kMost - 1]);
    memory_[0] = static_cast<double>(kept);
  }
  double* memory_;
};

// Remembers the last displacement and the way in.
class TipStep : public EffectStep {
 public:
  TipStep(double kappa, double radius) : kappa_(kappa), radius_(radius) {}
  std::size_t memory() const override { return 3 + PathMemory::kNumbers; }
  void take_place(const StepPlace& place) noexcept override {
    stiffness_ = place.contact;
    normal_ = place.normal;
    contact_.emplace(stiffness_, normal_, radius_);
  }
  void move(StepSample& sample, double* memory) noexcept override {
    Eigen::Map<Vec3> before(memory);
    PathMemory path(memory + 3);
    if (sample.first) {
      before.setZero();
      path.clear();
    }
    const Vec3 tool = sample.u;
    share_ = 1;
    if (sample.in_air || !contact_ || tool.dot(normal_) >= 0) {
      path.clear();
      sample.u.setZero();
    } else {
      if (path.empty()) path.push_back({0, first_touch(normal_, before, tool).side, Vec3::Zero()});
      press(tool, path, sample.u);
    }
    before = tool;
  }
  double share_of_stiffness() const noexcept override { return share_; }

 private:
  // Where no equilibrium is found the tool is a flat one for that sample.
  void press(const Vec3& tool, PathMemory& path, Vec3& u) noexcept {
    const TipLaw<PathMemory> law{path, *contact_, normal_, kappa_, radius_};
    Vec3 x = tool;
    LocalForce force;
    if (!contact_->find(law, tool, x, force)) return;
    u = tool - x + contact_->disc_way(force.F);
    share_ = contact_->share_of_stiffness(force);
    const double z = std::max(0.0, -x.dot(normal_));
    const Tangential t = tangential(path, z, law.across * x, kappa_, radius_);
    if (t.leaving) {
      while (path.size() > 1 && path[path.size() - 1].z > z) path.pop_back();
      path.push_back(t.touched);
    }
    path.go_on({z, law.across * x, t.value}, 1e-13 * radius_);
  }

  double kappa_, radius_, share_ = 1;
  Vec3 normal_ = Vec3::UnitZ();
  ContactStiffness stiffness_;
  std::optional<LocalContact> contact_;  // of stiffness_
};

}  // namespace

std::unique_ptr<EffectStep> make_step(double kappa, double radius) {
  return std::make_unique<TipStep>(kappa, radius);
}

}  // namespace hapsim::tip
