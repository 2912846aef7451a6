#include "cli/parse.h"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "cli/completion.h"
#include "cli/help.h"
#include "expect_error.h"

namespace hapsim {
namespace {

namespace flag {
constexpr FileFlag body{"--body"};
constexpr NumberFlag depth{"--depth"};
constexpr LengthFlag edge{"--edge"};
constexpr TimesFlag times{"--times"};
constexpr PoseFlag mount{"--mount"};
constexpr FileFlag data{"--data"};
}  // namespace flag

ToolSpec sample() {
  ToolSpec spec;
  spec.name = "hs-parse";
  spec.summary = "a tool without an input";
  Option body{flag::body, "FILE", "The body."};
  body.required = true;
  Option depths{flag::depth, "M", "Depths."};
  depths.repeatable = true;
  depths.default_text = "0.001,0.002";
  depths.minimum = 0;
  Option edge{flag::edge, "M", "An edge."};
  edge.minimum = 1e-6;
  edge.maximum = 1;
  Option times{flag::times, "LIST", "Windows."};
  times.repeatable = true;
  Option mount{flag::mount, "X,Y,Z[,R,P,Y]", "A place."};
  Option data{flag::data, "FILE", "Recordings."};
  data.repeatable = true;
  spec.options = {body, depths, edge, times, mount, data};
  return spec;
}

// Words parted by spaces; _ is a space within one.
Arguments parsed(const std::string& line) {
  std::istringstream stream("hs-parse " + line);
  std::vector<std::string> words;
  for (std::string word; stream >> word;) {
    std::replace(word.begin(), word.end(), '_', ' ');
    words.push_back(word);
  }
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  return parse_command_line(sample(), static_cast<int>(argv.size()), argv.data()).arguments;
}

using Texts = std::vector<std::string>;

TEST(Parse, RequiresWhatIsRequired) {
  EXPECT_EQ(error_of([] { parsed(""); }, ExitCode::kUsage), "--body is required; The body.");
  EXPECT_EQ(parsed("--body -")[flag::body], "-");
}

TEST(Parse, TakesNoInputWhereThereIsNone) {
  EXPECT_EQ(error_of([] { parsed("--body b.ply data.csv"); }, ExitCode::kUsage),
            "'data.csv' is one argument too much; hs-parse takes flags only");
}

TEST(Parse, SplitsListsButNotFileNames) {
  EXPECT_EQ(parsed("--body b").list(flag::depth), (Texts{"0.001", "0.002"}));
  EXPECT_EQ(parsed("--body b --depth 1,2 --depth 3").list(flag::depth), (Texts{"1", "2", "3"}));
  EXPECT_EQ(parsed("--body b --data a,b --data c").list(flag::data), (Texts{"a,b", "c"}));
  EXPECT_EQ(error_of([] { parsed("--body b --depth 1,-2"); }, ExitCode::kUsage),
            "--depth is -2; give a number of at least 0");
}

TEST(Parse, QuantitiesAreToldInSi) {
  for (const char* text : {"0.004", "4mm", "4_mm", "0.004_m", "0.4cm"})
    EXPECT_EQ(parsed(std::string("--body b --edge ") + text)[flag::edge], 0.004) << text;
  EXPECT_EQ(parsed("--body b --edge 4mm").text(flag::edge), "0.004");
  EXPECT_EQ(parsed("--body b --edge 4.0e-3").text(flag::edge), "4.0e-3");  // as it was given
  EXPECT_EQ(parsed("--body b --times 50ms:1s,2:30").list(flag::times), (Texts{"0.05:1", "2:30"}));
  EXPECT_EQ(parsed("--body b --mount 1,2,3mm,0,0,180deg")[flag::mount],
            "0.001,0.002,0.003,0,0,3.141592653589793");
  EXPECT_EQ(parsed("--body b --mount=-5mm,0,0")[flag::mount], "-0.005,0,0");
}

TEST(Parse, QuantitiesOutOfBoundsOrOfAnotherKindAreRefused) {
  const auto failure = [](const std::string& text) {
    return error_of([&] { parsed("--body b --edge " + text); }, ExitCode::kUsage);
  };
  EXPECT_EQ(failure("4000mm"), "--edge is 4; give a number from 1e-06 to 1 m");
  EXPECT_EQ(failure("4"), "--edge is 4; give a number from 1e-06 to 1 m");
  EXPECT_EQ(failure("4N"), "--edge: unknown unit 'N'; use one of: m mm cm um in");
  EXPECT_EQ(failure("wide"), "--edge: 'wide' is no length; write for example 0.004 or 4mm");
}

TEST(Parse, TellsGivenFromDefault) {
  const Arguments arguments = parsed("--body b");
  EXPECT_TRUE(arguments.has(flag::depth));
  EXPECT_FALSE(arguments.given(flag::depth));
  EXPECT_FALSE(arguments.has(flag::data));
  EXPECT_FALSE(arguments[hapsim::flag::quiet]);
  EXPECT_EQ(arguments.output(), "-");
  EXPECT_EQ(arguments[flag::data], "");
  EXPECT_THROW(arguments[flag::edge], std::logic_error);
  EXPECT_THROW(arguments[TextFlag("--bdy")], std::logic_error);
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
  EXPECT_NE(help.find("An edge. A length from 1e-06 to 1 m, as 0.004 or 4mm."), std::string::npos)
      << help;
  EXPECT_EQ(help.find("Input:"), std::string::npos);
  EXPECT_EQ(help.find("Examples:"), std::string::npos);
}

// Options of one group stand together wherever they were declared, "General" last.
TEST(Help, ShowsGroups) {
  ToolSpec spec = sample();
  const char* const groups[] = {"Input", "General", "Mesh", "Output", "Input", "Mesh"};
  ASSERT_EQ(spec.options.size(), std::size(groups));
  for (std::size_t i = 0; i < std::size(groups); ++i) spec.options[i].group = groups[i];
  const std::string help = help_text(spec);
  std::size_t at = 0;
  for (const char* part : {"\nOptions, Input:\n", "--body FILE", "--mount X", "\nOptions, Mesh:\n",
                           "--edge M", "--data FILE", "\nOptions, Output:\n", "--times LIST",
                           "--output FILE", "\nOptions, General:\n", "--depth M", "--quiet"}) {
    const std::size_t found = help.find(part, at);
    ASSERT_NE(found, std::string::npos) << part << help;
    at = found;
  }
  const std::string page = man_page(spec);
  for (const char* part : {".SH OPTIONS\n.SS Input\n", ".SS Mesh\n", ".SS General\n"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  for (const char* shell : {"bash", "zsh", "fish"})
    EXPECT_NE(completion(spec, shell).find("mount"), std::string::npos) << shell;
  EXPECT_EQ(help_text(sample()).find("Options, "), std::string::npos);
  EXPECT_NE(help_text(sample()).find("\nOptions:\n"), std::string::npos);
}

}  // namespace
}  // namespace hapsim
