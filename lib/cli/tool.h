// A command: its specification as data, from which parsing, --help and the man page all come.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "cli/flag.h"
#include "cli/progress.h"

namespace hapsim {

// Extensions of tables: CSV, also under the names of plain text.
inline const std::vector<std::string> kTableExtensions{"csv", "txt", "dat"};

// One long flag. Every tool also has -o/--output, -q/--quiet, -v/--verbose, -h/--help,
// -V/--version, which run_tool adds.
struct Option {
  AnyFlag flag = {};
  std::string value = {};  // name of the value in the help: "UNIT"
  std::string help = {};   // one or two sentences
  std::string group = {};  // heading of --help and man page that it stands under; "" for none
  // kFile that is written: the extensions of what it may be. One that promises another format, as
  // "ply" does of a table, is refused before the work.
  std::vector<std::string> writes = {};
  std::string default_text = {};          // value when not given, "" for none
  std::vector<std::string> choices = {};  // kChoice
  double minimum = -1e300;                // of one number: checked bounds (SI)
  double maximum = 1e300;
  bool required = false;
  // Values gathered in order; also split at commas (kFile is not: names may hold commas).
  bool repeatable = false;

  std::string name() const { return flag.name; }
  OptionKind kind() const { return flag.kind; }
};

struct Example {
  std::string command = {};
  std::string explanation = {};
};

// What a tool is for: the headings under which hs lists them.
enum class Task { kBody, kRecording, kModel, kForces, kMany };

struct ToolSpec {
  std::string name = {};  // "hs-identify"
  Task task = Task::kBody;
  std::string summary = {};  // one line
  std::string input = {};    // what the positional argument is; "" when there is none
  std::vector<std::string> description = {};  // paragraphs; plain text
  std::vector<Option> options = {};
  std::vector<std::pair<std::string, std::vector<std::pair<std::string, std::string>>>> tables =
      {};  // documented columns: title, then (column, meaning)
  // Of --output, as Option::writes; where there are several formats the extension says which.
  std::vector<std::string> writes = kTableExtensions;
  std::vector<Example> examples = {};
  std::vector<std::string> see_also = {};  // "hs-compare(1)"
  bool input_optional = false;  // without the positional argument, standard input is not read
};

// The parsed command line. Asking for a flag that the specification lacks is our own bug
// (std::logic_error).
class Arguments {
 public:
  bool input_given() const { return input_given_; }
  const std::string& input() const { return input_; }    // "-" when absent
  const std::string& output() const { return output_; }  // "-" when absent
  const std::string& tool() const { return tool_; }
  bool quiet() const { return quiet_; }
  bool verbose() const { return verbose_; }
  bool given(const AnyFlag& flag) const;  // on the command line
  bool has(const AnyFlag& flag) const;    // given, or has a default
  // The value, or the default. Of text: "" when there is neither; of a number, checked finite and
  // within bounds: it must have one, unless has() was asked.
  template <OptionKind kKind>
  typename Flag<kKind>::Value operator[](const Flag<kKind>& flag) const {
    if constexpr (kKind == OptionKind::kSwitch)
      return given(flag);
    else if constexpr (std::is_same_v<typename Flag<kKind>::Value, std::string>)
      return text(flag);
    else
      return static_cast<typename Flag<kKind>::Value>(number(flag));
  }
  // Of any kind, as it was written (a quantity in SI).
  std::string text(const AnyFlag& flag) const;
  std::vector<std::string> list(const AnyFlag& flag) const;

  struct Value {
    std::string flag;
    std::vector<std::string> texts;
    bool given = false;
  };
  std::string tool_;
  std::string input_ = "-";
  std::string output_ = "-";
  bool input_given_ = false;
  bool quiet_ = false;
  bool verbose_ = false;
  std::vector<Value> values_;

 private:
  const Value& value(const AnyFlag& flag) const;
  double number(const AnyFlag& flag) const;
};

// A line of summary for people on standard error, unless --quiet: "hs-identify: text".
void say(const Arguments& arguments, const std::string& tool, const std::string& text);
// The same, of the tool that runs.
void say(const Arguments& arguments, const std::string& text);
// The same, --quiet or not: why a check failed.
void tell(const std::string& tool, const std::string& text);
// Whether the result goes out: a terminal gets a table only where -o - asks for it.
bool result_is_wanted(const Arguments& arguments);
// The output, or nowhere where the result is not wanted.
std::string result_file(const Arguments& arguments);
// Whether standard error is a terminal that shows colours, and NO_COLOR is not set.
bool colourful();

// Version of hapsim, "0.1.0".
std::string version();

// main() of every tool: parses, runs, catches, maps to the exit code. `--man` prints the man page.
// A closed pipe ends it silently; signals leave no temporary file behind.
int run_tool(const ToolSpec& spec, int argc, char** argv,
             const std::function<int(const Arguments&)>& run);

}  // namespace hapsim
