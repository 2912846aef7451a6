#include "import/assemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/median.h"
#include "import/table_facts.h"
#include "io/number.h"
#include "io/quantity.h"
#include "recording/force_noise.h"

namespace hapsim {
namespace {

// Numbers of the presses: those of the table where it has distinct whole ones, else 1, 2, ...
std::vector<int> press_ids(const RawTable& table, const ColumnMap& map,
                           const std::vector<PressTrack>& tracks) {
  std::vector<int> ids;
  std::set<int> seen;
  for (const PressTrack& track : tracks) {
    int id = 0;
    const std::string text = map.press.size() == 1
                                 ? table.columns[at(map.press[0])][at(track.segment.rows.front())]
                                 : "";
    double value = 0;
    if (parse_number(text, value) && value == std::floor(value) && std::abs(value) < 1e9)
      id = static_cast<int>(value);
    if (text.empty() || !parse_number(text, value) || value != id || !seen.insert(id).second) {
      for (std::size_t i = 0; i < tracks.size(); ++i)
        (i < ids.size() ? ids[i] : ids.emplace_back()) = static_cast<int>(i) + 1;
      return ids;
    }
    ids.push_back(id);
  }
  return ids;
}

// Samples in which the tip is above the undeformed surface and feels nothing.
std::vector<char> contact_flags(const Samples& samples, const PressTrack& track, double noise) {
  const auto& rows = track.segment.rows;
  const auto& told = samples[ScalarRole::kContactFlag];
  const double top = *std::max_element(track.force.begin(), track.force.end());
  // Rounded coordinates do not lift the tip off the surface.
  const double reach = *std::max_element(track.travel.begin(), track.travel.end());
  const double lift = -std::max(std::min(5e-6, 0.02 * reach), 0.005 * reach);
  std::vector<double> air;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (track.travel[i] < lift) air.push_back(track.force[i]);
  const double rest = upper_median(std::move(air));
  std::vector<char> flags;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const bool feels = std::abs(track.force[i] - rest) > 6 * noise + 0.02 * top;
    const bool touches = track.segment.sliding ? track.force[i] > 0.2 * top
                         : told.empty()        ? track.travel[i] >= lift || feels
                                               : told[at(rows[i])] > 0;
    flags.push_back(touches ? 1 : 0);
  }
  return flags;
}

// A sensor at its limit repeats one largest value while the tip goes on.
std::vector<bool> saturated(const PressTrack& track, double limit) {
  std::vector<bool> marks(track.force.size(), false);
  for (std::size_t i = 0; i < marks.size();) {
    std::size_t end = i;
    while (end < marks.size() && track.force[end] >= limit * (1 - 1e-12)) ++end;
    if (end - i >= 5) {
      const auto [low, high] =
          std::minmax_element(track.travel.begin() + static_cast<std::ptrdiff_t>(i),
                              track.travel.begin() + static_cast<std::ptrdiff_t>(end));
      const double reach = *std::max_element(track.travel.begin(), track.travel.end());
      if (*high - *low > 0.02 * reach)
        for (std::size_t k = i; k < end; ++k) marks[k] = true;
    }
    i = std::max(end, i + 1);
  }
  return marks;
}

// Columns without a role, and the names of presses that are no numbers.
std::vector<std::size_t> carried_columns(const RawTable& table, const ColumnMap& map,
                                         bool numbers_kept) {
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < table.header.size(); ++c) {
    const auto& cells = table.columns[c];
    const bool empty =
        std::all_of(cells.begin(), cells.end(), [](const auto& cell) { return cell.empty(); });
    if (!empty && (map.meaning[c].empty() || (map.meaning[c] == "press" && !numbers_kept)))
      columns.push_back(c);
  }
  return columns;
}

std::string carried_name(const std::string& name) {
  static const std::set<std::string> kOwn{"press", "t",  "x",  "y",  "z",    "ux",      "uy",
                                          "uz",    "fx", "fy", "fz", "temp", "contact", "sx",
                                          "sy",    "sz", "rx", "ry", "rz"};
  return kOwn.count(name) ? "source " + name : name;
}

// Digits that are kept: of every day's sizes to 0.1 nm and 1 nN, of smaller ones a millionth.
struct Digits {
  double length = 1e10, force = 1e9;  // per unit
};

