// The sub-models of an analytical contact force model from a recording.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "acfm/acfm.h"
#include "experiment/dataset.h"
#include "mesh/signed_distance.h"

namespace hapsim {

struct AcfmFitOptions {
  int terms = 1;            // Maxwell elements of each direction
  bool stiffening = false;  // s is a parameter, else 0
  double noise = 1;         // standard deviation of the force noise [N]
  int folds = 6;            // parts in which presses and positions are held out; 0: none
  int threads = 0;          // positions side by side; 0: as many as the machine has
  // Bounds of the relaxation times [s], one a term, short to long; empty: from half a sample step
  // to three times the longest press, with starts spread over what the presses show.
  std::vector<std::pair<double, double>> windows;
};

struct AcfmFit {
  Acfm model;
  double rmse = 0;  // per force component, in the axes that were moved as well as in those not [N]
  // Errors on what the fit has not seen [N]; NaN where nothing can be left out.
  double held_out_presses = std::numeric_limits<double>::quiet_NaN();
  double held_out_positions = std::numeric_limits<double>::quiet_NaN();  // interpolated instead
  int derived_axes = 0;                                                  // not moved in these data
  std::vector<std::string> remarks;  // what is not determined, in words
};

// The normals of dataset.positions, outward. Error(kBadInput): a contact more than three tool radii
// off the surface.
std::vector<Vec3> contact_normals(const Dataset& dataset, const SignedDistance& surface);

// Each direction of each position by itself: residuals (measured - model) / noise, parameters ks >
// 0, k_i >= 0, tau_i in its window, thesis (5.44)-(5.50), with the derivatives of the exact step in
// closed form: df/dks = -q, df/dk_i = -m_i, df/dtau_i = -k_i dm_i/dtau_i, m_i the memory of q,
// df/ds = -(ks w + sum k_i memory of w), w = dq/ds. An
// axis that was not moved has the stiffness of the normal times that of a bonded disc across over
// along (disc_compliance, nu = 0.4), or of the tangents' mean, and their relaxation. `normals`: of
// dataset.positions, outward.
// Error(kBadInput): no axis of a position moves. Error(kNoConvergence): a fit does not converge.
AcfmFit fit_acfm(const Dataset& dataset, const std::vector<Vec3>& normals,
                 const AcfmFitOptions& options);

// The model's forces along the recording, one a row; without a time column its springs alone.
std::vector<Vec3> acfm_forces(const Acfm& model, const Dataset& dataset);

}  // namespace hapsim
