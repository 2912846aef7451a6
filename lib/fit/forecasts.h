// Models fitted to what parts of the data know, and what they leave of the rest.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "fit/first_parts.h"

namespace hapsim {

// A model and sets of effects on top of it, fitted anew to what each part knows. Nothing of a
// fit to all rows comes in: effects are added one by one, each from its own starts on what the
// smaller sets came to there, and the best of these ways counts. What the known rows cannot show
// stays out. Of the model itself, regions, fields, offsets by press and effects that finite
// elements are solved for start from their values; bodies stay linear about `about`.
class Forecasts {
 public:
  using Names = std::vector<std::string>;  // sorted; a name twice is a term more

  // `fitted`: the model without the sets. The experiment must outlive it.
  Forecasts(const Fit& fitted, const Experiment& experiment, std::vector<UnseenPart> parts,
            const FitOptions& options);

  const std::vector<UnseenPart>& parts() const { return parts_; }
  // What the model with these effects leaves of each part's unseen rows, stacked [N].
  const std::vector<Eigen::VectorXd>& left(const Names& added);

 private:
  const Fit& learned(std::size_t part, const Names& own, const Names& added);
  Fit learn_bare(const UnseenPart& part) const;
  // From each of its starts, the best; false: these rows cannot show it.
  bool learn_more(const Fit& smaller, const std::string& effect, const UnseenPart& part,
                  Fit& more) const;

  const Experiment& experiment_;
  std::vector<UnseenPart> parts_;
  FitOptions options_;
  Model model_;
  Model bare_;  // without what is learned anew:
  Names own_;
  Linearisation about_;
  Eigen::VectorXd measured_;
  std::vector<std::map<Names, Fit>> learned_;  // by part
  std::map<Names, std::vector<Eigen::VectorXd>> left_;
};

}  // namespace hapsim
