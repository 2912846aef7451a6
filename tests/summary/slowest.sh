#!/usr/bin/env bash
# slowest.sh BEFORE AFTER LOG: the ten units of the build and the ten tests that took longest, by the build's
# own records: Ninja's log before and after the build, and ctest's last log.
set -euo pipefail
before=$1 after=$2 log=$3
# All is read to its end: a reader that stops early kills its writer, and with it this script.
top() { sort -rn | awk 'NR <= 10 { printf "  %8.1f s  %s\n", $1, $2 }'; }

# A line of Ninja's log: start and end [ms] in its build, time of the file, file, hash. Lines that were there
# before belong to earlier builds.
units=$(grep -vxFf "$before" "$after" | grep -v '^#' |
  awk -F '\t' '$4 ~ /\.(o|gch)$/ { sub(/CMakeFiles\/[^\/]*\.dir\//, "", $4); print ($2 - $1) / 1000, $4 }' || true)
if [[ -n $units ]]; then
  echo "== slowest units of this build ($(wc -l <<<"$units") compiled)"
  top <<<"$units"
else
  echo "== slowest units: nothing was compiled"
fi
echo "== slowest tests"
awk -F '[:"]' '/^[0-9]+\/[0-9]+ Testing: / { sub(/^[^:]*: /, ""); name = $0 }
  /^Test time = / { split($0, words, " "); print words[4], name }' "$log" | top
