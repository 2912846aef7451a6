// The module hapsim of Python: the C interface (c/hapsim.h) with numpy's arrays in place of
// pointers, and exceptions in place of statuses.
#include "c/hapsim.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace py = pybind11;
using namespace py::literals;

namespace {

// ---- Errors: hapsim.Error and one below it for each status.
std::array<PyObject*, 6> errors{};

void define_errors(py::module_& m) {
  const auto define = [&](int code, const char* name, const char* words, PyObject* base) {
    const std::string full = std::string("hapsim.") + name;
    py::dict members("code"_a = code);
    PyObject* type = PyErr_NewExceptionWithDoc(full.c_str(), words, base, members.ptr());
    m.attr(name) = py::reinterpret_borrow<py::object>(type);
    return type;
  };
  PyObject* base = define(0, "Error", "What hapsim cannot do, in the words of its tools.", nullptr);
  errors.fill(base);
  errors[HS_USAGE] = define(HS_USAGE, "UsageError", "An option is wrong.", base);
  errors[HS_BAD_INPUT] =
      define(HS_BAD_INPUT, "BadInputError", "A file or an array cannot be used.", base);
  errors[HS_NO_CONVERGENCE] = define(HS_NO_CONVERGENCE, "NoConvergenceError",
                                     "A numerical method failed or was stopped.", base);
  errors[HS_IO] = define(HS_IO, "IoError", "Reading or writing failed.", base);
}

void require(hs_status status) {
  if (status == HS_DONE) return;
  if (PyErr_Occurred() == nullptr)  // else it was stopped by an exception of Python
    PyErr_SetString(errors.at(static_cast<std::size_t>(status)), hs_message());
  throw py::error_already_set();
}

[[noreturn]] void fail(hs_status status, const std::string& words) {
  PyErr_SetString(errors.at(static_cast<std::size_t>(status)), words.c_str());
  throw py::error_already_set();
}

std::string path_of(const py::object& path) {
  return py::str(py::module_::import("os").attr("fspath")(path));
}

py::object from_json(const char* text) {
  return py::module_::import("json").attr("loads")(text);
}

// ---- What is asked for by keywords: fix="nu=0.45", tool_radius=0.004, folds=0.
class Options {
 public:
  explicit Options(const py::kwargs& keywords) {
    hs_options* made = nullptr;
    require(hs_options_new(&made));
    options_.reset(made);
    for (const auto& [key, value] : keywords) {
      std::string name = py::str(key);
      for (char& c : name)
        if (c == '_') c = '-';
      if (name == "say") {
        if (!value.is_none()) say_ = py::reinterpret_borrow<py::object>(value);
      } else if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
        for (const py::handle& one : value) set(name, one);
      } else if (!value.is_none()) {
        set(name, value);
      }
    }
    hs_options_listen(made, say, stop, this);
  }
  Options(const Options&) = delete;
  const hs_options* get() const { return options_.get(); }

 private:
  struct Free {
    void operator()(hs_options* o) const { hs_options_free(o); }
  };

  void set(const std::string& name, const py::handle& value) {
    std::string text;
    if (py::isinstance<py::bool_>(value))
      text = value.cast<bool>() ? "true" : "false";
    else if (py::isinstance<py::str>(value) || PyIndex_Check(value.ptr()) != 0)
      text = py::str(value);
    else if (PyNumber_Check(value.ptr()) != 0)
      text = py::repr(py::float_(py::reinterpret_borrow<py::object>(value)));
    else
      text = path_of(py::reinterpret_borrow<py::object>(value));
    require(hs_options_set(options_.get(), name.c_str(), text.c_str()));
  }
  // Of a thread that waits without Python's lock.
  static void say(void* context, const char* words) {
    const py::gil_scoped_acquire lock;
    const Options& self = *static_cast<const Options*>(context);
    if (self.say_.is_none() || PyErr_Occurred() != nullptr) return;
    try {
      self.say_(words);
    } catch (py::error_already_set& error) {
      error.restore();
    }
  }
  static int stop(void*) {
    const py::gil_scoped_acquire lock;
    return PyErr_Occurred() != nullptr || PyErr_CheckSignals() != 0 ? 1 : 0;
  }

