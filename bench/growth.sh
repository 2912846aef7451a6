#!/usr/bin/env bash
# growth.sh BIN: how preparation grows with places and a batch with recordings. A block of 80 x 60 x 40 mm, pressed once
# at each of 10, 40 and 160 places, identified with nothing prepared; then one recording of four places as 20, 80 and 320
# of a batch whose contacts are prepared, make on one job. Seconds of the processor, memory of the largest process, the power by
# which time grows from one line to the next, and what a recording of the batch takes beyond hs-identify on it alone.
# Recorded in bench/results/growth.txt (bench/record.sh).
set -euo pipefail
[[ -n ${1-} && -x $1/hs-identify ]] || { echo "usage: growth.sh BIN" >&2; exit 2; }
bin=$(cd "$1" && pwd)
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export XDG_CACHE_HOME=$work/cache
awk -v what=cuboid -v a=0.08 -v b=0.06 -v c=0.04 -f "$root/share/examples/shapes.awk" >block.off
"$bin/hs-tetmesh" -q block.off -o body.ply
printf 'effect,region,parameter,value\nelastic,0,E,15000\nelastic,0,nu,0.42\n' >truth.csv
recording() { # PLACES: forces on coarser meshes than those that are prepared
  awk -v n="$1" 'BEGIN { print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"
    for (p = 0; p < n; ++p) { x = 0.012 + 0.056 * (0.5 + p) / n; y = 0.012 + 0.036 * (0.618034 * p % 1)
      for (i = 0; i <= 10; ++i) printf "%d,%.1f,%.5f,%.5f,0.04,0,0,%.6f\n", p, 0.1 * i, x, y, -0.0002 * i } }' >motion.csv
  "$bin/hs-simulate" -q motion.csv --body body.ply --model truth.csv --rim-edge 0.3 --add-noise 0.005 -o "data-$1.csv"
}
cost() { # COMMAND...: its seconds of the processor and megabytes
  command time -o took -f '%U %S %M' "$@" >out 2>err || { cat err >&2; return 1; }
  awk '{ printf "%.3f %.0f\n", $1 + $2, $3 / 1024 }' took
}
power() { awk -v a="$1" -v b="$2" -v by="$3" 'BEGIN { printf "%.2f", log(b / a) / log(by) }'; } # LESS MORE FACTOR

before=0
for places in 10 40 160; do
  recording "$places"
  read -r seconds memory < <(cost "$bin/hs-identify" -q "data-$places.csv" --body body.ply --effects elastic --folds 0 --cache none -o model.csv)
  grown=
  [[ $before == 0 ]] || grown=", grows by the power $(power "$before" "$seconds" 4)"
  printf 'preparation of %4d places: %8.2f s, %5d MB%s\n' "$places" "$seconds" "$memory" "$grown"
  before=$seconds
done
recording 4
alone=("$bin/hs-identify" -q data-4.csv --body body.ply --effects elastic -o model.csv)
"${alone[@]}"
read -r once memory < <(cost "${alone[@]}")
before=0
for count in 20 80 320; do
  { echo 'name,body,data,effects'
    for ((i = 0; i < count; ++i)); do
      ln -f data-4.csv "data-$count-$i.csv"
      echo "recording $i,body.ply,data-$count-$i.csv,elastic"
    done; } >manifest.csv
  read -r seconds memory < <(cost make --no-print-directory -s -j1 -f "$root/Makefile.pipeline" batch BIN="$bin" \
    MANIFEST=manifest.csv OUT="out-$count" BATCH_FLAGS='--stages model')
  grown=
  [[ $before == 0 ]] || grown=", grows by the power $(power "$before" "$seconds" 4)"
  printf 'a batch of %4d recordings: %8.2f s, %5d MB, %.1f ms a recording beyond %.1f ms alone%s\n' "$count" "$seconds" "$memory" \
    "$(awk -v a="$seconds" -v n="$count" -v one="$once" 'BEGIN { print 1000 * (a / n - one) }')" "$(awk -v one="$once" 'BEGIN { print 1000 * one }')" "$grown"
  before=$seconds
done
