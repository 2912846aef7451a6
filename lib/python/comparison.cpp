#include "python/comparison.h"

#include <memory>

#include "python/convert.h"
#include "python/options.h"
#include "python/recording.h"

namespace hapsim::python {
namespace {

struct Comparison {
  std::shared_ptr<hs_comparison> handle;
  py::object summary;
};

Comparison compare(const Recording& measured, const Recording& simulated) {
  hs_comparison* made = nullptr;
  run([&] { return hs_compare(measured.handle.get(), simulated.handle.get(), &made); });
  return {owned<hs_comparison, hs_comparison_free>(made), from_json(hs_comparison_json(made))};
}

// The residuals belong to their comparison.
Recording residuals_of(const Comparison& c) {
  hs_recording* residuals = const_cast<hs_recording*>(hs_comparison_residuals(c.handle.get()));
  return {std::shared_ptr<hs_recording>(c.handle, residuals)};
}

}  // namespace

void define_comparison(py::module_& m) {
  py::class_<Comparison>(m, "Comparison")
      .def_readonly("summary", &Comparison::summary, "what hs-compare --json writes")
      .def("__getitem__",
           [](const Comparison& c, const py::str& key) { return py::object(c.summary[key]); })
      .def_property_readonly("residuals", &residuals_of,
                             "the recording with sx,sy,sz (simulated) and rx,ry,rz (the rest)");
  m.def("compare", &compare, "measured"_a, "simulated"_a, "hs-compare.");
}

}  // namespace hapsim::python
