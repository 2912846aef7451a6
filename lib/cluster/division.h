// How many clusters a tree of samples has, and whether it has more than one.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "base/random.h"
#include "cluster/dendrogram.h"

namespace hapsim {

struct DivisionOptions {
  double significance = 0.05;  // chance of dividing what is one
  int simulations = 999;       // fewer for many samples, at least 99
  int most = 8;                // clusters looked for at once within a branch
};

// The test of one branch of the tree.
struct BranchTest {
  std::vector<int> samples;
  double scatter = 0;    // over what the standard errors explain, root mean square
  double p_scatter = 1;  // chance of as much scatter from the errors alone
  double p_gaps = 1;     // chance of as tight clusters in samples spread evenly
  double level = 0;      // both must be below it
  bool divided = false;
};

struct Division {
  std::vector<int> label;         // cluster of each sample, numbered by first sample
  std::vector<BranchTest> tests;  // the first is that of all samples: one cluster or more?
};

// Divides from the root downwards. A branch is divided when its samples scatter more than their
// errors allow AND the best of its cuts into 2 .. `most` clusters is tighter than in samples spread
// evenly over a box of the same principal variances, among one-peaked spreads the hardest to tell
// from clusters: the gap statistic of Tibshirani, Walther and Hastie (J. R. Statist. Soc. B 63,
// 2001), taken over all numbers of clusters at once so that several in a row do not hide each
// other. Levels fall with the branch's size, which bounds the chance of any false division
// (Meinshausen, Biometrika 95, 2008). Samples and errors n x d as in scaled_distances(); branches
// of fewer than four samples stay whole. Cost: simulations x n^2 a branch.
Division natural_division(const Eigen::MatrixXd& samples, const Eigen::MatrixXd& errors,
                          Linkage linkage, Random& random, const DivisionOptions& options = {});

}  // namespace hapsim
