#!/usr/bin/env bash
# run.sh BUILD OUT [SEEDS [LEVELS [TRUTH...]]]: trials of the diagnosis on the shipped phantom. The
# results in OUT/trials.csv are gone on with when it is run again; delete the file to begin anew.
# VERBOSE=1 prints what each diagnosis found.
set -euo pipefail
build=$1 out=$2 seeds=${3:-3} levels=${4:-0.5,1,3}
shift $(($# < 4 ? $# : 4))
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
phantom=$root/share/examples/phantom
mkdir -p "$out"
if [[ ! -e $out/true.ply ]]; then
  awk -v what=motion -f "$phantom/geometry.awk" >"$out/motion.csv"
  awk -v what=surface -f "$phantom/geometry.awk" >"$out/surface.stl"
  "$build/bin/hs-tetmesh" -q "$out/surface.stl" -o "$out/true.ply"
  "$build/bin/hs-scan2ply" -q "$phantom/scan.csv" --unit mm | "$build/bin/hs-reconstruct" -q |
    "$build/bin/hs-tetmesh" -q -o "$out/diagnosed.ply"
fi
"$build/bench/diagnosis/bench_diagnosis" "$out/diagnosed.ply" "$out/true.ply" "$out/motion.csv" \
  "$out/trials.csv" "$seeds" "$levels" "$@"
