#!/usr/bin/env bash
# fuse_paces.sh BIN OUT: ten presses of 125 to 200 ms into the organ of share/examples/thesis/heart.sh, with finite
# elements every 20 to 200 ms, each as late as they are apart; the filter was taught by that script's lesson, other
# presses, whose finite elements come every 20 ms. A row a pace: slow forces that came in time, and the error against
# finite elements every millisecond [N] fused, of the analytical model alone, of the last slow force held and of the
# last two drawn on; NIS and its 95 % band. Exit code 1 where the fused force is worse than what it is made of, or NIS
# lies outside. OUT may have the results of heart.sh (then only the paces are computed).
# Recorded in bench/results/fuse-paces.txt (bench/record.sh).
set -euo pipefail
[[ -n ${2-} && -x $1/hs-fuse ]] || { echo "usage: fuse_paces.sh BIN OUT" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
export PATH="$(cd "$1" && pwd):$PATH"
thesis=$here/../share/examples/thesis
mkdir -p "$2"
[[ -s $2/summary.csv ]] || sh "$thesis/heart.sh" "$2" >/dev/null 2>&1
cd "$2"
motion() { awk -v presses="$presses" -v hold=1 -v step="$1" -f "$thesis/presses.awk"; } # STEP
presses='0.125:0.008 0.2:0.009 0.125:0.007 0.16:0.0085 0.14:0.006 0.18:0.0075 0.15:0.009 0.2:0.0065 0.13:0.0085 0.17:0.008'
fe='--full --own-mesh --body organ.ply --model organ.csv -q'
motion 0.001 | hs-simulate - --model acfm.csv -q -o paces.acfm.csv
[[ -s paces.exact.csv ]] || motion 0.001 | hs-simulate - $fe -o paces.exact.csv
printf '%5s | %4s | %7s | %7s | %7s | %7s | %5s | %s\n' ms slow fused alone held drawn NIS band
worse=0
for ms in 20 50 100 150 200; do
  s=$(awk -v ms=$ms 'BEGIN { print ms / 1000 }')
  [[ -s paces.fe.$ms.csv ]] || motion "$s" | hs-simulate - $fe -o "paces.fe.$ms.csv"
  hs-simulate "paces.fe.$ms.csv" --model acfm.csv -q -o "paces.steps.$ms.csv"
  hs-fuse -q paces.acfm.csv --slow "paces.fe.$ms.csv" --stepped "paces.steps.$ms.csv" --delay "$s" \
    --parameters filter.csv --exact paces.exact.csv --json summary.json -o fused.csv
  value() { sed -n "s/.*\"$1\": *{[^}]*\"value\": *\([-0-9.e+]*\).*/\1/p" <(tr -d '\n' <summary.json); }
  row=$(printf '%5s | %4.0f | %7.4f | %7.4f | %7.4f | %7.4f | %5.2f | %.2f to %.2f' $ms "$(value slow_forces)" "$(value error_fused)" \
    "$(value error_fast)" "$(value error_held)" "$(value error_extrapolated)" "$(value nis)" "$(value nis_low)" "$(value nis_high)")
  echo "$row"
  awk '{ exit !($5 < $7 && $5 < $9 && $5 < $11 && $13 >= $15 && $13 <= $17) }' <<<"$row" || worse=1
done
exit $worse
