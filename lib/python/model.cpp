#include "python/model.h"

#include <cstdlib>
#include <string>

#include "python/body.h"
#include "python/convert.h"
#include "python/options.h"
#include "python/recording.h"

namespace hapsim::python {
namespace {

Model adopt(hs_model* made) {
  return {owned<hs_model, hs_model_free>(made)};
}

Model read_model_file(const py::object& path) {
  hs_model* made = nullptr;
  require(hs_model_read(path_of(path).c_str(), &made));
  return adopt(made);
}

Model parse(const std::string& text, const std::string& name) {
  hs_model* made = nullptr;
  require(hs_model_parse(text.c_str(), name.c_str(), &made));
  return adopt(made);
}

Model copy(const hs_model* model) {
  hs_model* made = nullptr;
  require(hs_model_copy(model, &made));
  return adopt(made);
}

hs_parameter at(const Model& model, std::size_t number) {
  hs_parameter p{};
  require(hs_model_parameter(model.handle.get(), number, &p));
  return p;
}

py::list parameters(const Model& model) {
  static constexpr const char* kStates[] = {"free", "fixed", "derived"};
  py::list rows;
  for (std::size_t k = 0; k < hs_model_parameters(model.handle.get()); ++k) {
    const hs_parameter p = at(model, k);
    rows.append(py::dict("effect"_a = p.effect, "region"_a = p.region, "parameter"_a = p.parameter,
                         "value"_a = p.value, "unit"_a = p.unit, "std_error"_a = p.std_error,
                         "lower"_a = p.lower, "upper"_a = p.upper, "state"_a = kStates[p.state]));
  }
  return rows;
}

// "elastic.E", "elastic.E[2]" of region 2.
struct Name {
  std::string effect, parameter;
  int region = 0;
};

Name split(const std::string& name) {
  const std::size_t dot = name.find('.');
  const std::size_t bracket = name.find('[');
  if (dot == std::string::npos) fail(HS_USAGE, name + " is no parameter; give EFFECT.NAME");
  Name parts{name.substr(0, dot), name.substr(dot + 1, bracket - dot - 1)};
  if (bracket != std::string::npos) parts.region = std::atoi(name.c_str() + bracket + 1);
  return parts;
}

double get(const Model& model, const std::string& name) {
  const Name parts = split(name);
  for (std::size_t k = 0; k < hs_model_parameters(model.handle.get()); ++k) {
    const hs_parameter p = at(model, k);
    if (parts.effect == p.effect && parts.parameter == p.parameter && parts.region == p.region)
      return p.value;
  }
  throw py::key_error(name);
}

void set(const Model& model, const std::string& name, double value) {
  const Name parts = split(name);
  require(hs_model_set(model.handle.get(), parts.effect.c_str(), parts.region,
                       parts.parameter.c_str(), value));
}

py::list effects(const Model& model) {
  py::list names;
  for (std::size_t k = 0; k < hs_model_parameters(model.handle.get()); ++k) {
    const py::str name(at(model, k).effect);
    if (!names.contains(name)) names.append(name);
  }
  return names;
}

py::dict metadata(const Model& model) {
  return metadata_of([&](std::size_t k) { return hs_model_metadata_key(model.handle.get(), k); },
                     [&](const char* key) { return hs_model_metadata(model.handle.get(), key); });
}

void write(const Model& model, const py::object& path) {
  require(hs_model_write(model.handle.get(), path_of(path).c_str()));
}

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
  Model result = copy(hs_identification_model(made));
  result.summary = from_json(hs_identification_json(made));
  return result;
}

}  // namespace

void define_model(py::module_& m) {
  py::class_<Model>(m, "Model", "Effects with the values of their parameters.")
      .def_static("read", &read_model_file, "path"_a)
      .def_static("parse", &parse, "text"_a, "name"_a = "model", "The text of model.csv.")
      .def("write", &write, "path"_a)
      .def("copy", [](const Model& model) { return copy(model.handle.get()); })
      .def_property_readonly("name", [](const Model& x) { return hs_model_name(x.handle.get()); })
      .def_property_readonly("text", [](const Model& x) { return hs_model_text(x.handle.get()); })
      .def_property_readonly("effects", &effects)
      .def_property_readonly("parameters", &parameters, "the rows of model.csv")
      .def("__getitem__", &get, "model['elastic.E'], model['elastic.E[2]'] of region 2")
      .def("__setitem__", &set)
      .def_property_readonly("metadata", &metadata)
      .def_readonly("summary", &Model::summary, "of identify(): what hs-identify --json writes")
      .def("__repr__", [](const py::object& model) {
        return py::str("<hapsim.Model {}: {}>")
            .format(model.attr("name"), py::str("+").attr("join")(model.attr("effects")));
      });

  m.def("simulate", &simulate, "motion"_a, "body"_a, "model"_a,
        "hs-simulate: the motion with the model's forces.");
  m.def("identify", &identify, "recording"_a, "body"_a, "model"_a = py::none(),
        "hs-identify: a model of a recording, or of several (lists) of one body or of one each.");
}

}  // namespace hapsim::python
