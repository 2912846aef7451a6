#!/bin/sh
# scanned-sphere.sh [FOLDER]: thesis 6.5 from a scan to the hand. A laser's 130 points over 130 x 100 mm,
# some 72 of them on the upper half of a soft sphere, become a body of tetrahedra; over a network of
# 300 ms there and back, with jitter of 50 ms and 5 % of packets lost, it is identified from late forces
# while it is pressed, and felt at once from then on. What is pressed is another body: its surface is not
# scanned but known, it is meshed finer, and it relaxes at a time that the operator is not told.
# Needs the hs- tools on the PATH; writes into FOLDER (scanned-sphere).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-scanned-sphere}
mkdir -p "$out"
cd "$out"

awk -v what=dome -v a=0.048 -v b=0.048 -v c=0.048 -v n=32 -v m=12 -f "$here/../shapes.awk" >sphere.off
hs-tetmesh sphere.off --edge 0.01 -q -o real.ply
cat >hidden.csv <<'END'
effect,region,parameter,value,unit
elastic,0,E,22000,Pa
elastic,0,nu,0.45,1
viscoelastic,0,E1,6000,Pa
viscoelastic,0,tau1,0.15,s
END

# 13 lines of 10 points seen from above, 0.2 mm of noise; what lies on the table is not the sphere's.
awk 'BEGIN {
  srand(3); print "x,y,z"
  for (i = 0; i < 13; ++i) for (j = 0; j < 10; ++j) {
    x = -0.06 + 0.01 * i; y = -0.045 + 0.01 * j; q = 0.048 ^ 2 - x * x - y * y
    noise = 0.0002 * sqrt(-2 * log(1 - rand())) * cos(6.28318530718 * rand())
    if (q > 0 && sqrt(q) + noise > 0.003) printf "%.6f,%.6f,%.6f\n", x, y, sqrt(q) + noise
  }
}' >scan.csv
hs-scan2ply scan.csv -q -o points.ply
hs-reconstruct points.ply -q -o surface.ply
hs-tetmesh surface.ply --edge 0.02 -q -o sphere.ply

awk -v x=0.004 -v y=0.002 -v z=0.04779 -f "$here/../telepresence/hand.awk" >motion.csv

port=${PORT:-9125}
bad='--delay 0.15 --jitter 0.05 --loss 0.05 --duplicate 0.02 --reorder 0.02'
hs-link --listen "$port" --body real.ply --model hidden.csv --tool-radius 0.004 --add-noise 0.01 --idle 600 -q $bad &
far=$!
hs-link motion.csv --peer "$port" --body sphere.ply --times 0.05,0.5 --samples 6000 --patience 600 $bad \
  --identified identified.csv -o felt.csv 2>said.txt
kill "$far"
wait
cat said.txt
value() { tr -s '\n ' ' ' <said.txt | sed -n "s/.*$1.*/\1/p"; }
{
  echo 'figure,thesis,ours'
  printf 'scanned sphere: nodes and tetrahedra,120 and 285,%s\n' "$(awk '$2 == "vertex" { v = $3 } $2 == "tetrahedron" { print v " and " $3; exit }' sphere.ply)"
  printf 'scanned sphere: error once identified [N],0.2 to 0.3,%s\n' "$(value 'after it: .*error \([0-9.e-]*\) N rms')"
  printf 'scanned sphere: felt behind the force until identified [ms],300,%s\n' "$(value "before identification: .* \(-*[0-9.]*\) ms behind the body's force.*after it")"
  printf 'scanned sphere: felt behind the force once identified [ms],0,%s\n' "$(value "after it: .* \(-*[0-9.]*\) ms behind the body's force")"
  printf 'scanned sphere: identification [ms],150,%s\n' "$(value 'identified after .* in at most \([0-9.]*\) ms')"
} >summary.csv
cat summary.csv
awk -f "$here/../plot.awk" -v title='A scanned sphere over 300 ms, identified while it is pressed' felt.csv >felt.svg