  std::unique_ptr<hs_options, Free> options_;
  py::object say_ = py::none();
};

// `call` without Python's lock.
template <class Call>
void run(const Call& call) {
  hs_status status;
  {
    const py::gil_scoped_release free;
    status = call();
  }
  require(status);
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();  // of `say`
}

// ---- Arrays that are views: `owner` lives as long as they do.
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

template <class Handle, void (*kFree)(Handle*)>
std::shared_ptr<Handle> owned(Handle* handle) {
  return {handle, kFree};
}

// ---- Bodies
struct Body {
  std::shared_ptr<hs_body> handle;

  static Body read(const py::object& path) {
    hs_body* body = nullptr;
    const std::string file = path_of(path);
    run([&] { return hs_body_read(file.c_str(), &body); });
    return {owned<hs_body, hs_body_free>(body)};
  }
  template <class Number>
  static py::array array(const py::object& self, const Number* (*get)(const hs_body*, std::size_t*),
                         std::size_t columns, std::size_t shown = 0) {
    std::size_t count = 0;
    const Number* data = get(self.cast<Body&>().handle.get(), &count);
    return table(data, count, columns, self, shown == 0 ? columns : shown);
  }
  static py::array tets(const py::object& self) {
    std::size_t count = 0;
    const std::int32_t* data = hs_body_tetrahedra(self.cast<Body&>().handle.get(), &count);
    return table(data, count, 10, self, data[4] < 0 ? 4 : 10);
  }
};

// ---- Metadata: a dict of its own, not a view.
py::dict metadata_of(const std::function<const char*(std::size_t)>& key,
                     const std::function<const char*(const char*)>& value) {
  py::dict all;
  for (std::size_t k = 0; const char* name = key(k); ++k) all[name] = value(name);
  return all;
}

// ---- Recordings
struct Recording {
  std::shared_ptr<hs_recording> handle;

  static Recording adopt(hs_recording* made) {
    return {owned<hs_recording, hs_recording_free>(made)};
  }
  static Recording read(const py::object& path, bool forces) {
    hs_recording* made = nullptr;
    const std::string file = path_of(path);
    run([&] { return hs_recording_read(file.c_str(), forces ? 1 : 0, &made); });
    return adopt(made);
  }
  static Recording make(const py::dict& columns, const py::dict& metadata) {
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
    require(
        hs_recording_make(words.data(), data.data(), names.size(), rows, forces ? 1 : 0, &made));
    Recording recording = adopt(made);
    for (const auto& [key, value] : metadata) recording.set(py::str(key), py::str(value));
    return recording;
  }
  void set(const std::string& key, const std::string& value) const {
    require(hs_recording_set_metadata(handle.get(), key.c_str(), value.c_str()));
  }
  py::list columns() const {
    py::list names;
    for (std::size_t k = 0; const char* name = hs_recording_column_name(handle.get(), k); ++k)
      names.append(name);
    return names;
  }
  hs_column find(const std::string& name) const {
    hs_column column{};
    require(hs_recording_column(handle.get(), name.c_str(), &column));
    return column;
  }
  static py::array column(const py::object& self, const std::string& name) {
    const Recording& r = self.cast<Recording&>();
    const hs_column c = r.find(name);
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
  static py::array vectors(const py::object& self, const char* first) {
    const Recording& r = self.cast<Recording&>();
    const hs_column c = r.find(first);
    const auto rows = static_cast<py::ssize_t>(hs_recording_rows(r.handle.get()));
    return view(static_cast<const double*>(c.data), {rows, 3},
                {static_cast<py::ssize_t>(c.stride), static_cast<py::ssize_t>(sizeof(double))},
                self, true);
  }
  py::dict metadata() const {
    return metadata_of(
        [this](std::size_t k) { return hs_recording_metadata_key(handle.get(), k); },
        [this](const char* key) { return hs_recording_metadata(handle.get(), key); });
  }
  void write(const py::object& path) const {
    require(hs_recording_write(handle.get(), path_of(path).c_str()));
  }
};

// ---- Models
struct Model {
  std::shared_ptr<hs_model> handle;
  py::object summary = py::none();  // of identify(), as by --json

