#include "cli/failure.h"

#include <gtest/gtest.h>

#include <functional>
#include <new>
#include <stdexcept>
#include <system_error>

#include "io/stream.h"

namespace hapsim {
namespace {

Failure failure_of(const std::function<void()>& call) {
  try {
    call();
  } catch (...) {
    return current_failure();
  }
  ADD_FAILURE() << "nothing was thrown";
  return {};
}

TEST(Failure, WhateverIsThrownHasACodeAndWords) {
  const Failure ours = failure_of([] { fail_input("data.csv:17", "it is wrong", "mend it"); });
  EXPECT_EQ(ours.code, ExitCode::kBadInput);
  EXPECT_EQ(ours.words, "data.csv:17: it is wrong; mend it");
  EXPECT_EQ(failure_of([] { throw std::bad_alloc(); }).code, ExitCode::kNoConvergence);
  EXPECT_EQ(failure_of([] {
              throw std::system_error(std::make_error_code(std::errc::no_space_on_device));
            }).code,
            ExitCode::kIo);
  const Failure bug = failure_of([] { throw std::logic_error("a bug"); });
  EXPECT_EQ(bug.words, "internal error: a bug; please report it");
  EXPECT_EQ(failure_of([] { throw 7; }).words, "internal error; please report it");
}

TEST(Failure, AClosedPipeIsSilent) {
  const Failure closed = failure_of([] { throw ClosedPipe(); });
  EXPECT_EQ(closed.code, ExitCode::kIo);
  EXPECT_EQ(closed.words, "");
}

}  // namespace
}  // namespace hapsim
