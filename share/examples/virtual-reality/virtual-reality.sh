#!/bin/sh
# virtual-reality.sh [FOLDER]: the virtual objects of Tables A.1 and A.2 and of Figure 6.7, a cuboid 120 x 210 x 60 mm
# of six elastic, ten viscoelastic and two more viscoelastic materials, pressed at the middle of its top; forces as CSV and
# force over displacement as SVG. Needs the hs- tools on the PATH; writes into FOLDER (virtual).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=${1:-virtual}
mkdir -p "$out"
cd "$out"

# The cuboid, held at its base.
awk -v what=cuboid -v a=0.12 -v b=0.21 -v c=0.06 -f "$here/../shapes.awk" >cuboid.off
hs-tetmesh cuboid.off --edge 0.035 -q -o cuboid.ply

# motion FUNCTION RATE: 1 kHz, two cycles. ramp: in and out at that rate, 10 mm deep; sine: the rate
# is 0.02 sin(RATE t), so the depth 0.02 (1 - cos(RATE t)) / RATE.
motion() {
  awk -v kind="$1" -v rate="$2" 'BEGIN {
    print "# tool_radius: 0.004"; print "press,t,x,y,z,ux,uy,uz"
    period = kind == "ramp" ? 2 * 0.01 / rate : 8 * atan2(1, 1) / rate
    n = int(2 * period / 0.001 + 0.5)
    for (i = 0; i <= n; ++i) {
      t = i * 0.001; s = t % period
      u = kind == "sine" ? 0.02 * (1 - cos(rate * t)) / rate : rate * (s < period / 2 ? s : period - s)
      printf "1,%.3f,0.06,0.105,0.06,0,0,%.9g\n", t, -u
    }
  }'
}
# simulate NAME E NU [E1 TAU1 E2 TAU2]: NAME.motion.csv to NAME.csv.
simulate() {
  {
    echo effect,region,parameter,value,unit,state
    echo "elastic,0,E,$2,Pa,fixed"
    echo "elastic,0,nu,$3,1,fixed"
    if [ $# -gt 3 ]; then
      printf 'viscoelastic,0,E1,%s,Pa,fixed\nviscoelastic,0,tau1,%s,s,fixed\n' "$4" "$5"
      printf 'viscoelastic,0,E2,%s,Pa,fixed\nviscoelastic,0,tau2,%s,s,fixed\n' "$6" "$7"
    fi
  } >"$1.model.csv"
  hs-simulate "$1.motion.csv" --body cuboid.ply --model "$1.model.csv" -q -o "$1.csv"
}

# Table A.1: index, E [Pa]; nu = 0.3.
while read -r index modulus; do
  motion ramp 0.05 >"elastic-$index.motion.csv"
  simulate "elastic-$index" "$modulus" 0.3
done <<'END'
1 10000
2 20000
3 30000
4 50000
5 60000
6 70000
END

# Table A.2: index, motion, rate, tau1, tau2 [s]; E = 20 kPa, nu = 0.3, E1 = 10 kPa, E2 = 6 kPa.
while read -r index kind rate tau1 tau2; do
  motion "$kind" "$rate" >"viscoelastic-$index.motion.csv"
  simulate "viscoelastic-$index" 20000 0.3 10000 "$tau1" 6000 "$tau2"
done <<'END'
1 ramp 0.05 0.1 0.2
2 sine 1 0.1 0.2
3 sine 2 0.1 0.2
4 ramp 0.025 0.1 0.2
5 ramp 0.1 0.1 0.2
6 ramp 0.01 0.1 0.2
7 ramp 0.05 0.01 0.02
8 ramp 0.05 0.05 0.1
9 ramp 0.05 0.01 0.2
10 ramp 0.05 0.2 0.2
END

# Figure 6.7: materials a and b beside c, which is row 6; what each cycle loses of the work put in, and its peak.
motion ramp 0.01 >material-a.motion.csv
simulate material-a 2000 0.3 20000 0.6 8000 0.1
motion ramp 0.05 >material-b.motion.csv
simulate material-b 20000 0.3 10000 0.6 8000 0.1
motion ramp 0.01 >material-c.motion.csv
simulate material-c 20000 0.3 10000 0.1 6000 0.2
loss_of() { # NAME: of its second cycle, in %, and the largest force [N]
  awk -F, '/^[0-9]/ { t[++n] = $2; u[n] = -$8; f[n] = $NF; if (f[n] > most) most = f[n] }
    END {
      for (i = int(n / 2) + 2; i <= n; ++i) { w = (f[i] + f[i - 1]) / 2 * (u[i] - u[i - 1]); net += w; if (w > 0) in_ += w }
      printf "%.1f %.3f", 100 * net / in_, most
    }' "$1.csv"
}
echo 'Figure 6.7: work lost of the work put in by the second cycle, largest force:'
for material in a b c; do
  loss=$(loss_of material-$material)
  echo "material $material  ${loss% *} %  ${loss#* } N"
done

# An analytical model of two Maxwell elements from each row's forces, exact and with noise: its error
# on them, and on a faster press with a hold that it has not seen, both without the noise.
awk 'BEGIN {
  print "# tool_radius: 0.004"; print "press,t,x,y,z,ux,uy,uz"
  for (i = 0; i <= 600; ++i) {
    t = i * 0.001; u = t < 0.05 ? 0.2 * t : t < 0.4 ? 0.01 : t < 0.5 ? 0.01 - 0.1 * (t - 0.4) : 0
    printf "1,%.3f,0.06,0.105,0.06,0,0,%.9g\n", t, -u
  }
}' >unseen.motion.csv
error_of() { # FORCES MOTION: of acfm.csv, in % of the forces' rms
  hs-simulate "$2" --model acfm.csv -q |
    hs-compare "$1" --simulated - -o residuals.csv 2>&1 | sed -n "s/^ *ERROR *\([0-9.e-]*\) % of the force.s rms.*/\1/p"
}
echo 'Analytical model of Table A.2 against finite elements, error in % of the force:'
echo '     from exact forces from forces with noise of 0.01 N'
echo 'row  seen      unseen  seen      unseen'
for index in 1 2 3 4 5 6 7 8 9 10; do
  name=viscoelastic-$index
  hs-simulate "$name.motion.csv" --body cuboid.ply --model "$name.model.csv" --add-noise 0.01 -q -o noisy.csv
  hs-simulate unseen.motion.csv --body cuboid.ply --model "$name.model.csv" -q -o unseen.csv
  printf '%-3s' "$index"
  for forces in "$name.csv" noisy.csv; do
    hs-identify "$forces" --body cuboid.ply --acfm 2 -q -o acfm.csv
    printf '  %-8s  %-6s' "$(error_of "$name.csv" "$name.motion.csv")" "$(error_of unseen.csv unseen.motion.csv)"
  done
  echo
