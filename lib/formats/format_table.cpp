#include "formats/format_table.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "io/extension.h"
#include "io/wrapped.h"

namespace hapsim {

const Format& ply_format();
const Format& vtu_format();
const Format& vtk_format();
const Format& gmsh_format();
const Format& tetgen_format();
const Format& abaqus_format();
const Format& febio_format();
const Format& sofa_format();
const Format& stl_format();
const Format& off_format();
const Format& obj_format();
const Format& pcd_format();

const std::vector<const Format*>& all_formats() {
  // Those that say what they are come before those that any rows of numbers could be.
  static const std::vector<const Format*> formats{
      &ply_format(),    &vtu_format(),   &vtk_format(),  &gmsh_format(), &tetgen_format(),
      &abaqus_format(), &febio_format(), &sofa_format(), &stl_format(),  &off_format(),
      &obj_format(),    &pcd_format(),   &rows_format(), &csv_format()};
  return formats;
}

namespace {

bool can_read(const Format& format, Content content) {
  // The corners of triangles are points too.
  return content == Content::kPoints
             ? format.read_points != nullptr || format.read_surface != nullptr
         : content == Content::kTriangles ? format.read_surface != nullptr
                                          : format.read_mesh != nullptr;
}

bool can_write(const Format& format, Content content) {
  return content == Content::kPoints      ? format.write_points != nullptr
         : content == Content::kTriangles ? format.write_surface != nullptr
                                          : format.write_mesh != nullptr;
}

bool has_extension(const Format& format, const std::string& extension) {
  const auto& known = format.extensions;
  return std::find(known.begin(), known.end(), extension) != known.end();
}

const char* noun(Content content) {
  return content == Content::kPoints      ? "file of points"
         : content == Content::kTriangles ? "surface"
                                          : "mesh";
}

// "A, B or C".
std::string either(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

}  // namespace

Recognised recognise(const std::string& bytes) {
  for (const Format* format : all_formats())
    if (const Content content = format->sniff(bytes); content != Content::kNothing)
      return {format, content};
  return {};
}

const Format& format_to_write(const std::string& path, Content content) {
  const std::string extension = extension_of(path);
  for (const Format* format : all_formats())
    if (can_write(*format, content) && (extension.empty() || has_extension(*format, extension)))
      return *format;
  std::vector<std::string> known = extensions_to_write(content);
  for (std::string& word : known) word.insert(word.begin(), '.');
  fail_usage(fmt::format("{}: a {} is not written as .{}", path, noun(content), extension),
             "give " + either(known));
}

std::vector<std::string> extensions_to_write(Content content) {
  std::vector<std::string> known;
  for (const Format* format : all_formats())
    if (can_write(*format, content))
      known.insert(known.end(), format->extensions.begin(), format->extensions.end());
  return known;
}

std::string names_to_read(Content content) {
  std::vector<std::string> names;
  for (const Format* format : all_formats())
    if (can_read(*format, content)) names.emplace_back(format->name);
  return either(names);
}

void fail_format(const std::string& name, const std::string& bytes, Content content,
                 const std::string& mend) {
  if (bytes.empty()) fail_input(name, "the file is empty", mend);
  const Recognised found = recognise(bytes);
  if (found.format == nullptr) refuse_wrapped(name, bytes);
  const std::string known = names_to_read(content);
  fail_input(name,
             fmt::format("not a {} {}{}", known, noun(content),
                         found.format == nullptr ? "" : fmt::format(" but {}", found.format->name)),
             mend);
}

}  // namespace hapsim
