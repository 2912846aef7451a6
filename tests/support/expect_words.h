// That a call fails, with which code and which words in its message.
#pragma once

#include <string>

#include "expect_error.h"

namespace hapsim {

template <class Call>
void expect_error(Call&& call, ExitCode code, const std::string& words) {
  const std::string message = error_of(std::forward<Call>(call), code);
  EXPECT_NE(message.find(words), std::string::npos) << message << "\nhas not\n" << words;
}

}  // namespace hapsim
