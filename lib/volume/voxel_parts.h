// Connected parts of a mask of voxels.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace hapsim {

// Runs of set voxels along the first axis, joined across faces (union-find).
class VoxelParts {
 public:
  // `set(row)[i]` as one byte a voxel, x fastest; `wanted` is the value that counts as set.
  VoxelParts(const std::array<int, 3>& size, const std::vector<std::uint8_t>& mask,
             std::uint8_t wanted);

  struct Part {
    std::size_t voxels = 0;
    std::size_t border = 0;  // of them at the border of the volume
  };
  const std::vector<Part>& parts() const { return parts_; }
  std::size_t runs() const { return runs_.size(); }
  // Writes `value` into the mask where the part is chosen.
  void mark(const std::function<bool(std::size_t part)>& chosen, std::uint8_t value,
            std::vector<std::uint8_t>& mask) const;

 private:
  struct Run {
    int begin, end;  // voxels begin .. end-1 of the row
    std::uint32_t part;
  };
  std::uint32_t root(std::uint32_t run);
  void join_rows(std::size_t row, std::size_t other);

  std::array<int, 3> size_;
  std::vector<Run> runs_;
  std::vector<std::size_t> first_;  // first run of each row, and the end
  std::vector<std::uint32_t> parent_;
  std::vector<Part> parts_;
};

}  // namespace hapsim
