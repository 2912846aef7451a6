// Bags of ROS 1: forces and positions of the tool brought together by their stamps. By our own
// reader, as Debian's librosbag_storage loads Python and plugins into whoever opens a bag.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/counted.h"
#include "base/error.h"
#include "io/number.h"
#include "tables/container.h"
#include "tables/stamped_messages.h"

namespace hapsim {
namespace {

const char* kind_words(StampedKind kind) {
  return kind == StampedKind::kForce ? "forces" : "positions";
}

// "/wrench (geometry_msgs/WrenchStamped), /diagnostics (...)": a few of them.
std::string topic_list(const std::vector<BagTopic>& topics) {
  constexpr std::size_t kMost = 6;
  std::string all;
  for (std::size_t i = 0; i < std::min(topics.size(), kMost); ++i)
    all += (all.empty() ? "" : ", ") + topics[i].topic + " (" + topics[i].type + ")";
  return topics.size() > kMost ? all + ", ..." : topics.empty() ? "none" : all;
}

class BagTable {
 public:
  BagTable(const std::string& bytes, const std::string& name, const TableOptions& options)
      : name_(name),
        length_unit_(options.length_unit.empty() ? "m" : options.length_unit),
        topics_(read_bag(bytes, name)) {
    if (options.topics.empty())
      find(options.positions_alone);
    else
      for (const std::string& topic : options.topics) take(topic);
    if (options.positions_alone && force_)  // its stamps would be kept, not those of the positions
      fail_usage("--topic: " + shown(force_->topic) + " has forces, --tip-motion needs none",
                 "name the topic of positions alone");
    if (!force_ && !tip_)
      fail_input(name_,
                 "no topic has stamped forces or positions; the bag holds " + topic_list(topics_),
                 "record geometry_msgs/WrenchStamped and PoseStamped, or write a CSV by "
                 "'rostopic echo -b FILE -p TOPIC'");
  }

  RawTable table() {
    table_.name = name_;
    const StampedSeries *force = nullptr, *tip = nullptr;
    std::optional<StampedSeries> forces, tips;
    const auto read = [&](bool by_receipt) {
      if (force_) forces = series_of(*force_, *stamped_type(force_->type), by_receipt, name_);
      if (tip_) tips = series_of(*tip_, *stamped_type(tip_->type), by_receipt, name_);
    };
    read(false);
    if ((forces && forces->stamps_lack) || (tips && tips->stamps_lack)) {
      read(true);  // of both, for the sake of one clock
      table_.notes.emplace_back("stamps are not set: messages count from when they were received");
    }
    if (forces) force = &*forces;
    if (tips) tip = &*tips;
    set_columns();
    const StampedSeries& kept = force ? *force : *tip;
    StampJoin join;
    if (force && tip) {
      join = join_at(kept.stamp, *tip, stamped_type(tip_->type)->names.size() > 3 ? 3 : -1);
      tell_join(join, *force, *tip);
    } else {
      for (std::size_t i = 0; i < kept.stamp.size(); ++i) join.row.push_back(i);
    }
    for (std::size_t i = 0; i < join.row.size(); ++i) {
      const std::size_t row = join.row[i];
      std::size_t column = 0;
      const auto put = [&](double value) {
        table_.columns[column++].push_back(format_number(value));
      };
      put(static_cast<double>(kept.stamp[row] - kept.stamp[join.row[0]]) / 1e9);
      for (const double value : kept.values[row]) put(value);
      if (force && tip)
        for (const double value : join.values[i]) put(value);
      table_.line.push_back(static_cast<long>(row) + 1);
      table_.block.push_back(0);
    }
    return std::move(table_);
  }

 private:
  const BagTopic*& place(StampedKind kind) { return kind == StampedKind::kForce ? force_ : tip_; }

  // The only topic of each kind that has messages.
  void find(bool positions_alone) {
    for (const StampedKind kind : {StampedKind::kForce, StampedKind::kTip}) {
      if (positions_alone && kind == StampedKind::kForce) continue;
      std::string all;
      std::size_t count = 0;
      for (const BagTopic& topic : topics_) {
        const StampedType* type = stamped_type(topic.type);
        if (!type || type->kind != kind || topic.messages.empty()) continue;
        all += (all.empty() ? "" : ", ") + topic.topic;
        place(kind) = &topic;
        ++count;
      }
      if (count > 1)
        fail_input(name_,
                   fmt::format("the bag holds several topics of {}: {}", kind_words(kind), all),
                   "say which by --topic NAME, once for forces and once for positions");
    }
  }

