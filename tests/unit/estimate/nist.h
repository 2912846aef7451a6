// Nonlinear regression problems with certified values: NIST Statistical Reference Datasets (StRD),
// data and values in the public domain.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace hapsim::test {

struct NistProblem {
  std::vector<double> x, y;
  std::vector<std::vector<double>> starts;
  std::vector<double> value, error;  // certified parameters and standard deviations
  double sum_of_squares = 0;
  // Prediction and its derivatives by the parameters.
  double (*model)(const Eigen::VectorXd& b, double x, Eigen::VectorXd* d) = nullptr;

  void operator()(const Eigen::VectorXd& b, Eigen::VectorXd& r, Eigen::MatrixXd* J) const {
    r.resize(static_cast<Eigen::Index>(x.size()));
    if (J != nullptr) J->resize(r.size(), b.size());
    Eigen::VectorXd d(b.size());
    for (Eigen::Index i = 0; i < r.size(); ++i) {
      r[i] = model(b, x[i], J != nullptr ? &d : nullptr) - y[i];
      if (J != nullptr) J->row(i) = d.transpose();
    }
  }
};

// Misra (1978), dental research: b1 (1 - exp(-b2 x)). Lower difficulty.
inline NistProblem misra1a() {
  return {{77.6, 114.9, 141.1, 190.8, 239.9, 289.0, 332.8, 378.4, 434.8, 477.3, 536.8, 593.1, 689.1,
           760.0},
          {10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02, 44.82, 50.76, 55.05, 61.01, 66.40,
           75.47, 81.78},
          {{500, 0.0001}, {250, 0.0005}},
          {2.3894212918e+02, 5.5015643181e-04},
          {2.7070075241e+00, 7.2668688436e-06},
          1.2455138894e-01,
          [](const Eigen::VectorXd& b, double x, Eigen::VectorXd* d) {
            const double e = std::exp(-b[1] * x);
            if (d != nullptr) *d << 1 - e, b[0] * x * e;
            return b[0] * (1 - e);
          }};
}

// Kowalik and Osborne (1978): b1 (x^2 + b2 x) / (x^2 + b3 x + b4). Higher difficulty.
inline NistProblem mgh09() {
  return {{4, 2, 1, 0.5, 0.25, 0.167, 0.125, 0.1, 0.0833, 0.0714, 0.0625},
          {0.1957, 0.1947, 0.1735, 0.16, 0.0844, 0.0627, 0.0456, 0.0342, 0.0323, 0.0235, 0.0246},
          {{25, 39, 41.5, 39}, {0.25, 0.39, 0.415, 0.39}},
          {1.9280693458e-01, 1.9128232873e-01, 1.2305650693e-01, 1.3606233068e-01},
          {1.1435312227e-02, 1.9633220911e-01, 8.0842031232e-02, 9.0025542308e-02},
          3.0750560385e-04,
          [](const Eigen::VectorXd& b, double x, Eigen::VectorXd* d) {
            const double top = x * x + b[1] * x, bottom = x * x + b[2] * x + b[3];
            const double f = b[0] * top / bottom;
            if (d != nullptr) *d << top / bottom, b[0] * x / bottom, -f * x / bottom, -f / bottom;
            return f;
          }};
}

// Lanczos (1956), three exponentials to four digits: the shape of relaxation. Lower difficulty.
inline NistProblem lanczos3() {
  NistProblem p{{},
                {2.5134, 2.0443, 1.6684, 1.3664, 1.1232, 0.9269, 0.7679, 0.6389,
                 0.5338, 0.4479, 0.3776, 0.3197, 0.2720, 0.2325, 0.1997, 0.1723,
                 0.1493, 0.1301, 0.1138, 0.1000, 0.0883, 0.0783, 0.0698, 0.0624},
                {{1.2, 0.3, 5.6, 5.5, 6.5, 7.6}, {0.5, 0.7, 3.6, 4.2, 4, 6.3}},
                {8.6816414977e-02, 9.5498101505e-01, 8.4400777463e-01, 2.9515951832e+00,
                 1.5825685901e+00, 4.9863565084e+00},
                {1.7197908859e-02, 9.7041624475e-02, 4.1488663282e-02, 1.0766312506e-01,
                 5.8371576281e-02, 3.4436403035e-02},
                1.6117193594e-08,
                [](const Eigen::VectorXd& b, double x, Eigen::VectorXd* d) {
                  double f = 0;
                  for (int k = 0; k < 3; ++k) {
                    const double e = std::exp(-b[2 * k + 1] * x);
                    f += b[2 * k] * e;
                    if (d == nullptr) continue;
                    (*d)[2 * k] = e;
                    (*d)[2 * k + 1] = -b[2 * k] * x * e;
                  }
                  return f;
                }};
  for (int i = 0; i < 24; ++i) p.x.push_back(0.05 * i);
  return p;
}

}  // namespace hapsim::test
