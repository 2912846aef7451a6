#!/usr/bin/env bash
# Builds everything and runs every test; further arguments go to ctest (`./run-tests.sh -R io`).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
. share/steps.sh

# Debian 12's clang-format decides: other versions break lines elsewhere.
format() {
  if ! clang-format --version 2>/dev/null | grep -q 'version 14\.' || ! git rev-parse >/dev/null 2>&1; then
    echo "format: skipped, clang-format 14 or git is missing"
    return
  fi
  local files
  mapfile -t files < <(git ls-files '*.h' '*.cpp')
  clang-format --dry-run --Werror "${files[@]}"
}

timed "dependencies" dependencies
timed "build" build ci
well_formed=yes
timed "format" format || well_formed=no
ctest --preset ci --parallel "$jobs" "$@"
[[ $well_formed == yes ]] || { echo "run-tests: the format is wrong; run clang-format -i" >&2; exit 1; }
