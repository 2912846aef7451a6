#!/usr/bin/env bash
# What a build from nothing costs the processor, without ccache: its units, their seconds together, and
# the ten slowest. Nothing named: what run-example.sh builds.
#
#   tests/build-times.sh [PRESET [TARGET...]]
set -euo pipefail

# For each unit the compiler is called through this script.
if [[ -n ${HAPSIM_BUILD_TIMES:-} ]]; then
  TIMEFORMAT='%U %S'
  exec 3>&1 4>&2
  status=0
  seconds=$({ time "$@" >&3 2>&4; } 2>&1) || status=$?
  printf '%s %s\n' "$seconds" "${!#}" >>"$HAPSIM_BUILD_TIMES"
  exit $status
fi

cd "$(dirname "${BASH_SOURCE[0]}")/.."
. share/steps.sh
preset=${1:-release}
shift || true
[[ $# -gt 0 ]] || mapfile -t tools < <(pipeline_tools)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
: >"$folder/times"
cmake --preset "$preset" -B "$folder/build" -DCMAKE_CXX_COMPILER_LAUNCHER="$PWD/tests/build-times.sh" \
  --log-level=WARNING >/dev/null
HAPSIM_BUILD_TIMES=$folder/times cmake --build "$folder/build" --parallel "$jobs" \
  --target "${@:-${tools[@]}}" >/dev/null
awk -v jobs="$jobs" '{ user += $1; kernel += $2 }
  END { printf "%d units, %.0f s user, %.0f s system, by %d jobs\n", NR, user, kernel, jobs }' "$folder/times"
sort -rn "$folder/times" | sed -E "s|$folder/build/||; s|$PWD/||" | sed -n 1,10p
