// Prony terms of a master curve against published ones.
//   bench_master_curve DATA.csv PRONY.csv
// DATA: a relaxation modulus over time (t, E_relax) or storage and loss over frequency in Hz (f,
// E_stor, E_loss), G or E; a row of units below the header is passed over. PRONY: tau (s) and alpha
// (shares of the instantaneous modulus E_0, a column or else fitted to DATA as one factor). Terms
// of two relaxation times a decade are fitted with moduli of at least 0 by relative least squares;
// printed is how far the two curves are apart at the data's points. Asked: 1 %.
// Recorded in bench/results/master-curve.txt (bench/record.sh).
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <initializer_list>

#include "base/error.h"
#include "estimate/least_squares.h"
#include "io/csv.h"

namespace hapsim::bench {
namespace {

constexpr double kTwoPi = 6.283185307179586;

// The column of one of these names, whatever their case; empty when there is none.
std::vector<double> column(const CsvTable& table, std::initializer_list<const char*> names) {
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    std::string name = table.header[c];
    for (char& letter : name) letter = static_cast<char>(std::tolower(letter));
    if (std::find(names.begin(), names.end(), name) == names.end()) continue;
    std::vector<double> values;
    for (std::size_t row = 0; row < table.rows(); ++row) {
      double value = 0;
      if (parse_number(table.columns[c][row], value))
        values.push_back(value);
      else if (row > 0)  // the first may hold units
        fail_input(
            table.name,
            fmt::format("'{}' in column {} is no number", table.columns[c][row], table.header[c]),
            "correct or remove the row");
    }
    return values;
  }
  return {};
}

CsvTable table_of(const std::string& path) {
  Input input(path);
  return read_csv(input);
}

struct Curve {
  bool frequency = false;
  std::vector<double> at;  // [s] or [rad/s]
  Eigen::VectorXd value;   // the modulus, or storage and then loss
  // Of a term of unit modulus and of the long-time modulus (tau infinite).
  Eigen::VectorXd term(double tau) const {
    const auto n = static_cast<Eigen::Index>(at.size());
    Eigen::VectorXd unit = Eigen::VectorXd::Zero(value.size());
    for (Eigen::Index i = 0; i < n; ++i) {
      const double x = at[static_cast<std::size_t>(i)];
      if (!frequency) {
        unit[i] = std::exp(-x / tau);
        continue;
      }
      const double w2 = std::isinf(tau) ? 1 : x * x * tau * tau / (1 + x * x * tau * tau);
      unit[i] = w2;
      unit[n + i] = std::isinf(tau) ? 0 : x * tau / (1 + x * x * tau * tau);
    }
    return unit;
  }
};

Curve curve_of(const CsvTable& table) {
  Curve curve;
  const auto storage = column(table, {"e_stor", "g_stor", "storage", "e'", "g'"});
  const auto loss = column(table, {"e_loss", "g_loss", "loss", "e''", "g''"});
  std::vector<double> values = column(table, {"e_relax", "g_relax", "e", "g", "modulus"});
  curve.frequency = !storage.empty() && !loss.empty();
  if (curve.frequency) {
    curve.at = column(table, {"f", "f_set", "freq", "frequency", "f_hz"});
    for (double& f : curve.at) f *= kTwoPi;
    if (curve.at.empty()) curve.at = column(table, {"w", "omega"});
    values = storage;
    values.insert(values.end(), loss.begin(), loss.end());
  } else {
    curve.at = column(table, {"t", "time", "t_s"});
  }
  curve.value =
      Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
  if (curve.at.size() < 3 || values.size() != curve.at.size() * (curve.frequency ? 2 : 1))
    fail_input(table.name, "this is no master curve", "give columns t,E_relax or f,E_stor,E_loss");
  if (curve.value.minCoeff() <= 0)
    fail_input(table.name, "a modulus is not positive", "correct or remove the row");
  return curve;
}

Eigen::VectorXd published(const CsvTable& prony, const Curve& curve) {
  const auto tau = column(prony, {"tau", "tau_i"}), alpha = column(prony, {"alpha", "alpha_i"});
  if (tau.empty() || tau.size() != alpha.size())
    fail_input(prony.name, "these are no Prony terms", "give columns tau,alpha");
  double rest = 1;
  for (const double a : alpha) rest -= a;
  Eigen::VectorXd f = rest * curve.term(INFINITY);
  for (std::size_t k = 0; k < tau.size(); ++k) f += alpha[k] * curve.term(tau[k]);
  const auto e0 = column(prony, {"e_0", "e0", "g_0", "g0"});
  const Eigen::VectorXd relative = f.cwiseQuotient(curve.value);
  return f * (e0.empty() ? relative.sum() / relative.squaredNorm() : e0.front());
}

Eigen::VectorXd fitted(const Curve& curve, std::string& words) {
  const auto [low, high] = std::minmax_element(curve.at.begin(), curve.at.end());
  double first = curve.frequency ? 1 / *high : *low, last = curve.frequency ? 1 / *low : *high;
  if (first <= 0) first = 1e-3 * last;
  std::vector<double> tau{INFINITY};
  for (double t = first; t < 2 * last; t *= std::sqrt(10.0)) tau.push_back(t);
  Eigen::MatrixXd A(curve.value.size(), static_cast<Eigen::Index>(tau.size()));
  const double size = curve.value.maxCoeff();
  for (std::size_t k = 0; k < tau.size(); ++k)
    A.col(static_cast<Eigen::Index>(k)) =
        size * curve.term(tau[k]).cwiseQuotient(curve.value) / 0.01;
  const std::vector<Unknown> start(tau.size(),
                                   {1.0 / static_cast<double>(tau.size()), 0, 10, 0.1, false});
  const LeastSquaresResult result =
      minimise(start, [&](const Eigen::VectorXd& x, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
        r = A * x - Eigen::VectorXd::Constant(A.rows(), 1 / 0.01);
        if (J != nullptr) *J = A;
      });
  if (!result.converged) fail_numerics("the fit", result.message, "look at the data");
  words = fmt::format("{} terms, {} of them at work", tau.size() - 1,
                      (result.x.tail(result.x.size() - 1).array() > 1e-6).count());
  return 0.01 * curve.value.asDiagonal() * (A * result.x);
}

int run(const std::string& data, const std::string& terms) {
  const Curve curve = curve_of(table_of(data));
  const Eigen::VectorXd known = published(table_of(terms), curve);
  std::string words;
  const Eigen::VectorXd ours = fitted(curve, words);
  const auto apart = [&](const char* what, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    // Of the modulus itself: a loss near zero is no measure.
    const Eigen::Index n = static_cast<Eigen::Index>(curve.at.size());
    const Eigen::ArrayXd d = (a.head(n).array() / b.head(n).array() - 1).abs();
    fmt::print("{}: rms {:.2f} %, worst {:.2f} %\n", what, 100 * std::sqrt(d.square().mean()),
               100 * d.maxCoeff());
    return d.maxCoeff();
  };
  fmt::print("{}: {} points, {}\n", data, curve.at.size(), words);
  apart("ours from the data", ours, curve.value);
  apart("published from the data", known, curve.value);
  return apart("ours from the published curve (asked 1 %)", ours, known) <= 0.01 ? 0 : 1;
}

}  // namespace
}  // namespace hapsim::bench

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "bench_master_curve DATA.csv PRONY.csv\n");
    return 2;
  }
  try {
    return hapsim::bench::run(argv[1], argv[2]);
  } catch (const hapsim::Error& error) {
    fmt::print(stderr, "bench_master_curve: {}\n", error.what());
    return static_cast<int>(error.code());
  }
}
