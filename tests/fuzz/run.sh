#!/usr/bin/env bash
# run.sh [-j JOBS] [-s SLICE] FUZZER FOLDER MINUTES [READER...]: fuzzes every reader, or those named, until
# each has had MINUTES of processor time, in slices of SLICE seconds (60), JOBS readers at once (1). What
# the fuzzer FUZZER (build/fuzz/tests/fuzz/fuzz_readers) makes of tests/fuzz/cases is kept in FOLDER/READER,
# findings beside it in FOLDER/found, and a line a slice in FOLDER/slices.csv: the next call goes on from
# there, also after an interruption. Prints the table of all slices so far; exit code 1 with findings.
set -uo pipefail
jobs=1 slice=60
while getopts j:s: flag; do
  case $flag in j) jobs=$OPTARG ;; s) slice=$OPTARG ;; *) exit 2 ;; esac
done
shift $((OPTIND - 1))
(($# >= 3)) || { sed -n '2,6s/^# //p' "$0" >&2; exit 2; }
fuzzer=$(realpath "$1") folder=$2 minutes=$3
shift 3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mkdir -p "$folder/found" && cd "$folder" || exit 5
[[ -s slices.csv ]] || echo 'reader,cpu_seconds,executions,edges' >slices.csv
export LSAN_OPTIONS=suppressions=$here/leaks.supp:print_suppressions=0
readers=("$@")
((${#readers[@]})) || readers=($(HAPSIM_READER= "$fuzzer" -runs=1 2>&1 | sed -n 's/.*must be one of: //p'))

spent() { awk -F, -v reader="$1" 'NR > 1 && $1 == reader { s += $2 } END { print s / 60 }' slices.csv; }
# The fuzzer's own clock counts wall time; the processor time it used is what counts here.
fuzz() { # READER
  local reader=$1 log=$1.log TIMEFORMAT='cpu %U %S' child
  mkdir -p "$reader"
  { time {
    HAPSIM_READER=$reader "$fuzzer" -max_total_time="$slice" -rss_limit_mb=2000 -timeout=120 -print_final_stats=1 \
      -reload=0 -artifact_prefix="found/$reader-" "$reader" "$here/cases/$reader" &
    child=$!
    trap 'kill -INT $child' TERM INT
    while kill -0 $child 2>/dev/null; do wait $child; done
  }; } >"$log" 2>&1
  awk -v reader="$reader" '/^cpu / { cpu = $2 + $3 } / cov: / { for (i = 1; i < NF; ++i) if ($i == "cov:") edges = $(i + 1) }
    /^stat::number_of_executed_units:/ { runs = $2 } END { printf "%s,%.1f,%d,%d\n", reader, cpu, runs, edges }' "$log" >>slices.csv
}

stopped= running=()
declare -A last
trap 'stopped=yes; kill -TERM "${running[@]}" 2>/dev/null' TERM INT
while [[ -z $stopped ]]; do
  worked=
  for reader in "${readers[@]}"; do
    [[ -z $stopped ]] && awk -v s="$(spent "$reader")" -v m="$minutes" 'BEGIN { exit !(s < m) }' || continue
    worked=yes
    while (($(jobs -rp | wc -l) >= jobs)); do wait -n; done
    [[ -z ${last[$reader]:-} ]] || wait "${last[$reader]}"  # two slices of one reader would share its log
    [[ -z $stopped ]] || break
    fuzz "$reader" &
    last[$reader]=$!
    running=($(jobs -rp))
  done
  [[ -n $worked ]] || break
done
while [[ -n $(jobs -rp) ]]; do wait; done

printf '%-10s %12s %8s %12s %9s\n' reader executions edges 'CPU minutes' findings
for reader in "${readers[@]}"; do
  awk -F, -v reader="$reader" -v found="$(find found -name "$reader-*" ! -name '*slow-unit*' | wc -l)" '$1 == reader { s += $2; n += $3; if ($4 > e) e = $4 }
    END { printf "%-10s %12d %8d %12.1f %9d\n", reader, n, e, s / 60, found }' slices.csv
done
[[ -z $(find found -type f ! -name '*slow-unit*') ]]
