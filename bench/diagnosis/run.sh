#!/usr/bin/env bash
# run.sh BUILD OUT [FROM:TO [LOW:HIGH [TRUTH...]]] [--verbose] [--keep FOLDER]: trials on the shipped
# phantom, seeds FROM to TO, errors LOW to HIGH times the noise. The results in OUT/trials.csv are
# gone on with when it is run again; delete the file to begin anew. Two runs at once share nothing:
# give each an OUT of its own and put the files together. Truths whose finite elements are solved
# (regions, layer, anisotropic, base, inclusion) take up to 13 GB: one such run at a time.
set -euo pipefail
build=$1 out=$2 seeds=${3:-1:8} levels=${4:-3:10}
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
