// Bags of ROS 1: one by ROS's own recorder, small ones made here, and damaged ones.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "expect_error.h"
#include "import/import.h"
#include "import/tip_motion.h"
#include "tables/bag_records.h"
#include "tables/stamped_messages.h"

namespace hapsim::test {
namespace {

std::string recorded_bag() {
  Input input(HAPSIM_EXAMPLES "/robot/press.bag");
  return input.read_all();
}

template <class T>
std::string raw(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}
std::string counted_text(const std::string& text) {
  return raw(static_cast<std::uint32_t>(text.size())) + text;
}
std::string a_field(const std::string& name, const std::string& value) {
  return counted_text(name + "=" + value);
}
std::string a_record(const std::string& fields, const std::string& data) {
  return counted_text(fields) + counted_text(data);
}
std::string op_field(char op) {
  return a_field("op", std::string(1, op));
}

// std_msgs/Header, then numbers.
std::string stamped(std::int64_t stamp_ms, const std::string& frame,
                    const std::vector<double>& numbers, const std::string& child = "") {
  const std::int64_t seconds = stamp_ms / 1000;
  std::string bytes = raw(std::uint32_t{0}) + raw(static_cast<std::uint32_t>(seconds)) +
                      raw(static_cast<std::uint32_t>(1000000 * (stamp_ms - 1000 * seconds))) +
                      counted_text(frame) + child;
  for (const double number : numbers) bytes += raw(number);
  return bytes;
}

class BagMaker {
 public:
  int topic(const std::string& name, const std::string& type) {
    const auto id = static_cast<std::uint32_t>(connections_++);
    chunk_ += a_record(op_field(7) + a_field("conn", raw(id)) + a_field("topic", name),
                       a_field("topic", name) + a_field("type", "geometry_msgs/" + type));
    return static_cast<int>(id);
  }
  void message(int topic, std::int64_t received_ms, const std::string& body) {
    const std::int64_t seconds = received_ms / 1000;
    chunk_ += a_record(
        op_field(2) + a_field("conn", raw(static_cast<std::uint32_t>(topic))) +
            a_field("time",
                    raw(static_cast<std::uint32_t>(seconds)) +
                        raw(static_cast<std::uint32_t>(1000000 * (received_ms - 1000 * seconds)))),
        body);
  }
  std::string bytes(const std::string& compression = "none", std::uint64_t index = 4096,
                    const std::string& more = "") const {
    return "#ROSBAG V2.0\n" +
           a_record(op_field(3) + a_field("index_pos", raw(index)) +
                        a_field("conn_count", raw(static_cast<std::uint32_t>(connections_))) +
                        a_field("chunk_count", raw(std::uint32_t{1})) + more,
                    std::string(100, ' ')) +
           a_record(op_field(5) + a_field("compression", compression) +
                        a_field("size", raw(static_cast<std::uint32_t>(chunk_.size()))),
                    chunk_) +
           a_record(op_field(6), "");
  }

