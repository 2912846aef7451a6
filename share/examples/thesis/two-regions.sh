#!/bin/sh
# two-regions.sh [FOLDER]: a block of two foams in plan view, 20 places, 500 samples (thesis 6.4). The
# recording is simulated with finite elements of both regions and noise of 0.05 N. Needs the hs- tools
# on the PATH; writes into FOLDER (two-regions).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-two-regions}
mkdir -p "$out"
cd "$out"

awk -v what=cuboid -v a=0.12 -v b=0.21 -v c=0.06 -f "$here/../shapes.awk" >block.off
hs-tetmesh block.off --edge 0.035 -q -o block.ply
cat >foams.csv <<'END'
effect,region,parameter,value,unit
elastic,0,E,20000,Pa
elastic,0,nu,0.3,1
elastic,1,E,40000,Pa
regions,0,x,0.06,m
regions,0,y,0.05,m
regions,1,x,0.06,m
regions,1,y,0.15,m
END
awk 'BEGIN {
  print "# tool_radius: 0.004"; print "press,x,y,z,ux,uy,uz"
  for (i = 0; i < 4; ++i) for (j = 0; j < 5; ++j) {
    ++p
    for (k = 1; k <= 25; ++k) printf "%d,%g,%g,0.06,0,0,%.9g\n", p, 0.024 * (i + 1), 0.025 + 0.04 * j, -0.0004 * k
  }
}' >motion.csv
hs-simulate motion.csv --body block.ply --model foams.csv --add-noise 0.05 -q -o data.csv
hs-identify data.csv --body block.ply --add regions --regions 2 --fix nu=0.3 --folds 0 -o model.csv 2>said.txt
grep -E ' E |E \(region| error ' said.txt || true
awk -F, '$1 == "regions" && $3 ~ /^y/ { ++n; right += $2 == ($4 > 0.1) }
  END { printf "places in the right region: %d of %d (the thesis: all 20)\n", right, n }' model.csv
# The boundary by eight points, moved with the moduli until the forces fit.
hs-identify data.csv --body block.ply --model model.csv --refine-boundary 8 --folds 0 -o boundary.csv 2>moved.txt
grep -E ' E |E \(region| error ' moved.txt || true
# Half-way between the points of the one region and the other, inside the block: root mean square from y = 100 mm.
off=$(awk -F, '$1 == "regions" { v[$2, $3] = $4 }
  END { for (k = 1; k <= 8; ++k) { x = v[0, "x" k]; y = (v[0, "y" k] + v[1, "y" k]) / 2
      if (x > 0 && x < 0.12) { s += (y - 0.1) ^ 2; ++n } }
    printf "%.1f", 1000 * sqrt(s / n) }' boundary.csv)
echo "the boundary is off by $off mm"
awk -v OFS=, '/^#/ { print; next } !n++ { print $0, "t"; next } { print $0, n / 1000 }' motion.csv |
  hs-simulate --live - --body block.ply --model boundary.csv -o /dev/null 2>live.txt
{
  echo 'figure,thesis,ours'
  sed -n 's/.*ready in \([0-9.e+-]*\) s:.*/two regions: made ready [s],0.395,\1/p' live.txt
  sed -n 's/.*median \([0-9.]*\) us.*/\1/p' live.txt | awk '{ printf "two regions: a force [ms],15,%.4f\n", $1 / 1000 }'
  sed -n 's/^# rmse: \(.*\)/\1/p' boundary.csv | awk '{ printf "two regions: error with the boundary moved [N],0.1 to 0.3,%.4g\n", $1 }'
  echo "two regions: boundary off by [mm],a curve,$off"
  sed -n 's/^# rmse: \(.*\)/\1/p' model.csv | awk '{ printf "two regions: error before that [N],0.1 to 0.3,%.4g\n", $1 }'
  awk -F, '$1 == "regions" && $3 ~ /^y/ { ++n; right += $2 == ($4 > 0.1) }
    END { printf "two regions: places in the right one,20 of 20,%d of %d\n", right, n }' model.csv
} >summary.csv
# The places in plan view, coloured by the region they were given, and the hidden boundary.
awk -F, 'BEGIN { print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 300 460\" font-family=\"sans-serif\" font-size=\"12\">"
    print "<rect width=\"300\" height=\"460\" fill=\"white\"/><text x=\"30\" y=\"20\">Regions found at 20 places</text>"
    print "<rect x=\"30\" y=\"30\" width=\"240\" height=\"420\" fill=\"none\" stroke=\"black\"/>"
    print "<path d=\"M30 250H270\" stroke=\"black\" stroke-dasharray=\"6 4\"/>" }
  $1 == "regions" && $3 ~ /^x/ { x[substr($3, 2), $2] = $4 }
  $1 == "regions" && $3 ~ /^y/ { printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"8\" fill=\"%s\"/>\n",
    30 + 2000 * x[substr($3, 2), $2], 450 - 2000 * $4, $2 ? "#d55e00" : "#0072b2" }
  END { print "</svg>" }' model.csv >regions.svg
echo 'hidden: E = 20 and 40 kPa, the boundary at y = 100 mm; noise 0.05 N. The thesis: error 0.1 to 0.3 N.'
