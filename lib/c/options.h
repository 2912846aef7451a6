// hs_options, and what they say to a call.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "c/hapsim.h"
#include "cli/tool.h"

struct hs_options {
  std::vector<std::pair<std::string, std::string>> values;
  void (*say)(void*, const char*) = nullptr;
  int (*stop)(void*) = nullptr;
  void* context = nullptr;
};

namespace hapsim {

// What a call was asked with, checked as the flags of the tool of that name.
class Asked {
 public:
  // Error(kUsage) as parse_command_line() has it.
  Asked(const std::string& tool, std::vector<Option> known, const hs_options* options);

  const Arguments& arguments() const { return arguments_; }
  std::function<void(const std::string&)> say() const;
  // Whether the work is to end; asks in the thread of the call alone.
  std::function<bool()> stop() const;
  // For who cannot be told but by an exception: Error(kNoConvergence) once it is to end.
  std::function<void()> end_if_stopped() const;

 private:
  Arguments arguments_;
  hs_options listener_;
};

}  // namespace hapsim
