#!/usr/bin/env bash
# record.sh NAME COMMAND...: runs COMMAND, shows what it prints and keeps that as bench/results/NAME.txt, below
# lines that say the command, the date, the machine and the commit. What goes to standard error is shown and not
# kept. A COMMAND that ends with 1 (something asked for is missed) is kept too, with that code in the header;
# after any other code, or a kill, the file stays as it was. Returns COMMAND's exit code.
# The commit is that of the sources: build first. HAPSIM_RESULTS is another folder than bench/results.
set -uo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[[ $# -ge 2 && $1 =~ ^[a-z0-9-]+$ ]] || { echo 'usage: record.sh NAME COMMAND...' >&2; exit 2; }
folder=${HAPSIM_RESULTS:-$root/bench/results} name=$1
shift
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

load() { cut -d' ' -f1 /proc/loadavg; }
machine() {
  printf '%s, %s cores, %s GB, %s, load %s' "$(sed -n '0,/^model name/s/^model name[^:]*: //p' /proc/cpuinfo)" "$(nproc)" \
    "$(awk '/^MemTotal/ { printf "%.0f", $2 / 1e6 }' /proc/meminfo)" "$(. /etc/os-release && echo "$PRETTY_NAME")" "$(load)"
}
commit() { # of what is in git; results do not change what is measured
  git -C "$root" rev-parse --short HEAD 2>/dev/null || { echo 'not known'; return; }
  git -C "$root" diff --quiet HEAD -- . ':!bench/results' ':!*.md' || echo '(changed since)'
}
words=$(printf '%q ' "$@")
words=${words//"$root/"/}
date=$(date -u '+%Y-%m-%d %H:%M UTC') machine=$(machine) commit=$(commit | paste -sd' ')
"$@" | tee "$work/output"
code=${PIPESTATUS[0]}
if ((code > 1)); then
  echo "record.sh: exit code $code; $name.txt stays as it was" >&2
  exit "$code"
fi
{
  echo "# command: ${words% }"
  echo "# date:    $date"
  echo "# machine: $machine before, $(load) after"
  echo "# commit:  $commit"
  ((code == 0)) || echo "# exit:    $code"
  echo
  cat "$work/output"
} >"$work/whole"
mkdir -p "$folder" && cp "$work/whole" "$folder/.$name.tmp" && mv "$folder/.$name.tmp" "$folder/$name.txt" || exit 5
exit "$code"
