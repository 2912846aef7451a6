#include "model/model_library.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ctime>
#include <sstream>
#include <tuple>

#include "base/error.h"
#include "effects/catalogue.h"
#include "model/model_edit.h"

namespace hapsim {
namespace {

const DatabaseFormat& format() {
  static const DatabaseFormat format{"model library", 0x6873'6d6c /* "hsml" */, 1,
                                     "CREATE TABLE entry ("
                                     "  id INTEGER PRIMARY KEY AUTOINCREMENT,"
                                     "  stored TEXT NOT NULL,"
                                     "  material TEXT NOT NULL, object TEXT NOT NULL,"
                                     "  element_size REAL NOT NULL,"
                                     "  tool TEXT NOT NULL, tool_radius REAL NOT NULL,"
                                     "  model TEXT NOT NULL)"};
  return format;
}

constexpr const char* kSelect =
    "SELECT id, stored, material, object, element_size, tool, tool_radius, model FROM entry";

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

bool same_name(const std::string& a, const std::string& b) {
  return !a.empty() && lower(a) == lower(b);
}

std::string now() {
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
}

LibraryEntry entry_of(const Row& row, const std::string& library) {
  LibraryEntry entry;
  entry.id = static_cast<int>(number_of(row[0]));
  entry.stored = text_of(row[1]);
  entry.described = {text_of(row[2]), text_of(row[3]), number_of(row[4]), text_of(row[5]),
                     number_of(row[6])};
  Input text = Input::from_bytes(text_of(row[7]), fmt::format("{}: entry {}", library, entry.id));
  entry.model = read_model(text);
  return entry;
}

[[noreturn]] void fail_absent(const std::string& library, int id) {
  fail_usage(fmt::format("{} has no entry {}", library, id), "list it: hs-library " + library);
}

// An effect's rows of one region: two models with as many have as many terms.
std::size_t rows_of(const Model& model, const std::string& effect, int region) {
  return static_cast<std::size_t>(
      std::count_if(model.parameters.begin(), model.parameters.end(),
                    [&](const Parameter& p) { return p.effect == effect && p.region == region; }));
}

double log_ratio(double a, double b) {
  return a > 0 && b > 0 ? std::abs(std::log(a / b)) : 0;
}

}  // namespace

Described describe(const Recording& recording, const TetMesh& body) {
  Described d;
  d.material = recording.metadata.find("material").value_or("");
  d.object = recording.metadata.find("object").value_or("");
  // A regular tetrahedron of edge a has the volume a^3 / (6 sqrt 2).
  d.element_size =
      std::cbrt(6 * std::sqrt(2.0) * volume(body) / static_cast<double>(body.tets.size()));
  d.tool = recording.metadata.find("tool").value_or("flat");
  d.tool_radius = recording.tool_radius();
  return d;
}

ModelLibrary::ModelLibrary(const std::string& path, Database::Mode mode, double patience)
    : database_(path, format(), mode, patience) {}

std::vector<LibraryEntry> ModelLibrary::entries() {
  std::vector<LibraryEntry> entries;
  for (const Row& row : database_.query(std::string(kSelect) + " ORDER BY id"))
    entries.push_back(entry_of(row, database_.path()));
  return entries;
}

LibraryEntry ModelLibrary::entry(int id) {
  const auto rows = database_.query(std::string(kSelect) + " WHERE id = ?", {std::int64_t{id}});
  if (rows.empty()) fail_absent(database_.path(), id);
  return entry_of(rows.front(), database_.path());
}

int ModelLibrary::add(const Described& d, const Model& model) {
  std::ostringstream text;
  write_model(text, model);
  database_.query(
      "INSERT INTO entry (stored, material, object, element_size, tool, tool_radius, model)"
      " VALUES (?, ?, ?, ?, ?, ?, ?)",
      {now(), d.material, d.object, d.element_size, d.tool, d.tool_radius, text.str()});
  return static_cast<int>(database_.last_id());
}

void ModelLibrary::remove(const std::vector<int>& ids) {
  Database::Transaction transaction(database_);
  for (const int id : ids)
    if (database_.query("DELETE FROM entry WHERE id = ? RETURNING id", {std::int64_t{id}}).empty())
      fail_absent(database_.path(), id);
  transaction.commit();
}

const LibraryEntry* nearest_entry(const std::vector<LibraryEntry>& entries, const Described& wanted,
                                  const std::vector<std::string>& effects) {
  const auto nearness = [&](const LibraryEntry& e) {
    const Described& d = e.described;
    int common = 0, alone = 0;
    for (const std::string& effect : effects) common += e.model.has(effect);
    for (const std::string& effect : e.model.effects())
      alone += std::find(effects.begin(), effects.end(), effect) == effects.end();
    return std::tuple(same_name(d.material, wanted.material), same_name(d.object, wanted.object),
                      common, -alone, d.tool == wanted.tool,
                      -log_ratio(d.tool_radius, wanted.tool_radius) -
                          log_ratio(d.element_size, wanted.element_size),
                      e.id);
  };
  const auto nearest = std::max_element(
      entries.begin(), entries.end(),
      [&](const LibraryEntry& a, const LibraryEntry& b) { return nearness(a) < nearness(b); });
  return nearest == entries.end() ? nullptr : &*nearest;
}

std::string words_of(const LibraryEntry& entry) {
  const Described& d = entry.described;
  std::string what = d.material;
  if (!d.object.empty()) what += (what.empty() ? "" : ", ") + d.object;
  return fmt::format("entry {} ({}{}{} tool of {:.3g} mm, elements of {:.2g} mm, {})", entry.id,
                     what, what.empty() ? "" : ", ", d.tool, 1e3 * d.tool_radius,
                     1e3 * d.element_size, effects_label(entry.model));
}

std::optional<Model> with_values_of(const Model& start, const Model& known, bool same_object) {
  Model model = start;
  bool taken = false;
  for (Parameter& p : model.parameters) {
    const EffectCard& card = require_effect(p.effect).card();
    if (p.state != ParameterState::kFree || card.per_press || card.is_map) continue;
    if (card.solved && !same_object) continue;
    if (rows_of(start, p.effect, p.region) != rows_of(known, p.effect, p.region)) continue;
    const Parameter* other = known.find(p.effect, p.region, p.name);
    if (other == nullptr) continue;
    p.value = std::clamp(other->value, p.lower, p.upper);
    taken = true;
  }
  if (!taken) return std::nullopt;
  return model;
}

}  // namespace hapsim
