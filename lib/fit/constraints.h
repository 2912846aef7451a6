// Constraints between a model's parameters, as people write them: "E >= 2*E1".
#pragma once

#include <string>
#include <vector>

#include "estimate/smooth_constraint.h"
#include "fit/fit.h"

namespace hapsim {

// "elastic.E", "elastic.E[2]" of region 2: what a constraint, --json and model['...'] call it.
std::string parameter_name(const Parameter& p);

// Of all texts of --constrain, parse_relations().
std::vector<Relation> parse_constraints(const std::vector<std::string>& texts,
                                        const std::string& option);

// Those whose names the model has all (a fit on the way to a larger model keeps the others later),
// as functions of its free parameters; fixed ones have their values. A name may lack its effect
// where one effect alone has it; without a region it is of region 0. `number`: which of
// `constraints`.
struct BoundConstraints {
  std::vector<SmoothConstraint> among;
  std::vector<std::size_t> number;
};
BoundConstraints bind_constraints(const Model& model, const std::vector<Relation>& constraints);

// Whether the model's own values keep them.
bool keeps(const Model& model, const BoundConstraints& constraints);

// "E >= 5000, elastic E's upper bound 4000": what contradicts each other, nothing of it to spare.
std::string conflict_words(const Model& model, const std::vector<Relation>& constraints);

// Error(kUsage): a name that no parameter of the model has, or several (the names are listed), or
// constraints that contradict each other or the bounds.
void require_constraints(const Model& model, const std::vector<Relation>& constraints);

// What binds a fit and what that costs, a paragraph each; empty where it has no constraints.
std::vector<std::string> constraint_words(const Fit& fitted);

}  // namespace hapsim
