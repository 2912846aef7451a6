# Sourced after tool.sh, with BIN in $bin: block.ply, and data.csv of a material that relaxes once
# (truth.csv), with noise; clean.csv without.
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
