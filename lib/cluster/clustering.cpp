#include "cluster/clustering.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace hapsim {

std::vector<int> ward_clusters(const std::vector<double>& values, const std::vector<double>& errors,
                               int clusters) {
  // In one dimension Ward's merges always join neighbours, so a sorted list of groups is enough.
  struct Group {
    double weight, mean;
    std::vector<int> members;
  };
  std::vector<int> order(values.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return values[a] < values[b]; });
  std::vector<Group> groups;
  for (const int i : order) groups.push_back({1 / (errors[i] * errors[i]), values[i], {i}});
  while (static_cast<int>(groups.size()) > std::max(1, clusters)) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t g = 0; g + 1 < groups.size(); ++g) {
      const double wa = groups[g].weight, wb = groups[g + 1].weight;
      const double gap = groups[g + 1].mean - groups[g].mean;
      const double cost = wa * wb / (wa + wb) * gap * gap;
      if (cost < least) least = cost, best = g;
    }
    Group& a = groups[best];
    const Group& b = groups[best + 1];
    a.mean = (a.weight * a.mean + b.weight * b.mean) / (a.weight + b.weight);
    a.weight += b.weight;
    a.members.insert(a.members.end(), b.members.begin(), b.members.end());
    groups.erase(groups.begin() + static_cast<long>(best) + 1);
  }
  std::vector<int> label(values.size(), 0);
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const int i : groups[g].members) label[i] = static_cast<int>(g);
  return label;
}

}  // namespace hapsim
