#include "recording/recording.h"

#include <map>

#include "base/error.h"
#include "io/csv.h"
#include "recording/tools_together.h"

namespace hapsim {

double Recording::tool_radius() const {
  const auto radius = metadata.number("tool_radius", name);
  if (!radius)
    fail_input(name, "the tool's radius is not given",
               "add a line '# tool_radius: 0.004' (metres) at the top");
  if (!(*radius >= 1e-6 && *radius < 1))
    fail_input(name, "tool_radius " + format_number(*radius) + " is not between 1e-6 and 1 m",
               "give it in metres (4 mm is 0.004)");
  return *radius;
}

double Recording::disc_radius() const {
  const double tool = tool_radius();
  const auto disc = metadata.number("contact_radius", name);
  if (disc && !(*disc >= 1e-8 && *disc <= tool))
    fail_input(name, "contact_radius " + format_number(*disc) + " is not between 0 and tool_radius",
               "leave it out: hs-identify writes it where a ball is declared");
  return disc.value_or(tool);
}

bool Recording::has_ball() const {
  return metadata.find("tool") == "sphere";
}

std::optional<double> Recording::force_noise() const {
  constexpr double kLeast = 1e-15, kMost = 1e6;  // [N]; beyond them weights lose all digits
  const auto noise = metadata.number("force_noise", name);
  if (!noise || *noise == 0) return std::nullopt;  // 0: not known
  if (!(*noise >= kLeast && *noise <= kMost))
    fail_input(name, "force_noise " + format_number(*noise) + " is not between 1e-15 and 1e6 N",
               "give the standard deviation of a component in newtons, or remove the line");
  return noise;
}

std::vector<Press> Recording::presses() const {
  std::vector<Press> result;
  std::map<std::pair<int, std::string>, std::size_t> index;
  const std::vector<std::string>* tool = tool_ids(*this);
  for (std::size_t row = 0; row < rows(); ++row) {
    const auto [found, is_new] = index.try_emplace(
        {press[row], tool == nullptr ? std::string() : (*tool)[row]}, result.size());
    if (is_new) result.push_back({press[row], {}});
    result[found->second].rows.push_back(static_cast<int>(row));
  }
  return result;
}

int measured_axes(const std::vector<Vec3>& forces) {
  Vec3 largest = Vec3::Zero();
  for (const Vec3& f : forces) largest = largest.cwiseMax(f.cwiseAbs());
  return std::max(1, static_cast<int>((largest.array() > 0).count()));
}

void write_recording(std::ostream& out, const Recording& r) {
  std::vector<std::string> header{"press"};
  const auto add = [&](bool present, std::initializer_list<const char*> names) {
    if (present) header.insert(header.end(), names.begin(), names.end());
  };
  add(!r.t.empty(), {"t"});
  add(true, {"x", "y", "z", "ux", "uy", "uz"});
  add(!r.f.empty(), {"fx", "fy", "fz"});
  for (const OptionalColumn& column : kOptionalColumns)
    add(!(r.*column.values).empty(), {column.name});
  add(!r.contact.empty(), {"contact"});
  header.insert(header.end(), r.extra_header.begin(), r.extra_header.end());

  CsvWriter writer(out, r.metadata, header);
  std::vector<std::string> fields(header.size());
  for (std::size_t row = 0; row < r.rows(); ++row) {
    std::size_t c = 0;
    const auto put = [&](const Vec3& v) {
      for (int k = 0; k < 3; ++k) fields[c++] = format_number(v[k]);
    };
    fields[c++] = std::to_string(r.press[row]);
    if (!r.t.empty()) fields[c++] = format_number(r.t[row]);
    put(r.position[row]);
    put(r.u[row]);
    if (!r.f.empty()) put(r.f[row]);
    for (const OptionalColumn& column : kOptionalColumns)
      if (const auto& values = r.*column.values; !values.empty())
        fields[c++] = format_number(values[row]);
    if (!r.contact.empty()) fields[c++] = r.contact[row] != 0 ? "1" : "0";
    for (const auto& column : r.extra) fields[c++] = column[row];
    writer.row(fields);
  }
}

}  // namespace hapsim
