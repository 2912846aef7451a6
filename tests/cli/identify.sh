#!/usr/bin/env bash
# identify.sh BIN: what hs-identify refuses and how it says so; terms and windows.
set -uo pipefail
bin=$1
. "$(dirname "${BASH_SOURCE[0]}")/tool.sh" "$1/hs-identify"
# A block of 60 x 60 x 30 mm on its support, as a closed surface.
cat >block.stl <<'STL'
solid block
STL
awk 'BEGIN {
  split("0 0 0,.06 0 0,.06 .06 0,0 .06 0,0 0 .03,.06 0 .03,.06 .06 .03,0 .06 .03", v, ",")
  split("1 3 2,1 4 3,5 6 7,5 7 8,1 2 6,1 6 5,2 3 7,2 7 6,3 4 8,3 8 7,4 1 5,4 5 8", f, ",")
  for (i = 1; i <= 12; ++i) {
    split(f[i], c, " ")
    print "facet normal 0 0 0\nouter loop"
    for (k = 1; k <= 3; ++k) print "vertex " v[c[k]]
    print "endloop\nendfacet"
  }
  print "endsolid block"
}' >>block.stl
"$bin/hs-tetmesh" -q block.stl -o block.ply || complain 'the block is meshed'
# motion: two positions, slanting presses of 1 s with a hold of 2 s
awk 'BEGIN {
  print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"
  for (p = 0; p < 4; ++p)
    for (i = 0; i <= 60; ++i) {
      t = 0.05 * i; s = 0.002 * (t < 1 ? t : 1)
      printf "%d,%.2f,%.3f,0.03,0.03,%.6f,0,%.6f\n", p, t, p < 2 ? 0.02 : 0.04, p % 2 ? s / 2 : 0, -s
    }
}' >motion.csv
cat >truth.csv <<'CSV'
effect,region,parameter,value,unit,std_error,lower,upper,state
elastic,0,E,10000,Pa,,1,1e12,free
elastic,0,nu,0.4,1,,0,0.499,free
viscoelastic,0,E1,6000,Pa,,0,1e12,free
viscoelastic,0,tau1,0.4,s,,0.0001,100000,free
CSV
export XDG_CACHE_HOME=$work/cache
"$bin/hs-simulate" -q motion.csv --body block.ply --model truth.csv --rim-edge 0.3 >clean.csv ||
  complain 'the motion is simulated'
awk -F, -v OFS=, '/^#/ { print; next } !h { h = 1; for (i = 1; i <= NF; ++i) c[$i] = i; print; next }
  BEGIN { srand(2) } { for (k = 9; k <= 11; ++k) { g = -6; for (j = 0; j < 12; ++j) g += rand()
  $k = sprintf("%.6f", $k + 0.002 * g) } print }' clean.csv >data.csv
common=(--body block.ply --rim-edge 0.3 --folds 0 -o out.csv)

expect 0 'viscoelastic tau1 = 0.' data.csv "${common[@]}" --add viscoelastic --terms auto:3
grep -q '1 term of viscoelastic chosen' .err || complain 'one term is chosen'
grep -q 'slower than 3 s is not identifiable' .err || complain 'what the holds do not tell is said'
expect 0 'viscoelastic tau1' data.csv "${common[@]}" --add viscoelastic --windows 0.1:1
grep -q '^viscoelastic,0,tau1,.*,0.1,1,free' out.csv || complain 'a window becomes bounds'
expect 2 'the windows of the relaxation times overlap' data.csv "${common[@]}" --add viscoelastic \
  --windows 0.1:1,0.5:3
expect 2 '--terms many is not a number of terms' data.csv "${common[@]}" --terms many
expect 2 '--windows 3 is no window' data.csv "${common[@]}" --windows 3

rm -f out.csv
awk '/^#/ || !n++ || n == 22' data.csv >one-row.csv # three components
expect 3 '3 force components cannot tell 4 free parameters' one-row.csv "${common[@]}" --noise 0.01 \
  --add sensor-rotation --fix nu
awk -F, -v OFS=, '/^[0-9]/ { $6 = $7 = $8 = 0 } 1' data.csv >still.csv
expect 3 'no row presses the body' still.csv "${common[@]}"
awk -F, -v OFS=, '/^[0-9]/ { $9 = -$9; $10 = -$10; $11 = -$11 } 1' data.csv >sign.csv
expect 3 'the forces point the wrong way' sign.csv "${common[@]}"
awk -F, -v OFS=, '/^[0-9]/ { $11 *= 1000 } 1' data.csv >milli.csv
expect 3 'column fz is some' milli.csv "${common[@]}"
sed '20s/,[^,]*$/,nan/' data.csv >nan.csv
expect 3 'nan.csv' nan.csv "${common[@]}"
awk -F, -v OFS=, '/^[0-9]/ { $5 = 0.09 } 1' data.csv >outside.csv
expect 3 'surface' outside.csv "${common[@]}"
awk -F, '/^[0-9]/ { if ($1 > 1) next } 1' data.csv >place.csv
expect 2 'too few contact positions' place.csv "${common[@]}" --add regions
[[ ! -e out.csv ]] || complain 'a refused run leaves nothing behind'

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
