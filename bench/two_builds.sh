#!/usr/bin/env bash
# two_builds.sh OLD_BIN NEW_BIN [PAIRS]: processor time and peak memory from scan to diagnosis on the shipped phantom
# and, where HAPSIM_SHARED is there, on recordings by another solver; both builds in turn, PAIRS times (5), after one
# run each that fills their caches but where a first run is measured. Medians and ratios.
# Recorded in bench/results/two-builds.txt (bench/record.sh).
set -euo pipefail
(($# >= 2)) || { sed -n '2,5s/^# \{0,1\}//p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
# shellcheck disable=SC2034 # new is read by its name
old=$(cd "$1" && pwd) new=$(cd "$2" && pwd) pairs=${3:-5}
shared=${HAPSIM_SHARED:-$here/../shared}/independent
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export XDG_CACHE_HOME

XDG_CACHE_HOME=$work/made
"$old/hs-scan2ply" -q "$here/share/examples/phantom/scan.csv" --unit mm | "$old/hs-reconstruct" -q | "$old/hs-tetmesh" -q -o phantom.ply
cp "$here/share/examples/phantom/data.csv" phantom.csv
names=(phantom)
if [[ -d $shared ]]; then
  for pair in null:cuboid viscoelastic:ball; do
    name=${pair%:*}
    "$old/hs-tetmesh" -q "$shared/${pair#*:}.stl" -o "$name.ply"
    cp "$shared/$name.csv" "$name.csv"
    names+=("$name")
  done
else
  echo "two_builds: no $shared, the phantom alone" >&2
fi

# Seconds of the processor and MB of one call; each build has a cache of its own.
cache_of() { echo "$work/cache-$(cksum <<<"$1" | cut -d' ' -f1)"; }
one() { # BIN TOOL ARGUMENTS...
  XDG_CACHE_HOME=$(cache_of "$1") command time -f '%U %S %M' -o cost "$1/$2" "${@:3}" >out 2>err || { cat err >&2; exit 1; }
  awk 'END {printf "%.3f %.1f\n", $1 + $2, $3 / 1024}' cost
}
median() { sort -g "$1" | awk '{v[NR] = $1} END {printf "%.3f", v[int((NR + 1) / 2)]}'; }
row() { # NAME first|again COMMAND...: both builds in turn; first: nothing is prepared
  local name=$1 when=$2 build seconds memory
  shift 2
  rm -f old-s new-s old-m new-m
  for build in old new; do [[ $when == first ]] || one "${!build}" "$@" >/dev/null; done
  for ((k = 0; k < pairs; ++k)); do
    for build in old new; do
      [[ $when == again ]] || rm -rf "$(cache_of "${!build}")"
      read -r seconds memory < <(one "${!build}" "$@")
      echo "$seconds" >>$build-s
      echo "$memory" >>$build-m
    done
  done
  printf '%-34s %9s %9s ' "$name" "$(median old-s)" "$(median new-s)"
  awk -v a="$(median old-s)" -v b="$(median new-s)" 'BEGIN {printf "%6.3f ", (a > 0 ? b / a : 1)}'
  awk -v a="$(median old-m)" -v b="$(median new-m)" 'BEGIN {printf "%9.1f %9.1f %6.3f\n", a, b, b / a}'
}

printf '%-34s %9s %9s %6s %9s %9s %6s\n' command 'old s' 'new s' ratio 'old MB' 'new MB' ratio
scan=$here/share/examples/phantom/scan.csv
"$old/hs-scan2ply" -q "$scan" --unit mm -o points.ply
"$old/hs-reconstruct" -q points.ply -o surface.ply
row 'hs-scan2ply phantom' again hs-scan2ply -q "$scan" --unit mm -o p.ply
row 'hs-reconstruct phantom' again hs-reconstruct -q points.ply -o s.ply
row 'hs-tetmesh phantom' again hs-tetmesh -q surface.ply -o b.ply
for name in "${names[@]}"; do
  "$old/hs-identify" -q "$name.csv" --body "$name.ply" --effects elastic -o "$name-model.csv"
  "$old/hs-simulate" -q "$name.csv" --body "$name.ply" --model "$name-model.csv" -o "$name-simulated.csv"
  row "hs-identify $name, first run" first hs-identify "$name.csv" --body "$name.ply" --effects elastic -o m.csv
  row "hs-identify $name" again hs-identify "$name.csv" --body "$name.ply" --effects elastic -o m.csv
  row "hs-identify $name, robust" again hs-identify "$name.csv" --body "$name.ply" --effects elastic --robust huber -o m.csv
  row "hs-diagnose $name" again hs-diagnose "$name.csv" --body "$name.ply" --model "$name-model.csv" -o e.csv
  row "hs-simulate $name" again hs-simulate "$name.csv" --body "$name.ply" --model "$name-model.csv" -o f.csv
  row "hs-compare $name" again hs-compare -q "$name.csv" --simulated "$name-simulated.csv" -o c.csv
done
