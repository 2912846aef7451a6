#!/bin/sh
# telepresence.sh [FOLDER]: a soft hemisphere pressed over a network with a delay of 300 ms there and
# back, jitter of 50 ms and 5 % of packets lost. The operator feels late forces, identifies the body
# from them while it runs, and from then on feels the identified body at once. Then a stiff body over
# networks of 0 to 600 ms there and back with 20 % lost, never identified: what the hand gets with the
# limit of energy and without. Needs the hs- tools on the PATH; writes into FOLDER (telepresence).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-telepresence}
mkdir -p "$out"
cd "$out"

# A hemisphere of radius 50 mm, held at its base.
awk -v what=dome -v a=0.05 -v b=0.05 -v c=0.05 -v n=28 -v m=9 -f "$here/../shapes.awk" >ball.off
hs-tetmesh ball.off --edge 0.011 -q -o real.ply  # what is pressed is meshed finer than
hs-tetmesh ball.off --edge 0.02 -q -o ball.ply   # what is identified
cat >hidden.csv <<'END'
effect,region,parameter,value,unit
elastic,0,E,22000,Pa
elastic,0,nu,0.45,1
viscoelastic,0,E1,6000,Pa
viscoelastic,0,tau1,0.15,s
END
awk -v x=0.004 -v y=0.002 -v z=0.0496 -f "$here/hand.awk" >motion.csv

port=${PORT:-9123}
bad='--delay 0.15 --jitter 0.05 --loss 0.05 --duplicate 0.02 --reorder 0.02'
hs-link --listen "$port" --body real.ply --model hidden.csv --tool-radius 0.004 --add-noise 0.01 --idle 3 $bad &
sleep 1
hs-link motion.csv --peer "$port" --body ball.ply --times 0.15 --samples 6000 $bad \
  --identified identified.csv -o felt.csv 2>said.txt
cat said.txt >&2
wait
{
  echo 'figure,thesis,ours'
  sed -n 's/.*after it: .*error \([0-9.]*\) N rms.*/sphere: error once identified [N],0.2 to 0.3,\1/p' said.txt
  sed -n "s/.*before identification: .* \(-*[0-9.]*\) ms behind the body's force.*/sphere: felt behind the force until identified [ms],300,\1/p" said.txt
  sed -n "s/.*after it: .* \(-*[0-9.]*\) ms behind the body's force.*/sphere: felt behind the force once identified [ms],0,\1/p" said.txt
  sed -n 's/.*identified after .* in at most \([0-9.]*\) ms.*/sphere: identification [ms],150,\1/p' said.txt
} >summary.csv
grep -E '^(elastic|viscoelastic)' identified.csv
awk -f "$here/plot.awk" -v title='Telepresence: 300 ms delay, the body identified while it runs' felt.csv >felt.svg

# The same hand on a body 15 times as stiff: a late force pushes when the hand has turned.
sed 's/22000/330000/; s/6000/90000/' hidden.csv >stiff.csv
head -10002 motion.csv >short.csv
echo 'delay there and back [s],energy,put in by the hand [mJ],most got by it [mJ],largest force [N]' >energy.csv
for delay in 0 0.15 0.3 0.6; do
  half=$(awk "BEGIN { print $delay / 2 }")
  bad="--delay $half --jitter 0.02 --loss 0.2"
  for limit in '' --any-energy; do
    hs-link --listen "$port" --body real.ply --model stiff.csv --tool-radius 0.004 --idle 3 -q $bad &
    sleep 1
    hs-link short.csv --peer "$port" --body ball.ply --samples 0 $bad $limit -o stiff-felt.csv 2>said.txt
    wait
    force=$(awk -F, '/^1,/ { f = $9 * $9 + $10 * $10 + $11 * $11; if (f > m) m = f } END { printf "%.3g", sqrt(m) }' stiff-felt.csv)
    sed -n "s/.*energy: the hand put in \([^ ]*\) mJ.*at most \([^ ]*\) mJ ahead.*/$delay,${limit:-bounded},\1,\2,$force/p" said.txt >>energy.csv
  done
done
cat energy.csv
echo "$out: felt.csv identified.csv felt.svg energy.csv"
