// Data that cannot be what they claim to be: told before a fit makes numbers of them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "experiment/forces.h"
#include "experiment/linearisation.h"

namespace hapsim {

// Error(kBadInput) when the selection has fewer force components than the model free parameters.
void require_enough_data(const Model& model, const Dataset& dataset, const Selection& selection);

// Error(kBadInput), without a body: when nothing is pressed, or no force is measured; when the
// forces go along the displacements instead of against them, with each press's mean taken out and
// without (an offset of the sensor alone is no wrong sign); when one axis's forces are some hundred
// times what its displacements and the other axes call for, or a hundredth of it: another unit (the
// column is named).
void require_presses(const Dataset& dataset);

// Error(kUsage) when there are several bodies or tools: `what` knows one of each only.
void require_one_setup(const Dataset& dataset, const std::string& what);

// A sentence when the modulus is far from that of soft bodies, as forces in mN or displacements in
// mm give; "" when it is not.
std::string strange_modulus(const Model& model);

// Regions that have a modulus but no place, so that it acts nowhere: no key point (effect regions)
// is of them, or, of a model without key points, no tetrahedron of the bodies.
std::vector<int> idle_regions(const Model& model, std::span<const TetMesh> bodies);

// What is to be said of a model that was read: its fit was ended early; a line each, beginning with
// the file's name.
std::vector<std::string> doubts_of(const Model& model);
// The same of a model on its bodies: a modulus acts nowhere, or in a sheet.
std::vector<std::string> doubts_of(const Model& model, std::span<const TetMesh> bodies);

// What mixtures in elements that boundaries cut leave open of the forces; "" where that is little.
std::string mixture_words(const Linearisation& about);

}  // namespace hapsim
