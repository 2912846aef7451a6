#!/usr/bin/env bash
# scan2ply.sh BIN: what hs-scan2ply prints, writes and returns, for every kind of input.
set -uo pipefail
bin=$(cd "$1" && pwd)
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
example=$root/share/examples/robot
. "$root/tests/cli/tool.sh" "$bin/hs-scan2ply"
# refuse TEXT ARGUMENTS...: bad input in one line, and nothing left behind
refuse() {
  rm -f none.ply
  expect 3 "$@" -o none.ply
  [[ $(wc -l <.err) == 1 ]] || complain "not one line: ${*:2}"
  [[ ! -e none.ply ]] || complain "something is left behind: ${*:2}"
}

# A dome in millimetres: 900 points, some given twice, some far off.
awk 'BEGIN {
  print "x,y,z"
  for (i = 0; i < 900; ++i) {
    u = 2.399963 * i; s = sqrt((i + 0.5) / 900); z = 40 * sqrt(1 - 0.9 * s * s)
    row = sprintf("%.4f,%.4f,%.4f", 40 * s * cos(u), 40 * s * sin(u), z)
    print row
    if (i % 90 == 0) print row
    if (i % 90 == 45) printf "%.4f,%.4f,%.4f\n", 40 * s * cos(u), 40 * s * sin(u), z + 15
  }
}' >dome.csv
expect 0 'removed 10 given twice, 0 nearly so, ' dome.csv --unit mm --json j.json -o dome.ply
flat .err | grep -q 'kept 900 ' || complain 'the outliers are removed, and nothing else'
grep -q '"duplicates": 10' j.json || complain 'JSON counts what was removed'
refuse 'm wide when read in m; give its unit, as --unit mm' dome.csv

# The same points from every format.
tail -n +2 dome.csv | tr , ' ' >dome.xyz
awk -F, 'NR == 1 { next } { rows = rows "\n" $1 " " $2 " " $3; ++n }
  END { printf "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH %d\nHEIGHT 1\nPOINTS %d\nDATA ascii%s\n", n, n, rows }' dome.csv >dome.pcd
for file in dome.xyz dome.pcd; do
  "$bin/hs-scan2ply" -q "$file" --unit mm | cmp -s - dome.ply || complain "$file gives other points"
done
"$bin/hs-scan2ply" -q --unit mm <dome.csv | cmp -s - dome.ply || complain 'standard input gives other points'
"$bin/hs-scan2ply" -q dome.csv --unit mm --ascii -o ascii.ply || complain 'ASCII'
expect 0 'kept 900' ascii.ply --keep-outliers
expect 0 'kept 900' dome.ply --keep-outliers

# Too little, and what is no scan: one line each.
rows() { printf 'x,y,z\n'; printf '%s\n' "$@"; }
: >empty.csv
rows >none.csv
rows 0,0,0 >one.csv
rows 0,0,0 0,0.1,0 0.1,0,0 >three.csv
rows 0,0,0 0.1,0,0 0.2,0,0 0.3,0,0 0.4,0,0 >line.csv
rows 0,0,0 0,0,0 0,0,0 0,0,0 0,0,0 >same.csv
rows 0,0,0 0.1,0,0 nan,0,0 0.3,0,0 0.4,0,0 >nan.csv
rows 0,0,0 0.1,0 >short.csv
printf 'x,y,zz\n0,0,0\n' >column.csv
printf 'ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty double x\nproperty double y\nproperty double z\nend_header\nabc' >huge.ply
head -c 700 dome.ply >cut.ply
printf '# .PCD v0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nPOINTS 99999999999\nDATA binary\nabc' >huge.pcd
printf '# .PCD v0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 2\nDATA ascii\n1 2 3\n1 2\n' >short.pcd
refuse 'the file is empty' empty.csv
refuse 'there are no points' none.csv
refuse 'only 1 different point;' one.csv
refuse 'only 3 different points' three.csv
refuse 'all points lie on one line' line.csv
refuse 'only 1 different point;' same.csv
refuse "x is 'nan' (line 4)" nan.csv
refuse 'short.csv:3: 2 fields' short.csv
refuse "column 'z' is missing; did you mean" column.csv
refuse 'huge.ply' huge.ply
refuse 'cut.ply' cut.ply
refuse 'claims 99999999999 points' huge.pcd
refuse 'short.pcd:8: 2 numbers where the header names 3' short.pcd
expect 5 'missing.csv' missing.csv
# Flat is a surface too.
awk 'BEGIN { print "x,y,z"; for (i = 0; i < 20; ++i) for (j = 0; j < 20; ++j) printf "%g,%g,0\n", i / 200, j / 200 }' >flat.csv
expect 0 'kept 400' flat.csv

# A volume: a ball of radius 8 in voxels of 1 mm, linear across its surface.
awk 'BEGIN {
  print "NRRD0004\ntype: float\ndimension: 3\nsizes: 24 24 24\nencoding: ascii\nspacings: 1 1 1\n"
  for (k = 0; k < 24; ++k) for (j = 0; j < 24; ++j) for (i = 0; i < 24; ++i)
    printf "%.5f\n", 8 - sqrt((i - 11.5) ^ 2 + (j - 11.5) ^ 2 + (k - 11.5) ^ 2)
}' >ball.nrrd
expect 0 'NRRD, ASCII, 24 x 24 x 24 voxels' ball.nrrd --threshold 0 --ascii -o ball.ply
awk '/^end_header/ { on = 1; next } on { r = sqrt(($1 - 0.0115) ^ 2 + ($2 - 0.0115) ^ 2 + ($3 - 0.0115) ^ 2); if (r < 0.00795 || r > 0.00802) exit 1 }' ball.ply ||
  complain 'points of the ball'
