#!/usr/bin/env bash
# batch.sh BIN [COUNT [STAGE]]: COUNT synthetic recordings (three bodies, five materials, one in twenty
# broken in one of five ways) as a batch: with -j1, with -j2, and with -j2 killed three times on the way
# and resumed. Prints times, what was found, and whether the summaries are equal.
set -euo pipefail
bin=$(cd "$1" && pwd) count=${2:-300} stage=${3:-model}
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

sizes=("0.06 0.05 0.04" "0.08 0.06 0.03" "0.05 0.05 0.05")
for b in 0 1 2; do
  awk -v size="${sizes[b]}" 'BEGIN {
    split(size, s, " "); print "OFF"; print 8, 12, 0
    for (i = 0; i < 8; ++i) print (i % 2) * s[1], (int(i / 2) % 2) * s[2], (i >= 4) * s[3]
    split("0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5", f, ",")
    for (i = 1; i <= 12; ++i) print 3, f[i] }' >body$b.off
  "$bin/hs-tetmesh" -q body$b.off -o body$b.ply
done
material() { # NUMBER E
  printf 'effect,region,parameter,value\nelastic,0,E,%s\n' "$2"
  case $1 in
    0) printf 'elastic,0,nu,0.3\n' ;;
    1) printf 'elastic,0,nu,0.45\n' ;;
    2) printf 'elastic,0,nu,0.4\nviscoelastic,0,E1,6000\nviscoelastic,0,tau1,0.3\n' ;;
    3) printf 'elastic,0,nu,0.45\nviscoelastic,0,E1,3000\nviscoelastic,0,tau1,0.1\n' ;;
    4) printf 'elastic,0,nu,0.4\nsensor-bias,0,bx,0.02\nsensor-bias,0,by,0\nsensor-bias,0,bz,0.05\n' ;;
  esac
}
effects=(elastic elastic "elastic viscoelastic" "elastic viscoelastic" "elastic sensor-bias")
echo "name,body,data,effects,options,common_options,true_E" >manifest.csv
start=$SECONDS
for ((i = 0; i < count; ++i)); do
  m=$((i % 5)) b=$((i % 3)) E=$((8000 + 40 * i))
  read -r sx sy sz <<<"${sizes[b]}"
  awk -v i=$i -v sx="$sx" -v sy="$sy" -v sz="$sz" 'BEGIN { srand(i + 1)
    print "# tool_radius: 0.004\n# force_noise: 0.002\npress,t,x,y,z,ux,uy,uz"
    for (p = 0; p < 4; ++p) {
      x = sx * (0.3 + 0.4 * rand()); y = sy * (0.3 + 0.4 * rand())
      for (k = 0; k <= 50; ++k) { t = k * 0.02; s = 0.0015 * (t < 0.3 ? t / 0.3 : 1)
        printf "%d,%.2f,%.5f,%.5f,%s,%.6f,0,%.6f\n", p, t, x, y, sz, p % 2 ? s / 2 : 0, -s } } }' >motion.csv
  material $m $E >truth.csv
  "$bin/hs-simulate" -q motion.csv --body body$b.ply --model truth.csv --add-noise 0.002 --seed $((i + 1)) \
    --cache none -o data$i.csv
  if ((i % 20 == 7)); then
    case $((i / 20 % 5)) in
      0) head -c 2000 data$i.csv >cut && mv cut data$i.csv ;;
      1) sed -i '9s/,[^,]*$/,nan/' data$i.csv ;;
      2) rm data$i.csv ;;
      3) sed -i 's/ux/vx/' data$i.csv ;;
      4) : >data$i.csv ;;
    esac
  fi
  echo "recording $i,body$b.ply,data$i.csv,${effects[m]},,,$E" >>manifest.csv
done
echo "$count recordings made in $((SECONDS - start)) s"

batch() { # OUT JOBS
  XDG_CACHE_HOME=$work/cache-$1 make --no-print-directory -s -j"$2" -f "$root/Makefile.pipeline" batch \
    BIN="$bin" MANIFEST=manifest.csv OUT="$1" BATCH_FLAGS="--stages $stage" 2>"$1.log" || true
}
seconds() { local from=$EPOCHREALTIME; "$@"; awk -v a="$from" -v b="$EPOCHREALTIME" 'BEGIN { print b - a }'; }
one=$(seconds batch one 1)
two=$(seconds batch two 2)
grep "recordings done\|median" two.log
awk -v a="$one" -v b="$two" 'BEGIN { printf "-j1 %.1f s, -j2 %.1f s: parallel efficiency %.0f %%\n", a, b, 50 * a / b }'
for part in 1 2 3; do
  setsid env XDG_CACHE_HOME="$work/cache-killed" make -s -j2 -f "$root/Makefile.pipeline" batch BIN="$bin" \
    MANIFEST=manifest.csv OUT=killed BATCH_FLAGS="--stages $stage" >/dev/null 2>&1 &
  sleep "$(awk -v t="$two" 'BEGIN { print t / 5 }')"
  kill -KILL -- -$!
  wait $! 2>/dev/null || true
done
batch killed 2
same() { cmp -s <(sed "s#\b$1/#two/#g" "$1/summary.csv") two/summary.csv && echo "the same bytes" || echo "DIFFERENT"; }
echo "killed three times and resumed: $(same killed); -j1 against -j2: $(same one)"
awk -F, 'NR > 1 && $3 == "done" { n++; e = $5 / $NF - 1; if (e < 0) e = -e; if (e < 0.05) good++ }
  END { printf "%d done, E within 5 %% of the truth in %d\n", n, good }' two/summary.csv
