// How far one signal comes after another.
#pragma once

#include <vector>

namespace hapsim {

// The shift of y against x, in samples and parts of one, at which their correlation is largest, at
// most `most` either way: positive when y comes later. The parabola through the largest and its
// neighbours gives the part. NaN where one of them does not change or is too short. Cost: samples x
// most.
double lag_between(const std::vector<double>& x, const std::vector<double>& y, int most);

}  // namespace hapsim
