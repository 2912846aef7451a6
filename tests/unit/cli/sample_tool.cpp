// A small tool with every kind of flag, for the tests of the command line and of the output.
#include <unistd.h>

#include <chrono>
#include <new>
#include <optional>
#include <stdexcept>
#include <thread>

#include "base/error.h"
#include "cli/tool.h"
#include "io/stream.h"

namespace {

namespace flag {
constexpr hapsim::ChoiceFlag unit{"--unit"};
constexpr hapsim::NumberFlag ratio{"--ratio"};
constexpr hapsim::IntegerFlag threads{"--threads"};
constexpr hapsim::TextFlag effects{"--effects"};
constexpr hapsim::FileFlag other{"--other"};
constexpr hapsim::SwitchFlag echo{"--echo"};
constexpr hapsim::ChoiceFlag act{"--act"};
}  // namespace flag

hapsim::ToolSpec specification() {
  hapsim::ToolSpec spec;
  spec.name = "hs-sample";
  spec.summary = "copy the input, for tests";
  spec.input = "Any bytes";
  spec.description = {
      "Copies its input to its output. A paragraph that is long enough to be wrapped by the help, "
      "which must not exceed eighty columns even where words are long.",
      ".A second paragraph, which begins with a dot and holds a back\\slash and a \xc2\xb5."};
  hapsim::Option unit{flag::unit, "UNIT", "Unit of lengths."};
  unit.default_text = "m";
  unit.choices = {"m", "mm", "cm"};
  hapsim::Option ratio{flag::ratio, "R", "Poisson's ratio"};
  ratio.minimum = -1;
  ratio.maximum = 0.5;
  hapsim::Option threads{flag::threads, "N", "Number of threads."};
  threads.default_text = "1";
  threads.minimum = 1;
  hapsim::Option effects{flag::effects, "NAMES", "Effects."};
  effects.repeatable = true;
  hapsim::Option other{flag::other, "FILE", "Another output, written first."};
  other.writes = hapsim::kTableExtensions;
  hapsim::Option echo{flag::echo, "", "Print the arguments instead."};
  hapsim::Option act{flag::act, "WHAT", "Misbehave."};
  act.choices = {"throw", "memory", "wait", "check", "flood", "progress", "states", "error"};
  spec.options = {unit, ratio, threads, effects, other, echo, act};
  spec.tables = {{"Columns of the result", {{"x", "position [m]"}, {"y", "another [m]"}}}};
  spec.examples = {{"hs-sample data.csv -o copy.csv", "Copies a file."}};
  spec.see_also = {"hs-compare(1)", "hs-simulate(1)"};
  return spec;
}

void echo(const hapsim::Arguments& arguments, std::ostream& out) {
  out << "input=" << arguments.input() << " output=" << arguments.output()
      << " unit=" << arguments[flag::unit] << " threads=" << arguments[flag::threads];
  if (arguments.has(flag::ratio)) out << " ratio=" << arguments[flag::ratio];
  for (const std::string& name : arguments.list(flag::effects)) out << " effect=" << name;
  out << " given=" << arguments.given(flag::unit) << '\n';
}

int act(const std::string& what, const hapsim::Arguments& arguments, hapsim::Output& out) {
  if (what == "throw") throw std::runtime_error("a\nbug");
  if (what == "memory") throw std::bad_alloc();
  if (what == "check") return 1;
  if (what == "error") hapsim::fail_input("data.csv:17", "a bad \033[31mcell", "mend it");
  if (what == "flood")
    for (int i = 0; i < 1000000; ++i) out.stream() << "a line of some length\n";
  if (what == "wait") {
    out.stream() << "half" << std::flush;
    hapsim::say(arguments, "hs-sample", "waiting");
    pause();  // until a signal ends it
  }
  if (what == "progress") {
    hapsim::Progress progress(arguments, "steps", 40);
    for (int i = 0; i < 40; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      progress.step();
    }
  }
  if (what == "states") {
    const auto a_while = [] { std::this_thread::sleep_for(std::chrono::milliseconds(250)); };
    hapsim::Progress progress(arguments, "", 8);
    progress.show("testing friction", 2, 31);
    progress.show("testing friction", 3, 31);
    a_while();
    hapsim::say(arguments, "said");
    progress.show("");
    progress.step();
    progress.running("cycles auto");
    a_while();
  }
  out.commit();
  return 0;
}

int run(const hapsim::Arguments& arguments) {
  std::optional<hapsim::Output> other;
  if (arguments.has(flag::other)) {
    other.emplace(arguments[flag::other]);
    other->write("other\n");
  }
  hapsim::Output out(arguments.output());
  if (arguments.has(flag::act)) return act(arguments[flag::act], arguments, out);
  if (arguments[flag::echo])
    echo(arguments, out.stream());
  else
    out.write(hapsim::Input(arguments.input()).read_all());
  out.commit();
  if (other) other->commit();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return hapsim::run_tool(specification(), argc, argv, run);
}