Digits digits_of(const std::vector<PressTrack>& tracks) {
  double depth = 0, force = 0;
  for (const PressTrack& track : tracks)
    for (std::size_t i = 0; i < track.f.size(); ++i) {
      depth = std::max(depth, track.u[i].norm());
      force = std::max(force, track.f[i].norm());
    }
  Digits digits;
  const auto fine = [](double size) { return std::pow(10, 6 - std::floor(std::log10(size))); };
  if (depth > 0 && depth < 1e-5) digits.length = fine(depth);
  if (force > 0 && force < 1e-4) digits.force = fine(force);
  return digits;
}

// Differences of decimal numbers are written as decimal numbers again; -0 becomes 0.
Vec3 rounded(const Vec3& v, double per_unit) {
  return ((v * per_unit).array().round() / per_unit + 0.0).matrix();
}

// Of all samples, also those that --rate or --drop-air leave out. None from fewer differences than
// would tell it to a fifth.
NoiseEstimate noise_of(const std::vector<PressTrack>& tracks, const Digits& digits) {
  constexpr std::size_t kFewest = 30;
  Recording all;
  for (std::size_t p = 0; p < tracks.size(); ++p) {
    all.press.insert(all.press.end(), tracks[p].f.size(), static_cast<int>(p));
    for (const Vec3& u : tracks[p].u) all.u.push_back(rounded(u, digits.length));
    for (const Vec3& f : tracks[p].f) all.f.push_back(rounded(f, digits.force));
  }
  const NoiseEstimate noise = measure_force_noise(all);
  return noise.differences < kFewest ? NoiseEstimate{} : noise;
}

class Assembler {
 public:
  Assembler(const RawTable& table, const ColumnMap& map, const Samples& samples,
            const ImportOptions& options, ImportResult& result)
      : table_(table), map_(map), samples_(samples), options_(options), result_(result) {}

  void assemble(const std::vector<PressTrack>& tracks) {
    Recording& out = result_.recording;
    out.name = table_.name;
    set_metadata();
    set_facts(tracks);
    const std::vector<int> ids = press_ids(table_, map_, tracks);
    digits_ = digits_of(tracks);
    const NoiseEstimate noise = noise_of(tracks, digits_);
    note_noise(noise);
    carried_ =
        carried_columns(table_, map_, map_.press.size() == 1 && ids_are_table_ids(tracks, ids));
    for (const std::size_t c : carried_) out.extra_header.push_back(carried_name(table_.header[c]));
    out.extra.resize(carried_.size());
    double limit = 0;
    for (const PressTrack& track : tracks)
      limit = std::max(limit, *std::max_element(track.force.begin(), track.force.end()));
    for (std::size_t p = 0; p < tracks.size(); ++p) add(tracks[p], ids[p], noise.along, limit);
    if (std::all_of(out.contact.begin(), out.contact.end(), [](char c) { return c != 0; }))
      out.contact.clear();
    if (dropped_)
      result_.notes.warnings.push_back(fmt::format(
          "{} samples at the sensor's limit ({:.4g} N) while the tip went on are left out",
          dropped_, limit));
  }

 private:
  bool ids_are_table_ids(const std::vector<PressTrack>& tracks, const std::vector<int>& ids) const {
    double value = 0;
    for (std::size_t p = 0; p < tracks.size(); ++p)
      if (!parse_number(table_.columns[at(map_.press[0])][at(tracks[p].segment.rows.front())],
                        value) ||
          value != ids[p])
        return false;
    return true;
  }

  void set_metadata() {
    Metadata& metadata = result_.recording.metadata;
    metadata = table_.metadata;
    metadata.set("source", table_.name);
    // "tool_radius: 3 mm" is not hapsim's number of metres.
    const auto radius = metadata.find("tool_radius");
    double value;
    if (radius && !parse_number(*radius, value))
      metadata.set("tool_radius",
                   format_number(parse_length_at(table_.name, *radius, "tool_radius")));
    if (options_.tool_radius) metadata.set("tool_radius", format_number(*options_.tool_radius));
    if (!options_.tool.empty()) metadata.set("tool", options_.tool);
    // What the table states must be of use to whoever reads the recording.
    if (metadata.find("tool_radius")) result_.recording.tool_radius();
    result_.recording.force_noise();
  }

  // Every place that a sliding tool touched, half a millimetre apart.
  void touch_along(const PressTrack& track, const std::vector<char>& flags) {
    constexpr double kApart = 5e-4;
    const std::size_t begin = result_.touched.size();
    for (std::size_t i = 0; i < flags.size(); ++i) {
      const Vec3 place = rounded(track.contact + track.u[i], 1e10);
      if (flags[i] && (result_.touched.size() == begin ||
                       (place - result_.touched.back().point).norm() >= kApart))
        result_.touched.push_back({place, Vec3::Zero()});
    }
  }

