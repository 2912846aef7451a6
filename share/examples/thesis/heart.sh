#!/bin/sh
# heart.sh [FOLDER]: an organ of finite strain and two Maxwell elements (thesis 6.6). Finite elements
# every 20 ms, 20 ms late, and an analytical model are fused at 1 kHz and compared with the exact
# solution in steps of 1 ms. Needs the hs- tools on the PATH; writes into FOLDER (heart).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-heart}
mkdir -p "$out"
cd "$out"

# An organ of about 90 x 70 x 55 mm, flat below, held there.
awk -v what=dome -v a=0.045 -v b=0.035 -v c=0.055 -v n=24 -v m=10 -v lobe=0.12 -f "$here/../shapes.awk" >organ.off
cat >organ.csv <<'END'
effect,region,parameter,value,unit
elastic,0,E,12000,Pa
elastic,0,nu,0.45,1
hyperelastic,0,s,1,1
hyperelastic,0,finite,1,1
viscoelastic,0,E1,5000,Pa
viscoelastic,0,tau1,0.08,s
viscoelastic,0,E2,4000,Pa
viscoelastic,0,tau2,1,s
END

# motion KIND STEP
motion() {
  case $1 in
    lesson) presses='1.5:0.009 0.15:0.0085 0.4:0.006 0.12:0.0075 0.25:0.009 0.14:0.0092 0.18:0.0065 0.12:0.008' hold=0.3 ;;
    slow) presses='1.5:0.008 2:0.006' hold=0.5 ;;
    fast) presses='0.125:0.008 0.2:0.009 0.125:0.007' hold=1 ;;
  esac
  awk -v presses="$presses" -v hold=$hold -v step="$2" -f "$here/presses.awk"
}
motion fast 0.001 >fast.csv
hs-tetmesh organ.off --edge 0.012 --contacts fast.csv --size 0.004 --growth 0.8 -q -o organ.ply
fe='--full --own-mesh --body organ.ply --model organ.csv -q'

# What the filter and the analytical model are learned from: finite elements alone.
motion lesson 0.001 >lesson.csv
motion lesson 0.02 | hs-simulate $fe -o lesson.fe.csv
hs-identify lesson.fe.csv --body organ.ply --acfm 2 --stiffening --folds 0 -o acfm.csv
# What the analytical model makes of the finite elements' steps is what these make of a body that relaxes.
hs-simulate lesson.fe.csv --model acfm.csv -q -o lesson.steps.csv
hs-simulate lesson.csv --model acfm.csv -q |
  hs-fuse - --slow lesson.fe.csv --stepped lesson.steps.csv --delay 0.02 --learn filter.csv -o /dev/null

for kind in slow fast; do
  motion $kind 0.001 >$kind.csv
  motion $kind 0.02 | hs-simulate $fe -o $kind.fe.csv
  began=$(date +%s%N)
  hs-simulate $kind.csv $fe -o $kind.exact.csv
  step=$(awk -v ns=$(($(date +%s%N) - began)) '/^[0-9]/ { ++n } END { printf "%.0f", ns / n / 1e6 }' $kind.csv)
  echo "$kind motion:"
  hs-simulate $kind.fe.csv --model acfm.csv -q -o $kind.steps.csv
  hs-simulate $kind.csv --model acfm.csv -q |
    hs-fuse - --slow $kind.fe.csv --stepped $kind.steps.csv --delay 0.02 --parameters filter.csv --exact $kind.exact.csv -o $kind.fused.csv 2>$kind.txt
  cat $kind.txt
  awk -f "$here/../plot.awk" -v title="Organ, $kind motion" -v over=t -v press=1 \
    $kind.exact.csv $kind.fused.csv $kind.fe.csv >$kind.svg
done
{
  echo 'figure,thesis,ours'
  echo "organ: a step of its finite elements [ms],20 to 90,$step"
  for kind in slow fast; do
    tr -s '\n ' ' ' <$kind.txt | sed -n "s/.*fused error \([0-9.]*\) N [^N]*step \([0-9.]*\) N.*/organ: error fused ($kind) [N],about 0.1,\1\norgan: largest step in a ms ($kind) [N],0.5 to 0.8,\2/p"
  done
} >summary.csv
echo 'The thesis: errors of about 0.1 N, steps of 0.5 to 0.8 N in a millisecond without fusing.'
