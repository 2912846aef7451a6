// What a call fails with, for tests of messages and exit codes.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"

namespace hapsim {

// The message of the Error that `call` throws; a test failure when there is none or its code
// differs.
template <class Call>
std::string error_of(Call&& call, ExitCode code = ExitCode::kBadInput) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(code)) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no Error was thrown";
  return "";
}

}  // namespace hapsim
