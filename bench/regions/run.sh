#!/usr/bin/env bash
# run.sh BIN OUT [NAME...]: blocks of two moduli with a straight boundary (the thesis's) and two S-shaped ones, solved by
# CalculiX on meshes of Gmsh's. hs-identify is told no number of regions: --add regions, then --refine-boundary (and
# Poisson's ratio, which is fixed). score.py says how far moduli and boundary are off, after either. NAME-2 is another
# draw of the noise. OUT keeps everything, and nothing that is there is made again: delete OUT/found to look again.
# Recorded in bench/results/regions.txt (bench/record.sh).
set -euo pipefail
[[ -n ${2-} && -x $1/hs-identify ]] || { echo "usage: run.sh BIN OUT [NAME...]" >&2; exit 2; }
bin=$1 out=$2
shift 2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
programs=(/usr/bin/python3)
[[ ${HAPSIM_SOLVE:-yes} == yes ]] && programs+=(ccx gmsh)
for program in "${programs[@]}"; do
  command -v "$program" >/dev/null || { echo "regions: $program is missing" >&2; exit 5; }
done
/usr/bin/python3 -c 'import numpy' || { echo "regions: python3-numpy is missing" >&2; exit 5; }
[[ $# -gt 0 ]] && names=("$@") || names=(straight s-across s-along)
export PYTHONPATH=$here/../independent
mkdir -p "$out/found"
if [[ ${HAPSIM_SOLVE:-yes} == yes ]]; then /usr/bin/python3 "$here/solve.py" "$out" "${names[@]%-[0-9]}" >&2; fi
/usr/bin/python3 "$here/record.py" "$out" "${names[@]}"
[[ -e $out/cuboid.ply ]] || "$bin/hs-tetmesh" -q "$out/cuboid.stl" -o "$out/cuboid.ply"
# identify FLAGS... TO: OUT/found/TO, there when it has ended well (interrupted, hs-identify leaves the best so far).
identify() {
  local to=$out/found/${!#}
  [[ -e $to ]] && return
  nice "$bin/hs-identify" -q "${@:1:$#-1}" --body "$out/cuboid.ply" --folds 0 --threads 1 -o "$to.part.csv" &&
    mv "$to.part.csv" "$to"
}
for name in "${names[@]}"; do
  nu=0.4
  [[ $name == straight* ]] && nu=0.3
  data=$out/data/$name.csv
  [[ -e $data ]] || continue
  identify "$data" --add regions --fix "nu=$nu" "$name-added.csv" &&
    identify "$data" --model "$out/found/$name-added.csv" --refine-boundary 8 "$name-refined.csv" ||
    echo "$name: hs-identify failed" >&2
done
/usr/bin/python3 "$here/score.py" "$out" found "${names[@]}"
