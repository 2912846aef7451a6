#include "material/body_features.h"

namespace hapsim {

std::size_t feature_size(Feature kind) {
  switch (kind) {
    case Feature::kLayer:
    case Feature::kGrowth:
      return 2;
    case Feature::kInclusion:
      return 5;
    case Feature::kTransverse:
      return 4;
    case Feature::kTension:
      return 1;
    default:
      return 3;
  }
}

}  // namespace hapsim
