// The interval that a parameter's standard error stands for.
#pragma once

#include <limits>
#include <string>

#include "model/model.h"

namespace hapsim {

inline constexpr double kHalf95 = 1.959963985;  // of 95 % of a normal distribution [std deviations]

// NaN where nothing is estimated.
struct ParameterInterval {
  double lower = std::numeric_limits<double>::quiet_NaN();
  double upper = std::numeric_limits<double>::quiet_NaN();
  bool known() const { return lower <= upper; }
};

// 95 %: value +- 1.96 standard errors; of a parameter that is stepped in its logarithm
// (ParameterCard) value times or over exp(1.96 std_error / value), within the row's bounds. So a
// modulus or a size has an interval of its sign, however little is known of it.
ParameterInterval interval95(const Parameter& p);
// The same of a value of an effect, without bounds.
ParameterInterval interval95(double value, double std_error, bool logarithmic);

// "1.2e+04 Pa ± 300", "0.0005 m (0.0002 to 0.0016)": an interval, 95 %, where + and - differ.
// `digits` of the value, `error_digits` of the error; the unit "1" is none.
std::string with_interval(double value, const std::string& unit, double std_error,
                          const ParameterInterval& interval, bool logarithmic, int digits,
                          int error_digits);

bool is_logarithmic(const Parameter& p);  // no: of an effect that the catalogue has not
// Whether with_interval() tells the interval.
bool tells_interval(double value, double std_error, bool logarithmic);

}  // namespace hapsim
