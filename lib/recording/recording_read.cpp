#include <algorithm>
#include <array>
#include <climits>
#include <cmath>
#include <map>

#include "base/error.h"
#include "io/csv.h"
#include "recording/recording.h"
#include "recording/thinning.h"

namespace hapsim {
namespace {

// Those of kOptionalColumns follow.
enum Column { kPress, kT, kX, kY, kZ, kUx, kUy, kUz, kFx, kFy, kFz, kContact, kOptional };
constexpr std::size_t kColumns = kOptional + std::size(kOptionalColumns);

constexpr std::array<const char*, kColumns> names() {
  std::array<const char*, kColumns> names{"press", "t",  "x",  "y",  "z",  "ux",
                                          "uy",    "uz", "fx", "fy", "fz", "contact"};
  for (std::size_t k = kOptional; k < kColumns; ++k)
    names[k] = kOptionalColumns[k - kOptional].name;
  return names;
}
constexpr std::array<const char*, kColumns> kNames = names();

constexpr double kLargestPosition = 10;     // [m]; beyond it the unit is wrong
constexpr double kLargestDisplacement = 1;  // [m]
constexpr double kLargestForce = 1e6;       // [N]

class RecordingReader {
 public:
  RecordingReader(Input& input, bool need_forces) : csv_(input) {
    recording_.name = input.name();
    find_columns(need_forces);
  }

  // `thinner`: may be null.
  Recording read(Thinner* thinner) {
    std::vector<std::string_view> fields;
    while (csv_.next(fields)) {
      if (!parse(fields)) {
        if (bad_.full()) break;
        continue;
      }
      check();
      store(fields);
      if (thinner != nullptr) thinner->added(recording_);
    }
    bad_.fail_if_any(recording_.name);
    if (recording_.rows() == 0)
      fail_input(recording_.name, "there is a header but no data row", "add the recorded rows");
    recording_.metadata = csv_.metadata();
    check_metadata();
    return std::move(recording_);
  }

 private:
  void find_columns(bool need_forces) {
    const auto& header = csv_.header();
    std::array<bool, kColumns> present{};
    for (std::size_t c = 0; c < header.size(); ++c) {
      const auto name = std::find(kNames.begin(), kNames.end(), header[c]);
      const auto which = static_cast<std::size_t>(name - kNames.begin());
      meaning_.push_back(which);
      if (which < kColumns)
        present[which] = true;
      else
        recording_.extra_header.push_back(header[c]);
    }
    recording_.extra.resize(recording_.extra_header.size());
    const bool any_force = present[kFx] || present[kFy] || present[kFz];
    for (std::size_t k = 0; k < kColumns; ++k) {
      const bool force = k >= kFx && k <= kFz;
      const bool optional = k == kT || k >= kContact || (force && !need_forces && !any_force);
      if (!present[k] && !optional)
        fail_missing_column(recording_.name, kNames[k], header, {kNames.begin(), kNames.end()});
    }
    present_ = present;
  }

  bool parse(const std::vector<std::string_view>& fields) {
    bool good = true;
    for (std::size_t c = 0; c < fields.size(); ++c) {
      const std::size_t k = meaning_[c];
      if (k == kColumns || parse_number(fields[c], value_[k])) continue;
      bad_.add(kNames[k], csv_.line(), fields[c]);
      good = false;
    }
    return good;
  }

  void check() {
    if (std::abs(value_[kPress]) > INT_MAX || value_[kPress] != std::floor(value_[kPress]))
      fail_input(csv_.where(), "press is " + format_number(value_[kPress]) + ", not an integer",
                 "number the contact episodes 1, 2, 3");
    for (const Column k : {kX, kY, kZ}) check_size(k, kLargestPosition);
    for (const Column k : {kUx, kUy, kUz}) check_size(k, kLargestDisplacement);
    for (const Column k : {kFx, kFy, kFz})
      if (present_[k] && std::abs(value_[k]) > kLargestForce)
        fail_input(csv_.where(),
                   std::string(kNames[k]) + " is " + format_number(value_[k]) + " N, beyond 1e6 N",
                   "give forces in newtons");
    if (present_[kContact] && value_[kContact] != 0 && value_[kContact] != 1)
      fail_input(csv_.where(), "contact is " + format_number(value_[kContact]),
                 "write 1 in contact and 0 in the air");
    if (present_[kT]) check_time();
  }

  void check_size(Column k, double limit) const {
    if (std::abs(value_[k]) <= limit) return;
    fail_input(csv_.where(),
               std::string(kNames[k]) + " is " + format_number(value_[k]) + " m, beyond " +
                   format_number(limit) + " m",
               "are these millimetres? divide lengths by 1000");
  }

  void check_time() {
    const auto [last, is_new] = last_time_.try_emplace(value_[kPress], value_[kT]);
    if (!is_new && value_[kT] < last->second)
      fail_input(csv_.where(),
                 "time runs backwards in press " + format_number(value_[kPress]) + ": " +
                     format_number(value_[kT]) + " s after " + format_number(last->second) + " s",
                 "sort the rows, or begin a new press");
    last->second = value_[kT];
  }

  void store(const std::vector<std::string_view>& fields) {
    Recording& r = recording_;
    const auto& v = value_;
    r.line.push_back(csv_.line());
    r.press.push_back(static_cast<int>(v[kPress]));
    if (present_[kT]) r.t.push_back(v[kT]);
    r.position.emplace_back(v[kX], v[kY], v[kZ]);
    r.u.emplace_back(v[kUx], v[kUy], v[kUz]);
    if (present_[kFx]) r.f.emplace_back(v[kFx], v[kFy], v[kFz]);
    if (present_[kContact]) r.contact.push_back(v[kContact] != 0 ? 1 : 0);
    for (std::size_t k = kOptional; k < kColumns; ++k)
      if (present_[k]) (r.*kOptionalColumns[k - kOptional].values).push_back(v[k]);
    std::size_t extra = 0;
    for (std::size_t c = 0; c < fields.size() && !r.extra.empty(); ++c)
      if (meaning_[c] == kColumns) r.extra[extra++].emplace_back(fields[c]);
  }

  void check_metadata() const {
    const Metadata& m = recording_.metadata;
    if (m.find("tool_radius")) recording_.disc_radius();
    recording_.force_noise();
    m.number("temp_ref", recording_.name);
    if (const auto tool = m.find("tool"); tool && *tool != "flat" && *tool != "sphere")
      fail_input(recording_.name, "tool is " + shown(*tool), "known are: flat, sphere");
  }

  CsvReader csv_;
  Recording recording_;
  std::vector<std::size_t> meaning_;  // column of the file -> Column, kColumns for an unknown one
  std::array<bool, kColumns> present_{};
  std::array<double, kColumns> value_{};
  std::map<double, double> last_time_;  // of each press
  BadCells bad_;
};

}  // namespace

Recording read_recording(Input& input, bool need_forces) {
  return RecordingReader(input, need_forces).read(nullptr);
}

Recording read_thinned(Input& input, bool need_forces, std::size_t most, double noise,
                       Thinning& thinning) {
  Thinner thinner(most, noise);
  Recording recording = RecordingReader(input, need_forces).read(&thinner);
  thinning = thinner.end(recording);
  return recording;
}

}  // namespace hapsim
