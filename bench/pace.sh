#!/usr/bin/env bash
# pace.sh BIN [SECONDS] [RATES]: hs-simulate --live --rate fed by another process through a pipe, so many
# seconds (60) at each rate ("1000 10000"), on a cuboid and a heart, elastic and with Maxwell elements;
# prints what was answered, how late, and whether the bytes are those of an unpaced run.
# Recorded in bench/results/pace.txt (bench/record.sh).
set -euo pipefail
bin=$(cd "$1" && pwd) seconds=${2:-60} rates=${3:-1000 10000}
shapes=$(cd "$(dirname "$0")/../share/examples" && pwd)/shapes.awk
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export XDG_CACHE_HOME=$work/cache
awk -v what=cuboid -v a=0.12 -v b=0.21 -v c=0.06 -f "$shapes" >cuboid.off
awk -v what=dome -v a=0.045 -v b=0.035 -v c=0.055 -v n=24 -v m=10 -v lobe=0.12 -f "$shapes" >heart.off
"$bin/hs-tetmesh" -q cuboid.off --edge 0.03 -o cuboid.ply
"$bin/hs-tetmesh" -q heart.off --edge 0.012 -o heart.ply
printf 'effect,region,parameter,value\nelastic,0,E,12000\nelastic,0,nu,0.45\n' >elastic.csv
cat elastic.csv - >viscoelastic.csv <<'END'
viscoelastic,0,E1,5000
viscoelastic,0,tau1,0.08
viscoelastic,0,E2,4000
viscoelastic,0,tau2,1
END
motion() { # TOP RATE: a tool that presses once a second all along
  awk -v top="$1" -v rate="$2" -v seconds="$seconds" 'BEGIN {
    print "# tool_radius: 0.004"; print "press,t,x,y,z,ux,uy,uz"
    for (i = 0; i < rate * seconds; ++i) {
      t = i / rate; s = sin(3.14159265 * t) ^ 2
      printf "1,%.6f,0,0,%s,%.9g,0,%.9g\n", t, top, 0.001 * s * sin(t), -0.006 * s
    }
  }'
}
printf '%-7s %-12s %7s %9s %9s  %s\n' body model rate asked answered 'from due to answered; bytes'
for body in cuboid heart; do
  top=0.055
  [[ $body == cuboid ]] && top=0.06
  for rate in $rates; do
    motion $top "$rate" >motion.csv
    [[ $body == cuboid ]] && sed -i 's/^1,\([^,]*\),0,0,/1,\1,0.06,0.105,/' motion.csv
    for model in elastic viscoelastic; do
      options=(--live - --body $body.ply --model $model.csv)
      cat motion.csv | "$bin/hs-simulate" "${options[@]}" --rate "$rate" 2>said | cat >paced.csv
      cat motion.csv | "$bin/hs-simulate" "${options[@]}" -q >plain.csv
      same=differ
      cmp -s paced.csv plain.csv && same=same
      printf '%-7s %-12s %7s %9s %9s  %s; %s\n' $body $model "$rate" "$(grep -c '^1,' motion.csv)" \
        "$(grep -c '^1,' paced.csv)" "$(sed -n 's/.*samples: //p' said)" $same
    done
  done
done
# What the machine does to any loop, where the benches are built.
bench=$bin/../bench/bench_realtime
[[ ! -x $bench ]] || "$bench" machine "$seconds" | tail -n 1
sed -n 's/^hs-simulate: \(memory .*\)/(\1)/p' said
