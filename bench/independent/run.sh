#!/usr/bin/env bash
# run.sh BIN OUT [scan|stl [NAME...]]: recordings that CalculiX computed on meshes of Gmsh's, diagnosed as a
# user would. OUT keeps the stiffnesses (an hour on two cores), the recordings and the results;
# what is there is not made again: delete OUT/diagnosed to diagnose anew.
# Recorded in bench/results/independent-*.txt (bench/record.sh).
set -euo pipefail
bin=$1 out=$2 from=${3:-stl}
shift $(($# < 3 ? $# : 3))
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
for program in ccx gmsh /usr/bin/python3; do
  command -v "$program" >/dev/null || { echo "independent: skipped, $program is missing" >&2; exit 0; }
done
python=/usr/bin/python3
"$python" -c 'import numpy' || { echo "independent: skipped, python3-numpy is missing" >&2; exit 0; }
mkdir -p "$out"
if [[ ${HAPSIM_SOLVE:-yes} == yes ]]; then
  for body in cuboid ball organ; do
    "$python" "$here/stiffnesses.py" "$out" "$body" 4 plain base anisotropic regions inclusion layer
  done
  "$python" "$here/stiffnesses.py" "$out" organ 6 plain base
  "$python" "$here/finite.py" "$out"
fi
"$python" "$here/make.py" "$out" "$@"
for body in cuboid ball organ; do
  target=$out/$body-$from.ply
  if [[ ! -e $target ]]; then
    if [[ $from == scan ]]; then
      "$bin/hs-scan2ply" -q "$out/${body}_scan.csv" | "$bin/hs-reconstruct" -q | "$bin/hs-tetmesh" -q -o "$target"
    else
      "$bin/hs-tetmesh" -q "$out/$body.stl" -o "$target"
    fi
  fi
done
results=$out/diagnosed/$from
mkdir -p "$results"
[[ $# -gt 0 ]] && names=("$@") || mapfile -t names < <(tail -n +2 "$out/truth.csv" | cut -d, -f1)
for name in "${names[@]}"; do
  data=$out/data/$name.csv
  [[ -e $data && ! -e $results/$name.json ]] || continue
  body=$out/$(awk -F, -v n="$name" '$1 == n { print $2 }' "$out/truth.csv")-$from.ply
  "$bin/hs-identify" -q "$data" --body "$body" --effects elastic -o "$results/$name.m0.csv" ||
    { echo "$name: hs-identify failed" >&2; continue; }
  began=$(date +%s)
  "$bin/hs-diagnose" -q "$data" --body "$body" --model "$results/$name.m0.csv" -o "$results/$name.csv" \
    --json "$results/$name.part" || { echo "$name: hs-diagnose failed" >&2; continue; }
  echo $(($(date +%s) - began)) >"$results/$name.seconds"
  mv "$results/$name.part" "$results/$name.json"
  "$python" "$here/table.py" "$out" "$from" "$name"
done
echo
"$python" "$here/table.py" "$out" "$from"
