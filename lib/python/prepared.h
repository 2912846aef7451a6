// Prepared: a body and a model made ready for Live.
#pragma once

#include <memory>

#include "python/body.h"
#include "python/model.h"

namespace hapsim::python {

struct Prepared {
  std::shared_ptr<hs_prepared> handle;
};
// `contacts`: a recording whose places are solved finely, or None.
Prepared prepare(const Body& body, const Model& model, const py::object& contacts,
                 const py::kwargs& keywords);

void define_prepared(py::module_& m);

}  // namespace hapsim::python
