// What the samples of a recording tell of themselves, for laws of what a model leaves.
#pragma once

#include <Eigen/Core>
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
  // Of the depth the growth; the fastest and deepest so far in the press, the deepest at its place.
  Column depth, speed, fastest, deepest, ever, growth, age, session, number, temperature;
  // Of the press before: its depth, how long ago it ended (natural logarithm of seconds), the same
  // of the one before at this place; here: 1 if there was one.
  Column last_depth, rest, rest_here, here;
  Vectors came, last_u;            // from the place before [m]; how the tool left it [m]
  Vectors place;                   // where [m]
  Vectors f, along, across, rate;  // along and across the normal; how fast it changes
  Vectors normal, u, velocity, acceleration;
  Vectors way;  // which way each axis last went, -1 to 1, turned within 1 % of the longest way
};

// Of a model's `forces` (stacked [N]). Of more than 10,000 samples every n-th is kept.
LawSamples law_samples(const Eigen::VectorXd& forces, const Dataset& dataset);

// The rows of stacked vectors that the samples are.
std::vector<Eigen::Index> stacked_components(const LawSamples& samples);

}  // namespace hapsim