done

# What the thesis gives figures of: making ready, and a force.
figures() { # KIND READY FORCE: the thesis's, beside ours
  hs-simulate --live "$1-1.motion.csv" --body cuboid.ply --model "$1-1.model.csv" -o /dev/null 2>said.txt
  sed -n "s/.*ready in \([0-9.e+-]*\) s:.*/virtual cuboid: made ready ($1) [s],$2,\1/p" said.txt
  sed -n 's/.*median \([0-9.]*\) us.*/\1/p' said.txt |
    awk -v kind="$1" -v theirs="$3" '{ printf "virtual cuboid: a force (%s) [ms],%s,%.4f\n", kind, theirs, $1 / 1000 }'
}
{
  echo 'figure,thesis,ours'
  figures elastic 0.095 15
  figures viscoelastic 0.12 30
  for material in a b c; do
    loss=$(loss_of material-$material)
    echo "virtual cuboid: material $material loses of a cycle's work [%],a loop,${loss% *}"
  done
} >summary.csv

plot() { # FILE TITLE NAME...
  file=$1 title=$2
  shift 2
  awk -f "$here/../plot.awk" -v title="$title" "$@" >"$file"
}
plot elastic.svg 'Table A.1: elastic, E = 10 to 70 kPa' elastic-[1-6].csv
plot rates.svg 'Table A.2, 1 and 4-6: rates 10 to 100 mm/s' \
  viscoelastic-6.csv viscoelastic-4.csv viscoelastic-1.csv viscoelastic-5.csv
plot sines.svg 'Table A.2, 2 and 3: sinusoidal rates' viscoelastic-2.csv viscoelastic-3.csv
plot times.svg 'Table A.2, 7-10: relaxation times' \
  viscoelastic-7.csv viscoelastic-8.csv viscoelastic-9.csv viscoelastic-10.csv
plot materials.svg 'Figure 6.7 (a): materials a, b and c' material-[abc].csv
plot materials-time.svg 'Figure 6.7 (b): force over time' -v over=t material-[abc].csv
echo "$out: elastic.svg rates.svg sines.svg times.svg materials.svg materials-time.svg"
