// `# key: value` lines of a CSV file and the like: kept in order and carried through.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hapsim {

class Metadata {
 public:
  // The value of the last line with that key.
  std::optional<std::string> find(const std::string& key) const;
  // The value as a number; throws Error(kBadInput, where) when it is not one.
  std::optional<double> number(const std::string& key, const std::string& where) const;
  void set(const std::string& key, const std::string& value);     // replaces, or appends
  void append(const std::string& key, const std::string& value);  // keeps equal keys before it
  void remove(const std::string& key);
  void add_comment(const std::string& text);  // a `#` line that is not `key: value`
  // What follows the `#` of a line: `key: value` (a word, a colon, a space) or a plain comment.
  void add_line(std::string_view text);

  struct Line {
    std::string key;  // empty: a plain comment
    std::string value;
  };
  const std::vector<Line>& lines() const { return lines_; }

 private:
  std::vector<Line> lines_;
};

}  // namespace hapsim
