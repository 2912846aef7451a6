// Marked points beside a recording: how they are matched, weighed and differentiated.
#include "experiment/markers.h"

#include <gtest/gtest.h>

#include "expect_error.h"
#include "fit/marker_rows.h"
#include "support/synthetic.h"

namespace hapsim {
namespace {

const std::vector<Vec3> kSeen{{0.03, 0.036, 0.04}, {0.05, 0.04, 0.04}, {0.02, 0.06, 0.04}};

// What a model's points show at times between the rows of the recording.
MarkerTable seen(const Experiment& w, const Model& model, double noise) {
  MarkerTable table;
  table.name = "markers";
  table.rest = kSeen;
  const MaterialSpec material = material_of(model);
  const MarkerGains gains(w.places, material, kSeen, true);
  const Recording& r = w.dataset.recording;
  for (std::size_t m = 0; m < kSeen.size(); ++m) table.points.push_back("p" + std::to_string(m));
  for (const Episode& e : w.dataset.episodes) {
    const auto at = gains.at(static_cast<std::size_t>(e.position), material);
    for (std::size_t k = 0; k + 1 < e.rows.size(); k += 3)
      for (std::size_t m = 0; m < kSeen.size(); ++m) {
        const auto i = static_cast<std::size_t>(e.rows[k]), j = i + 1;
        table.line.push_back(static_cast<long>(table.rows()) + 2);
        table.point.push_back(static_cast<int>(m));
        table.t.push_back(0.7 * r.t[i] + 0.3 * r.t[j]);
        table.u.push_back(at[m].G * (0.7 * r.u[i] + 0.3 * r.u[j]));
      }
  }
  if (noise > 0) add_marker_noise(table, noise, 3);
  return table;
}

TEST(Markers, AreFoundBetweenTheRows) {
  const Experiment w = test::experiment();
  const Model model = test::elastic(2e4, 0.4);
  const MarkerTable table = seen(w, model, 0);
  const Markers markers = match_markers(table, w);
  EXPECT_GT(markers.rows, table.rows() / 2);  // the others are of points under the tool
  FitOptions options;
  options.markers = &markers;
  options.noise = w.noise.value;
  const MarkerRows rows(model, w, all_episodes(w.dataset), options);
  EXPECT_LT(rows.error(model).rms, 1e-9);
  // A press of no number, and times that begin anew.
  MarkerTable other = table;
  other.press.assign(other.rows(), 99);
  EXPECT_NE(error_of([&] { match_markers(other, w); }).find("none of"), std::string::npos);
  Experiment anew = w;
  for (const Episode& e : anew.dataset.episodes)
    for (const int row : e.rows)
      anew.dataset.recording.t[static_cast<std::size_t>(row)] -=
          w.dataset.recording.t[static_cast<std::size_t>(e.rows[0])];
  EXPECT_NE(error_of([&] { match_markers(table, anew); }).find("column press"), std::string::npos);
}

TEST(Markers, OfAWrongUnitAreRefused) {
  const Experiment w = test::experiment();
  MarkerTable table = seen(w, test::elastic(2e4, 0.4), 1e-6);
  MarkerTable millimetres = table;
  for (Vec3& u : millimetres.u) u *= 1e3;
  EXPECT_NE(error_of([&] { match_markers(millimetres, w); }).find("ux_mm"), std::string::npos);
  for (Vec3& p : table.rest) p *= 1e3;
  EXPECT_NE(error_of([&] { match_markers(table, w); }).find("3 of 3 marked points lie"),
            std::string::npos);
}

TEST(Markers, HaveTheDerivativesOfTheirRows) {
  const Experiment w = test::experiment();
  const Model model = test::elastic(2e4, 0.4);
  const Markers markers = match_markers(seen(w, test::elastic(2e4, 0.43), 1e-5), w);
  FitOptions options;
  options.markers = &markers;
  options.noise = w.noise.value;
  options.floor = 0.01;
  const MarkerRows rows(model, w, all_episodes(w.dataset), options);
  const auto residual = [&](double modulus, double nu, Eigen::MatrixXd* J) {
    Eigen::VectorXd r(0);
    rows.append(test::elastic(modulus, nu), r, J);
    return r;
  };
  Eigen::MatrixXd J(0, 2);
  residual(2e4, 0.4, &J);
  const double step = 1e-5;
  const Eigen::VectorXd slope =
      (residual(2e4, 0.4 + step, nullptr) - residual(2e4, 0.4 - step, nullptr)) / (2 * step);
  EXPECT_LT((J.col(1) - slope).norm(), 1e-5 * slope.norm());
  EXPECT_LT(J.col(0).norm(), 1e-12);
  EXPECT_LT((residual(9e4, 0.4, nullptr) - residual(2e4, 0.4, nullptr)).norm(), 1e-9);
}

// Measured noise is that of the rows, and what no gain explains is told.
TEST(Markers, NoiseIsWhatNoProportionExplains) {
  const Experiment w = test::experiment();
  const Model model = test::elastic(2e4, 0.4);
  MarkerTable table = seen(w, model, 1e-5);
  table.metadata.remove("marker_noise");
  const Markers markers = match_markers(table, w);
  EXPECT_TRUE(markers.noise.measured);
  EXPECT_NEAR(markers.noise.value, 1e-5, 1e-6);
  MarkerTable late = table;
  late.metadata.set("marker_noise", "1e-5");
  for (double& t : late.t) t += 0.2;
  const Markers shifted = match_markers(late, w);
  FitOptions options;
  options.markers = &shifted;
  options.noise = w.noise.value;
  EXPECT_GT(MarkerRows(model, w, all_episodes(w.dataset), options).error(model).bent, 2);
}

TEST(Markers, OfWhatHasNoGainAreRefused) {
  const Experiment w = test::experiment();
  const Model model = test::elastic(2e4, 0.4);
  EXPECT_EQ(marker_refusal(model, w.dataset), "");
  const auto more = [&](const char* name) {
    const Effect& effect = *find_effect(name);
    std::vector<double> values;
    for (const ParameterCard& p : effect.card().parameters) values.push_back(p.start);
    return marker_refusal(test::with(model, name, values), w.dataset);
  };
  for (const char* fine : {"viscoelastic", "sensor-lag", "sensor-gain", "tare"})
    EXPECT_EQ(more(fine), "") << fine;
  for (const char* other : {"friction", "touch", "hyperelastic", "layer", "inclusion",
                            "arm-compliance", "poroelastic", "plastic", "tip"})
    EXPECT_NE(more(other), "") << other;
}

}  // namespace
}  // namespace hapsim
