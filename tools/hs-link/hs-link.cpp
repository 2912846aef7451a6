// hs-link: an operator and a teleoperator, two processes over UDP.
#include "base/error.h"
#include "hs-link/flags.h"
#include "hs-link/operator.h"
#include "hs-link/specification.h"
#include "hs-link/teleoperator.h"
#include "link/key_file.h"

namespace hapsim {
namespace {

int run(const Arguments& arguments) {
  if (arguments.given(flag::make_key)) {
    make_key(arguments[flag::make_key]);
    say(arguments, "hs-link",
        "a new key is in " + arguments[flag::make_key] +
            "; copy it to the other side by a safe way");
    return 0;
  }
  if (arguments.given(flag::listen) == arguments.given(flag::peer))
    fail_usage("it is either a teleoperator or an operator", "give --listen or --peer");
  if (!arguments.given(flag::body))
    fail_usage("--body is required", "the one that is pressed, or the one that is identified");
  return arguments.given(flag::listen) ? run_teleoperator(arguments) : run_operator(arguments);
}

}  // namespace
}  // namespace hapsim

int main(int argc, char** argv) {
  return hapsim::run_tool(hapsim::link_specification(), argc, argv, hapsim::run);
}
