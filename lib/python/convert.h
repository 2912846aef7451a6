// What the bound types share: paths, JSON, metadata, and handles of the C interface.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "python/errors.h"

namespace hapsim::python {

std::string path_of(const py::object& path);

py::object from_json(const char* text);

// A dict of its own, not a view.
py::dict metadata_of(const std::function<const char*(std::size_t)>& key,
                     const std::function<const char*(const char*)>& value);

template <class Handle, void (*kFree)(Handle*)>
std::shared_ptr<Handle> owned(Handle* handle) {
  return {handle, kFree};
}

// One thing, or a list of them.
template <class Thing, class Handle>
std::vector<const Handle*> handles(const py::object& given) {
  const auto one_of = [](const py::handle& one) -> const Handle* {
    if (!py::isinstance<Thing>(one))
      throw py::type_error(std::string(py::str(one)) + " is no " +
                           std::string(py::str(py::type::of<Thing>().attr("__name__"))));
    return one.cast<Thing&>().handle.get();
  };
  if (!py::isinstance<py::list>(given) && !py::isinstance<py::tuple>(given)) return {one_of(given)};
  std::vector<const Handle*> all;
  for (const py::handle& one : given) all.push_back(one_of(one));
  return all;
}

}  // namespace hapsim::python
