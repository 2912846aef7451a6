#!/usr/bin/env bash
# run.sh BIN OUT [NUMBER...]: phantoms with nothing, one or two lumps inside, solved by CalculiX on meshes of Gmsh's,
# recorded with noise and with contact points that lie off, each body's truth sealed in a file of its own;
# hs-identify --lumps says what is inside, and score.py opens the truths. Bodies NUMBER (0 to 19; beyond 19 the same
# kinds drawn anew). OUT keeps everything, and nothing that is there is made again: delete OUT/found to look again.
# Recorded in bench/results/lumps.txt (bench/record.sh).
set -euo pipefail
[[ -n ${2-} && -x $1/hs-identify ]] || { echo "usage: run.sh BIN OUT [NUMBER...]" >&2; exit 2; }
bin=$1 out=$2
shift 2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
programs=(/usr/bin/python3)
[[ ${HAPSIM_SOLVE:-yes} == yes ]] && programs+=(ccx gmsh)
for program in "${programs[@]}"; do
  command -v "$program" >/dev/null || { echo "lumps: $program is missing" >&2; exit 5; }
done
/usr/bin/python3 -c 'import numpy' || { echo "lumps: python3-numpy is missing" >&2; exit 5; }
[[ $# -gt 0 ]] && numbers=("$@") || numbers=({0..19})
export PYTHONPATH=$here/../independent
mkdir -p "$out/found"
if [[ ${HAPSIM_SOLVE:-yes} == yes ]]; then /usr/bin/python3 "$here/solve.py" "$out" "${numbers[@]}" >&2; fi
/usr/bin/python3 "$here/record.py" "$out" "${numbers[@]}"
for body in cuboid organ; do
  [[ -e $out/$body.ply ]] || "$bin/hs-tetmesh" -q "$out/$body.stl" -o "$out/$body.ply"
done
for number in "${numbers[@]}"; do
  name=$(printf 'body-%03d' "$number")
  [[ -e $out/data/$name.csv && ! -e $out/found/$name.csv ]] || continue
  body=$out/$(sed -n 's/^# object: //p' "$out/data/$name.csv").ply
  nice "$bin/hs-identify" -q "$out/data/$name.csv" --body "$body" --folds 0 --threads 1 -o "$out/found/$name.model.csv" \
    --lumps "$out/found/$name.csv" || echo "$name: hs-identify failed" >&2
done
/usr/bin/python3 "$here/score.py" "$out" asked
