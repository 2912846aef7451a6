#include "python/diagnosis.h"

#include <memory>

#include "python/body.h"
#include "python/convert.h"
#include "python/model.h"
#include "python/options.h"
#include "python/recording.h"

namespace hapsim::python {
namespace {

struct Diagnosis {
  std::shared_ptr<hs_diagnosis> handle;
  py::object summary;
};

Diagnosis diagnose(const Recording& recording, const Body& body, const Model& model,
                   const py::kwargs& keywords) {
  const Options options(keywords);
  hs_diagnosis* made = nullptr;
  run([&] {
    return hs_diagnose(body.handle.get(), model.handle.get(), recording.handle.get(), options.get(),
                       &made);
  });
  return {owned<hs_diagnosis, hs_diagnosis_free>(made), from_json(hs_diagnosis_json(made))};
}

Recording plan(const Diagnosis& diagnosis, std::size_t presses) {
  hs_recording* motion = nullptr;
  run([&] { return hs_diagnosis_plan(diagnosis.handle.get(), presses, &motion); });
  return Recording::adopt(motion);
}

}  // namespace

void define_diagnosis(py::module_& m) {
  py::class_<Diagnosis>(m, "Diagnosis")
      .def_readonly("summary", &Diagnosis::summary, "what hs-diagnose --json writes")
      .def("__getitem__",
           [](const Diagnosis& d, const py::str& key) { return py::object(d.summary[key]); })
      .def_property_readonly(
          "text", [](const Diagnosis& d) { return hs_diagnosis_text(d.handle.get()); },
          "the table of hs-diagnose (CSV)")
      .def(
          "write",
          [](const Diagnosis& d, const py::object& path) {
            require(hs_diagnosis_write(d.handle.get(), path_of(path).c_str()));
          },
          "path"_a);
  m.def("diagnose", &diagnose, "recording"_a, "body"_a, "model"_a,
        "hs-diagnose: which physical effect the model lacks.");
  m.def("plan", &plan, "diagnosis"_a, "presses"_a = 3,
        "hs-diagnose --plan: the motion of the presses to record next.");
}

}  // namespace hapsim::python
