#!/usr/bin/env bash
# live_reads_back.sh BIN: what live modes write of several touches is a recording to every tool, and effects act
# in it as in the batch mode; depths beyond what is valid are said, held or refused.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"

"$bin/hs-tetmesh" box.off --edge 0.012 -q -o body.ply || complain 'no body'
cat >model.csv <<'END'
effect,region,parameter,value,unit,state
elastic,0,E,20000,Pa,fixed
elastic,0,nu,0.4,1,fixed
hyperelastic,0,s,0.3,1,fixed
hyperelastic,0,finite,1,1,fixed
temperature,0,beta,0.02,1/K,fixed
temperature,0,T_ref,20,degC,fixed
softening,0,s,0.3,1,fixed
softening,0,m,2,1,fixed
softening,0,c,0.7,1,fixed
viscoelastic,0,E1,8000,Pa,fixed
viscoelastic,0,tau1,0.2,s,fixed
friction,0,mu,0.3,1,fixed
slack,0,enabled,1,1,fixed
sensor-lag,0,tau,0.02,s,fixed
sensor-lag,0,delay,0.013,s,fixed
sensor-bias,0,bx,0.02,N,fixed
sensor-bias,0,by,-0.01,N,fixed
sensor-bias,0,bz,0.05,N,fixed
tare,0,bx1,0.01,N,derived
tare,0,by1,0,N,derived
tare,0,bz1,0,N,derived
tare,0,bx2,0.03,N,derived
tare,0,by2,0,N,derived
tare,0,bz2,-0.04,N,derived
END
printf 'effect,region,parameter,value,unit\nelastic,0,E,20000,Pa\nelastic,0,nu,0.4,1\n' >elastic.csv
# A tip from the air down to the top at one place, sideways, up, and down at another; the first again.
awk 'BEGIN {
  print "# tool_radius: 0.004\n# recovery: partial\nt,x,y,z,temp"
  for (i = 0; i < 600; ++i) {
    p = int(i / 200); s = (i % 200) / 200; x = 0.02 + 0.02 * (p == 1); d = 0.004 * sin(3.14159265 * s) ^ 2 - 0.001
    printf "%.3f,%.9g,%.9g,%.9g,%.4g\n", 3 + 0.005 * i, x + 0.0005 * (d > 0) * sin(20 * s), 0.025 + 0.002 * (d < 0), 0.04 - d, 21 + 0.003 * i
  }
}' >tip.csv
run() { "$bin/$@" 2>err || complain "exit $?: $*"; }
run hs-simulate --live --accuracy 0.3 tip.csv --body body.ply --model model.csv -q -o first.csv
[[ $(awk -F, '/^[0-9]/ { print $1 }' first.csv | uniq | tr '\n' ' ') == '0 1 2 3 ' ]] ||
  complain "the touches are not presses: $(awk -F, '/^[0-9]/ { print $1 }' first.csv | uniq | tr '\n' ' ')"
# At the contacts it found, finely solved, the lines it wrote have the forces of the batch mode; so have the tip's own.
fine=(--body body.ply --model model.csv --rim-edge 0.3 -q)
run hs-simulate --live --accuracy 0.3 tip.csv --contacts first.csv "${fine[@]}" -o live.csv
run hs-simulate live.csv "${fine[@]}" -o batch.csv
run hs-simulate --live --accuracy 0.3 live.csv --contacts live.csv "${fine[@]}" -o again.csv
column() { # FILE NAME...
  local file=$1
  shift
  awk -F, -v names="$*" '/^#/ { next } !n++ { for (i = 1; i <= NF; ++i) at[$i] = i; m = split(names, name, " "); next }
    { for (k = 1; k <= m; ++k) printf "%s ", $at[name[k]]; print "" }' "$file"
}
agree() { # FILE FILE: forces, relative to the largest
  paste -d' ' <(column "$1" fx fy fz) <(column "$2" fx fy fz) | awk '
    { for (k = 1; k <= 3; ++k) { d = $k - $(k + 3); if (d < 0) d = -d; if (d > worst) worst = d; a = $k < 0 ? -$k : $k; if (a > most) most = a } }
    END { printf "%g of %g N, %d rows\n", worst, most, NR; exit !(NR == 600 && most > 0.2 && worst < 1e-6 * most) }'
}
agree live.csv batch.csv || complain 'live differs from batch'
agree live.csv again.csv || complain 'a tip differs from its presses'

