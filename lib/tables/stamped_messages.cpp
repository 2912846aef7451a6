#include "tables/stamped_messages.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>

#include "base/error.h"
#include "base/median.h"
#include "io/number.h"

namespace hapsim {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are little-endian");

// A gap is more than so many usual steps.
constexpr double kStepsOfGap = 5;

// Takes a message apart; what is read beyond its end makes it bad.
class MessageBytes {
 public:
  explicit MessageBytes(std::string_view bytes) : bytes_(bytes) {}
  template <class T>
  T number() {
    T value{};
    const std::string_view taken = take(sizeof(T));
    if (good_) std::memcpy(&value, taken.data(), sizeof(T));
    return value;
  }
  std::string_view text() { return take(number<std::uint32_t>()); }
  bool ended_well() const { return good_ && bytes_.empty(); }

 private:
  std::string_view take(std::size_t length) {
    if (!good_ || length > bytes_.size()) {
      good_ = false;
      return {};
    }
    const std::string_view taken = bytes_.substr(0, length);
    bytes_.remove_prefix(length);
    return taken;
  }
  std::string_view bytes_;
  bool good_ = true;
};

void sort_by_stamp(StampedSeries& series) {
  std::vector<std::size_t> order(series.stamp.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return series.stamp[a] < series.stamp[b]; });
  StampedSeries sorted = series;
  for (std::size_t i = 0; i < order.size(); ++i) {
    sorted.stamp[i] = series.stamp[order[i]];
    sorted.values[i] = series.values[order[i]];
  }
  series = std::move(sorted);
}

// Quaternions q and -q are one rotation: the nearer one is meant.
void toward(const std::vector<double>& from, std::vector<double>& to, std::size_t first) {
  double along = 0;
  for (std::size_t k = first; k < first + 4; ++k) along += from[k] * to[k];
  if (along < 0)
    for (std::size_t k = first; k < first + 4; ++k) to[k] = -to[k];
}

void normalise(std::vector<double>& values, std::size_t first) {
  double square = 0;
  for (std::size_t k = first; k < first + 4; ++k) square += values[k] * values[k];
  if (!(square > 0)) return;
  for (std::size_t k = first; k < first + 4; ++k) values[k] /= std::sqrt(square);
}

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

}  // namespace

const std::vector<StampedType>& stamped_types() {
  static const std::vector<StampedType> types{
      {"geometry_msgs/WrenchStamped",
       StampedKind::kForce,
       false,
       {"fx", "fy", "fz", "tx", "ty", "tz"}},
      {"geometry_msgs/PoseStamped",
       StampedKind::kTip,
       false,
       {"tip_x", "tip_y", "tip_z", "qx", "qy", "qz", "qw"}},
      {"geometry_msgs/PointStamped", StampedKind::kTip, false, {"tip_x", "tip_y", "tip_z"}},
      {"geometry_msgs/TransformStamped",
       StampedKind::kTip,
       true,
       {"tip_x", "tip_y", "tip_z", "qx", "qy", "qz", "qw"}}};
  return types;
}

const StampedType* stamped_type(const std::string& type) {
  for (const StampedType& known : stamped_types())
    if (type == known.type) return &known;
  return nullptr;
}

StampedSeries series_of(const BagTopic& topic, const StampedType& type, bool by_receipt,
                        const std::string& name) {
  StampedSeries series;
  series.topic = topic.topic;
  for (std::size_t i = 0; i < topic.messages.size(); ++i) {
    MessageBytes message(topic.messages[i].body);
    message.number<std::uint32_t>();  // seq
    const auto seconds = message.number<std::uint32_t>();
    const auto nanoseconds = message.number<std::uint32_t>();
    const std::string_view frame = message.text();
    if (i == 0) series.frame = frame;
    if (type.child_frame) message.text();
    std::vector<double> values(type.names.size());
    for (double& value : values) value = message.number<double>();
    if (!message.ended_well())
      fail_input(name,
                 "message " + std::to_string(i + 1) + " of " + shown(topic.topic) +
                     " has another length than a " + type.type,
                 "record the topic again");
    series.stamps_lack = series.stamps_lack || (seconds == 0 && nanoseconds == 0);
    series.stamp.push_back(by_receipt ? topic.messages[i].received
                                      : std::int64_t{seconds} * 1000000000 + nanoseconds);
    series.values.push_back(std::move(values));
  }
  sort_by_stamp(series);
  return series;
}

StampJoin join_at(const std::vector<std::int64_t>& kept, const StampedSeries& other,
                  int quaternion) {
  StampJoin join;
  std::vector<std::size_t> known;  // of `other`: finite, and later than the one before
  for (std::size_t i = 0; i < other.stamp.size(); ++i)
    if (all_finite(other.values[i]) &&
        (known.empty() || other.stamp[i] > other.stamp[known.back()]))
      known.push_back(i);
  std::vector<double> steps;
  for (std::size_t i = 1; i < known.size(); ++i)
    steps.push_back(1e-9 * static_cast<double>(other.stamp[known[i]] - other.stamp[known[i - 1]]));
  join.longest = steps.empty() ? 0 : kStepsOfGap * median(steps);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const auto after = std::lower_bound(
        known.begin(), known.end(), kept[i],
        [&other](std::size_t k, std::int64_t stamp) { return other.stamp[k] < stamp; });
    if (after == known.end() || (after == known.begin() && other.stamp[*after] != kept[i])) {
      ++join.outside;
      continue;
    }
    const std::size_t b = *after;
    const std::size_t a = other.stamp[b] == kept[i] ? b : *(after - 1);
    const double step = 1e-9 * static_cast<double>(other.stamp[b] - other.stamp[a]);
    if (step > join.longest) {
      ++join.in_gaps;
      continue;
    }
    const double share = a == b ? 0 : 1e-9 * static_cast<double>(kept[i] - other.stamp[a]) / step;
    std::vector<double> from = other.values[a], to = other.values[b];
    if (quaternion >= 0) toward(from, to, static_cast<std::size_t>(quaternion));
    for (std::size_t k = 0; k < from.size(); ++k) from[k] += share * (to[k] - from[k]);
    if (quaternion >= 0) normalise(from, static_cast<std::size_t>(quaternion));
    join.row.push_back(i);
    join.values.push_back(std::move(from));
  }
  return join;
}

}  // namespace hapsim
