#!/bin/sh
# scanned-heart.sh [FOLDER]: thesis 6.6 from a scan to the hand. A laser's 130 points of an organ on a
# table become a body of tetrahedra; one press that is held for 60 s gives it two Maxwell elements in
# the windows of (6.11); its finite elements every 100 ms, 100 ms late, and an analytical model learned
# from them are fused at 1 kHz and compared with the organ, which is another body: its surface is not
# scanned but known, its meshes are those of its contacts, it has three Maxwell elements, and what is
# measured on it is noisy. Beside it, over a network of 100 ms there and back, what a hand would feel
# without a model. Needs the hs- tools on the PATH; writes into FOLDER (scanned-heart).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-scanned-heart}
mkdir -p "$out"
cd "$out"

# The organ: about 90 x 70 x 55 mm, flat below, held there.
awk -v what=dome -v a=0.045 -v b=0.035 -v c=0.055 -v n=32 -v m=12 -v lobe=0.12 -f "$here/../shapes.awk" >organ.off
hs-tetmesh organ.off --edge 0.006 -q -o organ.ply
organ() { hs-simulate --live - --body organ.ply --model organ.csv -q; } # as the network's far side presses it
noisy() { # SEED: forces with noise of 0.02 N
  awk -F, -v OFS=, -v seed="$1" 'function noise() { return 0.02 * sqrt(-2 * log(1 - rand())) * cos(6.28318530718 * rand()) }
    BEGIN { srand(seed); print "# tool_radius: 0.006"; print "# force_noise: 0.02"; print "press,t,x,y,z,ux,uy,uz,fx,fy,fz" }
    /^[0-9]/ { print $1, $2, $3, $4, $5, $6, $7, $8, $9 + noise(), $10 + noise(), $11 + noise() }'
}
cat >organ.csv <<'END'
effect,region,parameter,value,unit
elastic,0,E,12000,Pa
elastic,0,nu,0.45,1
hyperelastic,0,s,0.4,1
hyperelastic,0,finite,1,1
viscoelastic,0,E1,5000,Pa
viscoelastic,0,tau1,0.15,s
viscoelastic,0,E2,3500,Pa
viscoelastic,0,tau2,2,s
viscoelastic,0,E3,3000,Pa
viscoelastic,0,tau3,20,s
END

# The scan: 13 lines of 10 points over 104 x 76 mm, seen from above, 0.2 mm of noise; what lies on the
# table is not the organ's.
awk 'BEGIN {
  srand(7); print "x,y,z"
  for (i = 0; i < 13; ++i) for (j = 0; j < 10; ++j) {
    x = -0.05 + 0.0085 * i; y = -0.038 + 0.0084 * j; pi = 3.14159265358979
    v = atan2(y / 0.035, x / 0.045)
    r = sqrt((x / 0.045) ^ 2 + (y / 0.035) ^ 2) / (1 + 0.12 * cos(v))
    z = r < 1 ? 0.055 * sqrt(1 - r * r) : 0
    noise = 0.0002 * sqrt(-2 * log(1 - rand())) * cos(2 * pi * rand())
    if (z + noise > 0.003) printf "%.6f,%.6f,%.6f\n", x, y, z + noise
  }
}' >scan.csv

# Held for 60 s: 300 samples.
awk 'BEGIN {
  print "# tool_radius: 0.006"; print "press,t,x,y,z,ux,uy,uz"
  for (i = 0; i < 300; ++i) { t = 0.2 * i; printf "1,%.3f,0,0,0.055,0,0,%.9g\n", t, -0.008 * (t < 0.6 ? t / 0.6 : 1) }
}' >held.csv
motion() { awk -v presses="$2" -v hold=1 -v step="$1" -f "$here/presses.awk"; } # STEP PRESSES
lesson='1.5:0.009 0.15:0.0085 0.4:0.006 0.12:0.0075 0.25:0.009 0.14:0.0092 0.18:0.0065 0.12:0.008'
hand='0.125:0.008 0.2:0.009 0.5:0.007 0.16:0.0085 1.5:0.008 0.14:0.006'

hs-scan2ply scan.csv -q -o points.ply
hs-reconstruct points.ply -q -o surface.ply
hs-tetmesh surface.ply --edge 0.012 --contacts held.csv --size 0.004 --growth 0.8 -q -o heart.ply
organ <held.csv | noisy 1 >measured.csv
hs-identify measured.csv --body heart.ply --effects hyperelastic,viscoelastic --terms 2 --windows 0.001:5,5:60 \
  --fix nu=0.45 -o identified.csv 2>identified.txt
cat identified.txt

# The finite elements of the thesis's size are too stiff under the tool: their moduli are lowered by the
# factor that the same press says.
fe='--full --own-mesh --body heart.ply -q'
awk 'NR < 3 || NR % 5 == 0' held.csv >few.csv
scaled() { # FACTOR: the moduli of identified.csv times it, finite strain
  awk -F, -v OFS=, -v k="$1" '/^#/ { next } $3 ~ /^E/ { $4 *= k } $3 == "finite" { $4 = 1 } { print $1, $2, $3, $4, $5 }' identified.csv
}
scaled 1 >elements.csv
hs-simulate few.csv $fe --model elements.csv -o few.fe.csv
factor=$(awk -F, '/^[0-9]/ { if (FNR == NR) f[$2 + 0] = $11; else { a += f[$2 + 0] * $11; b += $11 * $11 } } END { printf "%.4f", a / b }' measured.csv few.fe.csv)
scaled "$factor" >elements.csv

