#include "fit/learned_field.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "base/median.h"
#include "effects/catalogue.h"
#include "estimate/kriging.h"
#include "io/csv.h"
#include "io/number.h"
#include "model/body_parameters.h"
#include "model/interval.h"

namespace hapsim {
namespace {

constexpr std::size_t kFewest = 10;
// Standard deviations of the prior of each place's own logarithm of the factor and of the power: a
// place that hardly answers says little.
constexpr double kWideFactor = 3, kWidePower = 1.5;

// One pressed place: the model's force without the field, the measured one, and the depth as the
// body sees it.
struct PlaceData {
  Vec3 point = Vec3::Zero();
  std::vector<Vec3> model, measured;
  std::vector<double> log_depth;
};

std::vector<PlaceData> place_data(const Model& model, const Experiment& experiment,
                                  const Linearisation& about, const Selection& selection,
                                  double& depth) {
  const Dataset& dataset = experiment.dataset;
  Model body = model, all = model;
  std::erase_if(all.parameters,
                [](const Parameter& p) { return require_effect(p.effect).card().is_field; });
  body = all;
  std::erase_if(body.parameters, [](const Parameter& p) {
    return require_effect(p.effect).card().stage == Stage::kSensor;
  });
  const Eigen::VectorXd f = model_forces(body, experiment, about, selection, false).f;
  // What the sensor adds is not the place's.
  const Eigen::VectorXd target = measured_forces(dataset, selection) + f -
                                 model_forces(all, experiment, about, selection, false).f;
  const std::vector<Vec3> motion = motion_on_body(body, experiment, about, selection);
  const auto depth_of = [&](Eigen::Index row, const Episode& episode) {
    return -motion[static_cast<std::size_t>(row / 3)].dot(episode.view.normal);
  };
  // The factor holds where the forces are: a mean depth in which the two numbers hardly go
  // together.
  double weight = 0, logs = 0;
  Eigen::Index at = 0;
  for (const int e : selection) {
    const Episode& episode = dataset.episodes[e];
    for (std::size_t i = 0; i < episode.rows.size(); ++i, at += 3) {
      const double d = depth_of(at, episode);
      if (episode.view.in_air[i] || d <= 0) continue;
      const double w = f.segment<3>(at).squaredNorm();
      weight += w;
      logs += w * std::log(d);
    }
  }
  PlaceField scale;
  scale.depth = depth = weight > 0 ? std::exp(logs / weight) : 1e-3;
  std::vector<PlaceData> places;
  std::vector<int> number(dataset.positions.size(), -1);
  at = 0;
  for (const int e : selection) {
    const Episode& episode = dataset.episodes[e];
    int& n = number[static_cast<std::size_t>(episode.position)];
    if (n < 0) {  // the same place may be pressed by several tools
      const Vec3& point = dataset.positions[static_cast<std::size_t>(episode.position)];
      const auto known = std::find_if(places.begin(), places.end(), [&](const PlaceData& p) {
        return (p.point - point).norm() <= kSamePlace;
      });
      n = static_cast<int>(known - places.begin());
      if (known == places.end()) places.push_back({point, {}, {}, {}});
    }
    PlaceData& place = places[static_cast<std::size_t>(n)];
    for (std::size_t i = 0; i < episode.rows.size(); ++i, at += 3) {
      if (episode.view.in_air[i]) continue;
      place.model.emplace_back(f.segment<3>(at));
      place.measured.emplace_back(target.segment<3>(at));
      place.log_depth.push_back(scale.log_depth(depth_of(at, episode))[0]);
    }
  }
  std::erase_if(places, [](const PlaceData& p) {
    return std::all_of(p.model.begin(), p.model.end(), [](const Vec3& m) { return m.norm() <= 0; });
  });
  return places;
}

// Twice the negative log posterior of a place's two numbers, its gradient and Gauss-Newton matrix.
struct Posterior {
  double value = 0, squares = 0;  // squares: of the forces [N^2]
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
  Eigen::Matrix2d matrix = Eigen::Matrix2d::Zero();
};

Posterior posterior(const PlaceData& place, const Eigen::Vector2d& x, const Eigen::Vector2d& prior,
                    double noise) {
  Posterior p;
  for (std::size_t i = 0; i < place.model.size(); ++i) {
    const Vec3 f = std::exp(x[0] + x[1] * place.log_depth[i]) * place.model[i];
    const Vec3 r = f - place.measured[i];
    const Eigen::Vector2d by(1, place.log_depth[i]);
    p.squares += r.squaredNorm();
    p.gradient += f.dot(r) / (noise * noise) * by;
    p.matrix += f.squaredNorm() / (noise * noise) * by * by.transpose();
  }
  const Eigen::Vector2d wide(1 / (kWideFactor * kWideFactor), 1 / (kWidePower * kWidePower));
  const Eigen::Vector2d off = x - prior;
  p.value = p.squares / (noise * noise) + off.dot(wide.cwiseProduct(off));
  p.gradient += wide.cwiseProduct(off);
  p.matrix.diagonal() += wide;
  return p;
}

// The place's logarithm of the factor and power, by damped Gauss-Newton steps.
Eigen::Vector2d asked_for(const PlaceData& place, const Eigen::Vector2d& prior, double noise,
                          double& squares) {
  constexpr int kSteps = 60;
  constexpr double kSettled = 1e-7, kMost = 1;
  Eigen::Vector2d x = prior;
  Posterior now = posterior(place, x, prior, noise);
  double damping = 1e-3;
  for (int k = 0; k < kSteps; ++k) {
    Eigen::Matrix2d A = now.matrix;
    A.diagonal() *= 1 + damping;
    const Eigen::Vector2d step =
        -A.ldlt().solve(now.gradient).cwiseMax(-kMost).cwiseMin(kMost).eval();
    const Posterior next = posterior(place, x + step, prior, noise);
    if (next.value <= now.value) {
      x += step;
      now = next;
      damping = std::max(damping / 5, 1e-9);
    } else {
      damping = std::max(10 * damping, 1e-6);
    }
    if (step.cwiseAbs().maxCoeff() < kSettled || damping > 1e9) break;
  }
  squares = now.squares;
  return x;
}

// [factor, power] of each place, one a row.
Eigen::MatrixXd what_places_ask(const std::vector<PlaceData>& places, double noise) {
  Eigen::MatrixXd asked(static_cast<Eigen::Index>(places.size()), 2);
  std::vector<double> gain, left(places.size());
  for (const PlaceData& p : places) {
    double ff = 0, ft = 0;
    for (std::size_t i = 0; i < p.model.size(); ++i) {
      ff += p.model[i].squaredNorm();
      ft += p.model[i].dot(p.measured[i]);
    }
    gain.push_back(std::log(std::max(ft / ff, 1e-3)));
  }
  const Eigen::Vector2d prior(upper_median(gain), 0);
  for (int round = 0; round < 2; ++round) {
    for (std::size_t p = 0; p < places.size(); ++p) {
      double squares = 0;
      asked.row(static_cast<Eigen::Index>(p)) =
          asked_for(places[p], prior, noise, squares).transpose();
      left[p] =
          std::sqrt(squares / std::max(1.0, 3.0 * static_cast<double>(places[p].model.size()) - 2));
    }
    noise = std::max(noise, upper_median(left));
  }
  return asked;
}

// Fills in a kernel and the weights of one quantity.
void interpolate(const std::vector<PlaceData>& places, const Eigen::VectorXd& values,
                 bool keep_scales, PlaceField::Kernel& kernel, std::vector<double>& weights) {
  weights.assign(places.size(), 0);
  if (values.cwiseAbs().maxCoeff() < 1e-9) return;
  KrigingCoordinates at{Eigen::MatrixXd(values.size(), 3), {3}};
  for (std::size_t p = 0; p < places.size(); ++p)
    at.rows.row(static_cast<Eigen::Index>(p)) = places[p].point.transpose();
  const KrigingScales known{{kernel.range, kernel.fine}, kernel.nugget, kernel.share};
  const Kriging kriging(std::move(at), values, keep_scales && kernel.sd > 0 ? &known : nullptr);
  const KrigingScales& s = kriging.scales();
  kernel = {s.length[0], s.length[1], s.second, s.nugget, std::sqrt(kriging.variance())};
  for (std::size_t p = 0; p < places.size(); ++p)
    weights[p] = kriging.weights()(static_cast<Eigen::Index>(p), 0);
}

void put_field(Model& model, const PlaceField& field) {
  const Effect& effect = field_effect();
  const auto first =
      std::find_if(model.parameters.begin(), model.parameters.end(),
                   [&](const Parameter& p) { return p.effect == effect.card().name; });
  const auto where = first - model.parameters.begin();
  std::erase_if(model.parameters,
                [&](const Parameter& p) { return p.effect == effect.card().name; });
  const std::vector<Parameter> rows =
      effect_rows(effect, static_cast<int>(field.place.size()), field.values());
  model.parameters.insert(model.parameters.begin() + where, rows.begin(), rows.end());
}

}  // namespace

bool learns_field(const Model& model) {
  return std::any_of(model.parameters.begin(), model.parameters.end(), [](const Parameter& p) {
    return p.state == ParameterState::kDerived && require_effect(p.effect).card().is_field;
  });
}

PlaceField place_field(const Model& model) {
  for (const EffectInstance& i : effect_instances(model, false))
    if (i.effect->card().is_field) return PlaceField(i.values);
  return {};
}

std::vector<FieldAt> field_at(const PlaceField& field, const std::vector<Vec3>& places) {
  std::vector<FieldAt> result(places.size());
  if (field.place.empty() || places.empty()) return result;
  const auto rows_of = [](const std::vector<Vec3>& points) {
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t p = 0; p < points.size(); ++p)
      rows.row(static_cast<Eigen::Index>(p)) = points[p].transpose();
    return rows;
  };
  const Eigen::MatrixXd rows = rows_of(places);
  const auto sd_of = [&](const PlaceField::Kernel& kernel) {
    if (kernel.sd <= 0) return Eigen::VectorXd::Zero(rows.rows()).eval();
    const KrigingScales scales{{kernel.range, kernel.fine}, kernel.nugget, kernel.share};
    const Kriging kriging({rows_of(field.place), {3}},
                          Eigen::VectorXd::Zero(static_cast<Eigen::Index>(field.place.size())),
                          &scales);
    return Eigen::VectorXd(
        kernel.sd *
        (kriging.posterior_variance(kriging.covariance(rows)).array() + kernel.nugget).sqrt());
  };
  const Eigen::VectorXd factor = sd_of(field.factor), power = sd_of(field.power);
  for (std::size_t p = 0; p < places.size(); ++p) {
    const auto [G, H] = field.at(places[p]);
    const auto i = static_cast<Eigen::Index>(p);
    result[p] = {G, factor[i], H, power[i]};
  }
  return result;
}

