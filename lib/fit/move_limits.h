// How far a fit may trust a body that is linear about its last finite-element solution.
#pragma once

#include <vector>

#include "estimate/least_squares.h"
#include "model/model.h"

namespace hapsim {

struct MaterialSpec;

// The body of such a model is linearised between solutions; a homogeneous one is exact. Regions
// count where they are solved for (`exact_regions`), else they are first order once and for all.
bool is_linearised(const MaterialSpec& material, bool exact_regions);

// The unknowns of a model's free parameters, with the bounds of those that the body is linear in
// drawn closer about their values: `reach` typical changes (or the logarithm by `reach`) each way.
std::vector<Unknown> within_reach(std::vector<Unknown> unknowns, const Model& model, double reach);

}  // namespace hapsim
