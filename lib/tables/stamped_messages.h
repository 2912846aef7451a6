// Messages of ROS that carry a stamp, as numbers in time, and two such series brought together.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tables/bag_records.h"

namespace hapsim {

enum class StampedKind { kForce, kTip };

// A type of message: std_msgs/Header, then (child_frame_id and) numbers of 64 bits.
struct StampedType {
  const char* type;
  StampedKind kind;
  bool child_frame;
  std::vector<const char*> names;  // of its numbers, in order
};

// geometry_msgs/WrenchStamped (fx..tz), PoseStamped, PointStamped, TransformStamped (tip_x.., and
// qx..qw where it has them). Source: the .msg files of geometry_msgs.
const std::vector<StampedType>& stamped_types();
// Null: none of them.
const StampedType* stamped_type(const std::string& type);

struct StampedSeries {
  std::string topic, frame;
  std::vector<std::int64_t> stamp;          // [ns], ascending
  std::vector<std::vector<double>> values;  // values[i]: a row of the type's numbers
  bool stamps_lack = false;                 // some are zero: nobody has set them
};

// `by_receipt`: stamps are the times at which the messages were received. Error(kBadInput) at
// `name`: a message whose length is not that of its type.
StampedSeries series_of(const BagTopic& topic, const StampedType& type, bool by_receipt,
                        const std::string& name);

struct StampJoin {
  std::vector<std::size_t> row;             // of the series whose stamps are kept
  std::vector<std::vector<double>> values;  // of the other one at these stamps
  std::size_t outside = 0, in_gaps = 0;     // rows that are left out
  double longest = 0;                       // step between stamps beyond which is a gap [s]
};

// `other` between its stamps, linearly, at those of `kept`; a quaternion, if `quaternion` is where
// its four numbers begin (else negative), is made of length one. Between stamps of `other` that lie
// farther apart than five of its median steps nothing is known.
StampJoin join_at(const std::vector<std::int64_t>& kept, const StampedSeries& other,
                  int quaternion);

}  // namespace hapsim
