#include "python/prepared.h"

#include "python/convert.h"
#include "python/options.h"
#include "python/recording.h"

namespace hapsim::python {

Prepared prepare(const Body& body, const Model& model, const py::object& contacts,
                 const py::kwargs& keywords) {
  const Options options(keywords);
  const hs_recording* places =
      contacts.is_none() ? nullptr : handles<Recording, hs_recording>(contacts).front();
  hs_prepared* made = nullptr;
  run([&] {
    return hs_prepare(body.handle.get(), model.handle.get(), places, options.get(), &made);
  });
  return {owned<hs_prepared, hs_prepared_free>(made)};
}

void define_prepared(py::module_& m) {
  py::class_<Prepared>(m, "Prepared", "A body and a model made ready for Live.")
      .def_property_readonly(
          "off_contacts",
          [](const Prepared& p) { return hs_prepared_off_contacts(p.handle.get()); },
          "relative error that is expected of forces between the samples");
  m.def("prepare", &prepare, "body"_a, "model"_a, "contacts"_a = py::none(),
        "As hs-simulate --live begins; contacts: a recording whose places are solved finely.");
}

}  // namespace hapsim::python
