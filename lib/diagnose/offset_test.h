// Whether the presses have offsets of their own.
#pragma once

#include "experiment/weights.h"

namespace hapsim {

struct OffsetTest {
  double gain = 0;     // fall of the sum of squares, in units of the noise's variance
  double p_value = 1;  // of offsets that differ as much, when only what varies within presses works
};

// Constants of each press against its residual (stacked, over the noise), beyond what a wrong
// stiffness does in that press (gain_directions() of `forces`, stacked): that shows as an offset
// too, but not where the force is small. The p-value is Fisher's F of what the offsets take away
// over what is left in the means of ten stretches of each press, so that neighbouring samples may
// go together, and neighbouring stretches too, as an autoregression of first order; signs of whole
// presses cannot test offsets, which are as likely with either sign.
OffsetTest test_offsets(const Dataset& dataset, const Eigen::VectorXd& residual,
                        const Eigen::VectorXd& forces);

}  // namespace hapsim
