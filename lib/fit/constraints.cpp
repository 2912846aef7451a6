#include "fit/constraints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "estimate/feasible.h"
#include "fit/fit_uncertainty.h"
#include "io/number.h"

namespace hapsim {
namespace {

// Numbers of the parameters that a name means; what is derived is no unknown.
std::vector<std::size_t> meant(const Model& model, const std::string& name) {
  const std::size_t bracket = name.find('['), dot = name.find('.');
  const std::string region =
      bracket == std::string::npos ? "0" : name.substr(bracket + 1, name.size() - bracket - 2);
  const std::string effect = dot == std::string::npos ? "" : name.substr(0, dot);
  const std::size_t from = effect.empty() ? 0 : dot + 1;
  const std::string parameter = name.substr(from, bracket - from);
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    const Parameter& p = model.parameters[i];
    if (p.name == parameter && std::to_string(p.region) == region &&
        (effect.empty() || p.effect == effect) && p.state != ParameterState::kDerived)
      found.push_back(i);
  }
  return found;
}

bool has_all(const Model& model, const Expression& formula) {
  return std::all_of(formula.names().begin(), formula.names().end(),
                     [&](const std::string& name) { return meant(model, name).size() == 1; });
}

std::string names_of(const Model& model, const std::vector<std::size_t>& which) {
  std::string names;
  for (const std::size_t i : which)
    names += (names.empty() ? "" : ", ") + parameter_name(model.parameters[i]);
  return names;
}

// One constraint as a function of the free parameters.
SmoothConstraint bound(const Model& model, const Relation& one) {
  const std::vector<int> free = model.free_parameters();
  const auto columns = static_cast<Eigen::Index>(free.size());
  Eigen::VectorXd values(static_cast<Eigen::Index>(one.difference.names().size()));
  std::vector<Eigen::Index> names, unknowns;  // the free ones among them
  for (std::size_t k = 0; k < one.difference.names().size(); ++k) {
    const std::size_t i = meant(model, one.difference.names()[k]).front();
    values[static_cast<Eigen::Index>(k)] = model.parameters[i].value;
    const auto at = std::find(free.begin(), free.end(), static_cast<int>(i));
    if (at == free.end()) continue;
    names.push_back(static_cast<Eigen::Index>(k));
    unknowns.push_back(at - free.begin());
  }
  return {[formula = one.difference, values, names, unknowns,
           columns](const Eigen::VectorXd& x) mutable {
            for (std::size_t k = 0; k < names.size(); ++k) values[names[k]] = x[unknowns[k]];
            const Taylor own = formula.at(values);
            Taylor all{own.value, Eigen::VectorXd::Zero(columns),
                       Eigen::MatrixXd::Zero(columns, columns)};
            // "E" and "elastic.E" in one formula are the same unknown.
            for (std::size_t k = 0; k < names.size(); ++k) {
              all.slope[unknowns[k]] += own.slope[names[k]];
              for (std::size_t l = 0; l < names.size(); ++l)
                all.curvature(unknowns[k], unknowns[l]) += own.curvature(names[k], names[l]);
            }
            return all;
          },
          one.equality};
}

}  // namespace

std::string parameter_name(const Parameter& p) {
  return p.effect + "." + p.name + (p.region > 0 ? fmt::format("[{}]", p.region) : "");
}

std::vector<Relation> parse_constraints(const std::vector<std::string>& texts,
                                        const std::string& option) {
  std::vector<Relation> all;
  for (const std::string& text : texts)
    for (Relation& one : parse_relations(text, option)) all.push_back(std::move(one));
  return all;
}

BoundConstraints bind_constraints(const Model& model, const std::vector<Relation>& constraints) {
  BoundConstraints result;
  for (std::size_t c = 0; c < constraints.size(); ++c) {
    if (!has_all(model, constraints[c].difference)) continue;
    result.among.push_back(bound(model, constraints[c]));
    result.number.push_back(c);
  }
  return result;
}

