// The disc for which the body's stiffness under a ball is solved.
#pragma once

#include "model/model.h"
#include "recording/recording.h"

namespace hapsim {

// A ball's law (the effect `tip`) takes the body in series with a disc: exact where the contact is
// small against the body, or where that disc is the contact. So a body under a declared ball is
// solved for a disc somewhat wider than the widest contact of a half-space, sqrt(R depth), not for
// the ball's radius R: on a layer as thick as that, E comes out within some per cent, and with a
// disc of R 2.4 times too high (bench/real/balls.py). Metadata `contact_radius` [m] of models and
// recordings; absent: `tool_radius`.

// Sets it by the recording's own presses; removes it where no ball is declared.
void set_contact_radius(Recording& recording);
// Sets it as the model has it: its values are of that disc.
void set_contact_radius(Recording& recording, const Model& model);
// The model's, or the tool's radius [m].
double contact_radius(const Model& model, double tool_radius);

}  // namespace hapsim