  void set_facts(const std::vector<PressTrack>& tracks) {
    Metadata& metadata = result_.recording.metadata;
    const auto told = metadata.number("tool_radius", table_.name);
    if (const auto radius = ball_radius(samples_, tracks)) {
      if (!told) {
        metadata.set("tool_radius", format_number(*radius));
        if (options_.tool.empty()) metadata.set("tool", "sphere");
        result_.notes.facts.push_back(fmt::format(
            "the tool is a ball of radius {:.2f} mm, by its centre and the contact points",
            1e3 * *radius));
      } else if (std::abs(*radius - *told) > 0.05 * *told) {
        result_.notes.warnings.push_back(
            fmt::format("the tool's radius is said to be {:.2f} mm; by its ball's centre and the "
                        "contact points it is {:.2f} mm",
                        1e3 * *told, 1e3 * *radius));
      }
    }
    if (const auto height = specimen_height(samples_, tracks)) {
      metadata.set("thickness", fmt::format("{:.6g}", *height));
      result_.notes.facts.push_back(
          fmt::format("the specimen is {:.2f} mm thick: the gap at first contact", 1e3 * *height));
      if (options_.block && std::abs(*height - options_.block->z()) > 0.1 * *height)
        result_.notes.warnings.push_back(
            fmt::format("the block is {:.2f} mm thick, by the gap at first contact it is {:.2f} mm",
                        1e3 * options_.block->z(), 1e3 * *height));
    }
    if (!tracks.empty() && tracks.front().segment.sliding) metadata.set("motion", "sliding");
  }

  void note_noise(const NoiseEstimate& noise) {
    if (options_.noise == "off" || (noise.sigma <= 0 && options_.noise == "auto")) return;
    Metadata& metadata = result_.recording.metadata;
    if (metadata.find("force_noise") && options_.noise == "auto") return;
    if (noise.sigma <= 0)
      return result_.notes.warnings.push_back(
          "there are too few samples to estimate the noise of the force");
    metadata.set("force_noise", fmt::format("{:.3g}", noise.sigma));
    metadata.set("force_noise_from", noise.how);
    result_.notes.facts.push_back(
        fmt::format("force noise {:.3g} N, from {}", noise.sigma, noise.how));
  }

  void add(const PressTrack& track, int id, double noise, double limit) {
    Recording& out = result_.recording;
    const auto& t = samples_[ScalarRole::kTime];
    const auto& temp = samples_[ScalarRole::kTemperature];
    const std::vector<char> flags = contact_flags(samples_, track, noise);
    const std::vector<bool> full = saturated(track, limit);
    double next = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < track.segment.rows.size(); ++i) {
      const std::size_t row = at(track.segment.rows[i]);
      if (full[i]) ++dropped_;
      if (full[i] || (options_.drop_air && !flags[i])) continue;
      if (!t.empty() && options_.rate) {
        if (t[row] < next) continue;
        next = std::max(next + 1 / *options_.rate, t[row] + 0.5 / *options_.rate);
      }
      out.line.push_back(table_.line[row]);
      out.press.push_back(id);
      if (!t.empty()) out.t.push_back(t[row]);
      out.position.push_back(rounded(track.contact, 1e10));
      out.u.push_back(rounded(track.u[i], digits_.length));
      out.f.push_back(rounded(track.f[i], digits_.force));
      if (!temp.empty()) out.temp.push_back(temp[row]);
      out.contact.push_back(flags[i]);
      for (std::size_t c = 0; c < carried_.size(); ++c)
        out.extra[c].push_back(table_.columns[carried_[c]][row]);
    }
    if (track.segment.sliding) return touch_along(track, flags);
    result_.touched.push_back({rounded(track.contact, 1e10), map_.has(VectorRole::kNormal)
                                                                 ? rounded(track.outward, 1e9)
                                                                 : Vec3(Vec3::Zero())});
  }

  const RawTable& table_;
  const ColumnMap& map_;
  const Samples& samples_;
  const ImportOptions& options_;
  ImportResult& result_;
  std::vector<std::size_t> carried_;
  Digits digits_;
  std::size_t dropped_ = 0;
};

}  // namespace

void assemble(const RawTable& table, const ColumnMap& map, const Samples& samples,
              const ImportOptions& options, const std::vector<PressTrack>& tracks,
              ImportResult& result) {
  Assembler(table, map, samples, options, result).assemble(tracks);
}

}  // namespace hapsim