void write_field(std::ostream& out, const PlaceField& field, const Surface& surface) {
  Metadata metadata;
  metadata.set("depth", format_number(field.depth));
  CsvWriter writer(out, metadata,
                   {"x", "y", "z", "pressed", "factor", "low", "high", "power", "power_sd"});
  const auto write = [&](const std::vector<Vec3>& places, bool pressed) {
    const std::vector<FieldAt> at = field_at(field, places);
    for (std::size_t p = 0; p < places.size(); ++p) {
      // Of a pressed place the field has what it asked for.
      const double band = pressed ? 0 : kHalf95 * at[p].log_factor_sd;
      std::vector<std::string> row;
      for (int k = 0; k < 3; ++k) row.push_back(format_number(places[p][k]));
      row.push_back(pressed ? "1" : "0");
      for (const double g : {0.0, -band, band})
        row.push_back(format_number(std::exp(at[p].log_factor + g)));
      row.push_back(format_number(at[p].power));
      row.push_back(format_number(pressed ? 0 : at[p].power_sd));
      writer.row(row);
    }
  };
  write(field.place, true);
  write(surface.vertices, false);
}

void forget_field(Model& model) {
  if (!learns_field(model)) return;
  PlaceField field;
  field.place = {Vec3::Zero()};
  field.g = field.h = {0};
  put_field(model, field);
}

void learn_field(Model& model, const Experiment& experiment, const Linearisation& about,
                 const Selection& selection, double noise, bool keep_scales) {
  PlaceField field = place_field(model);
  const std::vector<PlaceData> places =
      place_data(model, experiment, about, selection, field.depth);
  if (places.size() < kFewest) return forget_field(model);
  Eigen::MatrixXd asked = what_places_ask(places, noise);
  if (Parameter& modulus = *modulus_of(model); modulus.state == ParameterState::kFree) {
    const double value =
        std::clamp(modulus.value * std::exp(asked.col(0).mean()), modulus.lower, modulus.upper);
    asked.col(0).array() -= std::log(value / modulus.value);
    modulus.value = value;
  }
  field.mean_power = asked.col(1).mean();
  asked.col(1).array() -= field.mean_power;
  field.place.clear();
  for (const PlaceData& p : places) field.place.push_back(p.point);
  interpolate(places, asked.col(0), keep_scales, field.factor, field.g);
  interpolate(places, asked.col(1), keep_scales, field.power, field.h);
  put_field(model, field);
}

}  // namespace hapsim
