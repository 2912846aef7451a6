#!/bin/sh
# polyurethane.sh [FOLDER]: a block of foam pressed and held at five places, identified elastic and
# viscoelastic (thesis 6.3). The recording is simulated: two Maxwell elements, noise of 0.02 N, contact
# meshes finer than those of the identification. Needs the hs- tools on the PATH; writes into FOLDER.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-polyurethane}
mkdir -p "$out"
cd "$out"

awk -v what=cuboid -v a=0.12 -v b=0.21 -v c=0.06 -f "$here/../shapes.awk" >block.off
hs-tetmesh block.off --edge 0.035 -q -o block.ply
cat >foam.csv <<'END'
effect,region,parameter,value,unit
elastic,0,E,32000,Pa
elastic,0,nu,0.3,1
viscoelastic,0,E1,9000,Pa
viscoelastic,0,tau1,0.4,s
viscoelastic,0,E2,6000,Pa
viscoelastic,0,tau2,4,s
END
# Rates and depths differ; every press is held for some seconds. 30 ms a sample, as the thesis.
awk 'BEGIN {
  print "# tool_radius: 0.004"; print "press,t,x,y,z,ux,uy,uz"
  split("30 50,90 50,60 105,30 160,90 160", place, ",")
  for (p = 1; p <= 5; ++p) for (k = 1; k <= 2; ++k) {
    split(place[p], xy, " "); rise = k == 1 ? 0.5 : 1.5; d = k == 1 ? 0.006 : 0.01
    for (i = 0; i * 0.03 < 10; ++i) {
      t = i * 0.03; s = t < rise ? t / rise : t < 8 ? 1 : t < 8 + rise ? 1 - (t - 8) / rise : 0
      printf "%d,%.2f,%g,%g,0.06,0,0,%.9g\n", 2 * p + k, t, xy[1] / 1000, xy[2] / 1000, -d * s
    }
  }
}' >motion.csv
hs-simulate motion.csv --body block.ply --model foam.csv --rim-edge 0.12 --add-noise 0.02 -q -o data.csv
hs-identify data.csv --body block.ply -q -o elastic.csv
hs-identify data.csv --body block.ply --add viscoelastic -q -o one.csv
hs-identify data.csv --body block.ply --add viscoelastic --terms auto -q -o auto.csv
told() { sed -n "s/^# $2: //p" "$1"; } # MODEL WHAT
row() { # NAME MODEL
  printf '%-26s %-22s %s\n' "$1" "$(printf '%.4g' "$(told "$2" rmse)") N" "$(printf '%.4g' "$(told "$2" heldout)") N"
}
echo 'model                      error                  on unseen places'
row 'elastic' elastic.csv
row 'one Maxwell element' one.csv
row 'as many as the data ask' auto.csv
{
  echo 'figure,thesis,ours'
  for model in elastic one auto; do
    echo "foam: error of $model [N],a curve,$(printf '%.4g' "$(told $model.csv rmse)")"
  done
} >summary.csv
# Force over time of a deep press, measured and by each model (its Fig. 6.15, 6.16).
for model in elastic one auto; do
  hs-simulate data.csv --body block.ply --model $model.csv -q -o with-$model.csv
done
awk -f "$here/../plot.awk" -v title='Foam pressed and held, identified elastic and viscoelastic' -v over=t -v press=4 \
  data.csv with-elastic.csv with-one.csv with-auto.csv >foam.svg
echo 'The thesis: elastic leaves the relaxation; one element is better and not enough (its Fig. 6.15, 6.16).'
