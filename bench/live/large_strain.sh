#!/usr/bin/env bash
# large_strain.sh BUILD OUT [PRESSES [SAMPLES [EDGE...]]]: hs-simulate --live --large-strain against finite elements, on
# a block 80 x 60 x 30 mm that is pressed to 30 % of its thickness with a tool of 4 mm at places that its samples do
# not have (bench_large_strain says what the rows are), elastic and relaxing. EDGE [m] is of the body's mesh: 0.0042 has
# 10,000 tetrahedra, 0.0019 has 107,000. Beside them, what one press takes CalculiX on the same tetrahedra, where it is
# installed (neo-Hookean, first order, one thread; the mesh is coarse for the tool, so its time alone counts). For
# comparison: Byeon and Lee (doi 10.1007/s00466-020-01815-3) published 16,481 nodes in less than 1 ms by a GPU, of
# hexahedra all alike. BODY=dome: half an ellipsoid 110 x 84 x 38 mm (the phantom's) instead of the block, pressed about
# its pole; EDGE `plain`: as hs-tetmesh has it by itself. The samples stay in OUT/cache, so an interrupted call is gone
# on with.
# Recorded in bench/results/large-strain.txt (bench/record.sh).
set -euo pipefail
(($# >= 2)) || { echo 'usage: large_strain.sh BUILD OUT [PRESSES [SAMPLES [EDGE...]]]' >&2; exit 2; }
build=$(cd "$1" && pwd)
mkdir -p "$2/cache"
out=$(cd "$2" && pwd) presses=${3:-5} samples=${4:-24}
shift $(($# < 4 ? $# : 4))
body=${BODY:-block} edges=(0.0042)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
[[ $body != dome ]] || edges=(plain)
(($# == 0)) || edges=("$@")
cd "$out"
export HAPSIM_BENCH_CACHE=$out/cache

case $body in
  block)
    point=0.04,0.034,0.03 depth=0.009
    awk 'BEGIN { X = 0.08; Y = 0.06; Z = 0.03; print "OFF\n8 12 0"
      for (k = 0; k < 2; k++) for (j = 0; j < 2; j++) for (i = 0; i < 2; i++) print i * X, j * Y, k * Z
      print "3 0 2 1\n3 1 2 3\n3 4 5 6\n3 5 7 6\n3 0 1 4\n3 1 5 4\n3 2 6 3\n3 3 6 7\n3 0 4 2\n3 2 4 6\n3 1 3 5\n3 3 7 5" }' >block.off
    printf '%s,0.03\n' 0.028,0.022 0.040,0.022 0.052,0.022 0.028,0.034 0.040,0.034 0.052,0.038 >contacts.csv
    ;;
  dome)
    point=0,0,0.038 depth=0.0114
    awk -v what=dome -v a=0.055 -v b=0.042 -v c=0.038 -v n=96 -v m=32 -v lobe=0 -f "$here/../../share/examples/shapes.awk" \
      >dome.off
    printf '%s\n' 0,0,0.038 0.01233,0.00544,0.03671 -0.01233,0.00544,0.03671 0,-0.01087,0.03671 0,0.01972,0.03355 \
      -0.02236,-0.00986,0.03355 >contacts.csv
    ;;
  *) echo "large_strain.sh: no body $body" >&2; exit 2 ;;
esac
cat >elastic.csv <<'END'
effect,region,parameter,value,unit,std_error,lower,upper,state
elastic,0,E,20000,Pa,,1,1e12,fixed
elastic,0,nu,0.4,1,,0,0.499,fixed
hyperelastic,0,s,0.2,1,,0,1.2,fixed
hyperelastic,0,finite,1,1,,0,1,fixed
END
{ head -n 3 elastic.csv; printf 'viscoelastic,0,E1,8000,Pa,,0,1e12,fixed\nviscoelastic,0,tau1,0.2,s,,0.0001,100000,fixed\n'
  tail -n 2 elastic.csv; } >relaxing.csv
for edge in "${edges[@]}"; do
  size=()
  [[ $edge == plain ]] || size=(--edge "$edge")
  "$build/bin/hs-tetmesh" -q "$body.off" "${size[@]}" -o "$body-$edge.ply"
  for model in elastic relaxing; do
    echo "$body, $model, edges $edge:"
    "$build/bench/live/bench_large_strain" "$body-$edge.ply" $model.csv contacts.csv "$presses" "$samples"
  done
  command -v ccx >/dev/null || continue
  sed 's/^hyperelastic,0,s,0.2/hyperelastic,0,s,0/' elastic.csv >neo.csv
  printf '# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz,fx,fy,fz,contact\n' >press.csv
  printf '0,%s,%s,0,0,%s,0,0,%s,1\n' 0 "$point" 0 0 1 "$point" "-$depth" -1 >>press.csv
  "$build/bin/hs-export" -q neo.csv --body "$body-$edge.ply" --data press.csv --press 0 --format calculix -o press.inp
  OMP_NUM_THREADS=1 command time -f '%U %S %M' -o took ccx press >ccx.log
  awk -v iterations="$(grep -c '^ *iteration' ccx.log)" '
    { printf "CalculiX, one press of the same tetrahedra: %.1f s of a processor, %d iterations, %.0f MB\n", $1 + $2, iterations, $3 / 1024 }' took
done
