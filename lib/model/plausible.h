// Data that cannot be what they claim to be: told before a fit makes numbers of them.
#pragma once

#include <string>

#include "model/forces.h"

namespace hapsim {

// Error(kBadInput) when the selection has fewer force components than the model free parameters.
void require_enough_data(const Model& model, const Dataset& dataset, const Selection& selection);

// Error(kBadInput) naming the column when one axis's forces are some thousand times what the model
// and the other axes call for, or a thousandth of it: another unit. `model`: fitted.
void require_like_columns(const Model& model, const Dataset& dataset, const Selection& selection,
                          const BodyStiffness& body);

// A sentence when the modulus is far from that of soft bodies, as forces in mN or displacements in
// mm give; "" when it is not.
std::string strange_modulus(const Model& model);

}  // namespace hapsim
