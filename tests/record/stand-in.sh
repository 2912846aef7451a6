#!/usr/bin/env bash
# Stands in for every tool while record.sh runs (its own name says for which): calls it and keeps, in a file of
# its own in $SAID, what it was asked, what it said and how it ended. So what the tools of one pipeline say does
# not mix by chance. What it said is passed on when it has ended.
tool=${0##*/}
number=1
until (set -C; : >"$SAID/$tool.$number") 2>/dev/null; do number=$((number + 1)); done
log=$SAID/$tool.$number
"$RECORDED_BIN/$tool" "$@" 2>"$log.part"
code=$?
cat "$log.part" >&2
{
  printf '%s' "$tool"
  (($# == 0)) || printf ' %q' "$@"
  printf '\n'
  cat "$log.part"
  printf 'exit %d\n' "$code"
} >"$log"
rm "$log.part"
exit "$code"
