#!/usr/bin/env bash
# table.sh BUILD OUT [PLACES [NU,NU... [BODY...]]]: the live force against the batch mode's on block, ball, organ-like
# lump, the shipped phantom and, where HAPSIM_SHARED has its scan, the bunny; a row a body and Poisson's ratio, whose
# columns bench_field explains, then how many are as asked: at most 2 % rms, 5 % worst, 95 % within what is stated.
# A row that stands in OUT is not measured again, so an interrupted call is gone on with; a row of another number of
# places is another. Places that were solved stay in OUT/cache, so wall and processor seconds of rows measured again
# are not those of a first run. Exit code 1 where a row is not as asked.
# Recorded in bench/results/live-table.txt (bench/record.sh).
set -euo pipefail
(($# >= 2)) || { echo 'usage: table.sh BUILD OUT [PLACES [NU,NU... [BODY...]]]' >&2; exit 2; }
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=$(cd "$1" && pwd)
mkdir -p "$2/rows" "$2/cache"
out=$(cd "$2" && pwd) places=${3:-200} nus=${4:-0.3,0.45,0.49,0.499}
shift $(($# < 4 ? $# : 4))
scan=${HAPSIM_SHARED:-/nowhere}/realdata/scans/stanford-bunny.obj
bodies=(block ball organ phantom bunny)
(($# == 0)) || bodies=("$@")
export XDG_CACHE_HOME=$out/cache
bin=$build/bin

body_of() { # NAME: a file for those that come from a scan
  local file=$out/$1.ply
  case $1 in
    phantom)
      [[ -s $file ]] || "$bin/hs-scan2ply" -q "$root/share/examples/phantom/scan.csv" --unit mm | "$bin/hs-reconstruct" -q |
        "$bin/hs-tetmesh" -q -o "$file"
      ;;
    bunny) # its points, upright
      [[ -s $file ]] || awk 'BEGIN { print "x,y,z" } /^v / { print $2 "," (-$4) "," $3 }' "$scan" | "$bin/hs-scan2ply" -q |
        "$bin/hs-reconstruct" -q | "$bin/hs-tetmesh" -q --edge 5mm --fixed below:0.045 -o "$file"
      ;;
    *) file=$1 ;;
  esac
  echo "$file"
}

shown='' rows=()
for nu in ${nus//,/ }; do
  for body in "${bodies[@]}"; do
    [[ $body != bunny || -s $scan ]] || { echo 'table.sh: HAPSIM_SHARED has no bunny: left out' >&2; continue; }
    row=$out/rows/$body-$nu-$places
    if [[ ! -s $row ]]; then
      file=$(body_of "$body")
      HAPSIM_BENCH_CACHE=$out/cache "$build/bench/live/bench_field" "$places" "$nu" 0.02 "$file" >"$row.part"
      mv "$row.part" "$row"
    fi
    [[ -n $shown ]] || head -n 1 "$row"
    shown=yes
    tail -n +2 "$row" | grep -v '^ '
    rows+=("$row")
  done
done
tail -q -n +2 "${rows[@]}" | grep -v '^ ' | awk -v places="$places" '
  { ++n; rms = $9 + 0; worst = $11 + 0; covers = $12 + 0
    good = rms <= 2 && worst <= 5; as_asked += good && covers >= 95; narrow += covers < 95
    if (!good) wrong = wrong sprintf("%s %s (%.2f, %.2f %%)", wrong == "" ? "" : ", ", $1 " " $2, rms, worst) }
  END { printf "%d of %d rows of %d places are as asked; stated too narrow in %d; rms or worst too large: %s\n", as_asked, n, places, narrow, wrong == "" ? "none" : wrong
        exit as_asked < n }'
