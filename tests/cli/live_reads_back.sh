#!/usr/bin/env bash
# live_reads_back.sh BIN: what every live mode writes of several touches is a recording to every tool, and effects act
# in it as in the batch mode; what a model was not fitted to is said of each force; depths are held or refused.
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
run hs-simulate --live --accuracy 0.3 tip.csv --body body.ply --model elastic.csv --uncertainty --hand -q -o felt.csv
# Two tips at once that turn, each in presses of its own; and two whose contact points are known.
awk -F, -v OFS=, '/^#/ { print; next } !n++ { print "# tools: 2"; print "t,tool_id,x,y,z,thx,thy,thz,temp"; next }
  { for (k = 0; k < 2; ++k) print $1, k ? "right" : "left", $2 + (k ? 0.015 : -0.005), $3, $4, 0, 0, 0.01 * k, $5 }' tip.csv >tips.csv
run hs-simulate --live --accuracy 0.3 tips.csv --body body.ply --model elastic.csv --uncertainty -q -o turned.csv
run hs-simulate --live --accuracy 0.3 turned.csv --tools 2 --body body.ply --model elastic.csv --uncertainty -q -o told.csv
run hs-identify elastic-live.csv --body body.ply --acfm 0 -q -o springs.csv
run hs-simulate --live tip.csv --model springs.csv --body body.ply -q -o sprung.csv
run hs-tetmesh box.off --edge 0.012 --contacts elastic-live.csv -q -o fine.ply
run hs-fuse --live elastic-live.csv --body fine.ply --model elastic.csv --acfm-model springs.csv -q -o fused.csv
for file in felt.csv turned.csv told.csv; do
  column $file uncertainty contact fz | awk '{ if ($2 ? !($1 > 0 && $1 < $3) : $1 != 0) bad = 1 } END { exit bad || !NR }' ||
    complain "the uncertainties of $file"
done
for file in elastic-live.csv paced.csv felt.csv turned.csv told.csv sprung.csv fused.csv; do
  run hs-simulate "$file" --body body.ply --model elastic.csv --rim-edge 0.3 -q -o s.csv
  run hs-simulate --live "$file" --accuracy 0.3 --body body.ply --model elastic.csv -q -o l.csv
  run hs-identify "$file" --body body.ply --effects elastic --rim-edge 0.3 -q -o m.csv
  run hs-identify --follow "$file" --accuracy 0.3 --body body.ply -q -o e.csv
  run hs-compare "$file" --simulated s.csv -q -o c.csv
  run hs-diagnose "$file" --body body.ply --model elastic.csv --rim-edge 0.3 -q -o d.csv
  run hs-compare --follow "$file" --accuracy 0.3 --body body.ply --model elastic.csv --rate 200 --learning 0.5 -q -o f.csv
  run hs-identify "$file" --body body.ply --acfm 0 -q -o acfm.csv
  run hs-simulate --live tip.csv --model acfm.csv --body body.ply -q -o a.csv
  run hs-simulate a.csv --body body.ply --model elastic.csv --rim-edge 0.3 -q -o s.csv
done

# So it does of two tools that press in turn, then together; a watch is of each where it presses alone.
awk 'BEGIN {
  print "# tool_radius: 0.004\n# tools: 2\nt,x,y,z,tool_id"
  for (i = 0; i < 1000; ++i) {
    turn = int(i / 200); d = 0.003 * sin(3.14159265 * (i % 200) / 200) ^ 2
    printf "%.3f,0.016,0.025,%.9g,left\n%.3f,0.044,0.025,%.9g,right\n", 0.005 * i, 0.0405 - d * (turn != 1 && turn != 3),
      0.005 * i, 0.0405 - d * (turn % 2 == 1 || turn == 4)
  }
}' >tips.csv
run hs-simulate --live --accuracy 0.3 tips.csv --body body.ply --model elastic.csv -q -o two.csv
run hs-simulate two.csv --body body.ply --model elastic.csv --rim-edge 0.3 -q -o s.csv
run hs-identify two.csv --body body.ply --effects elastic --rim-edge 0.3 -q -o two-m.csv
run hs-simulate --live two.csv --accuracy 0.3 --body body.ply --model elastic.csv -q -o s.csv
run hs-identify --follow two.csv --accuracy 0.3 --body body.ply -q -o e.csv
awk -F, '/^#/ || !n++ || $2 * 10 == int($2 * 10)' two.csv >thin.csv
run hs-tetmesh box.off --edge 0.02 --contacts thin.csv -q -o own.ply
run hs-simulate --full thin.csv --body own.ply --model elastic.csv -q -o full.csv
paste -d' ' <(column thin.csv contact fz) <(column full.csv fz) | awk '{ d = $2 - $3; if ($1 ? d * d > 0.01 : $3 * $3 > 1e-18) bad = 1; n += $1 } END { exit bad || n < 20 }' ||
  complain 'the finite elements of two tools at once feel something else'
