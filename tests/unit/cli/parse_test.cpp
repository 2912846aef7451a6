#include "cli/parse.h"

#include <sstream>
#include <stdexcept>

#include "cli/help.h"
#include "expect_error.h"

namespace hapsim {
namespace {

ToolSpec sample() {
  ToolSpec spec;
  spec.name = "hs-parse";
  spec.summary = "a tool without an input";
  Option body{"--body", OptionKind::kFile, "FILE", "The body."};
  body.required = true;
  Option depths{"--depth", OptionKind::kNumber, "M", "Depths."};
  depths.repeatable = true;
  depths.default_text = "0.001,0.002";
  depths.minimum = 0;
  Option data{"--data", OptionKind::kFile, "FILE", "Recordings."};
  data.repeatable = true;
  spec.options = {body, depths, data};
  return spec;
}

Arguments parsed(const std::string& line) {
  std::istringstream stream("hs-parse " + line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  return parse_command_line(sample(), static_cast<int>(argv.size()), argv.data()).arguments;
}

using Texts = std::vector<std::string>;

TEST(Parse, RequiresWhatIsRequired) {
  EXPECT_EQ(error_of([] { parsed(""); }, ExitCode::kUsage), "--body is required; The body.");
  EXPECT_EQ(parsed("--body -").text("--body"), "-");
}

TEST(Parse, TakesNoInputWhereThereIsNone) {
  EXPECT_EQ(error_of([] { parsed("--body b.ply data.csv"); }, ExitCode::kUsage),
            "'data.csv' is one argument too much; hs-parse takes flags only");
}

TEST(Parse, SplitsListsButNotFileNames) {
  EXPECT_EQ(parsed("--body b").list("--depth"), (Texts{"0.001", "0.002"}));
  EXPECT_EQ(parsed("--body b --depth 1,2 --depth 3").list("--depth"), (Texts{"1", "2", "3"}));
  EXPECT_EQ(parsed("--body b --data a,b --data c").list("--data"), (Texts{"a,b", "c"}));
  EXPECT_EQ(error_of([] { parsed("--body b --depth 1,-2"); }, ExitCode::kUsage),
            "--depth is -2; give a number of at least 0");
}

TEST(Parse, TellsGivenFromDefault) {
  const Arguments arguments = parsed("--body b");
  EXPECT_TRUE(arguments.has("--depth"));
  EXPECT_FALSE(arguments.given("--depth"));
  EXPECT_FALSE(arguments.has("--data"));
  EXPECT_FALSE(arguments.given("--quiet"));
  EXPECT_EQ(arguments.output(), "-");
  EXPECT_EQ(arguments.text("--data"), "");
  EXPECT_THROW(arguments.number("--data"), std::logic_error);
  EXPECT_THROW(arguments.text("--bdy"), std::logic_error);
}

TEST(Parse, RefusesExtensionsThatAreNotWritten) {
  EXPECT_EQ(parsed("--body b -o forces.CSV").output(), "forces.CSV");
  for (const char* table : {"forces", "forces.new", "forces.2"})
    EXPECT_EQ(parsed(std::string("--body b -o ") + table).output(), table);
  EXPECT_EQ(error_of([] { parsed("--body b -o forces.ply"); }, ExitCode::kUsage),
            "--output is 'forces.ply', and this is not written as .ply; end the name in .csv, .txt "
            "or .dat");
}

TEST(Parse, HelpWinsOverErrors) {
  std::vector<std::string> words{"hs-parse", "--nonsense", "--help"};
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  EXPECT_EQ(parse_command_line(sample(), 3, argv.data()).request, Request::kHelp);
}

TEST(Help, ShowsRequiredFlagsInTheUsage) {
  const std::string help = help_text(sample());
  EXPECT_NE(help.find("Usage: hs-parse [OPTIONS] --body FILE\n"), std::string::npos) << help;
  EXPECT_EQ(help.find("Input:"), std::string::npos);
  EXPECT_EQ(help.find("Examples:"), std::string::npos);
}

}  // namespace
}  // namespace hapsim