bool keeps(const Model& model, const BoundConstraints& constraints) {
  return keeps(unknowns(model), constraints.among);
}

std::string conflict_words(const Model& model, const std::vector<Relation>& constraints) {
  const BoundConstraints own = bind_constraints(model, constraints);
  const Conflict conflict = find_conflict(unknowns(model), own.among);
  std::vector<std::string> parts;
  for (const std::size_t c : conflict.constraints) parts.push_back(constraints[own.number[c]].text);
  const std::vector<int> free = model.free_parameters();
  const auto parameter = [&](std::size_t i) -> const Parameter& {
    return model.parameters[static_cast<std::size_t>(free[i])];
  };
  for (const std::size_t i : conflict.lower)
    parts.push_back(parameter_name(parameter(i)) + "'s lower bound " +
                    format_number(parameter(i).lower));
  for (const std::size_t i : conflict.upper)
    parts.push_back(parameter_name(parameter(i)) + "'s upper bound " +
                    format_number(parameter(i).upper));
  // What is not fitted takes part with its value.
  for (const std::size_t c : conflict.constraints)
    for (const std::string& name : constraints[own.number[c]].difference.names()) {
      const Parameter& p = model.parameters[meant(model, name).front()];
      const std::string words = parameter_name(p) + " fixed at " + format_number(p.value);
      if (p.state == ParameterState::kFixed &&
          std::find(parts.begin(), parts.end(), words) == parts.end())
        parts.push_back(words);
    }
  std::string text;
  for (std::size_t k = 0; k < parts.size(); ++k)
    text += (k == 0 ? "" : k + 1 < parts.size() ? ", " : " and ") + parts[k];
  return text;
}

void require_constraints(const Model& model, const std::vector<Relation>& constraints) {
  for (const Relation& one : constraints)
    for (const std::string& name : one.difference.names()) {
      const std::vector<std::size_t> found = meant(model, name);
      if (found.size() > 1)
        fail_usage("'" + name + "' in '" + one.text + "' may mean several parameters",
                   "write one of: " + names_of(model, found));
      if (!found.empty()) continue;
      std::vector<std::size_t> all;
      for (std::size_t i = 0; i < model.parameters.size(); ++i)
        if (model.parameters[i].state != ParameterState::kDerived) all.push_back(i);
      fail_usage("the model has no parameter '" + name + "', of '" + one.text + "'",
                 "it has " + names_of(model, all));
    }
  const BoundConstraints own = bind_constraints(model, constraints);
  if (keeps(model, own) || feasible_point(unknowns(model), own.among)) return;
  const bool one = find_conflict(unknowns(model), own.among).constraints.size() == 1;
  const std::string words = conflict_words(model, constraints);
  fail_usage(words + (one && words.find(" and ") == std::string::npos ? " cannot be kept"
                                                                      : " contradict each other"),
             "change or leave out one of them");
}

std::vector<std::string> constraint_words(const Fit& fitted) {
  std::vector<std::string> lines;
  std::string slack;
  for (const KeptConstraint& c : fitted.constraints) {
    if (!c.active) {
      slack += (slack.empty() ? "" : "; ") + c.text;
      continue;
    }
    std::string line = c.text + " binds: ";
    if (!std::isfinite(c.cost))
      line += "what it costs is not known";
    else
      line += fmt::format("it costs {:.2g} N of error, {:.2g} standard errors", c.cost, c.doubt);
    lines.push_back(line);
  }
  if (!slack.empty()) lines.push_back("kept without being asked for: " + slack);
  const double rise = fitted.error.told() - fitted.unconstrained;
  if (std::isfinite(rise) && !fitted.constraints.empty() && rise != 0)
    lines.push_back(fmt::format("without them the error is {:.4g} N, {:.2g} N less",
                                fitted.unconstrained, rise));
  if (!fitted.held.empty()) {
    std::string held;
    for (const std::string& name : fitted.held) held += (held.empty() ? "" : ", ") + name;
    lines.push_back(held + " held by them: no standard error of its own");
  }
  return lines;
}

}  // namespace hapsim
