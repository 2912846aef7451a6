#include "diagnose/order_laws.h"

#include <functional>

#include "diagnose/law_columns.h"

namespace hapsim {
namespace law {
namespace {

constexpr int kFew = 4;  // hat functions

std::vector<Column> few_hats(const Column& x) {
  return hats(x, quantiles(x, kFew));
}

// By how long ago the place was pressed, where it was.
std::vector<Column> by_rest_here(const LawSamples& s) {
  std::vector<Column> found;
  for (const Column& hat : few_hats(s.rest_here)) found.emplace_back(hat.cwiseProduct(s.here));
  found.emplace_back(1 - s.here.array());
  return found;
}

// Depths that the place has not seen yet, and those that it has.
std::vector<Column> by_ever(const LawSamples& s) {
  const Column fresh = (s.depth.array() >= s.ever.array()).cast<double>();
  std::vector<Column> found = few_hats(s.ever);
  for (const Column& d : few_hats(s.depth)) {
    found.emplace_back(d.cwiseProduct(fresh));
    found.push_back(d);
  }
  return found;
}

Columns zeros_by(const Vectors& v, const LawSamples& s) {
  std::vector<Column> components;
  for (Eigen::Index axis = 0; axis < 3; ++axis) components.emplace_back(v.row(axis));
  return times(products(components, few_hats(s.age)), zeros(s));
}

}  // namespace
}  // namespace law

void add_order_laws(const LawSamples& s, std::vector<KindLaw>& laws) {
  using namespace law;
  const auto add = [&](
                       const char* kind, const std::function<Columns()>& columns,
                       const std::function<Columns()>& without = [] { return Columns(); }) {
    laws.push_back({kind, [&s, columns] { return stacked(columns(), s); },
                    [&s, without] { return stacked(without(), s); }});
  };
  const auto by = [&](const char* kind, const std::vector<Column>& order) {
    const auto also_by = [&](const std::vector<Column>& other, const Columns& what) {
      add(
          kind, [=] { return times(products(order, other), what); },
          [=] { return times(other, what); });
    };
    add(kind, [&s, order] { return times(order, gains(s)); });
    add(kind, [&s, order] { return times(order, zeros(s)); });
    also_by(few_hats(s.depth), gains(s));
    also_by(few_hats(slants(s)), gains(s));
    if (!s.timed) return;
    also_by(few_hats(s.age), gains(s));
    also_by(few_hats(s.age), zeros(s));
  };
  by("cycle", numbers(s));
  by("cycle", few_hats(s.last_depth));
  add(
      "cycle", [&s] { return times(by_ever(s), gains(s)); },
      [&s] { return times(few_hats(s.depth), gains(s)); });
  if (!s.timed) return;
  by("cycle", few_hats(s.rest));
  by("cycle", by_rest_here(s));
  by("session-time", few_hats(s.session));
  add("cycle", [&s] { return zeros_by(s.came, s); });
  add("cycle", [&s] { return zeros_by(s.last_u, s); });
}

}  // namespace hapsim
