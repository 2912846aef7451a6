// Linear inversion for a field on a graph: many unknowns, few data, and a penalty on differences.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace hapsim {

enum class Penalty { kSmooth, kTotalVariation };

struct FieldProblem {
  Eigen::MatrixXd J;                      // data x unknowns, whitened: the data's errors are 1
  Eigen::VectorXd data;                   // whitened
  std::vector<int> group;                 // data held out together (one a contact position)
  std::vector<std::array<int, 2>> edges;  // between neighbouring unknowns
  Eigen::VectorXd edge_weight;            // of |m_i - m_j|, positive
  Eigen::VectorXd node_weight;            // of |m_i|, small: what no edge holds
  double least_spread = 0;                // field_posterior.h
};

// The field of one weight of the penalty.
struct FieldCandidate {
  Eigen::VectorXd m;
  double weight = 0;
  double held_out = 0;   // root mean square of data left out group by group, in their errors
  double log_score = 0;  // log density of these, but for a constant
  double misfit = 0;     // root mean square of all data, in their errors
};

struct FieldSolution {
  std::vector<FieldCandidate> tried;  // by ascending weight
  std::size_t chosen = 0;
  const FieldCandidate& field() const { return tried[chosen]; }
};

// Minimises |J m - data|^2 + weight (|edge_weight Dm|^2 + |node_weight m|^2), or with total
// variation sum of edge_weight |Dm| (Rudin, Osher and Fatemi, Physica D 60, 1992) by reweighting
// (Vogel and Oman, SIAM J. Sci. Comput. 17, 1996), rounded below `edge` = 0.02. The weight is the
// one under which data left out, group by group, are predicted best (Stone, J. R. Statist. Soc. B
// 36, 1974; in closed form for the last reweighting); of equally good ones within 5 %, the
// strongest. Works in the space of the data: one sparse factorisation for each weighting, J.rows()
// solutions. The weights by `threads` threads (in_parallel).
FieldSolution solve_field(const FieldProblem& problem, Penalty penalty, int threads = 0);

}  // namespace hapsim
