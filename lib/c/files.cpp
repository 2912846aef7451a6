#include <algorithm>
#include <cstring>
#include <sstream>

#include "base/error.h"
#include "c/handles.h"
#include "formats/tetmesh_io.h"
#include "io/csv.h"
#include "io/stream.h"

namespace hapsim {

static_assert(sizeof(int) == sizeof(std::int32_t) && sizeof(Vec3) == 3 * sizeof(double) &&
              sizeof(Triangle) == 3 * sizeof(int));

std::unique_ptr<hs_recording> handle_of(Recording recording) {
  auto handle = std::make_unique<hs_recording>();
  handle->recording = std::move(recording);
  return handle;
}

std::unique_ptr<hs_model> handle_of(Model model) {
  auto handle = std::make_unique<hs_model>();
  handle->model = std::move(model);
  return handle;
}

const char* find_text(const Metadata& metadata, const char* key) noexcept {
  const char* found = nullptr;
  for (const Metadata::Line& line : metadata.lines())
    if (!line.key.empty() && line.key == key) found = line.value.c_str();
  return found;
}

const char* key_text(const Metadata& metadata, std::size_t number) noexcept {
  for (const Metadata::Line& line : metadata.lines())
    if (!line.key.empty() && number-- == 0) return line.key.c_str();
  return nullptr;
}

namespace {

// The numbers of a recording by the names of their columns.
struct Column {
  const char* name;
  hs_column (*of)(Recording&);  // data is null where there is none
};

template <std::vector<Vec3> Recording::*kValues, int kAxis>
hs_column axis_of(Recording& r) {
  std::vector<Vec3>& values = r.*kValues;
  return {values.empty() ? nullptr : values.front().data() + kAxis, sizeof(Vec3), HS_DOUBLE, 1};
}
template <class Number>
hs_column plain(std::vector<Number>& values, hs_kind kind) {
  return {values.empty() ? nullptr : values.data(), sizeof(Number), kind, 1};
}

std::vector<Column> columns() {
  return {{"press", [](Recording& r) { return plain(r.press, HS_INT32); }},
          {"t", [](Recording& r) { return plain(r.t, HS_DOUBLE); }},
          {"x", axis_of<&Recording::position, 0>},
          {"y", axis_of<&Recording::position, 1>},
          {"z", axis_of<&Recording::position, 2>},
          {"ux", axis_of<&Recording::u, 0>},
          {"uy", axis_of<&Recording::u, 1>},
          {"uz", axis_of<&Recording::u, 2>},
          {"fx", axis_of<&Recording::f, 0>},
          {"fy", axis_of<&Recording::f, 1>},
          {"fz", axis_of<&Recording::f, 2>}};
}

// What further there is of the row's own.
hs_column find_column(Recording& r, const char* name) {
  for (const Column& column : columns())
    if (std::strcmp(column.name, name) == 0) return column.of(r);
  for (const OptionalColumn& column : kOptionalColumns)
    if (std::strcmp(column.name, name) == 0) return plain(r.*column.values, HS_DOUBLE);
  if (std::strcmp(name, "contact") == 0) return plain(r.contact, HS_INT8);
  return {};
}

// The numbers of an unknown column; null where it is absent, or of other things.
const double* extra_numbers(hs_recording& handle, const std::string& name) {
  const Recording& r = handle.recording;
  const auto at = std::find(r.extra_header.begin(), r.extra_header.end(), name);
  if (at == r.extra_header.end()) return nullptr;
  const auto known = handle.extra.find(name);
  if (known != handle.extra.end()) return known->second.data();
  std::vector<double> numbers;
  for (const std::string& text : r.extra[static_cast<std::size_t>(at - r.extra_header.begin())])
    if (!parse_number(text, numbers.emplace_back())) return nullptr;
  return handle.extra.emplace(name, std::move(numbers)).first->second.data();
}

// What is written is named after its file, as what is read is.
template <class Thing>
void write_file(Thing& thing, const char* path, void (*write)(std::ostream&, const Thing&)) {
  Output output(path);
  write(output.stream(), thing);
  output.commit();
  thing.name = path;
}

}  // namespace
}  // namespace hapsim

using namespace hapsim;

hs_status hs_body_read(const char* path, hs_body** body) {
  return made(body, [&] {
    Input input(path);
    auto handle = std::make_unique<hs_body>();
    handle->name = input.name();
    handle->mesh = read_body(input, &handle->window);
    return handle;
  });
}

void hs_body_free(hs_body* body) {
  delete body;
}

const char* hs_body_name(const hs_body* body) {
  return body->name.c_str();
}

const double* hs_body_nodes(const hs_body* body, size_t* count) {
  *count = body->mesh.nodes.size();
  return body->mesh.nodes.front().data();
}

const uint8_t* hs_body_fixed(const hs_body* body, size_t* count) {
  *count = body->mesh.fixed.size();
  return body->mesh.fixed.data();
}

const int32_t* hs_body_tetrahedra(const hs_body* body, size_t* count) {
  *count = body->mesh.tets.size();
  return body->mesh.tets.front().data();
}

const int32_t* hs_body_regions(const hs_body* body, size_t* count) {
  *count = body->mesh.region.size();
  return body->mesh.region.data();
}

const int32_t* hs_body_faces(const hs_body* body, size_t* count) {
  *count = body->mesh.faces.size();
  return body->mesh.faces.front().data();
}