  void take(const std::string& name) {
    const auto topic = std::find_if(topics_.begin(), topics_.end(),
                                    [&name](const BagTopic& t) { return t.topic == name; });
    if (topic == topics_.end())
      fail_input(name_, "--topic: the bag has no topic " + shown(name),
                 "it holds " + topic_list(topics_));
    const StampedType* type = stamped_type(topic->type);
    if (!type) {
      std::string known;
      for (const StampedType& one : stamped_types())
        known += (known.empty() ? "" : ", ") + std::string(one.type);
      fail_input(name_, "--topic: " + shown(name) + " is of the type " + shown(topic->type),
                 "those that are read are " + known);
    }
    if (topic->messages.empty())
      fail_input(name_, "--topic: " + shown(name) + " has no messages", "record it again");
    if (place(type->kind) == &*topic)
      fail_usage("--topic names " + shown(name) + " twice",
                 "name one topic of forces and one of positions");
    if (place(type->kind))
      fail_usage(fmt::format("--topic names two topics of {}", kind_words(type->kind)),
                 "name one of forces and one of positions");
    place(type->kind) = &*topic;
  }

  void set_columns() {
    std::vector<std::string> names{"t"}, units{"s"};
    for (const BagTopic* topic : {force_, tip_}) {
      if (!topic) continue;
      for (const std::string one : stamped_type(topic->type)->names) {
        names.push_back(one);
        units.push_back(one[0] == 'f'              ? "N"
                        : one.rfind("tip", 0) == 0 ? length_unit_
                        : one[0] == 't'            ? "Nm"
                                                   : "");
      }
    }
    table_.set_header(names);
    table_.unit = units;
  }

  void tell_join(const StampJoin& join, const StampedSeries& force, const StampedSeries& tip) {
    if (join.row.empty() && join.outside == 0)
      fail_input(name_,
                 fmt::format("all forces of {} ({}) fall between positions of {} that are more "
                             "than {:.3g} s apart, five times their usual step",
                             force.topic, join.in_gaps, tip.topic, join.longest),
                 "record both without gaps, or choose topics by --topic");
    if (join.row.empty()) {
      const double before = 1e-9 * static_cast<double>(tip.stamp[0] - force.stamp[0]);
      fail_input(
          name_,
          fmt::format("no force of {} falls between two positions of {}, which begin "
                      "{:.6g} s {}",
                      force.topic, tip.topic, std::abs(before), before < 0 ? "earlier" : "later"),
          "set the clocks of both by one, or choose topics by --topic");
    }
    table_.notes.push_back(
        fmt::format("forces of {}, positions of {} between their stamps at those of the forces",
                    force.topic, tip.topic));
    if (join.outside > 0)
      table_.notes.push_back(counted(static_cast<std::ptrdiff_t>(join.outside), "force", "forces") +
                             " before the first or after the last position: left out");
    if (join.in_gaps > 0)
      table_.notes.push_back(fmt::format(
          "{} between positions more than {:.3g} s apart: left out",
          counted(static_cast<std::ptrdiff_t>(join.in_gaps), "force", "forces"), join.longest));
    if (force.frame != tip.frame)
      table_.notes.push_back(
          "forces are in the frame " + shown(force.frame) + ", positions in " + shown(tip.frame) +
          ": where the first turns with the tool, --calibration turns them back");
  }

  const std::string& name_;
  const std::string length_unit_;
  std::vector<BagTopic> topics_;
  const BagTopic *force_ = nullptr, *tip_ = nullptr;
  RawTable table_;
};

bool sniff_bag(const std::string& bytes) {
  return is_bag(bytes);
}

RawTable read_bag_table(const std::string& bytes, const std::string& name,
                        const TableOptions& options) {
  return BagTable(bytes, name, options).table();
}

}  // namespace

const Container kBagFile{"ROS 1 bag", sniff_bag, read_bag_table};

}  // namespace hapsim
