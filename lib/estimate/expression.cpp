#include "estimate/expression.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/error.h"
#include "base/units.h"

namespace hapsim {
namespace {

// f of one operand: f' and f'' there.
Taylor chain(const Taylor& a, double f, double f1, double f2) {
  return {f, f1 * a.slope, f1 * a.curvature + f2 * a.slope * a.slope.transpose()};
}

Taylor product(const Taylor& a, const Taylor& b) {
  const Eigen::MatrixXd cross = a.slope * b.slope.transpose();
  return {a.value * b.value, a.value * b.slope + b.value * a.slope,
          a.value * b.curvature + b.value * a.curvature + cross + cross.transpose()};
}

Taylor sum(const Taylor& a, const Taylor& b, double sign) {
  return {a.value + sign * b.value, a.slope + sign * b.slope, a.curvature + sign * b.curvature};
}

// Of any quantity; none where there is no such unit.
std::optional<double> factor_of(const std::string& unit) {
  for (const Quantity q : {Quantity::kLength, Quantity::kTime, Quantity::kForce,
                           Quantity::kPressure, Quantity::kAngle})
    if ((" " + known_units(q) + " ").find(" " + unit + " ") != std::string::npos)
      return unit_factor(q, unit);
  return std::nullopt;
}

Taylor power(const Taylor& a, const Taylor& b) {
  const double p = b.value;
  if (b.slope.isZero(0) && b.curvature.isZero(0)) {
    const double f1 = p == 0 ? 0 : p * std::pow(a.value, p - 1);
    const double f2 = p == 0 || p == 1 ? 0 : p * (p - 1) * std::pow(a.value, p - 2);
    return chain(a, std::pow(a.value, p), f1, f2);
  }
  const Taylor logarithm = chain(a, std::log(a.value), 1 / a.value, -1 / (a.value * a.value));
  const Taylor exponent = product(b, logarithm);
  const double f = std::exp(exponent.value);
  return chain(exponent, f, f, f);
}

}  // namespace

Taylor Expression::at(const Eigen::VectorXd& values) const {
  const Eigen::Index n = values.size();
  std::vector<Taylor> stack;
  for (const Step& step : steps_) {
    if (step.kind == Kind::kNumber || step.kind == Kind::kName) {
      Taylor leaf{step.number, Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
      if (step.kind == Kind::kName) {
        const auto k = static_cast<Eigen::Index>(step.name);
        leaf.value = values[k];
        leaf.slope[k] = 1;
      }
      stack.push_back(std::move(leaf));
      continue;
    }
    const Taylor b = std::move(stack.back());
    stack.pop_back();
    if (step.kind == Kind::kMinus) {
      stack.push_back(chain(b, -b.value, -1, 0));
      continue;
    }
    Taylor& a = stack.back();
    if (step.kind == Kind::kAdd) a = sum(a, b, 1);
    if (step.kind == Kind::kSubtract) a = sum(a, b, -1);
    if (step.kind == Kind::kTimes) a = product(a, b);
    if (step.kind == Kind::kOver)
      a = product(a, chain(b, 1 / b.value, -1 / (b.value * b.value), 2 / std::pow(b.value, 3)));
    if (step.kind == Kind::kPower) a = power(a, b);
  }
  return stack.front();
}

// Recursive descent: comparisons of sums of products of powers.
class FormulaReader {
 public:
  FormulaReader(std::string text, const std::string& option)
      : text_(std::move(text)), option_(option) {}

  std::vector<Relation> all() {
    std::vector<Relation> result;
    Side left = side();
    do {
      const std::string sign = sign_of_relation();
      if (sign.empty()) fail("has no =, <= or >= where one is due");
      Side right = side();
      Relation one;
      one.text = left.text + " " + sign + " " + right.text;
      one.equality = sign == "=";
      one.difference =
          sign == "<=" ? difference(right.steps, left.steps) : difference(left.steps, right.steps);
      result.push_back(std::move(one));
      left = std::move(right);
    } while (skip_blanks());
    return result;
  }

 private:
  using Kind = Expression::Kind;
  using Steps = std::vector<Expression::Step>;
  struct Side {
    std::string text;
    Steps steps;
  };

  [[noreturn]] void fail(const std::string& what) const {
    fail_usage(option_ + " '" + text_ + "' " + what +
                   (at_ < text_.size() ? " at '" + text_.substr(at_) + "'" : " at its end"),
               "write E >= 2*E1, or 1 <= E/E1 <= 3");
  }
  bool skip_blanks() {  // whether something is left
    while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    return at_ < text_.size();
  }
  bool take(char c) {
    if (!skip_blanks() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  std::string sign_of_relation() {
    if (!skip_blanks()) return "";
    for (const char* sign : {"<=", ">=", "==", "<", ">", "="})
      if (text_.compare(at_, std::string(sign).size(), sign) == 0) {
        at_ += std::string(sign).size();
        return sign[0] == '=' ? "=" : std::string(1, sign[0]) + "=";
      }
    return "";
  }

  // The names of all sides are kept in one list; those of a comparison are its own.
  static void append(Steps& steps, const Steps& more) {
    steps.insert(steps.end(), more.begin(), more.end());
  }
  Expression difference(const Steps& a, const Steps& b) const {
    Expression e;
    append(e.steps_, a);
    append(e.steps_, b);
    e.steps_.push_back({Kind::kSubtract});
    for (Expression::Step& step : e.steps_) {
      if (step.kind != Kind::kName) continue;
      const std::string& name = names_[step.name];
      const auto known = std::find(e.names_.begin(), e.names_.end(), name);
      step.name = static_cast<std::size_t>(known - e.names_.begin());
      if (known == e.names_.end()) e.names_.push_back(name);
    }
    return e;
  }

  Side side() {
    skip_blanks();
    const std::size_t from = at_;
    Side result;
    result.steps = terms();
    std::size_t to = at_;
    while (to > from && std::isspace(static_cast<unsigned char>(text_[to - 1])) != 0) --to;
    result.text = text_.substr(from, to - from);
    return result;
  }
  Steps terms() {
    Steps steps = factors();
    for (;;) {
      const Kind kind = take('+') ? Kind::kAdd : take('-') ? Kind::kSubtract : Kind::kNumber;
      if (kind == Kind::kNumber) return steps;
      append(steps, factors());
      steps.push_back({kind});
    }
  }
  Steps factors() {
    Steps steps = signed_power();
    for (;;) {
      const Kind kind = take('*') ? Kind::kTimes : take('/') ? Kind::kOver : Kind::kNumber;
      if (kind == Kind::kNumber) return steps;
      append(steps, signed_power());
      steps.push_back({kind});
    }
  }
  // -a^2 is -(a^2); a^b^c is a^(b^c).
  Steps signed_power() {
    if (++depth_ > 100) fail("is nested too deeply");
    Steps steps;
    if (take('-')) {
      steps = signed_power();
      steps.push_back({Kind::kMinus});
    } else if (take('+')) {
      steps = signed_power();
    } else {
      steps = leaf();
      if (take('^')) {
        append(steps, signed_power());
        steps.push_back({Kind::kPower});
      }
    }
    --depth_;
    return steps;
  }
  Steps leaf() {
    if (take('(')) {
      Steps steps = terms();
      if (!take(')')) fail("lacks a ')'");
      return steps;
    }
    if (!skip_blanks()) fail("lacks a number or a name");
    const auto c = static_cast<unsigned char>(text_[at_]);
    if (std::isdigit(c) != 0 || c == '.') return {{Kind::kNumber, number()}};
    if (std::isalpha(c) == 0 && c != '_') fail("has no number and no name");
    const std::string word = name();
    const auto known = std::find(names_.begin(), names_.end(), word);
    const auto k = static_cast<std::size_t>(known - names_.begin());
    if (known == names_.end()) names_.push_back(word);
    return {{Kind::kName, 0, k}};
  }
  std::size_t word_end(std::size_t from) const {
    while (from < text_.size() &&
           (std::isalnum(static_cast<unsigned char>(text_[from])) != 0 || text_[from] == '_'))
      ++from;
    return from;
  }
  double number() {
    double value = 0;
    const auto [end, error] =
        std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) fail("has no number");
    at_ = static_cast<std::size_t>(end - text_.data());
    const std::size_t before = at_;
    if (skip_blanks() && std::isalpha(static_cast<unsigned char>(text_[at_])) != 0) {
      const std::size_t to = word_end(at_);
      const std::optional<double> factor = factor_of(text_.substr(at_, to - at_));
      if (!factor) fail("has neither an operator nor a unit after the number");
      at_ = to;
      return value * *factor;
    }
    at_ = before;
    return value;
  }
  std::string name() {
    // An owner's words are joined by hyphens; it is one where a dot follows.
    const std::size_t from = at_;
    std::size_t to = word_end(at_);
    std::size_t owner = to;
    while (owner + 1 < text_.size() && text_[owner] == '-' && word_end(owner + 1) > owner + 1)
      owner = word_end(owner + 1);
    if (owner < text_.size() && text_[owner] == '.') to = word_end(owner + 1);
    std::string word = text_.substr(from, to - from);
    at_ = to;
    if (at_ >= text_.size() || (text_[at_] != '[' && text_[at_] != '(')) return word;
    const char close = text_[at_++] == '[' ? ']' : ')';
    word += "[" + region() + "]";
    if (!take(close)) fail("does not end the region");
    return word;
  }
  // A number, a word, or a point.
  std::string region() {
    if (!skip_blanks()) fail("does not end the region");
    const std::size_t from = at_, to = word_end(at_);
    const std::string word = text_.substr(from, to - from);
    const bool is_number = word.find_first_not_of("0123456789") == std::string::npos;
    const bool is_word = std::isdigit(static_cast<unsigned char>(text_[from])) == 0;
    at_ = to;
    skip_blanks();
    const bool ends = at_ >= text_.size() || text_[at_] == ']' || text_[at_] == ')';
    if (!word.empty() && ends && (is_number || is_word)) return word;
    at_ = from;
    std::string point;
    int coordinates = 0;
    do {
      skip_blanks();
      const bool minus = take('-');
      skip_blanks();
      if (++coordinates > 3 || at_ >= text_.size() ||
          (std::isdigit(static_cast<unsigned char>(text_[at_])) == 0 && text_[at_] != '.'))
        fail("has neither a region nor the two or three coordinates of a point");
      const double value = number();
      point += (point.empty() ? "" : ",") + fmt::format("{}", minus ? -value : value);
    } while (take(','));
    if (coordinates < 2) fail("has neither a region nor the two or three coordinates of a point");
    return point;
  }

  std::string text_;
  const std::string& option_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::vector<std::string> names_;
};

Expression Expression::renamed(const std::vector<std::string>& names) const {
  Expression result;
  std::vector<std::size_t> number;
  for (const std::string& name : names) {
    const auto known = std::find(result.names_.begin(), result.names_.end(), name);
    number.push_back(static_cast<std::size_t>(known - result.names_.begin()));
    if (known == result.names_.end()) result.names_.push_back(name);
  }
  result.steps_ = steps_;
  for (Step& step : result.steps_)
    if (step.kind == Kind::kName) step.name = number[step.name];
  return result;
}

std::vector<Relation> parse_relations(const std::string& text, const std::string& option) {
  std::vector<Relation> result;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.size(), text.find_first_of(";\n", from));
    std::string one = text.substr(from, to - from);
    from = to + 1;
    if (one.find_first_not_of(" \t\r") == std::string::npos) continue;
    for (Relation& comparison : FormulaReader(std::move(one), option).all())
      result.push_back(std::move(comparison));
  }
  if (result.empty()) fail_usage(option + " is empty", "write E >= 2*E1");
  return result;
}

}  // namespace hapsim
