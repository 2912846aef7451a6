#include "estimate/identifiability.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "estimate/coordinates.h"

namespace hapsim {
namespace {

constexpr double kTakesPart = 0.2;  // of the largest entry

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
  return text;
}

std::string words(const std::vector<Unknown>& unknowns, const std::vector<std::string>& names,
                  const Eigen::VectorXd& v) {
  std::vector<std::string> part;
  std::vector<Eigen::Index> at;
  const double largest = v.cwiseAbs().maxCoeff();
  for (Eigen::Index i = 0; i < v.size(); ++i)
    if (std::abs(v[i]) > kTakesPart * largest)
      part.push_back(names[static_cast<std::size_t>(i)]), at.push_back(i);
  if (part.empty()) return "the sensitivities are not finite";
  if (part.size() == 1) return part[0] + " has no effect that the data show";
  if (part.size() > 2)
    return joined(part) + " can change together without a change that the data show";
  // Movement along v leaves the data alone. In values, v as logarithm times the value.
  const Coordinates coordinates(unknowns);
  const auto i = static_cast<std::size_t>(at[0]), j = static_cast<std::size_t>(at[1]);
  const double a = v[at[0]] * coordinates.slope(i, unknowns[i].value);
  const double b = v[at[1]] * coordinates.slope(j, unknowns[j].value);
  const auto opposite = [](double p, double q) { return std::abs(p + q) < 0.1 * std::abs(p); };
  const auto same = [](double p, double q) { return std::abs(p - q) < 0.1 * std::abs(p); };
  std::string as;
  if (opposite(a, b)) {
    as = "their sum";
  } else if (same(a, b)) {
    as = "their difference";
  } else if (opposite(a / unknowns[i].value, b / unknowns[j].value)) {
    as = "their product";
  } else if (same(a / unknowns[i].value, b / unknowns[j].value)) {
    as = "their ratio";
  } else {
    return joined(part) + " can be traded for each other: the data see one combination of them";
  }
  return joined(part) + " enter only as " + as;
}

}  // namespace

std::vector<BlindDirection> blind_directions(const std::vector<Unknown>& unknowns,
                                             const std::vector<std::string>& names,
                                             const Eigen::MatrixXd& J, double largest_error,
                                             double noise) {
  std::vector<BlindDirection> result;
  const Coordinates coordinates(unknowns);
  Eigen::MatrixXd scaled = J;
  for (Eigen::Index c = 0; c < J.cols(); ++c) {
    const auto i = static_cast<std::size_t>(c);
    scaled.col(c) *= coordinates.slope(i, unknowns[i].value);
  }
  // Full V: with fewer residuals than unknowns the rest of it is unseen.
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::ColPivHouseholderQRPreconditioner> svd(
      scaled.rows() >= scaled.cols()
          ? scaled
          : (Eigen::MatrixXd(scaled.cols(), scaled.cols()) << scaled,
             Eigen::MatrixXd::Zero(scaled.cols() - scaled.rows(), scaled.cols()))
                .finished(),
      Eigen::ComputeThinV);
  const Eigen::VectorXd& s = svd.singularValues();
  for (Eigen::Index d = s.size() - 1; d >= 0; --d) {
    const bool unseen = s[d] <= 1e-10 * s[0] || s[0] == 0;
    const double error =
        unseen ? std::numeric_limits<double>::infinity() : std::max(1.0, noise) / s[d];
    if (error <= largest_error) break;
    Eigen::VectorXd v = svd.matrixV().col(d);
    Eigen::Index most = 0;
    v.cwiseAbs().maxCoeff(&most);
    if (v[most] < 0) v = -v;
    result.push_back({v, error, words(unknowns, names, v)});
  }
  return result;
}

Eigen::MatrixXd correlations(const Eigen::MatrixXd& covariance) {
  Eigen::VectorXd scale(covariance.rows());
  for (Eigen::Index i = 0; i < scale.size(); ++i)
    scale[i] = covariance(i, i) > 0 ? 1 / std::sqrt(covariance(i, i)) : 0;
  return scale.asDiagonal() * covariance * scale.asDiagonal();
}

bool enough_data(Eigen::Index references, Eigen::Index parameters, double ratio) {
  return static_cast<double>(references) >= ratio * static_cast<double>(parameters);
}

}  // namespace hapsim
