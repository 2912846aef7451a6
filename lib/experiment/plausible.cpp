#include "experiment/plausible.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "experiment/labels.h"
#include "experiment/thin_regions.h"
#include "model/body_parameters.h"
#include "model/search_state.h"

namespace hapsim {

void require_enough_data(const Model& model, const Dataset& dataset, const Selection& selection) {
  std::size_t rows = 0;
  for (const int e : selection) rows += dataset.episodes[e].rows.size();
  const std::size_t free = model.free_parameters().size();
  if (3 * rows < free)
    fail_input(dataset.recording.name,
               fmt::format("{} force components cannot tell {} free parameters", 3 * rows, free),
               "record more samples, or fix parameters (--fix)");
}

void require_presses(const Dataset& dataset) {
  const std::string& name = dataset.recording.name;
  // What each axis measured over what it was moved: root mean squares, so that neither sign nor
  // scatter matters; axes that are hardly moved say nothing.
  std::array<double, 3> moved{}, power{};
  double along = 0, along_centred = 0;  // force times displacement
  for (const Episode& e : dataset.episodes) {
    Vec3 mean_u = Vec3::Zero(), mean_f = Vec3::Zero();
    double n = 0, here = 0;
    for (std::size_t i = 0; i < e.view.size(); ++i) {
      if (e.view.in_air[i]) continue;
      const Vec3 &u = e.view.u[i], &f = dataset.recording.f[e.rows[i]];
      mean_u += u;
      mean_f += f;
      n += 1;
      here += f.dot(u);
      for (int k = 0; k < 3; ++k) {
        moved[k] += u[k] * u[k];
        power[k] += f[k] * f[k];
      }
    }
    along += here;
    if (n > 0) along_centred += here - mean_f.dot(mean_u) / n;
  }
  const double strongest = *std::max_element(moved.begin(), moved.end());
  if (strongest <= 0)
    fail_input(name, "no row presses the body", "check ux,uy,uz: all displacements are zero");
  if (*std::max_element(power.begin(), power.end()) <= 0)
    fail_input(name, "no row has a force", "check fx,fy,fz: all forces are zero");
  if (along > 0 && along_centred >= 0)
    fail_input(name, "the forces point the wrong way",
               "forces are of the body on the tool: pressing down (uz < 0) gives fz > 0");
  // An axis that moved by less than kMoved of the one that moved most says nothing. Stiffnesses of
  // one body by axis differ by less than ten; mN taken for N make them differ by a thousand.
  constexpr double kMoved = 0.03, kLeast = 100;
  std::array<double, 3> ratio{};
  for (int k = 0; k < 3; ++k)
    if (moved[k] > kMoved * kMoved * strongest && power[k] > 0)
      ratio[k] = std::sqrt(power[k] / moved[k]);
  for (int k = 0; k < 3; ++k)
    for (int other = 0; other < 3; ++other) {
      if (ratio[k] == 0 || ratio[other] == 0 || ratio[k] < kLeast * ratio[other]) continue;
      constexpr const char* kColumns[] = {"fx", "fy", "fz"};
      fail_input(name,
                 fmt::format("column {} is some {:.0f} times larger than {} calls for", kColumns[k],
                             ratio[k] / ratio[other], kColumns[other]),
                 "is one of them in mN? All forces are in N (hs-import converts)");
    }
}

void require_one_setup(const Dataset& dataset, const std::string& what) {
  if (dataset.setups.size() > 1)
    fail_usage(what + " is for one body and one tool, and these recordings have " +
                   (dataset.bodies() > 1 ? "several bodies" : "several tools"),
               "give it the recordings of one of them");
}

std::string strange_modulus(const Model& model) {
  constexpr double kSoftest = 50, kHardest = 5e6;  // from brain and fat to cartilage and rubber
  const Parameter* e = modulus_of(model);
  if (e == nullptr || (e->value >= kSoftest && e->value <= kHardest)) return "";
  return fmt::format(
      "E = {:.3g} Pa is {} than soft bodies are: are forces in N and displacements in m?", e->value,
      e->value > kHardest ? "harder" : "softer");
}

std::vector<int> idle_regions(const Model& model, std::span<const TetMesh> bodies) {
  std::vector<int> idle;
  const bool by_label = is_by_label(material_of(model));
  for (const Parameter& p : model.parameters) {
    if (!is_modulus(p) || p.region == 0) continue;
    const bool placed =
        by_label
            ? std::any_of(bodies.begin(), bodies.end(),
                          [&](const TetMesh& body) {
                            return std::find(body.region.begin(), body.region.end(), p.region) !=
                                   body.region.end();
                          })
            : std::any_of(model.parameters.begin(), model.parameters.end(),
                          [&](const Parameter& q) { return is_of_map(q) && q.region == p.region; });
    if (!placed) idle.push_back(p.region);
  }
  return idle;
}

std::vector<std::string> doubts_of(const Model& model) {
  std::vector<std::string> lines;
  if (is_unfinished(model))
    lines.push_back(model.name + ": the fit of this model was ended before it converged");
  if (const auto what = model.metadata.find("interrupted"))
    lines.push_back(model.name + ": interrupted " + *what + ", so more may be missing");
  return lines;
}

std::vector<std::string> doubts_of(const Model& model, std::span<const TetMesh> bodies) {
  std::vector<std::string> lines;
  for (const int region : idle_regions(model, bodies))
    lines.push_back(fmt::format(
        "{}: elastic E of region {} acts nowhere: no row of the effect regions gives "
        "that region a place{}",
        model.name, region,
        is_by_label(material_of(model)) ? ", and no tetrahedron of the body is of it" : ""));
  if (!is_by_label(material_of(model))) return lines;
  for (const TetMesh& body : bodies)
    for (const auto& [region, thickness] : thin_regions(body))
      lines.push_back(fmt::format(
          "region {} of the body is a sheet, some {:.2g} mm thick: with --full, elements thicker "
          "than it take only part of it, and no stated error knows",
          region, 1e3 * thickness));
  return lines;
}

std::string mixture_words(const Linearisation& about) {
  constexpr double kTold = 0.01;
  const std::vector<double> share = about.mixture_uncertainties();
  const auto many = std::count_if(share.begin(), share.end(), [](double s) { return s > kTold; });
  if (many == 0) return "";
  return fmt::format(
      "boundaries of another stiffness cut elements of the contact meshes: at {} of {} places that "
      "may change the force by more than {:.0f} %, by {:.2g} % at most",
      many, share.size(), 100 * kTold, 100 * *std::max_element(share.begin(), share.end()));
}

}  // namespace hapsim
