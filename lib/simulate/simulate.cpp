#include "simulate/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/median.h"
#include "base/random.h"
#include "experiment/contact_radius.h"
#include "experiment/plausible.h"
#include "experiment/press_clock.h"
#include "experiment/torques.h"
#include "io/number.h"
#include "model/model_edit.h"
#include "recording/force_noise.h"
#include "recording/tools_together.h"
#include "recording/torque_columns.h"
#include "simulate/regional_relaxation.h"
#include "simulate/traction.h"

namespace hapsim {
namespace {

// The model's own, solved here; where regions relax each in its own way with their elements.
StiffnessAt contact_mesh_stiffness(const Model& model, const Experiment& w,
                                   const std::function<void(const std::string&)>& say) {
  const MaterialSpec material = material_of(model);
  const std::vector<RegionRelaxation> regions = regional_relaxation_of(model, material);
  if (regions.empty())
    return [about = w.places.solve(material), material](std::size_t p) {
      return about.at(p, material);
    };
  const auto solve = [&](const MaterialSpec& sample) {
    const Linearisation about = w.places.solve(sample);
    std::vector<Eigen::Matrix3d> K;
    for (std::size_t p = 0; p < w.dataset.positions.size(); ++p) K.push_back(about.at(p, sample).K);
    return K;
  };
  double misfit = 0;
  std::vector<PositionStiffness> stiffness = regional_stiffness(regions, material, solve, misfit);
  say(
      fmt::format("regions relax each in its own way: {} Maxwell elements, within {:.1g} of the "
                  "stiffness",
                  stiffness.front().relaxing.size(), misfit));
  return [stiffness = std::move(stiffness)](std::size_t p) { return stiffness[p]; };
}

Eigen::VectorXd contact_mesh_forces(const Model& model, const Experiment& w, const Selection& all,
                                    const std::function<void(const std::string&)>& say) {
  if (regional_relaxation_of(model, material_of(model)).empty())
    return solved_forces(model, w, all, false).f;
  return model_forces(model, w.dataset, contact_mesh_stiffness(model, w, say), all, false).f;
}

// The model's torques in the place of measured ones.
void simulate_torques(const Model& model, const Experiment& w, const Selection& all,
                      Recording& out) {
  const MaterialSpec material = material_of(model);
  const TorqueLevers levers(w.places, material, true);
  const Signal forces = forces_before_sensor(model, w, w.places.solve(material), all, false);
  const Eigen::VectorXd torque = model_torques(forces, w.dataset, levers, material, all).f;
  std::vector<Vec3> of_row(out.rows(), Vec3::Zero());
  double doubt = 0;  // squares
  Eigen::Index at = 0;
  for (const int e : all) {
    const Episode& episode = w.dataset.episodes[static_cast<std::size_t>(e)];
    const double lever = levers.at(static_cast<std::size_t>(episode.position), material).doubt;
    for (const int row : episode.rows) {
      of_row[static_cast<std::size_t>(row)] = torque.segment<3>(at);
      doubt += std::pow(lever * forces.f.segment<3>(at).norm(), 2);
      at += 3;
    }
  }
  set_torques(out, of_row);
  if (at > 0)
    out.metadata.set("torque_uncertainty",
                     fmt::format("{:.2g}", std::sqrt(3 * doubt / static_cast<double>(at))));
}

// Rows of the table that are in no press are left out.
MarkerTable simulate_markers(const Model& model, const Experiment& w, const MarkerTable& asked,
                             const std::function<void(const std::string&)>& told) {
  const Recording& r = w.dataset.recording;
  MarkerTable all = asked;
  if (asked.rows() == 0) {
    if (r.t.empty())
      fail_input(r.name, "there are no times at which points could be seen",
                 "give the motion a column t");
    for (std::size_t row = 0; row < r.rows(); ++row)
      for (std::size_t m = 0; m < asked.points.size(); ++m) {
        all.point.push_back(static_cast<int>(m));
        all.press.push_back(r.press[row]);
        all.t.push_back(r.t[row]);
      }
  }
  const PressClock clock(all, w.dataset);
  const MaterialSpec material = material_of(model);
  const MarkerGains gains(w.places, material, asked.rest, true);
  std::vector<std::vector<MarkerGain>> at_place;
  for (std::size_t p = 0; p < w.places.size(); ++p) at_place.push_back(gains.at(p, material));
  MarkerTable out;
  out.name = asked.name;
  out.points = asked.points;
  out.rest = asked.rest;
  out.metadata = asked.metadata;
  out.metadata.remove("marker_noise");
  double doubt = 0;  // squares
  for (std::size_t row = 0; row < all.point.size(); ++row) {
    const PressTime at = clock.of_row(row);
    if (at.episode < 0) continue;
    const auto p =
        static_cast<std::size_t>(w.dataset.episodes[static_cast<std::size_t>(at.episode)].position);
    const MarkerGain& gain = at_place[p][static_cast<std::size_t>(all.point[row])];
    const Vec3 u = clock.displacement(at);
    out.point.push_back(all.point[row]);
    if (!all.press.empty()) out.press.push_back(all.press[row]);
    out.t.push_back(all.t[row]);
    out.u.push_back(gain.G * u);
    doubt += gain.doubt * gain.doubt * u.squaredNorm();
  }
  if (out.rows() < all.point.size())
    told(fmt::format("{} of {} rows of marked points are at no time of a press and left out",
                     all.point.size() - out.rows(), all.point.size()));
  if (out.rows() == 0)
    fail_input(asked.name, "no row is at a time of a press in " + r.name,
               "give times by the motion's clock, or points without times");
  out.metadata.set("marker_uncertainty",
                   fmt::format("{:.2g}", std::sqrt(doubt / static_cast<double>(out.rows()))));
  out.metadata.set("simulated", effects_label(model));
  return out;
}

}  // namespace

Simulated simulate(const TetMesh& body, const Model& model, Recording motion,
                   ExperimentOptions options, const std::function<void(const std::string&)>& say,
                   Control control, bool torques, const MarkerTable* points) {
  const auto told = [&](const std::string& words) {
    if (say && !words.empty()) say(words);
  };
  if (control == Control::kForce) motion.u.assign(motion.rows(), Vec3::Zero());  // not known yet
  set_contact_radius(motion, model);
  set_poisson_range(model, options);  // as a fit did, so its prepared stiffnesses serve again
  options.borrow = true;              // every row has its force
  Experiment w = make_experiment(body, std::move(motion), options);
  for (const std::string& words : left_out_words(w, true)) told(words);
  const Selection all = all_episodes(w.dataset);
  if (control == Control::kDisplacement) told(beyond_depth(w.depth, model));
  told(tools_together(w.dataset.recording));
  const bool wanted = torques || has_torques(w.dataset.recording);
  const std::string refusal = control == Control::kForce
                                  ? "displacements are found, and torques are not"
                              : wanted ? torque_refusal(model, w.dataset)
                                       : "";
  if (torques && !refusal.empty())
    fail_input(model.name.empty() ? "the model" : model.name, "no torques of it: " + refusal,
               "leave out --torques");
  if (points != nullptr) {
    const std::string why =
        control == Control::kForce ? "displacements are found" : marker_refusal(model, w.dataset);
    if (!why.empty())
      fail_input(model.name.empty() ? "the model" : model.name,
                 "no displacements of marked points of it: " + why, "leave out --markers");
    require_on_surface(*points, w);
  }
  Simulated simulated;
  simulated.mesh_uncertainty = w.places.mesh_uncertainty();
  simulated.positions = w.dataset.positions.size();
  const Linearisation about = w.places.solve(material_of(model));
  told(mixture_words(about));
  if (std::vector<double> mixed = about.mixture_uncertainties(); !mixed.empty())
    simulated.mesh_uncertainty =
        std::hypot(simulated.mesh_uncertainty, upper_median(std::move(mixed)));
  if (control == Control::kForce) {
    simulated.recording =
        with_displacements(model, w.dataset, contact_mesh_stiffness(model, w, told));
    told(beyond_depth(press_depth(body, simulated.recording), model));
    told(without_torques(simulated.recording, refusal));
    mark_simulated(simulated.recording.metadata, effects_label(model));
    return simulated;
  }
  const Eigen::VectorXd f = contact_mesh_forces(model, w, all, told);
  Recording out = with_forces(w.dataset, all, f, simulated.mesh_uncertainty);
  out.metadata.remove("torque_uncertainty");
  if (wanted && refusal.empty())
    simulate_torques(model, w, all, out);
  else
    told(without_torques(out, refusal));
  if (points != nullptr) simulated.markers = simulate_markers(model, w, *points, told);
  simulated.recording = std::move(out);
  mark_simulated(simulated.recording.metadata, effects_label(model));
  return simulated;
}

Recording with_forces(Dataset dataset, const Selection& episodes, const Eigen::VectorXd& f,
                      double mesh_uncertainty) {
  const std::vector<int> rows = stacked_rows(dataset, episodes);
  Recording out = std::move(dataset.recording);
  out.metadata.remove("mesh_uncertainty");
  if (mesh_uncertainty > 0)
    out.metadata.set("mesh_uncertainty", fmt::format("{:.2g}", mesh_uncertainty));
  out.f.assign(out.rows(), Vec3::Zero());
  for (std::size_t i = 0; i < rows.size(); ++i)
    out.f[static_cast<std::size_t>(rows[i])] = f.segment<3>(3 * static_cast<Eigen::Index>(i));
  return out;
}

void mark_simulated(Metadata& metadata, const std::string& label) {
  forget_force_noise(metadata);
  forget_torque_noise(metadata);
  metadata.set("simulated", label);
}

void add_noise(Recording& recording, double noise, std::uint64_t seed) {
  Random random(seed);
  for (Vec3& force : recording.f)
    for (int k = 0; k < 3; ++k) force[k] += noise * random.normal();
  recording.metadata.set("force_noise", format_number(noise));
  recording.metadata.set("seed", std::to_string(seed));
}

void add_torque_noise(Recording& recording, double noise, std::uint64_t seed) {
  std::vector<Vec3> torques = read_torques(recording).values;
  if (torques.empty()) fail_usage("there are no torques to add noise to", "add --torques");
  constexpr std::uint64_t kOther = 0x746f72717565;  // than the forces' numbers
  Random random(seed ^ kOther);
  for (Vec3& torque : torques)
    for (int k = 0; k < 3; ++k) torque[k] += noise * random.normal();
  set_torques(recording, torques);
  recording.metadata.set("torque_noise", format_number(noise));
  recording.metadata.set("seed", std::to_string(seed));
}

std::string without_torques(Recording& recording, const std::string& why) {
  if (!has_torques(recording)) return "";
  forget_torques(recording);
  recording.metadata.remove("torque_uncertainty");
  return "the torques are left out: " + why;
}

}  // namespace hapsim
