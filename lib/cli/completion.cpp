#include "cli/completion.h"

#include <stdexcept>

#include "cli/spec_text.h"

namespace hapsim {
namespace {

std::string begin(const ToolSpec& spec) {
  return "# Completion of " + spec.name + ", from its own specification.\n";
}

// Up to the first full stop that ends a sentence, for a list of flags is narrow.
std::string brief(const std::string& text) {
  return text.substr(0, text.find(". "));
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

// Inside single quotes of bash and zsh.
std::string quoted(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return "'" + result + "'";
}

// "-o" of "--output", "" without a short form.
std::string letter(const Option& option) {
  return short_flag(option.name()).substr(0, 2);
}

std::string bash(const ToolSpec& spec) {
  std::string flags, cases;
  for (const Option& option : all_options(spec)) {
    const std::string brief_flag = letter(option);
    flags += (flags.empty() ? "" : " ") + option.name();
    if (!brief_flag.empty()) flags += " " + brief_flag;
    if (option.kind() == OptionKind::kSwitch) continue;
    const std::string pattern =
        "    " + option.name() + (brief_flag.empty() ? "" : " | " + brief_flag) + ") ";
    if (option.kind() == OptionKind::kChoice)
      cases += pattern + "COMPREPLY=($(compgen -W " + quoted(joined(option.choices)) +
               " -- \"$word\")); return ;;\n";
    else if (option.kind() == OptionKind::kFile)
      cases += pattern + "return ;;\n";  // readline completes files
    else
      cases += pattern + "compopt +o default; return ;;\n";
  }
  std::string function = "_" + spec.name;
  for (char& c : function)
    if (c == '-') c = '_';
  return begin(spec) + function + "() {\n  local word=${COMP_WORDS[COMP_CWORD]}\n  COMPREPLY=()\n" +
         "  case ${COMP_WORDS[COMP_CWORD - 1]} in\n" + cases + "  esac\n" +
         "  [[ $word != -* ]] || COMPREPLY=($(compgen -W " + quoted(flags) +
         " -- \"$word\"))\n}\ncomplete -o default -F " + function + " " + spec.name + "\n";
}

// Text in [...] and between colons of a specification of _arguments.
std::string zsh_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

std::string zsh(const ToolSpec& spec) {
  std::string text = "#compdef " + spec.name + "\n" + begin(spec) + "_arguments -s -S";
  for (const Option& option : all_options(spec)) {
    std::string rest = "[" + zsh_text(brief(option.help)) + "]";
    if (option.kind() != OptionKind::kSwitch) rest += ":" + zsh_text(option.value) + ":";
    if (option.kind() == OptionKind::kChoice) rest += "(" + joined(option.choices) + ")";
    if (option.kind() == OptionKind::kFile) rest += "_files";
    const std::string brief_flag = letter(option);
    text += " \\\n  ";
    if (option.repeatable)
      text += quoted("*" + option.name() + rest);
    else if (brief_flag.empty())
      text += quoted(option.name() + rest);
    else
      text += quoted("(" + brief_flag + " " + option.name() + ")") + "{" + brief_flag + "," +
              option.name() + "}" + quoted(rest);
  }
  if (!spec.input.empty())
    text += " \\\n  " + quoted("::" + zsh_text(brief(spec.input)) + ":_files");
  return text + "\n";
}

std::string fish_quoted(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '\'' || c == '\\') result += '\\';
    result += c;
  }
  return "'" + result + "'";
}

std::string fish(const ToolSpec& spec) {
  std::string text = begin(spec);
  if (spec.input.empty()) text += "complete -c " + spec.name + " -f\n";
  for (const Option& option : all_options(spec)) {
    text += "complete -c " + spec.name + " -l " + option.name().substr(2);
    if (!letter(option).empty()) text += " -s " + letter(option).substr(1);
    if (option.kind() == OptionKind::kChoice)
      text += " -x -a " + fish_quoted(joined(option.choices));
    else if (option.kind() == OptionKind::kFile)
      text += " -r -F";
    else if (option.kind() != OptionKind::kSwitch)
      text += is_number(option) ? " -x" : " -r";
    text += " -d " + fish_quoted(brief(option.help)) + "\n";
  }
  return text;
}

}  // namespace

std::string completion(const ToolSpec& spec, const std::string& shell) {
  if (shell == "bash") return bash(spec);
  if (shell == "zsh") return zsh(spec);
  if (shell == "fish") return fish(spec);
  throw std::invalid_argument("no shell is named " + shell);
}

}  // namespace hapsim