# What the analytical model is learned from: these finite elements alone. The filter learns what the
# slow forces teach of the fast ones twice: of finite elements, and of what is measured on the organ.
motion 0.001 "$lesson" >lesson.csv
motion 0.02 "$lesson" | hs-simulate $fe --model elements.csv -o lesson.fe.csv
motion 0.02 "$lesson" | organ | noisy 2 >lesson.organ.csv
hs-identify lesson.fe.csv --body heart.ply --acfm 2 --stiffening --folds 0 -q -o acfm.csv
hs-simulate lesson.fe.csv --model acfm.csv -q -o lesson.steps.csv
hs-simulate lesson.csv --model acfm.csv -q -o lesson.fast.csv
hs-fuse lesson.fast.csv --slow lesson.fe.csv --stepped lesson.steps.csv --delay 0.02 --learn filter.fe.csv -q -o /dev/null
hs-fuse lesson.fast.csv --slow lesson.organ.csv --delay 0.1 --learn filter.organ.csv -q -o /dev/null

# A hand, over a network of 100 ms there and back: what it feels without a model is late.
motion 0.001 "$hand" >hand.csv
organ <hand.csv >organ.hand.csv
port=${PORT:-9124}
hs-link --listen "$port" --body organ.ply --model organ.csv --tool-radius 0.006 --add-noise 0.02 --idle 600 -q --delay 0.05 &
far=$!
hs-link hand.csv --peer "$port" --body heart.ply --samples 0 --delay 0.05 --any-energy --max-rate 10000 --patience 600 \
  -q -o felt.csv
kill "$far"
wait
awk -F, -v OFS=, '/^#/ { if (FNR == NR) print; next } FNR == NR { if (!/^[0-9]/) print $0, "fx", "fy", "fz", "arrives"
    else row[$1, $2 + 0] = $0; next }
  /^[0-9]/ && $22 != "" && ($1, $22 + 0) in row && !(($1, $22 + 0) in had) && $22 >= next_one[$1] {
    had[$1, $22 + 0]; next_one[$1] = $22 + 0.02; print row[$1, $22 + 0], $13, $14, $15, $2 }' hand.csv felt.csv >late.csv

# With the model: finite elements every 100 ms, 100 ms late, and then what the network brings as well.
motion 0.1 "$hand" | hs-simulate $fe --model elements.csv -o hand.fe.csv
hs-simulate hand.fe.csv --model acfm.csv -q -o hand.steps.csv
hs-simulate hand.csv --model acfm.csv -q -o hand.fast.csv
hs-fuse hand.fast.csv --slow hand.fe.csv --stepped hand.steps.csv --delay 0.1 --parameters filter.fe.csv \
  --exact organ.hand.csv -o fused.fe.csv 2>fe.txt
hs-fuse hand.fast.csv --slow late.csv --parameters filter.organ.csv --exact organ.hand.csv -o fused.csv 2>late.txt
# The same answered live: 1 kHz by the clock, finite elements beside it at their own pace.
hs-fuse hand.csv --live --body heart.ply --model elements.csv --acfm-model acfm.csv --parameters filter.fe.csv \
  -o live.csv 2>live.txt
cat fe.txt late.txt live.txt

error() { # FILE of forces, its columns against the organ's: rms per component [N]
  awk -F, 'FNR == NR { if (/^[0-9]/) for (k = 9; k < 12; ++k) f[$1, $2 + 0, k] = $k; next }
    /^[0-9]/ { for (k = 9; k < 12; ++k) { s += ($k - f[$1, $2 + 0, k]) ^ 2; ++n } } END { printf "%.4f", sqrt(s / n) }' organ.hand.csv "$1"
}
told() { tr -s '\n ' ' ' <"$1" | sed -n "s/.*$2 error \([0-9.]*\) N.*/\1/p"; }
{
  echo 'figure,thesis,ours'
  printf 'scanned heart: nodes and tetrahedra,535 and 1763,%s\n' "$(awk '$2 == "vertex" { v = $3 } $2 == "tetrahedron" { print v " and " $3; exit }' heart.ply)"
  printf 'scanned heart: error of the fit to 300 samples [N],about 0.1,%s\n' "$(tr -s '\n ' ' ' <identified.txt | sed -n 's/.* error \([0-9.]*\) N = .*/\1/p')"
  printf 'scanned heart: felt without a model [N],,%s\n' "$(error felt.csv)"
  printf 'scanned heart: finite elements held [N],above the fused,%s\n' "$(told fe.txt 'slow held')"
  printf 'scanned heart: fused with finite elements [N],about 0.1,%s\n' "$(told fe.txt fused)"
  printf 'scanned heart: fused with what the network brings [N],,%s\n' "$(told late.txt fused)"
  printf 'scanned heart: answered live at 1 kHz [N],,%s\n' "$(error live.csv)"
} >summary.csv
cat summary.csv
awk -f "$here/../plot.awk" -v title='Scanned heart: a hand over 100 ms' -v over=t -v press=1 \
  organ.hand.csv fused.csv fused.fe.csv felt.csv >heart.svg
