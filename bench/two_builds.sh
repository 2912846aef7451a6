#!/usr/bin/env bash
# two_builds.sh OLD_BIN NEW_BIN [PAIRS]: processor time and peak memory of hs-identify, hs-diagnose and
# hs-simulate on the shipped phantom and, where HAPSIM_SHARED is there, on recordings by another solver;
# both builds in turn, PAIRS times (5) after one run each that fills their caches. Medians and ratios.
set -euo pipefail
(($# >= 2)) || { sed -n '2,4s/^# \{0,1\}//p' "$0" >&2; exit 2; }
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
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

# Seconds of the processor and MB of one call.
one() { # BIN TOOL ARGUMENTS...
  local bin=$1
  shift
  XDG_CACHE_HOME=$work/cache-$(basename "$(dirname "$bin")")-$(cksum <<<"$bin" | cut -d' ' -f1) \
    command time -f '%U %S %M' -o cost "$bin/$1" "${@:2}" >out 2>err || { cat err >&2; exit 1; }
  awk 'END {printf "%.3f %.1f\n", $1 + $2, $3 / 1024}' cost
}
median() { sort -g "$1" | awk '{v[NR] = $1} END {printf "%.3f", v[int((NR + 1) / 2)]}'; }

printf '%-34s %9s %9s %6s %9s %9s %6s\n' command 'old s' 'new s' ratio 'old MB' 'new MB' ratio
for name in "${names[@]}"; do
  "$old/hs-identify" -q "$name.csv" --body "$name.ply" --effects elastic -o "$name-model.csv"
  for command in "hs-identify $name.csv --body $name.ply --effects elastic -o m.csv" \
    "hs-diagnose $name.csv --body $name.ply --model $name-model.csv -o e.csv" \
    "hs-simulate $name.csv --body $name.ply --model $name-model.csv -o f.csv"; do
    read -ra words <<<"$command"
    one "$old" "${words[@]}" >/dev/null
    one "$new" "${words[@]}" >/dev/null
    rm -f old-s new-s old-m new-m
    for ((k = 0; k < pairs; ++k)); do
      for build in old new; do
        read -r seconds memory < <(one "${!build}" "${words[@]}")
        echo "$seconds" >>$build-s
        echo "$memory" >>$build-m
      done
    done
    printf '%-34s %9s %9s ' "${words[0]} $name" "$(median old-s)" "$(median new-s)"
    awk -v a="$(median old-s)" -v b="$(median new-s)" 'BEGIN {printf "%6.3f ", b / a}'
    awk -v a="$(median old-m)" -v b="$(median new-m)" 'BEGIN {printf "%9.1f %9.1f %6.3f\n", a, b, b / a}'
  done
done
