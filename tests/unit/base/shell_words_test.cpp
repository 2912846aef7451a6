#include "base/shell_words.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <memory>

#include "base/random.h"
#include "expect_error.h"

namespace hapsim {
namespace {

using Words = std::vector<std::string>;

TEST(ShellWords, AreTakenApartAsAShellDoes) {
  EXPECT_EQ(split_words("--fix nu=0.4  -o\t'a b'", "x"), (Words{"--fix", "nu=0.4", "-o", "a b"}));
  EXPECT_EQ(split_words("a\\ b \"c\\\"d\" 'e\\' f''g \"\"", "x"),
            (Words{"a b", "c\"d", "e\\", "fg", ""}));
  EXPECT_EQ(split_words("$HOME * `x`", "x"), (Words{"$HOME", "*", "`x`"}));
  EXPECT_TRUE(split_words(" \t ", "x").empty());
  EXPECT_NE(error_of([] { split_words("a 'b", "m.csv:3"); }).find("m.csv:3: a quote (') opens"),
            std::string::npos);
}

TEST(ShellWords, PlainOnesStayPlain) {
  EXPECT_EQ(shell_line({"hs-identify", "data/a_1.csv", "--fix=nu=0.4"}),
            "hs-identify data/a_1.csv --fix=nu=0.4");
  EXPECT_EQ(shell_quoted(""), "''");
  EXPECT_EQ(shell_quoted("it's"), "'it'\\''s'");
}

// What is quoted comes back, from our own reading and from a real shell.
TEST(ShellWords, QuotedOnesComeBack) {
  constexpr std::string_view kLetters = "ab '\"\\$`*?!#~;&|<>(){}[]=:\t\n";
  Random random(3);
  for (int trial = 0; trial < 60; ++trial) {
    Words words(1 + random.integer(4));
    std::string wanted;
    for (std::string& word : words) {
      for (std::uint64_t n = random.integer(9); n > 0; --n)
        word += kLetters[random.integer(kLetters.size())];
      wanted += "<" + word + ">";
    }
    EXPECT_EQ(split_words(shell_line(words), "x"), words) << shell_line(words);
    const std::string command = "printf '<%s>' " + shell_line(words);
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    ASSERT_TRUE(pipe != nullptr);
    std::string got;
    for (std::array<char, 256> block{};;) {
      const std::size_t n = std::fread(block.data(), 1, block.size(), pipe.get());
      if (n == 0) break;
      got.append(block.data(), n);
    }
    EXPECT_EQ(got, wanted) << command;
  }
}

}  // namespace
}  // namespace hapsim
