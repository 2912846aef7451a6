#!/usr/bin/env bash
# record.sh BIN OUT [GROUP...]: everything that hapsim's tools make and say of the shipped and the shared
# inputs, so that a change of design can be checked byte by byte:
#
#   tests/record/record.sh build/ci/bin /tmp/before       # before the change
#   tests/record/record.sh build/ci/bin /tmp/after        # after it
#   tests/record/compare.sh /tmp/before /tmp/after
#
# Groups, each a file in groups/: phantom, tutorial, examples, thesis, independent, usage; without a name all.
# Inputs are those of the repository that this script lies in, and for `independent` HAPSIM_SHARED (otherwise
# ../shared beside the repository); where that is absent the group is skipped, and said so.
#
#   OUT/GROUP/...                    what the tools made, under fixed relative names
#   OUT/GROUP/said/STEP/TOOL.N       the tool's N-th call in that step: arguments, standard error, exit code
#   OUT/GROUP/said/STEP/stdout, exit what the step printed; its exit code, written when it has ended
#   OUT/times.txt                    seconds by the clock and of the processor of each step; not compared
#   OUT/cache, OUT/tools, OUT/stderr prepared stiffnesses, stand-ins for the tools, the last step's standard
#                                    error; not compared
#
# A step with its `exit` is not run again, so an interrupted recording is gone on with by the same call; to record a
# group anew, delete OUT/GROUP. A tool that fails is recorded like any other.
#
# What may differ from run to run is taken out (see tidy below, and the groups): the name of OUT, durations and
# latencies, the day when a library stored a model. Not recorded at all, for their results depend on the clock:
# hs-link (telepresence), hs-fuse --live and --rate.
set -euo pipefail
(($# >= 2)) || { sed -n '2,/^set/s/^# \{0,1\}//p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
export RECORDED_BIN
RECORDED_BIN=$(cd "$1" && pwd)
mkdir -p "$2/tools"
out=$(cd "$2" && pwd)
shift 2
groups=("$@")
(($#)) || groups=(phantom tutorial examples thesis independent usage)
shared=${HAPSIM_SHARED:-$root/../shared}
examples=$root/share/examples

tools=$(sed -n 's/^hapsim_tool(\(hs-[a-z0-9]*\) .*/\1/p' "$root/tools/CMakeLists.txt")
for tool in $tools; do
  [[ -x $RECORDED_BIN/$tool ]] || { echo "record: $RECORDED_BIN has no $tool; build all tools first" >&2; exit 2; }
  cp --remove-destination "$here/stand-in.sh" "$out/tools/$tool"
done
export PATH=$out/tools:$PATH XDG_CACHE_HOME=$out/cache LC_ALL=C TZ=UTC
export MAKEFLAGS='' TIMEFORMAT='%R %U %S'

# Tools end well when they are interrupted; what they then leave is not taken for the step's result.
trap 'exit 130' INT TERM

# use NAME TARGET: an input under a name in the group's folder. Links are not compared.
use() { ln -sfn "$2" "$1"; }

# step NAME COMMANDS: runs them in the group's folder, where this has not been done.
step() {
  local said=$PWD/said/$1 code=0
  [[ ! -e $said/exit ]] || return 0
  rm -rf "$said"
  mkdir -p "$said"
  { time SAID=$said bash -euo pipefail -c "$2" >"$said/stdout" 2>"$out/stderr" </dev/null || code=$?; } 2>"$out/time"
  ((code <= 128)) || { echo "record: $group/$1 was ended by a signal (exit $code)" >&2; exit "$code"; }
  awk -v step="$group/$1" '{ printf "%-40s %8.1f s, of the processor %8.1f s\n", step, $1, $2 + $3 }' "$out/time" |
    tee -a "$out/times.txt"
  ((code == 0)) || printf 'record: %s/%s ended with %d\n' "$group" "$1" "$code" >&2
  echo "$code" >"$said/exit"
}

# Once a group has ended, for make compares times and hs-batch sizes of files: takes out of every text what
# depends on the machine's clock, and the name of OUT and of the repository.
tidy() {
  local file
  while IFS= read -r -d '' file; do
    sed -Ei "s|$out|OUT|g; s|$root|ROOT|g; s|$shared|SHARED|g
      s/ready in [0-9.e+-]+ s:/ready in * s:/; s/([0-9]+ samples: median ).*/\1*/" "$file"
  done < <(grep -rlIZE -- "$out|$root|$shared|ready in|samples: median" . || true)
  ! grep -rlF -- "$out" . || { echo "record: these files of $group hold the name of OUT" >&2; exit 1; }
}

for group in "${groups[@]}"; do
  [[ -e $here/groups/$group.sh ]] || { echo "record: no group '$group'" >&2; exit 2; }
  mkdir -p "$out/$group"
  cd "$out/$group"
  . "$here/groups/$group.sh"
  tidy
  cd "$out"
done
rm -f "$out/time"