run hs-compare two.csv --simulated s.csv -q -o c.csv
run hs-compare --follow two.csv --accuracy 0.3 --body body.ply --model elastic.csv --rate 200 --learning 0.5 --events changes.csv -o f.csv
[[ $(grep -c '^hs-compare: tool \(left\|right\): 0 changes noticed' err) == 2 ]] || complain "the tools are not watched: $(cat err)"
grep -q 'lines were pressed beside another tool' err || complain 'what is left out is not told'
paste -d' ' <(column f.csv tool_id sx sy sz) <(column f.csv rx ry rz) | awk '{ ++rows[$1]; for (k = 2; k <= 4; ++k) if ($k != 0) pressed[$1] = 1
  for (k = 5; k <= 7; ++k) if ($k * $k > 1e-6) bad = 1 } END { exit !(!bad && rows["left"] > 700 && rows["right"] > 700 && pressed["left"] && pressed["right"]) }' ||
  complain 'the watch has other forces than the tools felt'
head -n 1 changes.csv | grep -q ',tool_id$' || complain 'changes do not say whose they are'

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
[[ $(column held.csv beyond | tr -d '\n') == '0 0 32 32 32 33 33 33 33 35 35 ' ]] || complain 'the depth is not flagged'
column held.csv uz fz | awk 'NR == 3 { k = $2 / $1 } END { exit !($1 < -0.0355 && $1 > -0.0365 && ($2 / $1 / k - 1) ^ 2 < 1e-12) }' || complain 'what is held is not the force of 36 mm'
run hs-simulate held.csv --body body.ply --model elastic.csv --rim-edge 0.3 -q -o s.csv
{ echo '# depth: 0.005'; cat elastic.csv; } >fitted.csv
deep 0.006 | "$bin/hs-simulate" - --body body.ply --model fitted.csv --rim-edge 0.3 -o s.csv 2>err
grep -q 'presses go 6 mm deep, and the model was fitted to 5 mm' err || complain 'deeper than fitted is not said'
grep -q '^# depth: 0.003' m.csv || complain 'a model does not say the depth that it was fitted to'

# What a model was fitted to comes with it: nothing of that is flagged, each of what it is not is.
deep 0.003 >pressed.csv
run hs-simulate pressed.csv --body body.ply --model elastic.csv --rim-edge 0.3 -q -o measured.csv
run hs-identify measured.csv --body body.ply --effects elastic --rim-edge 0.3 -q -o fitted.csv
grep -q '^# speed: 0.003' fitted.csv && grep -q '^# places: 0.03 0.025 0.04$' fitted.csv && grep -q '^# reach: 0.008' fitted.csv ||
  complain "a model does not say what it was fitted to: $(grep '^#' fitted.csv)"
beyond() { # of the last force of a press with that depth, step in time, place and way along
  awk -v d="$1" -v dt="$2" -v x="$3" -v s="$4" 'BEGIN { print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"
    for (i = 0; i <= 10; ++i) printf "1,%g,%g,0.025,0.04,%g,0,%g\n", dt * i, x, s * i / 10, -d * i / 10 }' >motion.csv
  "$bin/hs-simulate" --live --accuracy 0.3 motion.csv --body body.ply --model fitted.csv -o out.csv 2>err || complain "beyond $*"
  column out.csv beyond | tail -n 1 | tr -d ' '
}
for row in '0.003 0.1 0.03 0 0' '0.002 0.1 0.036 0.001 0' '0.004 0.2 0.03 0 1' '0.003 0.05 0.03 0 16' '0.003 0.1 0.045 0 8' \
  '0.002 0.2 0.03 0.0025 32' '0.007 0.05 0.045 0 57'; do
  read -r d dt x s asked <<<"$row"
  [[ $(beyond $d $dt $x $s) == "$asked" ]] || complain "beyond is $(beyond $d $dt $x $s), not $asked: $row"
done
for words in 'deeper than the model was fitted' 'away from the places' 'faster than the model' "model's law was verified"; do
  grep -q "$words" err || complain "it is not said: $words"
done

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
