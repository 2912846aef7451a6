#!/usr/bin/env bash
# run.sh BIN OUT [CAUSE...]: causes in the set-up, which bodies know nothing of, given one at a time to recordings that
# CalculiX computed of a block and a ball (bench/independent), diagnosed as a user would; a table at the end. OUT may be
# that of bench/independent/run.sh. What is there is not made again: delete OUT/worlds/diagnosed to diagnose anew. Causes
# that no effect of the catalogue covers (strangers.py, newcomers.py, outsiders.py, visitors.py, guests.py,
# callers.py, strays.py, drifters.py, latecomers.py, passersby.py, wayfarers.py) come in three sizes over the noise
# (NAME-2, -4, -8).
# BODIES=cuboid: that body alone; THIN=1: fewer places and samples, in a third of the time.
# Recorded in bench/results/open-world.txt.
set -euo pipefail
bin=$1 out=$2
shift 2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
for program in ccx gmsh /usr/bin/python3; do
  command -v "$program" >/dev/null || { echo "open-world: skipped, $program is missing" >&2; exit 0; }
done
python=/usr/bin/python3 worlds=$out/worlds
"$python" -c 'import numpy' || { echo "open-world: skipped, python3-numpy is missing" >&2; exit 0; }
export PYTHONPATH=$here/../independent
mkdir -p "$worlds/diagnosed"
for body in ${BODIES:-cuboid ball}; do
  "$python" "$here/../independent/stiffnesses.py" "$out" "$body" 4 plain >&2
  "$python" "$here/../independent/make.py" "$out" "null-$body" 2>/dev/null
  null=$out/data/null-$body.csv
  [[ -e $out/$body-stl.ply ]] || "$bin/hs-tetmesh" -q "$out/$body.stl" -o "$out/$body-stl.ply"
  if [[ -n ${THIN:-} ]]; then
    "$python" "$here/thin.py" "$null" >"$out/thin-$body.csv"
    null=$out/thin-$body.csv
  fi
  "$python" "$here/worlds.py" "$null" "$out" "$worlds" "$body" "$@"
  for data in "$worlds/data/$body"-*.csv; do
    world=$(basename "$data" .csv) results=$worlds/diagnosed
    [[ $# -eq 0 || " $* " == *" ${world#"$body"-} "* ]] || continue
    [[ ! -e $results/$world.json ]] || continue
    [[ -e $results/$world.m0.csv ]] || "$bin/hs-identify" -q "$data" --body "$out/$body-stl.ply" --effects elastic \
      -o "$results/$world.m0.csv" || { echo "$world: hs-identify failed" >&2; continue; }
    "$bin/hs-diagnose" -q "$data" --body "$out/$body-stl.ply" --model "$results/$world.m0.csv" \
      -o "$results/$world.csv" --json "$results/$world.part" || { echo "$world: hs-diagnose failed" >&2; continue; }
    mv "$results/$world.part" "$results/$world.json"
  done
done
"$python" "$here/table.py" "$worlds"
