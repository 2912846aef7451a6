#!/usr/bin/env bash
# fuse_paces.sh BIN OUT: the fast motion of share/examples/thesis/heart.sh, presses of 125 to 200 ms, with finite
# elements every 20 to 200 ms, each as late as they are apart; the filter was taught by that script's lesson, whose
# finite elements come every 20 ms. A row a pace: slow forces that came in time, and the error against finite elements
# every millisecond [N] fused, of the analytical model alone, of the last slow force held and of the last two drawn
# on; NIS and its 95 % band. OUT may have the results of heart.sh (then only the paces are computed).
# Recorded in bench/results/fuse-paces.txt (bench/record.sh).
set -euo pipefail
[[ -n ${2-} && -x $1/hs-fuse ]] || { echo "usage: fuse_paces.sh BIN OUT" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export PATH="$(cd "$1" && pwd):$PATH"
heart=$here/../share/examples/thesis/heart.sh
mkdir -p "$2"
[[ -s $2/fast.exact.csv && -s $2/filter.csv ]] || sh "$heart" "$2" >/dev/null 2>&1
cd "$2"
. <(sed -n '/^motion() {/,/^}/p' "$heart")
hs-simulate fast.csv --model acfm.csv -q -o fast.acfm.csv
printf '%5s | %4s | %7s | %7s | %7s | %7s | %5s | %s\n' ms slow fused alone held drawn NIS band
for ms in 20 50 100 150 200; do
  s=$(awk -v ms=$ms 'BEGIN { print ms / 1000 }')
  [[ -s fast.fe.$ms.csv ]] || motion fast "$s" | hs-simulate --full --own-mesh --body organ.ply --model organ.csv -q -o "fast.fe.$ms.csv"
  hs-fuse -q fast.acfm.csv --slow "fast.fe.$ms.csv" --delay "$s" --parameters filter.csv --exact fast.exact.csv \
    --json summary.json -o fused.csv
  value() { sed -n "s/.*\"$1\": *{[^}]*\"value\": *\([-0-9.e+]*\).*/\1/p" <(tr -d '\n' <summary.json); }
  printf '%5s | %4.0f | %7.4f | %7.4f | %7.4f | %7.4f | %5.2f | %.2f to %.2f\n' $ms "$(value slow_forces)" "$(value error_fused)" \
    "$(value error_fast)" "$(value error_held)" "$(value error_extrapolated)" "$(value nis)" "$(value nis_low)" "$(value nis_high)"
done
