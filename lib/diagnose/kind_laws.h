// Laws of many kinds that may take what a model leaves, each linear in its numbers.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "diagnose/law_samples.h"

namespace hapsim {

// What gains along the normal and across it do to the forces of the samples kept (stacked [N]), and
// zeros of each axis and along the normal.
Eigen::MatrixXd gain_columns(const LawSamples& samples);
Eigen::MatrixXd zero_columns(const LawSamples& samples);

struct KindLaw {
  std::string kind;  // of LeftOver::kind
  // What the law may do to the forces of the samples kept (stacked [N]), a column each number.
  std::function<Eigen::MatrixXd()> columns;
  // The same without what makes it of its kind; empty: nothing.
  std::function<Eigen::MatrixXd()> without = {};
};

// The simplest first (diagnose/left_kinds.h says what they are); a kind may have several. The
// arguments must outlive them.
std::vector<KindLaw> kind_laws(const LawSamples& samples, const Eigen::VectorXd& forces,
                               const Dataset& dataset);

}  // namespace hapsim
