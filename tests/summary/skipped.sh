#!/usr/bin/env bash
# skipped.sh LOG: what was skipped by the tests of ctest's last log, each with its reason, which a test prints
# as "SKIPPED: ...". Exits 1 when a reason does not name HAPSIM_SHARED, or when there is none.
set -euo pipefail
awk '
  function skipped(reason) {
    count++
    line = sprintf("  %-16s %s", test, reason)
    if (reason ~ /HAPSIM_SHARED/) allowed = allowed line "\n"
    else wrong = wrong line "\n"
  }
  /^[0-9]+\/[0-9]+ Testing: / { test = $3; told = 0 }
  # Of GoogleTest: the reason stands between the start of a test and its end.
  /^\[ RUN      \] / { told = 0 }
  /^\[  SKIPPED \] [^ ]+ \([0-9]+ ms\)/ && !told { skipped($4 " gives no reason") }
  /^SKIPPED: / { told = 1; skipped(substr($0, 10)) }
  /^Test (Skipped|Not Run|Disabled)/ && !told { skipped("gives no reason") }
  END {
    if (!count) { print "== nothing was skipped"; exit 0 }
    printf "== SKIPPED: %d tests\n%s", count, allowed
    if (wrong == "") exit 0
    printf "== skipped without need of the shared recordings, which is a failure\n%s", wrong
    exit 1
  }' "$1"
