#include "python/recording.h"

#include <cstdint>
#include <string>
#include <vector>

#include "python/arrays.h"
#include "python/convert.h"
#include "python/options.h"

namespace hapsim::python {
namespace {

void set_metadata(const Recording& r, const std::string& key, const std::string& value) {
  require(hs_recording_set_metadata(r.handle.get(), key.c_str(), value.c_str()));
}

Recording read_table(const py::object& path, bool forces) {
  hs_recording* made = nullptr;
  const std::string file = path_of(path);
  run([&] { return hs_recording_read(file.c_str(), forces ? 1 : 0, &made); });
  return Recording::adopt(made);
}

Recording make(const py::dict& columns, const py::dict& metadata) {
  using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
  std::vector<std::string> names;
  std::vector<Numbers> values;
  bool forces = false;
  for (const auto& [key, value] : columns) {
    names.push_back(py::str(key));
    values.push_back(py::cast<Numbers>(value));
    if (values.back().ndim() != 1 || values.back().size() != values.front().size())
      fail(HS_BAD_INPUT, "recording: column " + names.back() + " is no row of " +
                             std::to_string(values.front().size()) +
                             " numbers; give one number of each column a row");
    forces = forces || names.back() == "fz";
  }
  std::vector<const char*> words;
  std::vector<const double*> data;
  for (std::size_t k = 0; k < names.size(); ++k) {
    words.push_back(names[k].c_str());
    data.push_back(values[k].data());
  }
  hs_recording* made = nullptr;
  const std::size_t rows = values.empty() ? 0 : static_cast<std::size_t>(values.front().size());
  require(hs_recording_make(words.data(), data.data(), names.size(), rows, forces ? 1 : 0, &made));
  Recording recording = Recording::adopt(made);
  for (const auto& [key, value] : metadata) set_metadata(recording, py::str(key), py::str(value));
  return recording;
}

py::list columns(const Recording& r) {
  py::list names;
  for (std::size_t k = 0; const char* name = hs_recording_column_name(r.handle.get(), k); ++k)
    names.append(name);
  return names;
}

hs_column find(const Recording& r, const std::string& name) {
  hs_column column{};
  require(hs_recording_column(r.handle.get(), name.c_str(), &column));
  return column;
}

py::array column(const py::object& self, const std::string& name) {
  const Recording& r = self.cast<Recording&>();
  const hs_column c = find(r, name);
  const auto rows = static_cast<py::ssize_t>(hs_recording_rows(r.handle.get()));
  const auto stride = static_cast<py::ssize_t>(c.stride);
  const bool writable = c.own != 0;
  if (c.kind == HS_INT32)
    return view(static_cast<const std::int32_t*>(c.data), {rows}, {stride}, self, writable);
  if (c.kind == HS_INT8)
    return view(static_cast<const std::int8_t*>(c.data), {rows}, {stride}, self, writable);
  return view(static_cast<const double*>(c.data), {rows}, {stride}, self, writable);
}

// Three columns that stand beside each other.
py::array vectors(const py::object& self, const char* first) {
  const Recording& r = self.cast<Recording&>();
  const hs_column c = find(r, first);
  const auto rows = static_cast<py::ssize_t>(hs_recording_rows(r.handle.get()));
  return view(static_cast<const double*>(c.data), {rows, 3},
              {static_cast<py::ssize_t>(c.stride), static_cast<py::ssize_t>(sizeof(double))}, self,
              true);
}

py::dict all_metadata(const Recording& r) {
  return metadata_of([&](std::size_t k) { return hs_recording_metadata_key(r.handle.get(), k); },
                     [&](const char* key) { return hs_recording_metadata(r.handle.get(), key); });
}

void write_table(const Recording& r, const py::object& path) {
  require(hs_recording_write(r.handle.get(), path_of(path).c_str()));
}

}  // namespace

Recording Recording::adopt(hs_recording* made) {
  return {owned<hs_recording, hs_recording_free>(made)};
}

void define_recording(py::module_& m) {
  py::class_<Recording>(m, "Recording", "Presses, measured or simulated, or a motion of them.")
      .def(py::init(&make), "columns"_a, "metadata"_a = py::dict(),
           "From one array a column (press, t, x, ...), checked as a file is.")
      .def_static("read", &read_table, "path"_a, "forces"_a = true,
                  "forces=False: it may be a motion without them.")
      .def("write", &write_table, "path"_a)
      .def_property_readonly("name",
                             [](const Recording& r) { return hs_recording_name(r.handle.get()); })
      .def_property_readonly("columns", &columns)
      .def("__getitem__", &column, "A column, a view of the recording's own numbers.")
      .def("__len__", [](const Recording& r) { return hs_recording_rows(r.handle.get()); })
      .def_property_readonly("press", [](const py::object& r) { return column(r, "press"); })
      .def_property_readonly("t", [](const py::object& r) { return column(r, "t"); })
      .def_property_readonly(
          "position", [](const py::object& r) { return vectors(r, "x"); },
          "n x 3, contact points [m]")
      .def_property_readonly(
          "u", [](const py::object& r) { return vectors(r, "ux"); },
          "n x 3, displacements of the tip from there [m]")
      .def_property_readonly(
          "f", [](const py::object& r) { return vectors(r, "fx"); },
          "n x 3, forces of the body on the tool [N]")
      .def_property_readonly("metadata", &all_metadata)
      .def("set_metadata", &set_metadata, "key"_a, "value"_a)
      .def("__repr__", [](const py::object& r) {
        return py::str("<hapsim.Recording {}: {} rows>").format(r.attr("name"), py::len(r));
      });
}

}  // namespace hapsim::python
