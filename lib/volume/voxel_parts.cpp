#include "volume/voxel_parts.h"

#include <numeric>

namespace hapsim {

VoxelParts::VoxelParts(const std::array<int, 3>& size, const std::vector<std::uint8_t>& mask,
                       std::uint8_t wanted)
    : size_(size) {
  const auto width = static_cast<std::size_t>(size[0]), depth = static_cast<std::size_t>(size[1]);
  const std::size_t rows = depth * static_cast<std::size_t>(size[2]);
  first_.reserve(rows + 1);
  for (std::size_t row = 0; row < rows; ++row) {
    first_.push_back(runs_.size());
    const std::uint8_t* at = mask.data() + row * width;
    for (int i = 0; i < size[0];) {
      if (at[i] != wanted) {
        ++i;
        continue;
      }
      const int begin = i;
      while (i < size[0] && at[i] == wanted) ++i;
      runs_.push_back({begin, i, 0});
    }
  }
  first_.push_back(runs_.size());
  parent_.resize(runs_.size());
  std::iota(parent_.begin(), parent_.end(), 0u);
  for (std::size_t row = 0; row < rows; ++row) {
    if (row % depth > 0) join_rows(row, row - 1);
    if (row >= depth) join_rows(row, row - depth);
  }
  constexpr std::uint32_t kNone = 0xffffffffu;
  std::vector<std::uint32_t> number(runs_.size(), kNone);
  for (std::size_t row = 0; row < rows; ++row) {
    const std::size_t j = row % depth, k = row / depth;
    const bool outer =
        j == 0 || j + 1 == depth || k == 0 || k + 1 == static_cast<std::size_t>(size[2]);
    for (std::size_t r = first_[row]; r < first_[row + 1]; ++r) {
      const std::uint32_t top = root(static_cast<std::uint32_t>(r));
      if (number[top] == kNone) {
        number[top] = static_cast<std::uint32_t>(parts_.size());
        parts_.emplace_back();
      }
      Run& run = runs_[r];
      run.part = number[top];
      const auto length = static_cast<std::size_t>(run.end - run.begin);
      parts_[run.part].voxels += length;
      parts_[run.part].border +=
          outer ? length : (run.begin == 0 ? 1u : 0u) + (run.end == size[0] ? 1u : 0u);
    }
  }
}

std::uint32_t VoxelParts::root(std::uint32_t run) {
  while (parent_[run] != run) {
    parent_[run] = parent_[parent_[run]];
    run = parent_[run];
  }
  return run;
}

void VoxelParts::join_rows(std::size_t row, std::size_t other) {
  std::size_t a = first_[row], b = first_[other];
  while (a < first_[row + 1] && b < first_[other + 1]) {
    if (runs_[a].begin < runs_[b].end && runs_[b].begin < runs_[a].end) {
      parent_[root(static_cast<std::uint32_t>(a))] = root(static_cast<std::uint32_t>(b));
    }
    if (runs_[a].end < runs_[b].end) {
      ++a;
    } else {
      ++b;
    }
  }
}

void VoxelParts::mark(const std::function<bool(std::size_t)>& chosen, std::uint8_t value,
                      std::vector<std::uint8_t>& mask) const {
  const auto width = static_cast<std::size_t>(size_[0]);
  for (std::size_t row = 0; row + 1 < first_.size(); ++row) {
    for (std::size_t r = first_[row]; r < first_[row + 1]; ++r) {
      if (!chosen(runs_[r].part)) continue;
      for (int i = runs_[r].begin; i < runs_[r].end; ++i) {
        mask[row * width + static_cast<std::size_t>(i)] = value;
      }
    }
  }
}

}  // namespace hapsim
