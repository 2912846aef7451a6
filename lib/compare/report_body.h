// The body as a comparison's report colours it.
#pragma once

#include "compare/comparison.h"
#include "compare/error_map.h"
#include "model/model.h"
#include "report/report.h"
#include "solid/body_regions.h"

namespace hapsim {

// The next of 1, 1.5, 2, 3, 4, 5, 6, 8 and 10 times a power of ten, for the end of a scale. `value`
// > 0.
double round_up(double value);

// The end of the errors' scale [N]: an error as small as the noise must not look alarming, so at
// least twice that.
double top_error(const Comparison& comparison);

// Typical error of the positions [N], and over the surface as the map has it.
BodyLayer error_layer(const Comparison& comparison, const ErrorMap& map);

// What the body's surface is coloured by: the error, how much stiffer than the model the body is,
// and the regions of a model that has several (null: none); `labels` where these are the body's
// own, else null, and shown where they reach the surface. A map without a surface: only the
// positions, by error.
void add_body(const Comparison& comparison, const ErrorMap& map, const Model* model,
              const BodyRegions* labels, Report& report);

// The error of an earlier version, on the same scale as that of the compared one.
void add_body_before(const Comparison& before, const ErrorMap& map, Report& report);

}  // namespace hapsim
