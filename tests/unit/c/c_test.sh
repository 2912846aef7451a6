#!/usr/bin/env bash
# c_test.sh BIN PROGRAM LIBRARY: the C interface gives the bytes of the tools' files and the forces of the live loop,
# and the library shows nothing but what hapsim.h names.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
program=$(realpath "$2") library=$(realpath "$3")
. "$root/tests/cli/scratch.sh" "$1"

"$bin/hs-tetmesh" box.off --edge 0.012 -q -o body.ply || complain 'no body'
box_presses 24 0.0001 >motion.csv
printf 'effect,region,parameter,value\nelastic,0,E,12000\nelastic,0,nu,0.4\nviscoelastic,0,E1,6000\nviscoelastic,0,tau1,0.3\n' >hidden.csv
printf 'effect,region,parameter,value\nelastic,0,E,14000\nelastic,0,nu,0.4\n' >model.csv
"$bin/hs-simulate" motion.csv --body body.ply --model hidden.csv --add-noise 0.002 -q -o data.csv || complain 'no data'

mkdir tools && cd tools || exit 1
cp ../body.ply ../data.csv ../motion.csv ../model.csv .
run() { "$bin/$1" "${@:2}" -q 2>err || complain "$*"; }
run hs-simulate motion.csv --body body.ply --model model.csv -o forces.csv
run hs-identify data.csv --body body.ply --fix nu=0.4 --add viscoelastic --folds 3 -o m.csv
run hs-simulate data.csv --body body.ply --model m.csv -o fitted.csv
run hs-compare data.csv --simulated fitted.csv -o residuals.csv
run hs-diagnose data.csv --body body.ply --model model.csv --flips 99 --plan plan.csv --plan-presses 2 -o effects.csv
awk 'BEGIN { print "t,x,y,z"; for (i = 0; i < 200; ++i) printf "%.17g,0.03,0.025,%.17g\n", 0.001 * i, 0.0405 - 0.00001 * i }' >tips.csv
live=(--live --body body.ply --model model.csv --tool-radius 0.004 --accuracy 0.3)
run hs-simulate tips.csv "${live[@]}" -o tip-forces.csv
run hs-simulate motion.csv "${live[@]}" -o press-forces.csv
cd ..

"$program" >out 2>err || complain "the program: $(cat out)"
for file in forces m residuals effects plan; do
  cmp -s $file.csv tools/$file.csv || complain "$file.csv is not the tool's: $(diff $file.csv tools/$file.csv | head -n 4)"
done
# Numbers as they are, whatever they are written with.
same() { # FILE TOOL-FILE COLUMN...: the same numbers in the columns of these names
  awk -v names="${*:3}" -F, '/^#/ { next }
    !count { count = split(names, wanted, " "); for (i = 1; i <= NF; ++i) at[$i] = i; next }
    { for (k = 1; k <= count; ++k) printf "%.17g%s", $at[wanted[k]] + 0, k < count ? " " : "\n" }' "tools/$2" >expected
  awk '{ for (i = 1; i <= NF; ++i) $i = sprintf("%.17g", $i + 0); print }' "$1" | cmp -s - expected || complain "$1 is not $2"
}
same live.csv tip-forces.csv press contact uz fx fy fz
same press.csv press-forces.csv fx fy fz

# What the library shows, each under its version; what the header names is there.
nm -D --defined-only "$library" | awk '$2 ~ /[TDB]/ || /hapsim/ { print $3 }' | sed 's/@@*HAPSIM_0$//' | grep -v '^gk_sig' | sort >shown
grep -o '\bhs_[a-z_]*(' "$root/lib/c/hapsim.h" | tr -d '(' | sort -u >named
comm -23 shown named >err
[[ ! -s err ]] || complain 'the library shows what no header names'
for name in $(comm -13 shown named); do grep -q "^HS_API.*\b$name(" "$root/lib/c/hapsim.h" && complain "the library lacks $name"; done
readelf -d "$library" | grep -q 'SONAME.*libhapsim\.so\.0\]' || complain 'the library has another name'

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
printf 'the C interface: %s functions; the bytes of five files and the forces of %s steps\n' "$(wc -l <shown)" "$(cat live.csv press.csv | wc -l)"
