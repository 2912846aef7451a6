#include "cli/failure.h"

#include <new>
#include <stdexcept>
#include <system_error>

#include "io/stream.h"

namespace hapsim {

Failure current_failure() {
  try {
    throw;
  } catch (const Error& error) {
    return {error.code(), error.what()};
  } catch (const ClosedPipe&) {
    return {ExitCode::kIo, ""};
  } catch (const std::bad_alloc&) {
    return {ExitCode::kNoConvergence,
            "there is not enough memory; use a coarser mesh or a smaller file"};
  } catch (const std::system_error& error) {  // of std::filesystem and of threads
    return {ExitCode::kIo, error.what()};
  } catch (const std::exception& error) {
    return {ExitCode::kNoConvergence,
            std::string("internal error: ") + error.what() + "; please report it"};
  } catch (...) {  // foreign libraries throw what is no std::exception
    return {ExitCode::kNoConvergence, "internal error; please report it"};
  }
}

}  // namespace hapsim
