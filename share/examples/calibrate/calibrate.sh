#!/bin/sh
# calibrate.sh [FOLDER]: plans poses, calibrates a simulated rig by what its sensor shows in them and on a rigid
# block, and diagnoses a recording of that rig before and after. Needs hapsim's tools on the PATH; writes into
# FOLDER (here).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
cd "${1:-.}"

# Thirty poses, the sensor at rest in them.
hs-calibrate --plan plan.csv --plan-poses 30
awk -v what=poses -v seed=2 -f "$here/rig.awk" plan.csv >poses.csv

# A rigid block, pressed from above and from its sides: it does not move.
awk 'BEGIN { OFS = ","; print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz,fx,fy,fz"
  for (p = 1; p <= 6; ++p) for (i = 0; i <= 40; ++i) {
    for (k = 1; k <= 3; ++k) f[k] = 0
    f[(p + 1) % 3 + 1] = (p > 4 ? -25 : 25) * (1 - ((i - 20) / 20) ^ 2)  # z, x, y, z, -x, -y
    print p, i * 0.05, 0, 0, 0.04, 0, 0, 0, f[1], f[2], f[3] } }' |
  awk -v what=presses -v seed=3 -f "$here/rig.awk" >rigid.csv
hs-calibrate poses.csv --rigid rigid.csv -o cal.csv

# A soft block, pressed straight and sideways at six places; its forces from a mesh finer than any below.
awk -v what=cuboid -v a=0.06 -v b=0.05 -v c=0.04 -f "$here/../shapes.awk" >block.off
hs-tetmesh -q block.off -o body.ply
awk 'BEGIN { OFS = ","; print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"
  for (p = 0; p < 12; ++p) for (i = 0; i <= 30; ++i) {
    d = 0.0025 * (1 - ((i - 15) / 15) ^ 2); a = p * 2.4
    print p + 1, i * 0.05, 0.015 + 0.015 * (p % 3), 0.018 + 0.014 * (int(p / 3) % 2), 0.04,
      p < 6 ? 0 : 0.7 * d * cos(a), p < 6 ? 0 : 0.7 * d * sin(a), -d } }' >motion.csv
printf 'effect,region,parameter,value,unit\nelastic,0,E,150000,Pa\nelastic,0,nu,0.4,1\n' >truth.csv
hs-simulate -q motion.csv --body body.ply --model truth.csv --rim-edge 0.1 -o forces.csv
sed '/^# simulated/d; /^# force_noise/d' forces.csv | awk -v what=presses -v seed=4 -f "$here/rig.awk" >data.csv

for rig in raw calibrated; do
  set --
  [ $rig = raw ] || set -- --calibration cal.csv
  hs-identify data.csv "$@" --body body.ply --folds 0 -o m-$rig.csv
  hs-diagnose data.csv "$@" --body body.ply --model m-$rig.csv -o effects-$rig.csv
done
