#!/usr/bin/env bash
# closed.sh BIN OUT [CASE...]: forces above closed regions inside a block and a ball against CalculiX on meshes of Gmsh's
# that follow the regions' exact shapes (closed.py); and the moduli that hs-identify finds of two of them.
# The bodies are hapsim's own (hs-tetmesh --region), that of open-stiff, whose region reaches the surface, Gmsh's.
# MODES="live full" has these modes besides, GROWTH=yes a fit of regions that were drawn too small (it was ended at 400 s).
# OUT keeps the truths and nothing that is there is solved again. Recorded in bench/results/regions-closed.txt.
set -euo pipefail
[[ -n ${2-} && -x $1/hs-simulate ]] || { echo "usage: closed.sh BIN OUT [CASE...]" >&2; exit 2; }
bin=$1 out=$2
shift 2
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
for program in /usr/bin/python3 ccx gmsh; do
  command -v "$program" >/dev/null || { echo "closed: $program is missing" >&2; exit 5; }
done
export PYTHONPATH=$here:$here/../independent
all=$(/usr/bin/python3 -c 'import closed; print(*closed.CASES)')
read -ra names <<<"${*:-$all}"
mkdir -p "$out/closed"
[[ ${HAPSIM_SOLVE:-yes} != yes ]] || /usr/bin/python3 "$here/closed.py" "$out" "${names[@]}" >&2
/usr/bin/python3 -c "import pathlib, make; make.write_bodies(pathlib.Path('$out'))"
model() { # CASE: its true model
  /usr/bin/python3 - "$1" <<'PY'
import sys, closed
_, regions = closed.CASES[sys.argv[1]]
print("effect,region,parameter,value,state")
for k, ratio in enumerate([1.0] + [r for _, r, _ in regions]):
    print("elastic,%d,E,%g,free" % (k, ratio * closed.MODULUS))
print("elastic,0,nu,%g,fixed" % closed.POISSON)
PY
}
for name in "${names[@]}"; do
  of=$out/closed/$name
  body=$(/usr/bin/python3 -c "import closed; print(closed.CASES['$name'][0])")
  if [[ ! -e $of.ply ]]; then
    if [[ $name == open* ]]; then
      /usr/bin/python3 -c "import closed; closed.write_body('$out', '$name')"
      "$bin/hs-tetmesh" -q "$of.msh" --fixed bottom -o "$of.ply"
    else
      regions=()
      for file in "$of"-[0-9].stl; do regions+=(--region "$file"); done
      "$bin/hs-tetmesh" -q "$out/$body.stl" "${regions[@]}" -o "$of.ply"
    fi
  fi
  model "$name" >"$of.csv"
  /usr/bin/python3 "$here/closed_motion.py" "$out" "$name" >"$of-motion.csv"
  "$bin/hs-simulate" -q "$of-motion.csv" --body "$of.ply" --model "$of.csv" -o "$of-batch.csv"
  results=("batch=$of-batch.csv")
  for mode in ${MODES-}; do
    "$bin/hs-simulate" -q "$of-motion.csv" --body "$of.ply" --model "$of.csv" "--$mode" -o "$of-$mode.csv"
    results+=("$mode=$of-$mode.csv")
  done
  /usr/bin/python3 "$here/closed_score.py" "$out" "$name" "${results[@]}"
  [[ $name == two ]] || continue
  /usr/bin/python3 "$here/closed_motion.py" "$out" "$name" 1 >"$of-data.csv"
  "$bin/hs-identify" -q "$of-data.csv" --body "$of.ply" --fix nu=0.42 --add regions --regions labels --folds 0 -o "$of-found.csv"
  awk -F, 'NR == FNR { if ($3 == "E") e[$2] = $4; next }
    $3 == "E" { printf "two           found: E of region %d %.0f +- %.0f Pa of %.0f, %.1f %% off, %.1f standard errors\n",
      $2, $4, $6, e[$2], 100 * ($4 / e[$2] - 1), ($4 - e[$2]) / $6 }' "$of.csv" "$of-found.csv"
  # Regions that were drawn 1.5 mm too small all around: moduli and growth together, which hardly differ in what they do: ten
  # rounds or so of finite elements, half a second of a processor a place each (72 s in all).
  [[ ${GROWTH-} == yes ]] || continue
  if [[ ! -e $of-small.ply ]]; then
    /usr/bin/python3 -c "import closed; closed.write_surfaces('$out', '$name', 1.5)"
    "$bin/hs-tetmesh" -q "$out/$body.stl" --region "$of-small-1.stl" --region "$of-small-2.stl" -o "$of-small.ply"
  fi
  { sed 's/^\(elastic,[12],E\),[^,]*/\1,20000/' "$of.csv"
    echo "elastic,1,growth,0,free"; echo "elastic,2,growth,0,free"; } >"$of-small.csv"
  "$bin/hs-identify" -q "$of-data.csv" --body "$of-small.ply" --model "$of-small.csv" --folds 0 -o "$of-grown.csv"
  awk -F, '$1 == "elastic" && $2 > 0 { e = $3 == "E" ? ($2 == 1 ? 80000 : 8000) : 0.0015
    printf "two           drawn 1.5 mm too small: %s of region %d %.4g +- %.2g of %g, %.1f standard errors\n",
      $3, $2, $4, $6, e, ($4 - e) / $6 }' "$of-grown.csv"
done
