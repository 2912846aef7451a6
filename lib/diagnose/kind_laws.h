// Laws of many kinds that may take what a model leaves, each linear in its numbers.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "experiment/dataset.h"

namespace hapsim {

// What the samples that are looked at tell of themselves, one each.
struct LawSamples {
  using Column = Eigen::VectorXd;      // one number a sample
  using Vectors = Eigen::Matrix3Xd;    // one vector a sample
  std::vector<Eigen::Index> kept;      // of all, in the order of all_episodes()
  std::vector<Eigen::Index> since;     // how many samples of its press came before
  std::vector<int> press;              // its press, from 0
  bool timed = false, warmed = false;  // time, temperature were recorded
  // Of the depth the growth; the fastest so far in the press.
  Column depth, speed, fastest, growth, age, session, number, temperature;
  Vectors f, along, across, rate;  // along and across the normal; how fast it changes
  Vectors normal, u, velocity, acceleration;
  Vectors way;  // which way each axis last went, -1 to 1, turned within 1 % of the longest way
};

// Of a model's `forces` (stacked [N]). Of more than 10,000 samples every n-th is kept.
LawSamples law_samples(const Eigen::VectorXd& forces, const Dataset& dataset);

// What gains along the normal and across it do to the forces of the samples kept (stacked [N]), and
// zeros of each axis and along the normal.
Eigen::MatrixXd gain_columns(const LawSamples& samples);
Eigen::MatrixXd zero_columns(const LawSamples& samples);

struct KindLaw {
  std::string kind;  // of LeftOver::kind
  // What the law may do to the forces of the samples kept (stacked [N]), a column each number.
  std::function<Eigen::MatrixXd()> columns;
};

// The simplest first (diagnose/left_kinds.h says what they are); a kind may have several. The
// arguments must outlive them.
std::vector<KindLaw> kind_laws(const LawSamples& samples, const Eigen::VectorXd& forces,
                               const Dataset& dataset);

// The rows of stacked vectors that the samples are.
std::vector<Eigen::Index> stacked_components(const LawSamples& samples);

}  // namespace hapsim
