#!/usr/bin/env bash
# run.sh BIN: what measured torques tell beside forces: values and standard errors of hs-identify from forces alone
# (as a fit without torques has them, and weighed by position as beside torques), and with torques. A block of
# 60 x 50 x 40 mm, a tool of 3 mm to 1.5 mm deep; the recordings come from meshes with finer rims. Two minutes.
set -euo pipefail
bin=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export XDG_CACHE_HOME=$work/cache
awk 'BEGIN {
  print "OFF"; print 8, 12, 0
  for (i = 0; i < 8; ++i) print (i % 2) * 0.06, (int(i / 2) % 2) * 0.05, (i >= 4) * 0.04
  split("0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5", f, ",")
  for (i = 1; i <= 12; ++i) print 3, f[i]
}' >box.off
"$bin/hs-tetmesh" -q box.off -o block.ply

motion() { # POINTS SLANT: three presses a point; slanted to two sides and along y, or straight down (0)
  awk -v points="$1" -v slant="$2" 'BEGIN {
    print "# tool_radius: 0.003\npress,t,x,y,z,ux,uy,uz"
    n = split(points, at, " ") / 2
    for (k = 0; k < n; ++k) for (s = -1; s <= 1; ++s) for (i = 0; i <= 20; ++i) {
      d = 0.0015 * (i <= 10 ? i : 20 - i) / 10
      printf "%d,%.2f,%s,%s,0.04,%.6g,%.6g,%.6g\n", 3 * k + s + 2, 0.05 * i, at[2 * k + 1], at[2 * k + 2],
        slant * 0.6 * s * d, slant * (s == 0 ? 0.5 : 0) * d, -d
    } }'
}
model() { # STATE REGIONS: 1 of 200 kPa, or with one of 600 kPa from x = 45 mm on
  echo 'effect,region,parameter,value,unit,std_error,lower,upper,state'
  echo "elastic,0,E,200000,Pa,,,,$1"
  ((${2} == 1)) || echo "elastic,1,E,600000,Pa,,,,$1"
  echo "elastic,0,nu,0.42,1,,,,$1"
  ((${2} == 1)) || printf 'regions,%d,%s%d,%s,m,,,,fixed\n' 0 x 1 0.033 0 y 1 0.025 1 x 2 0.057 1 y 2 0.025
}
tell() { # NAME POINTS SLANT REGIONS
  motion "$2" "$3" >motion.csv
  model fixed "$4" >truth.csv
  model free "$4" >start.csv
  "$bin/hs-simulate" -q motion.csv --body block.ply --model truth.csv --rim-edge 0.12 --torques --add-noise 0.004 \
    --add-torque-noise 1.6e-5 -o data.csv
  sed 's/^# torque_noise.*/# torque_noise: 1000/' data.csv >numb.csv
  for how in 'forces alone' 'weighed by position' 'with torques'; do
    case $how in
      forces*) "$bin/hs-identify" -q data.csv --body block.ply --model start.csv --folds 0 --ignore-torques -o m.csv ;;
      weighed*) "$bin/hs-identify" -q numb.csv --body block.ply --model start.csv --folds 0 -o m.csv ;;
      *) "$bin/hs-identify" -q data.csv --body block.ply --model start.csv --folds 0 -o m.csv ;;
    esac
    printf '%-44s %-20s %s\n' "$1" "$how" "$(awk -F, '$1 == "elastic" {
      printf $3 == "nu" ? "nu %.4f +- %.4f" : "E" $2 " %.1f +- %.1f kPa  ", $3 == "nu" ? $4 : $4 / 1000, $3 == "nu" ? $6 : $6 / 1000 }' m.csv)"
  done
}
middle='0.03 0.025 0.035 0.02 0.025 0.03' edge='0.055 0.02 0.03 0.006 0.006 0.043 0.047 0.0055'
beside='0.03 0.025 0.038 0.02 0.041 0.03'
tell 'slanted, in the middle' "$middle" 1 1
tell 'slanted, near edges' "$edge" 1 1
tell 'straight down, in the middle' "$middle" 0 1
tell 'straight down, near edges' "$edge" 0 1
tell 'a region beside the tool, straight down' "$beside" 0 2
tell 'a region beside the tool, slanted' "$beside" 1 2
