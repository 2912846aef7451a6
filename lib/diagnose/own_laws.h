// What each press has of its own, which no other press foretells.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "diagnose/law_samples.h"
#include "diagnose/left_kinds.h"

namespace hapsim {

// Of what `residual` (of the samples kept, stacked [N]) holds, where stretches of each press are
// foretold by its others; `share`: of the squares beyond noise, by those that are left [N^2].
//   press           gains along the normal and across it of each press (nine tenths foretold), or
//                   a force of any direction that goes with the load's size (all but a twentieth)
//   place-and-way   the same, where presses of one place the same way (within 10 deg) have it alike
//                   (their variance is a quarter of its mean square at most). Alike with `press`
//                   where they are too few, or have little of it
//   zero-of-press   a zero of each press, where that foretells more, and nine tenths
// Empty where none does.
std::vector<LeftKind> own_laws(const LawSamples& samples, const Eigen::VectorXd& residual,
                               const std::function<double(double)>& share);

//   wander          a zero, or gains, that move in each press (hat functions of time), where they
//                   foretell four fifths: any law within a press is among them, so this says
//                   something only where no law of unseen presses foretells anything
std::vector<LeftKind> wandering(const LawSamples& samples, const Eigen::VectorXd& residual,
                                const std::function<double(double)>& share);

}  // namespace hapsim
