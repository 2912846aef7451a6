// hs-library: what a library of identified models holds.
#include <fmt/format.h>

#include "answer.h"
#include "base/counted.h"
#include "base/error.h"
#include "io/csv.h"
#include "model/body_parameters.h"
#include "model/library_summary.h"
#include "model/model_edit.h"
#include "model/model_library.h"

namespace hapsim {
namespace flag {
inline constexpr IntegerFlag show{"--show"};
inline constexpr TextFlag remove{"--remove"}, material{"--material"}, object{"--object"};
}  // namespace flag

namespace {

ToolSpec specification() {
  ToolSpec spec;
  spec.name = "hs-library";
  spec.task = Task::kModel;
  spec.summary = "list, show or remove the models of a library";
  spec.input = "model library, as hs-identify --library FILE writes it";
  spec.description = {
      "A library keeps identified models with what they describe: material, object, element size "
      "and tool. hs-identify --library takes start values from its nearest entry and adds its "
      "result. Many processes may use one library at once. Without a flag the entries are listed.",
      "The library is an SQLite file with one table, entry; it can be copied and kept like any "
      "file."};
  spec.options = {
      {.flag = flag::show,
       .value = "N",
       .help = "Writes the model of entry N, for hs-simulate --model and hs-identify --model.",
       .minimum = 1},
      {.flag = flag::remove,
       .value = "LIST",
       .help = "Removes the entries of these numbers, all or none.",
       .repeatable = true},
      {.flag = flag::material,
       .value = "NAME",
       .help = "Lists the entries of this material alone."},
      {.flag = flag::object, .value = "NAME", .help = "Lists the entries of this object alone."},
      answer_option()};
  spec.tables = {{"List (output)",
                  {{"entry", "its number, which is never given again"},
                   {"stored", "when, UTC"},
                   {"material, object", "as told to hs-identify"},
                   {"element_size", "edge of the regular tetrahedron of the mean volume [m]"},
                   {"tool, tool_radius", "flat or sphere, and its radius [m]"},
                   {"effects", "of the model"},
                   {"E, nu", "of its region 0 [Pa], [1]"},
                   {"rmse, force_noise", "error of the model and noise of its data [N]"}}}};
  spec.examples = {
      {"hs-identify data.csv --body body.ply --library lab.db --material liver -o m.csv",
       "Starts from the nearest model of the library, and adds the result to it."},
      {"hs-library lab.db --material liver", "Lists what it holds of a material."},
      {"hs-library lab.db --show 3 -o m.csv", "Writes a model as a table."},
      {"hs-library lab.db --remove 3,4", "Removes two of its entries."}};
  spec.see_also = {"hs-identify(1)", "hs-simulate(1)"};
  return spec;
}

std::vector<int> numbers(const std::vector<std::string>& texts) {
  std::vector<int> result;
  for (const std::string& text : texts) {
    double number = 0;
    if (!parse_number(text, number) || number < 1 || number > 1e9 || number != std::floor(number))
      fail_usage("--remove " + text + " is not the number of an entry", "give 3, or 3,4");
    result.push_back(static_cast<int>(number));
  }
  return result;
}

void show(const LibraryEntry& entry, std::ostream& out) {
  Model model = entry.model;
  const Described& d = entry.described;
  if (!d.material.empty()) model.metadata.set("material", d.material);
  if (!d.object.empty()) model.metadata.set("object", d.object);
  model.metadata.set("element_size", format_number(d.element_size));
  model.metadata.set("tool", d.tool);
  model.metadata.set("tool_radius", format_number(d.tool_radius));
  model.metadata.set("stored", entry.stored);
  write_model(out, model);
}

void list(const std::vector<LibraryEntry>& entries, std::ostream& out) {
  CsvWriter writer(out, {},
                   {"entry", "stored", "material", "object", "element_size", "tool", "tool_radius",
                    "effects", "E", "nu", "rmse", "force_noise"});
  for (const LibraryEntry& e : entries) {
    const Described& d = e.described;
    const auto told = [&](const char* key) { return e.model.metadata.find(key).value_or(""); };
    writer.row({std::to_string(e.id), e.stored, d.material, d.object, format_number(d.element_size),
                d.tool, format_number(d.tool_radius), effects_label(e.model),
                format_number(modulus_of(e.model)->value),
                format_number(poissons_ratio_of(e.model)->value), told("rmse"),
                told("force_noise")});
  }
}

int run(const Arguments& arguments) {
  if (arguments.given(flag::show) && arguments.given(flag::remove))
    fail_usage("--show and --remove exclude each other", "show the entry first");
  if (arguments.input() == "-")
    fail_usage("a library is no stream", "name the file: hs-library lab.db");
  if (arguments.given(flag::remove)) {
    const std::vector<int> ids = numbers(arguments.list(flag::remove));
    // Not made when it is absent.
    ModelLibrary(arguments.input(), Database::Mode::kRead);
    ModelLibrary(arguments.input(), Database::Mode::kWrite).remove(ids);
    say(arguments, "hs-library",
        fmt::format("{} removed from {}", counted(ids.size(), "entry", "entries"),
                    arguments.input()));
    return 0;
  }
  ModelLibrary library(arguments.input(), Database::Mode::kRead);
  Summary summary;
  Output output(result_file(arguments));
  if (arguments.given(flag::show)) {
    show(library.entry(static_cast<int>(arguments[flag::show])), output.stream());
    summary.values = {{"entry", static_cast<double>(arguments[flag::show]), "1"}};
    summary.verdict = fmt::format("model {} of {}", arguments.text(flag::show), arguments.input());
  } else {
    std::vector<LibraryEntry> entries = library.entries();
    const auto lacks = [&](const AnyFlag& flag, const std::string& name) {
      return arguments.given(flag) && name != arguments.text(flag);
    };
    std::erase_if(entries, [&](const LibraryEntry& e) {
      return lacks(flag::material, e.described.material) || lacks(flag::object, e.described.object);
    });
    list(entries, output.stream());
    summary = library_summary(entries, arguments.input());
  }
  output.commit();
  tell_answer(arguments, summary);
  return 0;
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::specification(), argc, argv, hapsim::run);
}
