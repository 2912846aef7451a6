#include "cli/parse.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "base/error.h"
#include "base/nearest.h"
#include "cli/check.h"
#include "cli/spec_text.h"

namespace hapsim {
namespace {

// What CLI11 found, before any check of ours.
struct Found {
  std::vector<std::vector<std::string>> values;  // for each flag of all_options()
  std::vector<std::string> inputs;
  std::vector<std::string> unknown;
};

[[noreturn]] void fail_value(const Option& option) {
  fail_usage(option.name() + " needs a value " + option.value, option.help);
}

Found find_all(const std::vector<Option>& options, const std::vector<std::string>& words) {
  Found found;
  found.values.resize(options.size());
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  for (std::size_t i = 0; i < options.size(); ++i) {
    const std::string name = short_flag(options[i].name()) + options[i].name();
    auto& values = found.values[i];
    const auto gather = [&values](const CLI::results_t& results) {
      values = results;
      return true;
    };
    if (options[i].kind() == OptionKind::kSwitch)
      app.add_flag_callback(name, [&values] { values = {"1"}; });
    else
      app.add_option(name, gather)->expected(1)->take_all()->allow_extra_args(false);
  }
  app.add_option("input", found.inputs)->expected(0, -1);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ArgumentMismatch&) {
    // Only the last word can lack its value.
    for (const Option& option : options)
      if (!words.empty() && is_flag(words.back(), option)) fail_value(option);
    fail_usage("a flag lacks its value", "see --help");
  } catch (const CLI::ParseError& error) {
    fail_usage(error.what(), "see --help");
  }
  found.unknown = app.remaining();
  std::erase(found.unknown, "--");
  return found;
}

[[noreturn]] void fail_unknown(const ToolSpec& spec, const std::string& word) {
  const std::string flag = word.substr(0, word.find('='));
  std::vector<std::string> names;
  for (const Option& option : all_options(spec)) names.push_back(option.name());
  const std::string near = nearest(flag, names);
  fail_usage("unknown flag '" + flag + "'",
             near.empty() ? spec.name + " --help lists the flags" : "did you mean '" + near + "'?");
}

// Commas in brackets and parentheses belong to what they stand in: E(1 mm, 2 mm) is one value.
std::vector<std::string> split_at_commas(const std::vector<std::string>& texts) {
  std::vector<std::string> parts;
  for (const std::string& text : texts) {
    parts.emplace_back();
    int depth = 0;
    for (const char c : text) {
      depth += c == '(' || c == '[' ? 1 : c == ')' || c == ']' ? -1 : 0;
      if (c == ',' && depth <= 0)
        parts.emplace_back();
      else
        parts.back() += c;
    }
  }
  return parts;
}

Arguments::Value make_value(const Option& option, std::vector<std::string> texts) {
  Arguments::Value value{option.name(), std::move(texts), false};
  value.given = !value.texts.empty();
  if (option.kind() == OptionKind::kSwitch) return value;
  if (!value.given && !option.default_text.empty()) value.texts = {option.default_text};
  if (!option.repeatable && value.texts.size() > 1)
    fail_usage(option.name() + " is given twice", "give it once");
  if (option.repeatable && option.kind() != OptionKind::kFile)
    value.texts = split_at_commas(value.texts);
  for (std::string& text : value.texts) {
    text = in_si(option, text);
    check_value(option, text);
  }
  return value;
}

// What CLI11 would take without a word: a flag as the value of another, a value for a switch.
void check_words(const std::vector<Option>& options, const std::vector<std::string>& words) {
  const auto is_any_flag = [&](const std::string& word) {
    const auto matches = [&](const Option& option) { return is_flag(word, option); };
    return word.starts_with("--") || std::any_of(options.begin(), options.end(), matches);
  };
  for (std::size_t i = 0; i < words.size() && words[i] != "--"; ++i)
    for (const Option& option : options) {
      if (option.kind() == OptionKind::kSwitch) {
        if (words[i].starts_with(option.name() + "="))
          fail_usage(option.name() + " takes no value", "leave out what follows it");
        continue;
      }
      const bool flag_follows = i + 1 < words.size() && is_any_flag(words[i + 1]);
      if (words[i] == option.name() + "=" || (is_flag(words[i], option) && flag_follows))
        fail_value(option);
    }
}

}  // namespace

CommandLine parse_command_line(const ToolSpec& spec, int argc, char** argv) {
  const std::vector<Option> options = all_options(spec);
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  CommandLine line;
  for (const std::string& word : words) {
    if (word == "--") break;
    if (word == "-h") line.request = Request::kShortHelp;
    if (word == "--help") line.request = Request::kHelp;
    if (word == "--man") line.request = Request::kMan;
    if (word == "--about") line.request = Request::kAbout;
    if (word == "-V" || word == "--version") line.request = Request::kVersion;
    for (const char* shell : {"bash", "zsh", "fish"})
      if (word == std::string("--completion-") + shell) {
        line.request = Request::kCompletion;
        line.shell = shell;
      }
    if (line.request == Request::kVersion)
      line.verbose = std::any_of(words.begin(), words.end(), [](const std::string& other) {
        return other == "-v" || other == "--verbose";
      });
    if (line.request != Request::kRun) return line;
  }
  if (std::erase(words, "--parsed") > 0) line.request = Request::kParsed;
  check_words(options, words);
  Found found = find_all(options, words);
  if (!found.unknown.empty()) fail_unknown(spec, found.unknown.front());

  Arguments& arguments = line.arguments;
  arguments.tool_ = spec.name;
  if (spec.input.empty() && !found.inputs.empty())
    fail_usage("'" + found.inputs[0] + "' is one argument too much",
               spec.name + " takes flags only");
  if (found.inputs.size() > 1)
    fail_usage("'" + found.inputs[1] + "' is one input too much",
               "there is one input; give others by their flags");
  arguments.input_given_ = !found.inputs.empty();
  if (arguments.input_given_) arguments.input_ = found.inputs[0];
  if (arguments.input_.empty()) fail_usage("the name of the input is empty", "name a file, or '-'");
  for (std::size_t i = 0; i < options.size(); ++i) {
    Arguments::Value value = make_value(options[i], std::move(found.values[i]));
    if (options[i].required && !value.given)
      fail_usage(options[i].name() + " is required", options[i].help);
    arguments.values_.push_back(std::move(value));
  }
  arguments.quiet_ = arguments[flag::quiet];
  arguments.verbose_ = arguments[flag::verbose];
  arguments.output_ = arguments[flag::output];
  if (arguments.quiet_ && arguments.verbose_)
    fail_usage("--quiet and --verbose contradict each other", "give one of them");
  return line;
}

}  // namespace hapsim
