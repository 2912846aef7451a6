#include "scan/touch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace hapsim {

double indentation(double force, const TouchModel& model) {
  if (model.stiffness) return force / *model.stiffness;
  const double plane = model.E / (1 - model.nu * model.nu);
  if (model.flat) return force / (2 * plane * model.tip_radius);
  return std::pow(3 * force / (4 * plane * std::sqrt(model.tip_radius)), 2. / 3);
}

TouchReport undo_touch(Scan& scan, const TouchModel& model, double most, const std::string& name) {
  TouchReport report;
  report.least = 1e300;
  const std::size_t count = scan.cloud.points.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double depth = indentation(scan.touch_force[i], model);
    if (!(depth <= most)) {
      fail_input(name,
                 fmt::format("a touch of {:.3g} N would push the surface in by {:.3g} mm",
                             scan.touch_force[i], 1e3 * depth),
                 "check --touch-force and the stiffness or modulus");
    }
    scan.cloud.points[i] += depth * scan.cloud.normals[i];
    report.least = std::min(report.least, depth);
    report.largest = std::max(report.largest, depth);
    report.mean += depth / static_cast<double>(count);
  }
  return report;
}

}  // namespace hapsim
