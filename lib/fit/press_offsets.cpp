#include "fit/press_offsets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "effects/catalogue.h"

namespace hapsim {
namespace {

constexpr std::size_t kStretches = 10;  // of a press

Eigen::Index rows_of(const Dataset& dataset, int episode) {
  return static_cast<Eigen::Index>(dataset.episodes[episode].rows.size());
}

}  // namespace

const Effect* offset_effect(const Model& model) {
  for (const std::string& name : model.effects())
    if (const Effect& effect = require_effect(name); effect.card().per_press) return &effect;
  return nullptr;
}

Eigen::MatrixXd press_means(const Dataset& dataset, const Selection& selection,
                            const Eigen::VectorXd& stacked) {
  Eigen::MatrixXd means(3, static_cast<Eigen::Index>(selection.size()));
  Eigen::Index at = 0;
  for (std::size_t p = 0; p < selection.size(); ++p) {
    const Eigen::Index n = rows_of(dataset, selection[p]);
    means.col(static_cast<Eigen::Index>(p)) =
        Eigen::Map<const Eigen::MatrixXd>(stacked.data() + at, 3, n).rowwise().mean();
    at += 3 * n;
  }
  return means;
}

void take_out_press_means(const Dataset& dataset, const Selection& selection,
                          Eigen::Ref<Eigen::MatrixXd> stacked) {
  for (Eigen::Index c = 0; c < stacked.cols(); ++c) {
    const Eigen::MatrixXd means = press_means(dataset, selection, stacked.col(c));
    Eigen::Index at = 0;
    for (std::size_t p = 0; p < selection.size(); ++p) {
      const Eigen::Index n = rows_of(dataset, selection[p]);
      for (Eigen::Index i = 0; i < n; ++i)
        stacked.col(c).segment<3>(at + 3 * i) -= means.col(static_cast<Eigen::Index>(p));
      at += 3 * n;
    }
  }
}

void take_out_cross_means(const Dataset& dataset, const Selection& selection,
                          Eigen::Ref<Eigen::VectorXd> stacked) {
  Eigen::Index at = 0;
  for (const int e : selection) {
    const auto n = static_cast<std::size_t>(rows_of(dataset, e));
    const std::size_t stretches = std::min<std::size_t>(kStretches, n);
    const auto half = [&](std::size_t i) { return i * stretches / n % 2; };
    Vec3 sum[2] = {Vec3::Zero(), Vec3::Zero()};
    double count[2] = {0, 0};
    for (std::size_t i = 0; i < n; ++i) {
      sum[half(i)] += stacked.segment<3>(at + 3 * static_cast<Eigen::Index>(i));
      ++count[half(i)];
    }
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t other = 1 - half(i);
      if (count[other] > 0)
        stacked.segment<3>(at + 3 * static_cast<Eigen::Index>(i)) -= sum[other] / count[other];
    }
    at += 3 * static_cast<Eigen::Index>(n);
  }
}

void set_offsets(Model& model, const Dataset& dataset, const Selection& selection,
                 const Eigen::MatrixXd& means, double error) {
  const Effect& effect = *offset_effect(model);
  const std::size_t components = effect.card().parameters.size();
  // The rows stand press by press, as effect_rows() made them.
  std::vector<Parameter*> rows;
  for (Parameter& p : model.parameters)
    if (p.effect == effect.card().name) rows.push_back(&p);
  for (Parameter* row : rows) {
    row->value = 0;
    row->std_error = std::numeric_limits<double>::quiet_NaN();
  }
  for (std::size_t p = 0; p < selection.size(); ++p) {
    const auto press = static_cast<std::size_t>(selection[p]);
    for (std::size_t k = 0; k < components; ++k) {
      const std::size_t row = press * components + k;
      if (row >= rows.size()) continue;
      rows[row]->value =
          std::clamp(means(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(p)),
                     rows[row]->lower, rows[row]->upper);
      rows[row]->std_error = error / std::sqrt(static_cast<double>(rows_of(dataset, selection[p])));
    }
  }
}

}  // namespace hapsim
