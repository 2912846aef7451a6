#include "tables/bag_records.h"

#include <fmt/format.h>

#include <map>

#include "base/error.h"
#include "base/shell_words.h"
#include "io/number.h"

namespace hapsim {
namespace {

constexpr std::string_view kBagMagic = "#ROSBAG V2.0\n";

enum BagOp : unsigned char {
  kBagMessage = 2,
  kBagHeader = 3,
  kBagIndex = 4,
  kBagChunk = 5,
  kBagChunkInfo = 6,
  kBagConnection = 7
};

std::uint64_t little_endian(std::string_view bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;)
    value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

using BagFields = std::map<std::string_view, std::string_view>;

struct BagRecord {
  BagFields fields;
  std::string_view data;
  std::size_t at = 0;  // in the file
};

class BagReader {
 public:
  BagReader(std::string_view bytes, const std::string& name)
      : bytes_(bytes), name_(name), file_(name == "stdin" ? "FILE" : shell_quoted(name)) {}

  std::vector<BagTopic> read() {
    check_version();
    std::size_t at = kBagMagic.size();
    if (at == bytes_.size()) cut(at);
    read_header(next(bytes_, at, 0));
    while (at < bytes_.size()) {
      const BagRecord record = next(bytes_, at, 0);
      switch (op(record)) {
        case kBagChunk:
          read_chunk(record);
          break;
        case kBagConnection:
          read_connection(record);
          break;
        case kBagMessage:
          read_message(record);
          break;
        case kBagIndex:
          break;
        case kBagChunkInfo:
          ++indexed_;
          break;
        default:
          damaged(record, "it is of no kind that a bag has there");
      }
    }
    // The index stands at the end: a part of it for every chunk.
    if (chunks_ != chunks_told_ || indexed_ != chunks_told_ ||
        topic_of_.size() != connections_told_)
      fail_input(
          name_,
          fmt::format("the bag is cut off: it says that it has {} chunks and {} connections, "
                      "and has {}, {} of them in its index, and {}",
                      chunks_told_, connections_told_, chunks_, indexed_, topic_of_.size()),
          reindex());
    return std::move(topics_);
  }

 private:
  std::string reindex() const { return "'rosbag reindex " + file_ + "' keeps what is whole"; }
  [[noreturn]] void cut(std::size_t at) const {
    fail_input(name_, fmt::format("the bag is cut off: the record at byte {} does not end", at),
               reindex());
  }
  [[noreturn]] void damaged(const BagRecord& record, const std::string& what) const {
    fail_input(name_, fmt::format("the record at byte {} is damaged: {}", record.at, what),
               "copy the bag again, or " + reindex());
  }

  void check_version() const {
    if (bytes_.substr(0, kBagMagic.size()) == kBagMagic) return;
    const std::string_view line = bytes_.substr(0, std::min<std::size_t>(bytes_.find('\n'), 40));
    fail_input(name_, shown(std::string(line)) + " is a bag of another version than 2.0",
               "'rosbag reindex " + file_ + "' writes it as 2.0");
  }

  // The length before a part that ends within `bytes`, and that part; `at` goes behind it.
  std::string_view part(std::string_view bytes, std::size_t& at, const BagRecord& record) const {
    if (bytes.size() - at < 4) cut(record.at);
    const std::size_t length = little_endian(bytes.substr(at, 4));
    if (bytes.size() - at - 4 < length) cut(record.at);
    at += 4 + length;
    return bytes.substr(at - length, length);
  }

  BagFields fields_of(std::string_view header, const BagRecord& record) const {
    BagFields fields;
    for (std::size_t at = 0; at < header.size();) {
      const std::size_t left = header.size() - at;
      const std::size_t length = left < 4 ? left : little_endian(header.substr(at, 4));
      if (left < 4 || left - 4 < length) damaged(record, "a field is longer than its header");
      const std::string_view field = header.substr(at + 4, length);
      const std::size_t equals = field.find('=');
      if (equals == field.npos) damaged(record, "a field has no name");
      fields[field.substr(0, equals)] = field.substr(equals + 1);
      at += 4 + length;
    }
    return fields;
  }

