// Hierarchical clustering: the tree of merges, its quality and its cuts.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace hapsim {

enum class Linkage { kAverage, kWard, kComplete, kSingle };

// Nodes below `leaves` are samples; merge m makes the node leaves + m. Heights ascend.
struct Merge {
  int left = 0, right = 0;
  double height = 0;
  int size = 0;  // samples below
};
struct Dendrogram {
  int leaves = 0;
  std::vector<Merge> merges;  // leaves - 1
};

// Distances of samples (rows) in units of their standard errors, n x n, of the same shape as the
// samples: d_ij^2 = sum over the columns of (x_i - x_j)^2 / ((s_i^2 + s_j^2) / 2). With equal
// errors that is Euclid's over s, so two samples of one value are about sqrt 2 apart in a column;
// an uncertain sample is near to all. Replaces thesis (5.7), which mixes units.
Eigen::MatrixXd scaled_distances(const Eigen::MatrixXd& samples, const Eigen::MatrixXd& errors);

// The tree of a symmetric matrix of distances by the recurrence of Lance and Williams (Comput. J.
// 9, 1967) along chains of nearest neighbours (Murtagh, Comput. J. 26, 1983): n^2 steps. Ward's
// heights are sqrt(2 a b / (a + b)) times the distance of the means of a and b samples.
Dendrogram agglomerate(const Eigen::MatrixXd& distances, Linkage linkage);

// The cluster of each sample when the tree is cut into `clusters`, numbered in order of their first
// sample.
std::vector<int> cut(const Dendrogram& tree, int clusters);

// Height at which two samples meet, n x n.
Eigen::MatrixXd cophenetic_distances(const Dendrogram& tree);
// Thesis (5.8), over all pairs; 1 when the tree keeps all distances, NaN when all are equal.
double cophenetic_correlation(const Eigen::MatrixXd& distances, const Dendrogram& tree);

// (height - mean) / standard deviation over a merge and those up to `depth` - 1 levels below it
// (Jain and Dubes, Algorithms for Clustering Data, 1988); 0 where there is nothing to compare with.
// Plays the part of the ratio (5.9). One a merge.
std::vector<double> inconsistency(const Dendrogram& tree, int depth = 2);

// Samples from left to right so that no branches cross.
std::vector<int> leaf_order(const Dendrogram& tree);

}  // namespace hapsim
