#include "imaging/stiffness_image.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "base/parallel.h"
#include "effects/catalogue.h"
#include "imaging/field_contacts.h"
#include "imaging/lump_solver.h"

namespace hapsim {
namespace {

// Over what the presses may see of the body: down to `depth` below them, four tool radii about.
FieldGrid grid_about(const std::vector<PreparedContact>& contacts, const TetMesh& body,
                     double tool_radius, double step, double depth) {
  Vec3 low = contacts.front().point, high = low;
  for (const PreparedContact& c : contacts) {
    const Vec3 deep = c.point - depth * c.normal;
    low = low.cwiseMin(c.point).cwiseMin(deep);
    high = high.cwiseMax(c.point).cwiseMax(deep);
  }
  Eigen::AlignedBox3d box;
  for (const Vec3& v : body.nodes) box.extend(v);
  const double margin = 4 * tool_radius;
  low = (low - Vec3::Constant(margin)).cwiseMax(box.min());
  high = (high + Vec3::Constant(margin)).cwiseMin(box.max());
  FieldGrid grid;
  grid.low = low;
  grid.step = step;
  for (int c = 0; c < 3; ++c)
    grid.count[c] = 1 + static_cast<int>(std::ceil((high[c] - low[c]) / step - 1e-9));
  return grid;
}

// Derivatives of the log gains by log E at the nodes: views x nodes.
Eigen::MatrixXd sensitivities(FieldContacts& contacts, std::size_t positions,
                              const std::vector<ImageView>& views, const ImageOptions& options) {
  const auto nodes = static_cast<Eigen::Index>(contacts.grid().size());
  Eigen::MatrixXd J(static_cast<Eigen::Index>(views.size()), nodes);
  const Eigen::VectorXd homogeneous = Eigen::VectorXd::Zero(nodes);
  in_parallel(positions, options.threads, [&](std::size_t p) {
    const FieldContacts::Contact contact = contacts.at(p, homogeneous);
    for (std::size_t v = 0; v < views.size(); ++v) {
      if (views[v].position != static_cast<int>(p)) continue;
      const Eigen::Matrix3d C = contact.S.transpose() * views[v].B * contact.S;
      Eigen::Matrix<double, 1, 6> row;
      row << C(0, 0), C(1, 1), C(2, 2), C(0, 1) + C(1, 0), C(1, 2) + C(2, 1), C(0, 2) + C(2, 0);
      J.row(static_cast<Eigen::Index>(v)) = row * contact.by_node / (C * contact.K_coarse).trace();
    }
    if (options.progress) options.progress();
  });
  return J;
}

// The least error that the views of a position have in common, beside noise: of the meshes.
constexpr double kLeastLumpError = 0.0025;

// What all gains have in common, and what another Poisson's ratio does where it is not known.
Eigen::MatrixXd free_directions(const Model& model, const Experiment& experiment,
                                const std::vector<ImageView>& views) {
  const auto n = static_cast<Eigen::Index>(views.size());
  const MaterialSpec material = material_of(model);
  const bool known = material.nu_column < 0;
  Eigen::MatrixXd free = Eigen::MatrixXd::Ones(n, known ? 1 : 2);
  for (Eigen::Index v = 0; v < n && !known; ++v) {
    const ImageView& view = views[static_cast<std::size_t>(v)];
    Eigen::Matrix3d K, by_nu;
    experiment.places.contact(static_cast<std::size_t>(view.position))
        .stiffness.evaluate(material.nu, K, by_nu);
    free(v, 1) = (by_nu * view.B).trace() / (K * view.B).trace();
  }
  return free;
}

Lump as_start(const FoundBall& ball) {
  Lump lump;
  lump.centre = ball.centre;
  lump.depth = ball.depth;
  lump.radius = ball.radius;
  lump.ratio = ball.ratio;
  return lump;
}

// One after the other, each in what the others leave and what their own values may still do; with
// several, all once more.
void find_lumps(const LumpData& whole, BallScene scene, const BallSolver& solver,
                StiffnessImage& image) {
  constexpr std::size_t kMost = 3;
  constexpr double kLeft = 0.01;  // share of the first's drop of chi^2 that its signal may miss
  const SignedDistance surface(scene.surface);
  const LumpScene about{scene.contacts, surface, scene.tool_radius, scene.largest_depth};
  std::vector<LumpPosterior> found;
  const auto left_by_others = [&](std::size_t own) {
    LumpData data = whole;
    for (std::size_t k = 0; k < found.size(); ++k)
      if (k != own) data.gain -= found[k].signal;
    return data;
  };
  scene.free = whole.free;
  scene.least_error = whole.floor;
  const std::vector<BallCandidate> candidates = ball_candidates(whole.J, whole.grid, scene);
  while (true) {
    const LumpData data = left_by_others(found.size());
    image.found = search_ball(whole.J, whole.grid, candidates, data.gain, whole.noise, scene);
    if (found.empty()) image.misfit_before = image.found.misfit_before;
    if (!image.found.ball || found.size() == kMost) break;
    const FoundBall& ball = *image.found.ball;
    if (!found.empty() && ball.drop < kLeft * found.front().lump.drop) break;
    LumpPosterior next = fit_lump(data, about, as_start(ball), solver);
    if (!(next.lump.drop >= image.found.critical)) break;
    next.lump.chance = ball.chance;
    scene.free.conservativeResize(Eigen::NoChange, scene.free.cols() + next.tangent.cols());
    scene.free.rightCols(next.tangent.cols()) = next.tangent;
    found.push_back(std::move(next));
  }
  for (std::size_t k = 0; k < found.size() && found.size() > 1; ++k) {
    const double chance = found[k].lump.chance;
    found[k] = fit_lump(left_by_others(k), about, found[k].lump, solver);
    found[k].lump.chance = chance;
  }
  std::stable_sort(found.begin(), found.end(), [](const LumpPosterior& a, const LumpPosterior& b) {
    return a.lump.drop > b.lump.drop;
  });
  image.error = image.found.error;
  for (const LumpPosterior& f : found) image.lumps.push_back(f.lump);
}

}  // namespace

std::vector<ImageView> image_views(const Model& model, const Experiment& experiment,
                                   const Linearisation& about) {
  const Dataset& dataset = experiment.dataset;
  const double noise = experiment.noise.value;
  Model without_sensor = model;
  std::erase_if(without_sensor.parameters, [](const Parameter& p) {
    return require_effect(p.effect).card().stage == Stage::kSensor;
  });
  const Selection all = all_episodes(dataset);
  const Eigen::VectorXd full = model_forces(model, experiment, about, all, false).f;
  const Eigen::VectorXd f = model_forces(without_sensor, experiment, about, all, false).f;
  const Eigen::VectorXd target = measured_forces(dataset, all) - (full - f);
  const MaterialSpec material = material_of(model);
  struct Sums {
    Vec3 direction;
    Eigen::Matrix3d ff = Eigen::Matrix3d::Zero();
    double ft = 0;
    int position = 0;
  };
  std::vector<Sums> sums;
  constexpr double kAlike = 0.966;  // 15 degrees
  Eigen::Index at = 0;
  for (const int e : all) {
    const Episode& episode = dataset.episodes[e];
    auto same = std::find_if(sums.begin(), sums.end(), [&](const Sums& s) {
      return s.position == episode.position && s.direction.dot(episode.view.direction) > kAlike;
    });
    if (same == sums.end()) {
      sums.push_back({episode.view.direction, Eigen::Matrix3d::Zero(), 0, episode.position});
      same = sums.end() - 1;
    }
    for (std::size_t i = 0; i < episode.rows.size(); ++i, at += 3) {
      same->ff += f.segment<3>(at) * f.segment<3>(at).transpose();
      same->ft += f.segment<3>(at).dot(target.segment<3>(at));
    }
  }
  std::vector<ImageView> views;
  for (const Sums& s : sums) {
    const double power = s.ff.trace();
    if (power <= 0 || s.ft <= 0) continue;
    const Eigen::Matrix3d K = about.at(static_cast<std::size_t>(s.position), material).K;
    views.push_back(
        {s.position, K.inverse() * s.ff / power, s.ft / power, noise / std::sqrt(power)});
  }
  std::stable_sort(views.begin(), views.end(),
                   [](const ImageView& a, const ImageView& b) { return a.position < b.position; });
  return views;
}

StiffnessImage stiffness_image(const Model& model, const Experiment& experiment,
                               const Linearisation& about, const TetMesh& body,
                               const ImageOptions& options) {
  const double tool = experiment.dataset.recording.disc_radius();
  const double depth = options.largest_depth > 0 ? options.largest_depth : 15 * tool;
  std::vector<ImageView> views = image_views(model, experiment, about);
  constexpr double kUseless = 0.3;  // relative error from which on a logarithm says nothing
  constexpr std::size_t kFewestPlaces = 4;
  std::erase_if(views, [](const ImageView& v) { return !(v.error <= kUseless * v.gain); });
  std::set<int> told;
  for (const ImageView& v : views) told.insert(v.position);
  if (told.size() < kFewestPlaces)
    fail_input(experiment.dataset.recording.name,
               fmt::format("the noise leaves {} of {} places whose stiffness is known to {:.0f} %",
                           told.size(), experiment.dataset.positions.size(), 100 * kUseless),
               fmt::format("an image needs {}: press deeper, or longer", kFewestPlaces));
  const auto n = static_cast<Eigen::Index>(views.size());
  const std::vector<PreparedContact>& pressed = experiment.places.setup(0)->contacts();
  const FieldGrid grid =
      grid_about(pressed, body, tool, options.step > 0 ? options.step : 0.7 * tool, depth);
  FieldContacts contacts(body, experiment.places, tool, material_of(model).nu, grid, 0, kSensedRim);
  const Eigen::MatrixXd J = sensitivities(contacts, pressed.size(), views, options);
  Eigen::VectorXd data(n), noise(n);
  std::vector<int> position;
  for (Eigen::Index v = 0; v < n; ++v) {
    data[v] = std::log(views[v].gain);
    noise[v] = views[v].error / views[v].gain;
    position.push_back(views[v].position);
  }
  StiffnessImage image;
  image.views = views.size();
  LumpData lump_data{data,
                     noise,
                     position,
                     free_directions(model, experiment, views),
                     experiment.shape.after,
                     kLeastLumpError,
                     J,
                     grid};
  const LumpSolver solver(contacts.base(), experiment.places, tool, material_of(model).nu, views,
                          options.threads);
  find_lumps(lump_data, {pressed, contacts.base().fine, tool, depth, {}, 0, options.threads},
             solver, image);
  image.field =
      image_field(J, grid, position, data, image.found.errors, options.penalty, options.threads);
  return image;
}

}  // namespace hapsim