 private:
  std::string chunk_;
  int connections_ = 0;
};

RawTable table_of_bag(const std::string& bytes, const TableOptions& options = {}) {
  Input input = Input::from_bytes(bytes, "session.bag");
  return read_raw_table(input, options);
}
std::vector<double> numbers(const RawTable& table, const std::string& name) {
  std::vector<double> values;
  for (std::size_t c = 0; c < table.header.size(); ++c)
    if (table.header[c] == name)
      for (const std::string& cell : table.columns[c]) values.push_back(std::stod(cell));
  return values;
}

template <class Call>
void expect_words(const std::vector<std::string>& words, const Call& call,
                  ExitCode code = ExitCode::kBadInput) {
  const std::string message = error_of(call, code);
  for (const std::string& word : words)
    EXPECT_NE(message.find(word), std::string::npos) << message << "\nhas not\n" << word;
}

// Forces every 10 ms and positions every 20 ms, 4 ms later, along z = 1 - 0.1 t.
BagMaker usual(const std::string& tip_type = "PoseStamped") {
  BagMaker bag;
  const int wrench = bag.topic("/wrench", "WrenchStamped"), tip = bag.topic("/tip", tip_type);
  for (int i = 0; i < 20; ++i) {
    bag.message(wrench, 10 * i, stamped(1000 + 10 * i, "base", {0, 0, 1.0 * i, 0, 0, 0}));
    if (i % 2) continue;
    std::vector<double> pose{0.1, 0.2, 1 - 1e-3 * (10 * i + 4)};
    const bool turned = tip_type != "PointStamped";
    if (turned) pose.insert(pose.end(), {1, 0, 0, 0});
    bag.message(tip, 10 * i + 5,
                stamped(1004 + 10 * i, "base", pose,
                        tip_type == "TransformStamped" ? counted_text("tool") : ""));
  }
  return bag;
}

TEST(Bag, OfRosRecorderIsRead) {
  const std::string bytes = recorded_bag();
  const std::vector<BagTopic> topics = read_bag(bytes, "press.bag");
  ASSERT_EQ(topics.size(), 3u);
  for (const BagTopic& topic : topics) {
    if (topic.type == "geometry_msgs/WrenchStamped") {
      EXPECT_EQ(topic.topic, "/wrench");
      EXPECT_EQ(topic.messages.size(), 320u);
      EXPECT_EQ(topic.messages[0].received, 1700000000000700000);
    } else if (topic.type == "geometry_msgs/PoseStamped") {
      EXPECT_EQ(topic.messages.size(), 160u);
    } else {
      EXPECT_EQ(topic.type, "std_msgs/String");
    }
  }
  ImportOptions options;
  options.tool_radius = 0.004;
  const ImportResult result = import_recording(table_of_bag(bytes), options);
  const Recording& out = result.recording;
  ASSERT_EQ(out.presses().size(), 2u);
  double deepest = 0;
  for (const Vec3& u : out.u) deepest = std::max(deepest, -u.z());
  EXPECT_NEAR(deepest, 3e-3, 5e-5);
  EXPECT_NEAR(out.position[0].x(), 0.022, 1e-9);
  EXPECT_NEAR(out.position[0].z(), 0.04, 5e-5);
}

TEST(Bag, PositionsAreTakenAtTheStampsOfForces) {
  for (const std::string type : {"PoseStamped", "PointStamped", "TransformStamped"}) {
    const RawTable table = table_of_bag(usual(type).bytes());
    const std::vector<double> t = numbers(table, "t"), z = numbers(table, "tip_z"),
                              f = numbers(table, "fz");
    ASSERT_EQ(z.size(), 18u) << type;  // one before the first, one after the last position
    for (std::size_t i = 0; i < z.size(); ++i) {
      EXPECT_DOUBLE_EQ(t[i], 0.01 * static_cast<double>(i));
      EXPECT_DOUBLE_EQ(f[i], static_cast<double>(i + 1));
      EXPECT_NEAR(z[i], 1 - 1e-3 * 10 * static_cast<double>(i + 1), 1e-12);
    }
    EXPECT_EQ(numbers(table, "qx").size(), type == "PointStamped" ? 0u : 18u);
  }
}

TEST(Bag, TipMotionKeepsThePositionsOwnStamps) {
  TableOptions options;
  options.positions_alone = true;
  const TipMotion motion = tip_motion(table_of_bag(usual().bytes(), options), {});
  ASSERT_EQ(motion.t.size(), 10u);
  EXPECT_DOUBLE_EQ(motion.t[1], 0.02);
  EXPECT_NEAR(motion.tip[1].z(), 1 - 0.024, 1e-12);
}

TEST(Bag, QuaternionsOfEitherSignAreOneRotation) {
  StampedSeries tips;
  tips.stamp = {0, 100};
  tips.values = {{0, 0, 0, 0, 0, 0, 1}, {0, 0, 0, 0, 0, -0.6, -0.8}};
  const StampJoin join = join_at({50}, tips, 3);
  ASSERT_EQ(join.values.size(), 1u);
  // Half of the way: by the half of the angle between them.
  EXPECT_NEAR(join.values[0][5], std::sin(std::atan2(0.6, 0.8) / 2), 1e-12);
  EXPECT_NEAR(join.values[0][6], std::cos(std::atan2(0.6, 0.8) / 2), 1e-12);
}

TEST(Bag, NothingIsKnownInAGapOrOutside) {
  StampedSeries tips;
  for (const std::int64_t stamp : {0, 10, 20, 30, 200, 210}) {
    tips.stamp.push_back(stamp);
    tips.values.push_back({1.0 * static_cast<double>(stamp)});
  }
  tips.values[1][0] = std::nan("");  // as if it were not there
  const StampJoin join = join_at({-5, 0, 5, 30, 100, 205, 210, 211}, tips, -1);
  EXPECT_EQ(join.row, (std::vector<std::size_t>{1, 2, 3, 5, 6}));
  EXPECT_DOUBLE_EQ(join.values[1][0], 5);
  EXPECT_EQ(join.outside, 2u);
  EXPECT_EQ(join.in_gaps, 1u);
}

TEST(Bag, ForcesThatAreAllInAGapAreTold) {
  BagMaker bag;
  const int wrench = bag.topic("/wrench", "WrenchStamped"), tip = bag.topic("/tip", "PointStamped");
  for (const int t : {0, 10, 20, 30, 3000, 3010, 3020})
    bag.message(tip, t, stamped(1000 + t, "base", {0, 0, 0.1}));
  for (int t = 1000; t < 1070; t += 10)
    bag.message(wrench, t, stamped(1000 + t, "base", {0, 0, 1, 0, 0, 0}));
  expect_words({"all forces of /wrench (7) fall between positions of /tip",
                "more than 0.05 s apart", "without gaps"},
               [&] { table_of_bag(bag.bytes()); });
}

TEST(Bag, LengthsAreInTheUnitThatIsTold) {
  TableOptions options;
  options.length_unit = "mm";
  options.positions_alone = true;
  const TipMotion motion = tip_motion(table_of_bag(usual().bytes(), options), {});
  EXPECT_NEAR(motion.tip[1].z(), 1e-3 * (1 - 0.024), 1e-15);
  BagMaker bag;  // in millimetres, and nobody says so
  const int tip = bag.topic("/tip", "PointStamped");
  for (int i = 0; i < 4; ++i) bag.message(tip, i, stamped(1000 + i, "base", {0, 0, 39.0 - i}));
  EXPECT_NEAR(tip_motion(table_of_bag(bag.bytes(), options), {}).tip[1].z(), 0.038, 1e-15);
  options.length_unit.clear();
  expect_words({"session.bag", "a position of the tip is 39 m away", "--unit mm"},
               [&] { tip_motion(table_of_bag(bag.bytes(), options), {}); });
}

TEST(Bag, StampsThatNobodySetAreThoseOfReceipt) {
  BagMaker bag;
  const int wrench = bag.topic("/wrench", "WrenchStamped"), tip = bag.topic("/tip", "PointStamped");
  for (int i = 0; i < 10; ++i) {
    bag.message(wrench, 5000 + 10 * i, stamped(0, "base", {0, 0, 1.0 * i, 0, 0, 0}));
    bag.message(tip, 5000 + 10 * i, stamped(99000 + 10 * i, "base", {0, 0, 0.1 * i}));
  }
  const RawTable table = table_of_bag(bag.bytes());
  EXPECT_EQ(table.rows(), 10u);
  EXPECT_NE(table.notes[0].find("when they were received"), std::string::npos);
}

TEST(Bag, SeveralTopicsAskForTheFlag) {
  BagMaker bag = usual();
  const int second = bag.topic("/wrench_filtered", "WrenchStamped");
  bag.message(second, 0, stamped(1000, "base", {0, 0, 7, 0, 0, 0}));
  bag.message(second, 0, stamped(1050, "base", {0, 0, 7, 0, 0, 0}));
  expect_words({"session.bag", "several topics of forces: /wrench, /wrench_filtered", "--topic"},
               [&] { table_of_bag(bag.bytes()); });
  TableOptions options;
  options.topics = {"/wrench_filtered", "/tip"};
  EXPECT_EQ(numbers(table_of_bag(bag.bytes(), options), "fz"), (std::vector<double>{7}));
  options.topics = {"/tip"};
  EXPECT_EQ(table_of_bag(bag.bytes(), options).rows(), 10u);
  options.topics = {"/tipp"};
  expect_words({"no topic '/tipp'", "it holds /wrench"},
               [&] { table_of_bag(bag.bytes(), options); });
  options.topics = {"/wrench", "/wrench_filtered"};
  expect_words(
      {"two topics of forces"}, [&] { table_of_bag(bag.bytes(), options); }, ExitCode::kUsage);
  options.topics = {"/wrench", "/wrench"};
  expect_words(
      {"names '/wrench' twice"}, [&] { table_of_bag(bag.bytes(), options); }, ExitCode::kUsage);
  options.topics = {"/wrench", "/tip"};
  options.positions_alone = true;
  expect_words(
      {"'/wrench' has forces, --tip-motion needs none"},
      [&] { table_of_bag(bag.bytes(), options); }, ExitCode::kUsage);
  options.positions_alone = false;
  expect_words({"no bag of ROS"}, [&] { table_of_bag("t,x\n0,1\n1,2\n", options); });
}

TEST(Bag, WhatCannotBeReadIsSaid) {
  const auto refused = [](const std::string& bytes, const std::vector<std::string>& words) {
    expect_words(words, [&] { table_of_bag(bytes); });
  };
  refused(usual().bytes("bz2"), {"compressed ('bz2')", "'rosbag decompress session.bag'"});
  refused(usual().bytes("none", 0), {"not closed", "'rosbag reindex session.bag'"});
  refused(usual().bytes("none", 4096, a_field("encryptor", "rosbag/AesCbcEncryptor")),
          {"encrypted", "rosbag decrypt"});
  refused("#ROSBAG V1.2\n", {"another version than 2.0", "rosbag reindex"});
  refused("#ROSBAG V2.0\n", {"cut off"});
  BagMaker two;
  two.topic("/a", "WrenchStamped");
  two.topic("/a", "PoseStamped");
  refused(two.bytes(), {"two types"});
  BagMaker other;
  other.topic("/scan", "LaserScan");
  refused(other.bytes(), {"no topic has stamped forces", "/scan (geometry_msgs/LaserScan)"});
  BagMaker apart;
  apart.message(apart.topic("/w", "WrenchStamped"), 0, stamped(1000, "", {0, 0, 0, 0, 0, 0}));
  apart.message(apart.topic("/p", "PointStamped"), 0, stamped(9000, "", {0, 0, 0}));
  refused(apart.bytes(), {"no force of /w falls between two positions of /p", "8 s later"});
  BagMaker crooked;
  crooked.message(crooked.topic("/w", "WrenchStamped"), 0, stamped(1000, "", {0, 0}));
  refused(crooked.bytes(), {"message 1 of '/w' has another length"});
  BagMaker orphan;
  orphan.message(3, 0, stamped(1000, "", {0, 0, 0}));
  refused(orphan.bytes(), {"damaged", "connection"});
}

// Wherever it is cut, and whatever byte is another one, there is one error or a table; never more.
TEST(Bag, DamagedOnesAreErrors) {
  const std::string small = usual().bytes();
  for (std::size_t length = 0; length < small.size(); ++length) {
    if (length < 13) continue;  // no longer a bag by its first line
    expect_words({"session.bag"}, [&] { table_of_bag(small.substr(0, length)); });
  }
  for (std::size_t i = 13; i < small.size(); ++i)
    for (const unsigned char bit : {0x01, 0x80, 0xff}) {
      std::string bytes = small;
      bytes[i] = static_cast<char>(static_cast<unsigned char>(bytes[i]) ^ bit);
      try {
        table_of_bag(bytes);
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::kBadInput) << i;
      }
    }
  const std::string bytes = recorded_bag();
  for (std::size_t length = 13; length < bytes.size(); length += 997)
    expect_words({}, [&] { table_of_bag(bytes.substr(0, length)); });
}

}  // namespace
}  // namespace hapsim::test
