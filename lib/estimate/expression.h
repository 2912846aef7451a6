// Formulas between unknowns as people write them, "E1 >= 2*E2", with exact derivatives.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace hapsim {

// A value with its first and second derivatives by n variables: what forward-mode automatic
// differentiation carries through a formula (Griewank and Walther, Evaluating Derivatives, 2008,
// chapter 3).
struct Taylor {
  double value = 0;
  Eigen::VectorXd slope;      // n
  Eigen::MatrixXd curvature;  // n x n, symmetric
};

// + - * / ^ and parentheses over numbers and names. A number may carry a unit of base/units.h ("50
// kPa"), all else is in SI.
class Expression {
 public:
  // By one value a name, in the order of names().
  Taylor at(const Eigen::VectorXd& values) const;
  const std::vector<std::string>& names() const { return names_; }
  // The same formula of the `names`, in the order of names(); equal ones are one.
  Expression renamed(const std::vector<std::string>& names) const;

 private:
  friend class FormulaReader;
  enum class Kind { kNumber, kName, kMinus, kAdd, kSubtract, kTimes, kOver, kPower };
  struct Step {  // of a postfix program
    Kind kind;
    double number = 0;
    std::size_t name = 0;
  };
  std::vector<Step> steps_;
  std::vector<std::string> names_;
};

struct Relation {
  std::string text;       // "E1 >= 2*E2"
  bool equality = false;  // difference = 0; else difference >= 0
  Expression difference;  // left - right of >= and =, right - left of <=
};

// One comparison, or several: apart by semicolons or lines, or in a chain ("1 <= E1/E2 <= 3").
// A name is a word, or has its owner before a dot ("sensor-gain.gx"; blanks stand about a minus
// that comes before such a name). What stands behind it in brackets or parentheses is part of it: a
// number
// ("E[2]" and "E(2)" are "E[2]"), a word ("E[tumour]") or a point of two or three coordinates
// ("E(20 mm, 25 mm)" is "E[0.02,0.025]").
// < is as <=. Error(kUsage) beginning with `option`: no such formula, and where it ends.
std::vector<Relation> parse_relations(const std::string& text, const std::string& option);

}  // namespace hapsim
