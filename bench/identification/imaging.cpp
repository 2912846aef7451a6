#include "cases.h"
namespace hapsim::bench {
std::vector<Case> imaging_cases() {
  return {};
}
}  // namespace hapsim::bench