hs_status hs_recording_read(const char* path, int need_forces, hs_recording** recording) {
  return made(recording, [&] {
    Input input(path);
    return handle_of(read_recording(input, need_forces != 0));
  });
}

hs_status hs_recording_make(const char* const* names, const double* const* values, size_t count,
                            size_t rows, int need_forces, hs_recording** recording) {
  return made(recording, [&] {
    // As a file has it, so that it is checked as one; numbers read back as they are.
    std::ostringstream text;
    CsvWriter csv(text, {}, {names, names + count});
    std::vector<std::string> fields(count);
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t k = 0; k < count; ++k) fields[k] = format_number(values[k][row]);
      csv.row(fields);
    }
    Input input = Input::from_bytes(text.str(), "recording");
    return handle_of(read_recording(input, need_forces != 0));
  });
}

hs_status hs_recording_write(hs_recording* recording, const char* path) {
  return guarded([&] { write_file<Recording>(recording->recording, path, write_recording); });
}

void hs_recording_free(hs_recording* recording) {
  delete recording;
}

const char* hs_recording_name(const hs_recording* recording) {
  return recording->recording.name.c_str();
}

size_t hs_recording_rows(const hs_recording* recording) {
  return recording->recording.rows();
}

hs_status hs_recording_column(hs_recording* recording, const char* name, hs_column* column) {
  *column = {};
  return guarded([&] {
    *column = find_column(recording->recording, name);
    if (column->data == nullptr)
      *column = {const_cast<double*>(extra_numbers(*recording, name)), sizeof(double), HS_DOUBLE,
                 0};
    if (column->data == nullptr)
      fail_usage(std::string(name) + " is no column of numbers of " + recording->recording.name,
                 "ask for one that it has");
  });
}

const char* hs_recording_column_name(const hs_recording* recording, size_t number) {
  // Nothing is changed by it.
  Recording& r = const_cast<Recording&>(recording->recording);
  for (const Column& column : columns())
    if (column.of(r).data != nullptr && number-- == 0) return column.name;
  for (const OptionalColumn& column : kOptionalColumns)
    if (!(r.*column.values).empty() && number-- == 0) return column.name;
  if (!r.contact.empty() && number-- == 0) return "contact";
  return number < r.extra_header.size() ? r.extra_header[number].c_str() : nullptr;
}

const char* hs_recording_metadata(const hs_recording* recording, const char* key) {
  return find_text(recording->recording.metadata, key);
}

const char* hs_recording_metadata_key(const hs_recording* recording, size_t number) {
  return key_text(recording->recording.metadata, number);
}

hs_status hs_recording_set_metadata(hs_recording* recording, const char* key, const char* value) {
  return guarded([&] {
    if (value == nullptr)
      recording->recording.metadata.remove(key);
    else
      recording->recording.metadata.set(key, value);
  });
}

hs_status hs_model_read(const char* path, hs_model** model) {
  return made(model, [&] {
    Input input(path);
    return handle_of(read_model(input));
  });
}

hs_status hs_model_parse(const char* text, const char* name, hs_model** model) {
  return made(model, [&] {
    Input input = Input::from_bytes(text, name);
    return handle_of(read_model(input));
  });
}

hs_status hs_model_write(hs_model* model, const char* path) {
  return guarded([&] { write_file<Model>(model->model, path, write_model); });
}

hs_status hs_model_copy(const hs_model* model, hs_model** copy) {
  return made(copy, [&] { return handle_of(model->model); });
}

void hs_model_free(hs_model* model) {
  delete model;
}

const char* hs_model_name(const hs_model* model) {
  return model->model.name.c_str();
}

const char* hs_model_text(hs_model* model) {
  const hs_status status = guarded([&] {
    std::ostringstream text;
    write_model(text, model->model);
    model->text = text.str();
  });
  return status == HS_DONE ? model->text.c_str() : nullptr;
}

size_t hs_model_parameters(const hs_model* model) {
  return model->model.parameters.size();
}

hs_status hs_model_parameter(const hs_model* model, size_t number, hs_parameter* parameter) {
  *parameter = {};
  return guarded([&] {
    if (number >= model->model.parameters.size())
      fail_usage("a model of " + std::to_string(model->model.parameters.size()) +
                     " parameters has no number " + std::to_string(number),
                 "count from 0");
    const Parameter& p = model->model.parameters[number];
    *parameter = {p.effect.c_str(), p.region,       p.name.c_str(),
                  p.value,          p.unit.c_str(), p.std_error,
                  p.lower,          p.upper,        static_cast<hs_state>(p.state)};
  });
}

hs_status hs_model_set(hs_model* model, const char* effect, int region, const char* parameter,
                       double value) {
  return guarded([&] {
    Parameter* p = model->model.find(effect, region, parameter);
    const std::string what = std::string(effect) + "." + parameter;
    if (p == nullptr)
      fail_usage("the model has no " + what + " of region " + std::to_string(region),
                 "name one that it has");
    if (!(value >= p->lower && value <= p->upper))
      fail_usage(what + " = " + format_number(value) + " is out of bounds",
                 "give a value from " + format_number(p->lower) + " to " + format_number(p->upper));
    p->value = value;
  });
}

const char* hs_model_metadata(const hs_model* model, const char* key) {
  return find_text(model->model.metadata, key);
}

const char* hs_model_metadata_key(const hs_model* model, size_t number) {
  return key_text(model->model.metadata, number);
}
