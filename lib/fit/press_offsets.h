// Offsets of the force that each press has for itself: solved for exactly within every fit.
#pragma once

#include "experiment/forces.h"

namespace hapsim {

// The model's effect whose parameters are an offset of each press, or null.
const Effect* offset_effect(const Model& model);

// The mean of each press and component of stacked rows: 3 x presses of the selection.
Eigen::MatrixXd press_means(const Dataset& dataset, const Selection& selection,
                            const Eigen::VectorXd& stacked);

// Takes these means out of stacked columns (3 x rows), in place: what a least-squares fit with the
// offsets free sees (variable projection; Golub and Pereyra, 1973).
void take_out_press_means(const Dataset& dataset, const Selection& selection,
                          Eigen::Ref<Eigen::MatrixXd> stacked);

// For presses that a fit has not seen: takes out of every other stretch of each press (a tenth of
// its rows) the mean of the stretches between, and the other way round.
void take_out_cross_means(const Dataset& dataset, const Selection& selection,
                          Eigen::Ref<Eigen::VectorXd> stacked);

// Writes the offsets of the selection's presses into the model's derived rows, zero elsewhere.
// `error`: standard deviation of one residual component [N].
void set_offsets(Model& model, const Dataset& dataset, const Selection& selection,
                 const Eigen::MatrixXd& means, double error);

}  // namespace hapsim