  static Model adopt(hs_model* made) { return {owned<hs_model, hs_model_free>(made)}; }
  static Model read(const py::object& path) {
    hs_model* made = nullptr;
    require(hs_model_read(path_of(path).c_str(), &made));
    return adopt(made);
  }
  static Model parse(const std::string& text, const std::string& name) {
    hs_model* made = nullptr;
    require(hs_model_parse(text.c_str(), name.c_str(), &made));
    return adopt(made);
  }
  static Model copy(const hs_model* model) {
    hs_model* made = nullptr;
    require(hs_model_copy(model, &made));
    return adopt(made);
  }
  py::list parameters() const {
    static constexpr const char* kStates[] = {"free", "fixed", "derived"};
    py::list rows;
    for (std::size_t k = 0; k < hs_model_parameters(handle.get()); ++k) {
      const hs_parameter p = at(k);
      rows.append(py::dict("effect"_a = p.effect, "region"_a = p.region,
                           "parameter"_a = p.parameter, "value"_a = p.value, "unit"_a = p.unit,
                           "std_error"_a = p.std_error, "lower"_a = p.lower, "upper"_a = p.upper,
                           "state"_a = kStates[p.state]));
    }
    return rows;
  }
  hs_parameter at(std::size_t number) const {
    hs_parameter p{};
    require(hs_model_parameter(handle.get(), number, &p));
    return p;
  }
  // "elastic.E", "elastic.E[2]" of region 2.
  struct Name {
    std::string effect, parameter;
    int region = 0;
  };
  static Name split(const std::string& name) {
    const std::size_t dot = name.find('.');
    const std::size_t bracket = name.find('[');
    if (dot == std::string::npos) fail(HS_USAGE, name + " is no parameter; give EFFECT.NAME");
    Name parts{name.substr(0, dot), name.substr(dot + 1, bracket - dot - 1)};
    if (bracket != std::string::npos) parts.region = std::atoi(name.c_str() + bracket + 1);
    return parts;
  }
  double get(const std::string& name) const {
    const Name parts = split(name);
    for (std::size_t k = 0; k < hs_model_parameters(handle.get()); ++k) {
      const hs_parameter p = at(k);
      if (parts.effect == p.effect && parts.parameter == p.parameter && parts.region == p.region)
        return p.value;
    }
    throw py::key_error(name);
  }
  void set(const std::string& name, double value) const {
    const Name parts = split(name);
    require(hs_model_set(handle.get(), parts.effect.c_str(), parts.region, parts.parameter.c_str(),
                         value));
  }
  py::list effects() const {
    py::list names;
    for (std::size_t k = 0; k < hs_model_parameters(handle.get()); ++k) {
      const py::str name(at(k).effect);
      if (!names.contains(name)) names.append(name);
    }
    return names;
  }
  py::dict metadata() const {
    return metadata_of([this](std::size_t k) { return hs_model_metadata_key(handle.get(), k); },
                       [this](const char* key) { return hs_model_metadata(handle.get(), key); });
  }
  void write(const py::object& path) const {
    require(hs_model_write(handle.get(), path_of(path).c_str()));
  }
};

// ---- What the tools do
Recording simulate(const Recording& motion, const Body& body, const Model& model,
                   const py::kwargs& keywords) {
  const Options options(keywords);
  hs_recording* forces = nullptr;
  run([&] {
    return hs_simulate(body.handle.get(), model.handle.get(), motion.handle.get(), options.get(),
                       &forces);
  });
  return Recording::adopt(forces);
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

Model identify(const py::object& recordings, const py::object& bodies, const py::object& model,
               const py::kwargs& keywords) {
  const Options options(keywords);
  const auto pressed = handles<Body, hs_body>(bodies);
  const auto measured = handles<Recording, hs_recording>(recordings);
  const hs_model* start = model.is_none() ? nullptr : handles<Model, hs_model>(model).front();
  hs_identification* made = nullptr;
  run([&] {
    return hs_identify(pressed.data(), pressed.size(), measured.data(), measured.size(), start,
                       options.get(), &made);
  });
  const auto found = owned<hs_identification, hs_identification_free>(made);
  Model result = Model::copy(hs_identification_model(made));
  result.summary = from_json(hs_identification_json(made));
  return result;
}

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

// ---- Live
struct Prepared {
  std::shared_ptr<hs_prepared> handle;
};

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

// Three numbers, of an array of numpy without a copy.
struct Vector {
  explicit Vector(const py::handle& given) {
    if (py::isinstance<py::array_t<double>>(given)) {
      const auto array = py::reinterpret_borrow<py::array_t<double>>(given);
      if (array.ndim() == 1 && array.size() == 3) {
        for (py::ssize_t k = 0; k < 3; ++k) values[static_cast<std::size_t>(k)] = *array.data(k);
        return;
      }
    }
    values = py::cast<std::array<double, 3>>(given);
  }
  std::array<double, 3> values;
};

py::array_t<double> array_of(const double* values) {
  return py::array_t<double>(3, values);
}

class Live {
 public:
  Live(Prepared prepared, const py::kwargs& keywords) : prepared_(std::move(prepared)) {
    const Options options(keywords);
    hs_live* made = nullptr;
    require(hs_live_new(prepared_.handle.get(), options.get(), &made));
    live_ = owned<hs_live, hs_live_free>(made);
  }

  py::array_t<double> step(const py::handle& position, const py::handle& t) {
    const Vector at(position);
    py::array_t<double> force(3);
    hs_live_step(live_.get(), time_of(t), at.values.data(), force.mutable_data());
    return force;
  }
  py::array_t<double> run(const py::array_t<double>& t, const py::array_t<double>& positions) {
    const auto times = t.unchecked<1>();
    const auto at = positions.unchecked<2>();
    if (at.shape(0) != times.shape(0) || at.shape(1) != 3)
      fail(HS_BAD_INPUT, "there are " + std::to_string(times.shape(0)) +
                             " times; give a position of three numbers for each");
    py::array_t<double> forces({at.shape(0), py::ssize_t{3}});
    double* out = forces.mutable_data();
    for (py::ssize_t i = 0; i < at.shape(0); ++i) {
      const double tip[3] = {at(i, 0), at(i, 1), at(i, 2)};
      hs_live_step(live_.get(), times(i), tip, out + 3 * i);
    }
    return forces;
  }
  void begin(const py::handle& contact) {
    hs_live_begin(live_.get(), Vector(contact).values.data());
  }
  py::array_t<double> press(const py::handle& u, const py::handle& t, bool in_air) {
    const Vector by(u);
    py::array_t<double> force(3);
    hs_live_press(live_.get(), time_of(t), by.values.data(), in_air ? 1 : 0, force.mutable_data());
    return force;
  }
  hs_feel feel() const {
    hs_feel now;
    hs_live_feel(live_.get(), &now);
    return now;
  }
  void set_temperature(double temperature) { hs_live_set_temperature(live_.get(), temperature); }
  void end() { hs_live_end(live_.get()); }

 private:
  // By the clock since the first step, where no time is given.
  double time_of(const py::handle& t) {
    if (!t.is_none()) return t.cast<double>();
    using Clock = std::chrono::steady_clock;
    const Clock::time_point now = Clock::now();
    if (!begun_) start_ = now;
    begun_ = true;
    return std::chrono::duration<double>(now - start_).count();
  }

  Prepared prepared_;
  std::shared_ptr<hs_live> live_;
  std::chrono::steady_clock::time_point start_;
  bool begun_ = false;
};

}  // namespace

PYBIND11_MODULE(hapsim, m) {
  m.doc() =
      "hapsim: contact-force models of soft bodies.\n\n"
      "Bodies, recordings and models are the files of hapsim's tools; simulate, identify, "
      "compare,\n"
      "diagnose and plan are the tools hs-simulate, hs-identify, hs-compare and hs-diagnose, and\n"
      "give their numbers to the last digit. Keywords are the tools' flags, with _ for -:\n"
      "fix='nu=0.45', tool_radius=0.004 or '4mm', folds=0; what may be given several times may be\n"
      "a list. say=print tells what a tool says on standard error. All numbers are in SI units.";
  m.attr("__version__") = hs_version();
  define_errors(m);

  py::class_<Body>(m, "Body", "Tetrahedra with fixed nodes.")
      .def_static("read", &Body::read, "path"_a, "Of any format that the tools read.")
      .def_property_readonly("name", [](const Body& b) { return hs_body_name(b.handle.get()); })
      .def_property_readonly(
          "nodes", [](const py::object& b) { return Body::array(b, hs_body_nodes, 3); },
          "n x 3 [m], a view")
      .def_property_readonly(
          "fixed", [](const py::object& b) { return Body::array(b, hs_body_fixed, 1); },
          "n, 1: bonded to the support")
      .def_property_readonly("tets", &Body::tets, "indices of 4 nodes, or of 10")
      .def_property_readonly("regions",
                             [](const py::object& b) { return Body::array(b, hs_body_regions, 1); })
      .def_property_readonly(
          "faces", [](const py::object& b) { return Body::array(b, hs_body_faces, 3); },
          "boundary triangles, outward")
      .def("__repr__", [](const py::object& b) {
        return py::str("<hapsim.Body {}: {} nodes, {} tetrahedra>")
            .format(b.attr("name"), py::len(b.attr("nodes")), py::len(b.attr("tets")));
      });

  py::class_<Recording>(m, "Recording", "Presses, measured or simulated, or a motion of them.")
      .def(py::init(&Recording::make), "columns"_a, "metadata"_a = py::dict(),
           "From one array a column (press, t, x, ...), checked as a file is.")
      .def_static("read", &Recording::read, "path"_a, "forces"_a = true,
                  "forces=False: it may be a motion without them.")
      .def("write", &Recording::write, "path"_a)
      .def_property_readonly("name",
                             [](const Recording& r) { return hs_recording_name(r.handle.get()); })
      .def_property_readonly("columns", &Recording::columns)
      .def("__getitem__", &Recording::column, "A column, a view of the recording's own numbers.")
      .def("__len__", [](const Recording& r) { return hs_recording_rows(r.handle.get()); })
      .def_property_readonly("press",
                             [](const py::object& r) { return Recording::column(r, "press"); })
      .def_property_readonly("t", [](const py::object& r) { return Recording::column(r, "t"); })
      .def_property_readonly(
          "position", [](const py::object& r) { return Recording::vectors(r, "x"); },
          "n x 3, contact points [m]")
      .def_property_readonly(
          "u", [](const py::object& r) { return Recording::vectors(r, "ux"); },
          "n x 3, displacements of the tip from there [m]")
      .def_property_readonly(
          "f", [](const py::object& r) { return Recording::vectors(r, "fx"); },
          "n x 3, forces of the body on the tool [N]")
      .def_property_readonly("metadata", &Recording::metadata)
      .def("set_metadata", &Recording::set, "key"_a, "value"_a)
      .def("__repr__", [](const py::object& r) {
        return py::str("<hapsim.Recording {}: {} rows>").format(r.attr("name"), py::len(r));
      });

  py::class_<Model>(m, "Model", "Effects with the values of their parameters.")
      .def_static("read", &Model::read, "path"_a)
      .def_static("parse", &Model::parse, "text"_a, "name"_a = "model", "The text of model.csv.")
      .def("write", &Model::write, "path"_a)
      .def("copy", [](const Model& model) { return Model::copy(model.handle.get()); })
      .def_property_readonly("name", [](const Model& x) { return hs_model_name(x.handle.get()); })
      .def_property_readonly("text", [](const Model& x) { return hs_model_text(x.handle.get()); })
      .def_property_readonly("effects", &Model::effects)
      .def_property_readonly("parameters", &Model::parameters, "the rows of model.csv")
      .def("__getitem__", &Model::get, "model['elastic.E'], model['elastic.E[2]'] of region 2")
      .def("__setitem__", &Model::set)
      .def_property_readonly("metadata", &Model::metadata)
      .def_readonly("summary", &Model::summary, "of identify(): what hs-identify --json writes")
      .def("__repr__", [](const py::object& model) {
        return py::str("<hapsim.Model {}: {}>")
            .format(model.attr("name"), py::str("+").attr("join")(model.attr("effects")));
      });

  m.def("simulate", &simulate, "motion"_a, "body"_a, "model"_a,
        "hs-simulate: the motion with the model's forces.");
  m.def("identify", &identify, "recording"_a, "body"_a, "model"_a = py::none(),
        "hs-identify: a model of a recording, or of several (lists) of one body or of one each.");

  py::class_<Comparison>(m, "Comparison")
      .def_readonly("summary", &Comparison::summary, "what hs-compare --json writes")
      .def("__getitem__",
           [](const Comparison& c, const py::str& key) { return py::object(c.summary[key]); })
      .def_property_readonly("residuals", &residuals_of,
                             "the recording with sx,sy,sz (simulated) and rx,ry,rz (the rest)");
  m.def("compare", &compare, "measured"_a, "simulated"_a, "hs-compare.");

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

  py::class_<Prepared>(m, "Prepared", "A body and a model made ready for Live.")
      .def_property_readonly(
          "off_contacts",
          [](const Prepared& p) { return hs_prepared_off_contacts(p.handle.get()); },
          "relative error that is expected of forces between the samples");
  m.def("prepare", &prepare, "body"_a, "model"_a, "contacts"_a = py::none(),
        "As hs-simulate --live begins; contacts: a recording whose places are solved finely.");

  py::class_<hs_feel>(m, "Feel", "What a tool felt at its last step.")
      .def_readonly("press", &hs_feel::press)
      .def_property_readonly("contact", [](const hs_feel& f) { return f.contact != 0; })
      .def_readonly("beyond", &hs_feel::beyond)
      .def_readonly("safety", &hs_feel::safety)
      .def_property_readonly("point", [](const hs_feel& f) { return array_of(f.point); })
      .def_property_readonly("u", [](const hs_feel& f) { return array_of(f.u); })
      .def_property_readonly("force", [](const hs_feel& f) { return array_of(f.force); })
      .def_readonly("uncertainty", &hs_feel::uncertainty)
      .def_property_readonly("asked", [](const hs_feel& f) { return array_of(f.asked); });

  py::class_<Live>(m, "Live", "hs-simulate --live: one tool, a force within microseconds.")
      .def(py::init<Prepared, const py::kwargs&>(), "prepared"_a,
           "Keywords are the limits of a hand: hand=True, max_force=5.")
      .def(py::init([](const Body& body, const Model& model, const py::object& contacts,
                       const py::kwargs& keywords) {
             return Live(prepare(body, model, contacts, keywords), py::kwargs());
           }),
           "body"_a, "model"_a, "contacts"_a = py::none(), "Keywords are those of prepare().")
      .def("step", &Live::step, "position"_a, "t"_a = py::none(),
           "Force [N] on a tool with its tip at a position [m]; without t [s] by the clock.")
      .def("run", &Live::run, "t"_a, "positions"_a, "step() for each row; forces, n x 3")
      .def("begin", &Live::begin, "contact"_a, "A recorded press, whose contact point is known.")
      .def("press", &Live::press, "u"_a, "t"_a, "in_air"_a = false,
           "Its force at a displacement u [m] from there.")
      .def_property_readonly("feel", &Live::feel)
      .def("set_temperature", &Live::set_temperature, "temperature"_a, "Of the body [degC].")
      .def("end", &Live::end, "Of a hand: zero from now on.");
}
