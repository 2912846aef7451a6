// The stiffness of a body against a bonded tool anywhere on its surface, as a table to interpolate.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "realtime/field_sampling.h"

namespace hapsim {

// A contact whose stiffness is known better than the samples give it.
struct KnownStiffness {
  Vec3 point, normal;  // on the surface [m]; outward, unit
  Eigen::Matrix3d K;   // [N/m], symmetric positive definite
};

struct FieldEntry {
  Vec3 point = Vec3::Zero();
  Eigen::Matrix3d K = Eigen::Matrix3d::Zero();  // [N/m]
  double uncertainty = 0;                       // as PlaceEstimate has it
  bool sampled = true;  // false: where contact meshes cannot be made, beside the support
};

// Entries at the corners of every face and, where the stiffness is not straight between them, on a
// lattice over the face, 2, 4, ... to 64 steps along its edges; straight in between. Known contacts
// become corners with their own stiffness.
class StiffnessField {
 public:
  // Three entries and their weights, which are not negative and sum to one.
  struct Place {
    std::array<int, 3> entry;
    Vec3 weight;
  };

  // From samples. Error(kBadInput): a known contact off the surface by more than a tenth of its
  // size, or not positive definite.
  StiffnessField(const Surface& surface, const FieldSampling& sampling,
                 const std::vector<KnownStiffness>& known, double tool_radius, int threads);
  // A table that bytes() wrote. Error(kBadInput): damaged, or of another layout.
  explicit StiffnessField(const std::string& bytes);
  std::string bytes() const;

  // The body's boundary, split where contacts are known.
  const Surface& surface() const { return surface_; }
  const std::vector<FieldEntry>& entries() const { return entries_; }
  std::size_t samples() const { return samples_; }
  double expected_error() const { return expected_; }       // relative, root mean square
  const std::vector<int>& known() const { return known_; }  // entries, as they were given
  // Multiplies each entry's stiffness by a positive number of its point.
  void scale(const std::function<double(const Vec3&)>& factor);

  // At a point of a face of surface(): look-ups that allocate and throw nothing.
  Place locate(int face, const Vec3& point) const noexcept;
  Eigen::Matrix3d at(const Place& place) const noexcept;  // [N/m]
  Eigen::Matrix3d at(int face, const Vec3& point) const noexcept { return at(locate(face, point)); }
  FieldEntry entry_at(const Place& place) const noexcept;

 private:
  Surface surface_;
  std::vector<int> first_, steps_;  // by face: of lattice_, row by row, corner 0 to corners 1 and 2
  std::vector<int> lattice_;        // entries
  std::vector<FieldEntry> entries_;
  std::vector<int> known_;
  std::size_t samples_ = 0;
  double expected_ = 0;
};

}  // namespace hapsim
