#!/usr/bin/env bash
# Builds everything and runs every test; further arguments go to ctest (`./run-tests.sh -R io`). Ends with
# what took longest and with what was skipped; a skipped test is a failure, unless it says that it needs
# the recordings in HAPSIM_SHARED.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. share/steps.sh

# Debian 12's clang-format decides: other versions break lines elsewhere.
format() {
  local program
  program=$(command -v clang-format-14 || command -v clang-format) && "$program" --version | grep -q 'version 14\.' ||
    { echo "format: clang-format 14 is missing; share/install-deps.sh --tests installs it on Debian 12" >&2; return 1; }
  find . \( -path './build*' -o -path './.git' \) -prune -o \( -name '*.h' -o -name '*.cpp' \) -print0 |
    xargs -0 -n 40 -P "$jobs" "$program" --dry-run --Werror
}

record=build/ci/.ninja_log
failed=()
timed "dependencies" dependencies --tests
before=$(mktemp)
trap 'rm -f "$before"' EXIT
[[ ! -e $record ]] || cp "$record" "$before"
timed "build" build ci
timed "format" format || failed+=("the format is wrong: run clang-format -i")
# One more than there are processors: some wait for a clock or a peer.
timed "tests" ctest --preset ci --parallel $((jobs + 1)) "$@" || failed+=("tests failed")
tests/summary/slowest.sh "$before" "$record" build/ci/Testing/Temporary/LastTest.log
tests/summary/skipped.sh build/ci/Testing/Temporary/LastTest.log || failed+=("tests were skipped")
for failure in "${failed[@]}"; do echo "run-tests: $failure" >&2; done
((${#failed[@]} == 0))
