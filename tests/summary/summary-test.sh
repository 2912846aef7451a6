#!/usr/bin/env bash
# summary-test.sh: the closing lines of run-tests.sh, from made-up records.
set -uo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
fail() { printf 'summary-test: %s\n' "$1"; cat out; exit 1; }

# entry NUMBER NAME SECONDS OUTPUT: as ctest writes it
entry() {
  printf '%d/9 Testing: %s\n%d/9 Test: %s\nOutput:\n-----\n%s\n<end of output>\nTest time = %6s sec\n-----\nTest Passed.\n' \
    "$1" "$2" "$1" "$2" "$4" "$3"
}
{ entry 1 quick 0.25 'Testing: nothing'; entry 2 slow 100.50 ''; entry 3 middle 9.75 ''; } >log
{ echo '# ninja log v5'; printf '0\t9000\t1\tlib/a/CMakeFiles/a.dir/old.cpp.o\tf\n'; } >before
{ cat before; printf '0\t2500\t2\tlib/a/CMakeFiles/a.dir/b.cpp.o\tf\n100\t200\t3\tbin/tool\tf\n5\t12005\t4\tlib/c/CMakeFiles/c.dir/d.cpp.o\tf\n'; } >after
"$here/slowest.sh" before after log >out || fail 'slowest'
[[ $(tr -s ' ' <out | tr '\n' ';') == '== slowest units of this build (2 compiled); 12.0 s lib/c/d.cpp.o; 2.5 s lib/a/b.cpp.o;== slowest tests; 100.5 s slow; 9.8 s middle; 0.2 s quick;' ]] ||
  fail 'the slowest'
"$here/slowest.sh" after after log >out && grep -q 'nothing was compiled' out || fail 'nothing compiled'

for ((i = 1; i <= 20000; ++i)); do printf '0\t%d\t2\tlib/a/CMakeFiles/a.dir/%d.cpp.o\tf\n' "$i" "$i"; done >many
"$here/slowest.sh" before many log >out && [[ $(grep -c 'lib/a/' out) == 10 ]] || fail 'of many units ten are told'

skips() { "$here/skipped.sh" log >out; }
skips && grep -q 'nothing was skipped' out || fail 'nothing skipped'
google() { printf '[ RUN      ] %s\na.cpp:3: Skipped\n%s\n[  SKIPPED ] %s (0 ms)\n[  SKIPPED ] 1 test, listed below:\n[  SKIPPED ] %s' "$1" "$2" "$1" "$1"; }
entry 1 real 1 "$(google Real.One 'SKIPPED: set HAPSIM_SHARED')" >log
skips && grep -q 'SKIPPED: 1 test' out && grep -q 'real .*set HAPSIM_SHARED' out || fail 'the shared recordings are a reason'
entry 1 other 1 "$(google Other.One 'SKIPPED: no ccx')" >>log
skips && fail 'a missing program is no reason'
grep -q 'other .*no ccx' out || fail 'the reason is told'
entry 1 silent 1 "$(google Silent.One '')" >log
skips && fail 'no reason is no reason'
grep -q 'silent .*Silent.One gives no reason' out || fail 'the test without a reason is named'
entry 1 script 1 'SKIPPED: no disk' >log
skips && fail 'a part of a script that is skipped counts'
entry 1 code 1 '' | sed 's/^Test Passed/Test Skipped/' >log
skips && fail "ctest's own word counts"
echo 'summary: passed'
