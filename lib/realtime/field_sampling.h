// Samples of a body's contact stiffness, placed until what lies between them is known well enough.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "contact/contact_library.h"
#include "realtime/place_model.h"

namespace hapsim {

// The budget of a body with limbs and thin parts: some seven minutes of two processors. Others
// reach the tolerance with some 350 at most.
constexpr std::size_t kMostSamples = 4000;

struct FieldSamplingOptions {
  double tolerance = 0.02;  // relative error of the force, root mean square over the surface
  std::size_t most = kMostSamples;  // places tried at which it ends, short of the tolerance
  std::function<void()> sampled;    // called at each (from any thread)
};

// A material as the contact meshes take it: `description` must determine `solid.group_of`.
struct SampledMaterial {
  FieldMaterial field;
  Material solid;
  std::string description;
};

// Samples on coarse meshes (kSampled; kCoarser where coarse ones scatter: beside edges, on limbs,
// of next to no compressibility), turned into what the finer ones give by the mean ratio, along and
// across the normal, of those that were solved on both; beside the support, where that ratio is
// another, on the finer meshes. The first samples lie apart from each other, later ones where the
// model of the earlier ones knows least, until the model's own uncertainty over the touchable
// surface is below the tolerance, and still is after another round of them.
class FieldSampling {
 public:
  // `known`: places to be sampled in any case. Error(kBadInput): the tool fits nowhere.
  FieldSampling(std::shared_ptr<const ContactLibrary> library, double tool_radius,
                SampledMaterial material, const std::vector<Vec3>& known,
                const FieldSamplingOptions& options);

  const PlaceModel& model() const { return *model_; }
  const PlaceViews& views() const { return *views_; }
  std::size_t samples() const { return samples_.size(); }
  double expected_error() const { return expected_; }  // over the surface, root mean square
  // Whether the tool lies well clear of what is bonded, and was not refused where tried near.
  bool is_touchable(const Vec3& point) const;

  // Another material at up to `most` of the same places.
  std::unique_ptr<PlaceModel> model_of(const SampledMaterial& material, std::size_t most) const;

 private:
  bool is_touchable(const Vec3& point, double reach) const;  // of what was refused [m]
  void add(const std::vector<Vec3>& places);
  void fit();
  std::vector<Vec3> draw(std::size_t count, std::uint64_t seed) const;
  std::size_t tried() const { return places_.size() + refused_.size(); }
  std::vector<PlaceView> views_of(const std::vector<Vec3>& places) const;
  ContactLevel level_at(const PlaceView& view) const;
  Eigen::Matrix3d corrected(const Eigen::Matrix3d& K, const Vec3& normal, ContactLevel level) const;

  std::shared_ptr<const ContactLibrary> library_;
  double radius_;
  SampledMaterial material_;
  FieldSamplingOptions options_;
  std::unique_ptr<SurfaceTree> bonded_;
  std::unique_ptr<PlaceViews> views_;
  std::vector<StiffnessSample> samples_;
  std::vector<ContactLevel> levels_;    // of the samples
  std::vector<Vec3> places_, refused_;  // as asked for
  // Of log K, fine to a level's, along and across: at places that were solved on both, and the
  // mean.
  struct Ratio {
    std::vector<Eigen::Vector2d> found;
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  };
  std::array<Ratio, 3> ratio_;  // by ContactLevel
  double noise_ = 0.005, expected_ = 0;
  std::unique_ptr<PlaceModel> model_;
};

}  // namespace hapsim