expect 2 'by Otsu' ball.nrrd
refuse 'no voxel is above the threshold 99; values go from' ball.nrrd --threshold 99
refuse 'NRRD' short.csv --threshold 1
head -c 9000 ball.nrrd >cut.nrrd
refuse 'cut.nrrd' cut.nrrd --threshold 0
mkdir folder
refuse 'there is no DICOM image in it' folder --threshold 1

# Sections of a cone.
awk 'BEGIN { print "section,x,y,z"; for (s = 0; s < 12; ++s) for (i = 0; i < 60; ++i)
  printf "%d,%.5f,%.5f,%.5f\n", s, (0.04 - 0.002 * s) * cos(i * 0.10472), (0.04 - 0.002 * s) * sin(i * 0.10472), 0.004 * s }' >cone.csv
expect 0 'NORMALS given' cone.csv
refuse 'there are 1 sections' flat.csv --sections

# Zones: two that drifted by 2 mm, and one that does not meet the others.
awk 'BEGIN { srand(1); print "zone,x,y,z"; for (z = 0; z < 2; ++z) for (i = 0; i < 900; ++i) {
  x = 0.08 * rand() - 0.05 + 0.02 * z; y = 0.08 * rand() - 0.04
  printf "%s,%.6f,%.6f,%.6f\n", z ? "b" : "a", x + 0.001 * z, y, 0.05 - 5 * x * x - 7 * y * y + 0.003 * sin(90 * x) * cos(80 * y) + 0.002 * z
} }' >zones.csv
expect 0 'zone b shifted by ' zones.csv --register --fix-zone a --json z.json -o zones.ply
grep -Eq 'zone b shifted by -(0\.9|1\.0)[0-9]* -?0\.0[0-9]* -(1\.9|2\.0)' .err || complain 'the drift is found'
grep -q '"shift_std_error"' z.json || complain 'JSON has the zones'
sed 's/^b,/c,/; /^a/d; /^zone/d' zones.csv | awk -F, -v OFS=, '{ $2 += 0.5; print }' >far.rows
cat zones.csv far.rows >far.csv
refuse "zone 'c' overlaps the others too little" far.csv --register
refuse 'there is only one zone' dome.csv --unit mm --register

# Touch: 0.2 N on 100 N/m is 2 mm.
expect 0 'indentation of the touch undone: 2.000 mm' dome.csv --unit mm --touch-force 0.2 --touch-stiffness 100
expect 2 'add --touch-stiffness' dome.csv --unit mm --touch-force 0.2
expect 3 'column touch_force' dome.csv --unit mm --touch-stiffness 100

# The robot's example as it stands.
if PATH=$bin:$PATH "$example/robot.sh" . >.out 2>.err; then
  grep -q ' [0-9] of [0-9]* places out of reach' .err || complain 'some of the raster is out of reach'
  volume=$(sed -n 's/.* \([0-9.]*\) cm^3$/\1/p' .err)
  # Half an ellipsoid of 55, 42 and 38 mm: 183.85 cm^3.
  awk -v v="$volume" 'BEGIN { exit !(v > 180 && v < 188) }' || complain "volume $volume cm^3 instead of 183.9"
else
  complain 'robot.sh fails'
fi
# Planned points come back from their joint angles.
setup=(--robot "$example/arm.urdf" --tip-link sensor --mount 0.02,0,0.015 --object-frame 0.45,0.05,0.10,0,0,0.4)
"$bin/hs-scan2ply" -q plan.csv "${setup[@]}" --keep-outliers --ascii -o back.ply
paste -d, <(grep -v '^[#q]' plan.csv) <(awk '/^end_header/ { on = 1; next } on { print $1 "," $2 "," $3 }' back.ply) |
  awk -F, '{ if (($8 - $14) ^ 2 + ($9 - $15) ^ 2 + ($10 - $16) ^ 2 > 1e-18) exit 1 }' || complain 'plan and back'
expect 0 'out of reach: 1.0000,0.0000,0.0000' --robot "$example/arm.urdf" --scan-plan grid --area 0.4,0,1,0 --pitch 0.1 -o grid.csv
expect 1 'out of reach' --robot "$example/arm.urdf" --scan-plan grid --area 0.4,0,1,0 --pitch 0.1 --check -o grid.csv
expect 4 'none of 11 places can be reached' --robot "$example/arm.urdf" --scan-plan grid --area 4,0,5,0 --pitch 0.1 -o none.csv
printf 'X,Y,Z\n0.4,0,0.1\n0.45,0.05,0.12\n' >press.csv
expect 0 '2 poses, 0 of 2' press.csv --robot "$example/arm.urdf" --scan-plan positions --bar 0.12 -o press-plan.csv
"$bin/hs-scan2ply" -q press-plan.csv --robot "$example/arm.urdf" --bar 0.12 2>.err
grep -q 'only 2 different points' .err || complain 'a plan of two presses is read again'
expect 2 'add --robot' --scan-plan grid
expect 2 'holds 2 numbers' driven.csv "${setup[@]}" --beam 0,1
refuse "column 'q1' is missing" dome.csv "${setup[@]}"
refuse 'cells are not finite numbers' <(printf 'q1,q2,q3,q4,q5,q6,d\n0,0,0,0,0,0,\n0,0,0,0,0,0,x\n') "${setup[@]}"
head -c 900 "$example/arm.urdf" >cut.urdf
refuse 'cannot be read as URDF' driven.csv --robot cut.urdf
refuse "no link 'senser'; did you mean 'sensor'?" driven.csv --robot "$example/arm.urdf" --tip-link senser

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