  // The record at `at` of `bytes`, which begin at `base` of the file.
  BagRecord next(std::string_view bytes, std::size_t& at, std::size_t base) const {
    BagRecord record;
    record.at = base + at;
    const std::string_view header = part(bytes, at, record);
    record.data = part(bytes, at, record);
    record.fields = fields_of(header, record);
    return record;
  }

  std::string_view field(const BagRecord& record, std::string_view key) const {
    const auto found = record.fields.find(key);
    if (found == record.fields.end()) damaged(record, "it has no field '" + std::string(key) + "'");
    return found->second;
  }
  std::uint64_t number(const BagRecord& record, std::string_view key, std::size_t size) const {
    const std::string_view value = field(record, key);
    if (value.size() != size)
      damaged(record, "its field '" + std::string(key) + "' has another length");
    return little_endian(value);
  }
  std::uint64_t op(const BagRecord& record) const { return number(record, "op", 1); }

  void read_header(const BagRecord& record) {
    if (op(record) != kBagHeader) damaged(record, "it should be the header of the bag");
    const auto encryptor = record.fields.find("encryptor");
    if (encryptor != record.fields.end() && !encryptor->second.empty())
      fail_input(name_, "the bag is encrypted",
                 "'rosbag decrypt " + file_ + "' writes it in the open");
    if (number(record, "index_pos", 8) == 0)
      fail_input(name_, "the bag was not closed: its recording goes on or was broken off",
                 reindex());
    chunks_told_ = number(record, "chunk_count", 4);
    connections_told_ = number(record, "conn_count", 4);
  }

  void read_chunk(const BagRecord& chunk) {
    const std::string_view compression = field(chunk, "compression");
    if (compression != "none")
      fail_input(name_, "the bag is compressed (" + shown(std::string(compression)) + ")",
                 "run 'rosbag decompress " + file_ + "' first");
    if (number(chunk, "size", 4) != chunk.data.size()) damaged(chunk, "its two lengths differ");
    ++chunks_;
    const std::size_t base = static_cast<std::size_t>(chunk.data.data() - bytes_.data());
    for (std::size_t at = 0; at < chunk.data.size();) {
      const BagRecord record = next(chunk.data, at, base);
      switch (op(record)) {
        case kBagConnection:
          read_connection(record);
          break;
        case kBagMessage:
          read_message(record);
          break;
        default:
          damaged(record, "it is of no kind that a chunk has");
      }
    }
  }

  // Stands in a chunk and, once more, in the index.
  void read_connection(const BagRecord& record) {
    const std::uint64_t id = number(record, "conn", 4);
    const std::string topic(field(record, "topic"));
    BagRecord inner{fields_of(record.data, record), {}, record.at};
    const std::string type(field(inner, "type"));
    std::size_t i = 0;
    while (i < topics_.size() && topics_[i].topic != topic) ++i;
    if (i == topics_.size()) topics_.push_back({topic, type, {}});
    if (topics_[i].type != type)
      fail_input(name_,
                 "the topic " + shown(topic) + " is of two types: " + shown(topics_[i].type) +
                     " and " + shown(type),
                 "record it again with one of them");
    topic_of_[id] = i;
  }

  void read_message(const BagRecord& record) {
    const auto topic = topic_of_.find(number(record, "conn", 4));
    if (topic == topic_of_.end())
      damaged(record, "it is of a connection that does not stand before it");
    const std::uint64_t time = number(record, "time", 8);
    const auto seconds = static_cast<std::int64_t>(time & 0xffffffffu);
    topics_[topic->second].messages.push_back(
        {seconds * 1000000000 + static_cast<std::int64_t>(time >> 32), record.data});
  }

  std::string_view bytes_;
  const std::string& name_;
  const std::string file_;  // in a command
  std::vector<BagTopic> topics_;
  std::map<std::uint64_t, std::size_t> topic_of_;  // of a connection
  std::uint64_t chunks_ = 0, indexed_ = 0, chunks_told_ = 0, connections_told_ = 0;
};

}  // namespace

bool is_bag(std::string_view bytes) {
  return bytes.rfind("#ROSBAG V", 0) == 0 || bytes.rfind("#ROSRECORD V", 0) == 0;
}

std::vector<BagTopic> read_bag(std::string_view bytes, const std::string& name) {
  return BagReader(bytes, name).read();
}

}  // namespace hapsim
