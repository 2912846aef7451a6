// Words and numbers of a text file, with the line in every error.
#pragma once

#include <string>
#include <string_view>

namespace hapsim {

// Words of a text file with the line they stand in.
class TextScanner {
 public:
  TextScanner(std::string_view text, const std::string& name, char comment = '\0')
      : rest_(text), name_(name), comment_(comment) {}
  bool done();              // nothing but blanks and comments is left
  std::string_view word();  // "" at the end
  std::string_view line();  // the rest of the line, without its newline
  double number(const char* what);
  // So many bytes as they are, from where the last word or line ended; lines are not counted in
  // them. `what` begins the message.
  std::string_view bytes(const char* what, std::size_t count);
  // A whole number within [low, high]; `what` begins the message.
  long integer(const char* what, long low, long high);
  // A count of things that take at least `bytes` bytes each in what is left.
  std::size_t count(const char* what, std::size_t bytes);
  long line_number() const { return line_; }
  std::string where() const { return name_ + ":" + std::to_string(line_); }
  [[noreturn]] void fail(const std::string& wrong) const;

 private:
  void skip();
  std::string_view rest_;
  const std::string& name_;
  char comment_;
  long line_ = 1;
};

}  // namespace hapsim
