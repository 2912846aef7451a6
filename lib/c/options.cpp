#include "c/options.h"

#include <thread>

#include "base/error.h"
#include "c/handles.h"
#include "cli/parse.h"

namespace hapsim {
namespace {

thread_local std::string message;

// "--fix=nu=0.45"; of a switch its name alone, or nothing where it is false.
void add_word(const std::vector<Option>& known, const std::string& name, const std::string& value,
              std::vector<std::string>& words) {
  const std::string flag = "--" + name;
  for (const Option& option : known) {
    if (option.name() != flag || option.kind() != OptionKind::kSwitch) continue;
    if (value == "true") words.push_back(flag);
    if (value != "true" && value != "false")
      fail_usage(flag + " is '" + value + "'", "give true or false");
    return;
  }
  words.push_back(flag + "=" + value);
}

}  // namespace

hs_status tell_failure(const Failure& failure) noexcept {
  try {
    message = failure.words;
  } catch (...) {
    message.clear();
  }
  return static_cast<hs_status>(failure.code);
}

Asked::Asked(const std::string& tool, std::vector<Option> known, const hs_options* options) {
  if (options != nullptr) listener_ = *options;
  ToolSpec spec;
  spec.name = tool;
  spec.options = std::move(known);
  std::vector<std::string> words{tool};
  for (const auto& [name, value] : listener_.values) add_word(spec.options, name, value, words);
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  const CommandLine line = parse_command_line(spec, static_cast<int>(argv.size()), argv.data());
  if (line.request != Request::kRun)
    fail_usage("help and version are of the command line", "see " + tool + "(1)");
  arguments_ = line.arguments;
}

std::function<void(const std::string&)> Asked::say() const {
  return [say = listener_.say, context = listener_.context](const std::string& words) {
    if (say != nullptr) say(context, words.c_str());
  };
}

std::function<bool()> Asked::stop() const {
  return [stop = listener_.stop, context = listener_.context, stopped = false,
          thread = std::this_thread::get_id()]() mutable {
    if (!stopped && stop != nullptr && std::this_thread::get_id() == thread)
      stopped = stop(context) != 0;
    return stopped;
  };
}

std::function<void()> Asked::end_if_stopped() const {
  return [stop = stop()] {
    if (stop()) fail_numerics("", "it was stopped", "let it go on to the end");
  };
}

}  // namespace hapsim

using namespace hapsim;

const char* hs_version(void) {
  static const std::string text = version();
  return text.c_str();
}

int hs_interface(void) {
  return HS_INTERFACE;
}

const char* hs_message(void) {
  return message.c_str();
}

hs_status hs_options_new(hs_options** options) {
  return made(options, [] { return std::make_unique<hs_options>(); });
}

void hs_options_free(hs_options* options) {
  delete options;
}

hs_status hs_options_set(hs_options* options, const char* name, const char* value) {
  return guarded([&] { options->values.emplace_back(name, value); });
}

void hs_options_listen(hs_options* options, void (*say)(void*, const char*), int (*stop)(void*),
                       void* context) {
  options->say = say;
  options->stop = stop;
  options->context = context;
}
