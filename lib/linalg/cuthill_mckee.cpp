#include "linalg/cuthill_mckee.h"

#include <algorithm>

namespace hapsim {
namespace {

struct Graph {
  std::vector<int> start, to;
  int degree(int v) const { return start[v + 1] - start[v]; }
};

Graph both_directions(const LowerPattern& pattern) {
  Graph graph;
  graph.start.assign(static_cast<std::size_t>(pattern.size()) + 1, 0);
  for (int c = 0; c < pattern.size(); ++c)
    for (int k = pattern.start[c]; k < pattern.start[c + 1]; ++k)
      if (pattern.row[k] != c) ++graph.start[c + 1], ++graph.start[pattern.row[k] + 1];
  for (int c = 0; c < pattern.size(); ++c) graph.start[c + 1] += graph.start[c];
  graph.to.resize(static_cast<std::size_t>(graph.start.back()));
  std::vector<int> next(graph.start.begin(), graph.start.end() - 1);
  for (int c = 0; c < pattern.size(); ++c)
    for (int k = pattern.start[c]; k < pattern.start[c + 1]; ++k)
      if (const int r = pattern.row[k]; r != c) graph.to[next[c]++] = r, graph.to[next[r]++] = c;
  return graph;
}

// Appends the part of the graph that `from` belongs to.
void visit(const Graph& graph, int from, std::vector<char>& seen, std::vector<int>& order) {
  std::size_t done = order.size();
  order.push_back(from);
  seen[from] = 1;
  while (done < order.size()) {
    const int v = order[done++];
    const std::size_t first = order.size();
    for (int k = graph.start[v]; k < graph.start[v + 1]; ++k)
      if (!seen[graph.to[k]]) {
        seen[graph.to[k]] = 1;
        order.push_back(graph.to[k]);
      }
    std::sort(order.begin() + static_cast<std::ptrdiff_t>(first), order.end(), [&](int a, int b) {
      return graph.degree(a) != graph.degree(b) ? graph.degree(a) < graph.degree(b) : a < b;
    });
  }
}

}  // namespace

std::vector<int> cuthill_mckee_order(const LowerPattern& pattern) {
  const Graph graph = both_directions(pattern);
  std::vector<char> seen(static_cast<std::size_t>(pattern.size()), 0);
  std::vector<int> order;
  order.reserve(seen.size());
  for (int v = 0; v < pattern.size(); ++v) {
    if (seen[v]) continue;
    // The last vertex of a first visit lies far out.
    const std::size_t begin = order.size();
    visit(graph, v, seen, order);
    const int far = order.back();
    for (std::size_t k = begin; k < order.size(); ++k) seen[order[k]] = 0;
    order.resize(begin);
    visit(graph, far, seen, order);
  }
  std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace hapsim
