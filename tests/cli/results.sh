#!/usr/bin/env bash
# results.sh: bench/record.sh keeps what a command prints, below what was run, when, where and of which commit;
# and bench/RESULTS.md is one page whose every row names a command that links to its raw output, all of which is linked.
bench=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../bench" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
complain() { printf 'FAILED: %s\n' "$1"; failures=$((failures + 1)); }
record() { # CODE ARGUMENTS...
  local code=$1
  shift
  HAPSIM_RESULTS=$work/results "$bench/record.sh" "$@" >"$work/out" 2>"$work/err"
  local got=$?
  ((got == code)) || complain "exit code $got, not $code: record.sh $*"
}
headed() { # FILE: its header is whole
  local word
  for word in command date machine commit; do
    sed '/^$/q' "$1" | grep -q "^# $word: *[^ ]" || complain "$1 does not say its $word"
  done
}

kept=$work/results/two-lines.txt
record 0 two-lines printf '%s\n' 'first line' '12 s'
cmp -s "$work/out" <(printf 'first line\n12 s\n') || complain 'the output is not shown'
headed "$kept"
cmp -s <(sed '1,/^$/d' "$kept") "$work/out" || complain 'the output is not kept'
grep -qF "# command: printf %s\\\\n first\\ line 12\\ s" "$kept" || complain 'the command is not kept as it was typed'
! grep -q '^# exit' "$kept" || complain 'an exit code of 0 is told'
record 1 two-lines sh -c 'echo missed; echo aside >&2; exit 1'
grep -q '^# exit: *1$' "$kept" && grep -qx missed "$kept" || complain 'a run that misses what is asked is not kept'
! grep -q '^aside' "$kept" && grep -qx aside "$work/err" || complain 'standard error is kept, or not shown'
record 3 two-lines sh -c 'echo broken; exit 3'
! grep -qx broken "$kept" || complain 'a run that failed replaces a result'
record 2 '../up' true
record 2 no-command
[[ $(ls -A "$work/results") == two-lines.txt ]] || complain 'something else is left'

page=$bench/RESULTS.md
(($(wc -l <"$page") <= 120)) || complain 'RESULTS.md is longer than a page'
while IFS='|' read -r _ claim number limit command rest; do
  [[ $claim == ' Claim ' || $claim == ---* ]] && continue
  [[ -n ${number// /} && -n ${limit// /} && $command == *'(results/'*'.txt)'* && -z $rest ]] ||
    complain "no number, limit or command with its output:$claim"
done < <(grep '^|' "$page")
for file in $(grep -o 'results/[a-z0-9-]*\.[a-z]*)' "$page" | tr -d ')' | sort -u); do
  [[ -e $bench/$file ]] || complain "RESULTS.md links to $file, which is not there"
done
for file in "$bench"/results/*; do
  grep -qF "(results/${file##*/})" "$page" || complain "RESULTS.md does not link to ${file##*/}"
  [[ $file != *.txt ]] || headed "$file"
done
((failures == 0)) && echo 'results: record.sh and RESULTS.md as they must be'
exit $((failures > 0))