# Every tool reads it.
run hs-simulate --live --accuracy 0.3 tip.csv --body body.ply --model elastic.csv -q -o elastic-live.csv
run hs-simulate --live --accuracy 0.3 tip.csv --body body.ply --model elastic.csv --rate 100000 -q -o paced.csv
for file in elastic-live.csv paced.csv; do
  run hs-simulate "$file" --body body.ply --model elastic.csv --rim-edge 0.3 -q -o s.csv
  run hs-simulate --live "$file" --accuracy 0.3 --body body.ply --model elastic.csv -q -o s.csv
  run hs-identify "$file" --body body.ply --effects elastic --rim-edge 0.3 -q -o m.csv
  run hs-identify --follow "$file" --accuracy 0.3 --body body.ply -q -o e.csv
  run hs-compare "$file" --simulated s.csv -q -o c.csv
  run hs-compare --follow "$file" --accuracy 0.3 --body body.ply --model elastic.csv --rate 200 --learning 0.5 -q -o f.csv
  run hs-identify "$file" --body body.ply --acfm 0 -q -o acfm.csv
  run hs-simulate --live tip.csv --model acfm.csv --body body.ply -q -o a.csv
  run hs-simulate a.csv --body body.ply --model elastic.csv --rim-edge 0.3 -q -o s.csv
done

# Depth: 25 mm of 40 is said, 39 as well, 44 refused; live 44 mm has the force of 36.
deep() { # DEPTH [m]
  awk -v d="$1" 'BEGIN { print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"
    for (i = 0; i <= 10; ++i) printf "1,%g,0.03,0.025,0.04,0,0,%g\n", 0.1 * i, -d * i / 10 }'
}
deep 0.015 | "$bin/hs-simulate" - --body body.ply --model elastic.csv --rim-edge 0.3 -o s.csv 2>err || complain '15 mm'
grep -q 'way through' err && complain '15 mm are said to be deep'
for depth in 0.025 0.039; do
  for mode in '' --own-mesh; do
    deep $depth | "$bin/hs-simulate" - --body body.ply --model elastic.csv --rim-edge 0.3 $mode -o s.csv 2>err || complain "exit $? at $depth $mode"
    grep -q '% of the way through the body' err || complain "$depth is not said to be deep $mode"
  done
done
for mode in '' --own-mesh --full; do
  deep 0.044 | "$bin/hs-simulate" - --body body.ply --model elastic.csv --rim-edge 0.3 $mode -o s.csv 2>err
  (($? == 3)) && grep -q 'goes through the body, which is 0.04 m thick there' err || complain "44 mm pass $mode"
done
deep 0.044 | "$bin/hs-simulate" --live --accuracy 0.3 - --body body.ply --model elastic.csv -o held.csv 2>err || complain 'live 44 mm'
grep -q 'of 2 the force is held at 90 %' err || complain 'held forces are not told'
[[ $(column held.csv beyond | tr -d ' \n') == 00000111133 ]] || complain 'the depth is not flagged'
column held.csv uz fz | awk 'NR == 3 { k = $2 / $1 } END { exit !($1 < -0.0355 && $1 > -0.0365 && ($2 / $1 / k - 1) ^ 2 < 1e-12) }' || complain 'what is held is not the force of 36 mm'
run hs-simulate held.csv --body body.ply --model elastic.csv --rim-edge 0.3 -q -o s.csv
{ echo '# depth: 0.005'; cat elastic.csv; } >fitted.csv
deep 0.006 | "$bin/hs-simulate" - --body body.ply --model fitted.csv --rim-edge 0.3 -o s.csv 2>err
grep -q 'presses go 6 mm deep, and the model was fitted to 5 mm' err || complain 'deeper than fitted is not said'
grep -q '^# depth: 0.003' m.csv || complain 'a model does not say the depth that it was fitted to'

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
