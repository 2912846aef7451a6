// Arrays that are views: their owner lives as long as they do.
#pragma once

#include <pybind11/numpy.h>

#include <utility>
#include <vector>

#include "python/errors.h"

namespace hapsim::python {

template <class Number>
py::array view(const Number* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
               const py::object& owner, bool writable) {
  py::array array(py::dtype::of<Number>(), std::move(shape), std::move(strides), data, owner);
  if (!writable)
    py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

template <class Number>
py::array table(const Number* data, std::size_t rows, std::size_t columns, const py::object& owner,
                std::size_t shown) {
  const auto size = static_cast<py::ssize_t>(sizeof(Number));
  const auto n = static_cast<py::ssize_t>(rows), wide = static_cast<py::ssize_t>(columns);
  if (columns == 1) return view(data, {n}, {size}, owner, false);
  return view(data, {n, static_cast<py::ssize_t>(shown)}, {wide * size, size}, owner, false);
}

}  // namespace hapsim::python
