#!/usr/bin/env bash
# batch.sh BIN [COUNT [STAGE]]: COUNT synthetic recordings (three bodies, five materials, one in twenty
# broken in one of five ways) as a batch: with -j1, with -j2, and with -j2 killed three times on the way
# and resumed; and through a Slurm controller and node daemon on loopback where they are installed, also with
# the node daemon killed, missed by the controller and started again. Prints one table: what was found and
# told, times, parallel efficiency, whether the summaries are equal. The efficiency means something on a
# machine with nothing else to do. Recorded in bench/results/batch.txt (bench/record.sh).
set -euo pipefail
bin=$(cd "$1" && pwd) count=${2:-300} stage=${3:-model}
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
work=$(mktemp -d)
. "$root/tests/cli/slurm_daemons.sh"
trap '[[ $BASHPID != "$$" ]] || { slurm_stop; rm -rf "$work"; }' EXIT
cd "$work"
begin=$EPOCHREALTIME

# The presses are simulated on a finer mesh at the tool's rim (the default) than they are identified on (0.3).
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
recording() { # NUMBER: its data, broken where its number says so
  local i=$1 b=$(($1 % 3)) sx sy sz
  read -r sx sy sz <<<"${sizes[b]}"
  awk -v i="$i" -v sx="$sx" -v sy="$sy" -v sz="$sz" 'BEGIN { srand(i + 1)
    print "# tool_radius: 0.004\n# force_noise: 0.002\npress,t,x,y,z,ux,uy,uz"
    for (p = 0; p < 4; ++p) {
      x = sx * (0.3 + 0.4 * rand()); y = sy * (0.3 + 0.4 * rand())
      for (k = 0; k <= 50; ++k) { t = k * 0.02; s = 0.0015 * (t < 0.3 ? t / 0.3 : 1)
        printf "%d,%.2f,%.5f,%.5f,%s,%.6f,0,%.6f\n", p, t, x, y, sz, p % 2 ? s / 2 : 0, -s } } }' >motion$i.csv
  material $((i % 5)) $((8000 + 40 * i)) >truth$i.csv
  "$bin/hs-simulate" -q motion$i.csv --body body$b.ply --model truth$i.csv --add-noise 0.002 \
    --seed $((i + 1)) --threads 1 --cache none -o data$i.csv
  if ((i % 20 == 7)); then
    case $((i / 20 % 5)) in
      0) awk 'NR == 20 { printf "%s", substr($0, 1, 20); exit } 1' data$i.csv >cut$i && mv cut$i data$i.csv ;;
      1) sed -i '9s/,[^,]*$/,nan/' data$i.csv ;;
      2) rm data$i.csv ;;
      3) sed -i 's/ux/vx/' data$i.csv ;;
      4) : >data$i.csv ;;
    esac
  fi
}
effects=(elastic elastic "elastic viscoelastic" "elastic viscoelastic" "elastic sensor-bias")
echo "name,body,data,effects,options,common_options,true_E" >manifest.csv
for ((i = 0; i < count; ++i)); do
  echo "recording $i,body$((i % 3)).ply,data$i.csv,${effects[i % 5]},,--rim-edge 0.3,$((8000 + 40 * i))" >>manifest.csv
  while (($(jobs -rp | wc -l) >= 2)); do wait -n; done
  recording $i &
done
wait
broken=$(((count + 12) / 20))
row() { printf '%-30s %s\n' "$1" "$2"; }
since() { awk -v a="$1" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.1f", b - a }'; }
row 'recordings' "$count, of them $broken broken; made in $(since "$begin") s"

batch() { # OUT JOBS FLAGS...: its wall time in `wall`, processor time in `cpu`, exit code in `code`
  local from=$EPOCHREALTIME TIMEFORMAT='%U %S'
  code=0
  { time XDG_CACHE_HOME=$work/cache-$1 make --no-print-directory -s -j"$2" -f "$root/Makefile.pipeline" batch \
    BIN="$bin" MANIFEST=manifest.csv OUT="$1" BATCH_FLAGS="--stages $stage" "${@:3}" 2>"$1.log"; } 2>"$1.time" || code=$?
  wall=$(since "$from") cpu=$(awk '{ printf "%.1f", $1 + $2 }' "$1.time")
}
batch one 1
wall1=$wall
row '-j1' "$wall s, $cpu s of processor time"
batch two 2
row '-j2' "$wall s, $cpu s of processor time"
row 'parallel efficiency of -j2' "$(awk -v a="$wall1" -v b="$wall" 'BEGIN { printf "%.0f %%", 50 * a / b }') (load of the machine: $(cut -d' ' -f1 /proc/loadavg))"
# What runs alone whatever -j is: the rules before, the summary and overview after.
from=$EPOCHREALTIME
"$bin/hs-batch" manifest.csv --prepare -q --out two --bin "$bin" --stages "$stage"
"$bin/hs-batch" manifest.csv -q --out two --stages "$stage" --html again.html -o again.csv || true
row 'rules and overview, serial' "$(since "$from") s"
row 'exit code of make' "$code"
row 'said at the end' "$(sed -n 's/^hs-batch: \(.* recordings done.*\)/\1/p' two.log)"
row 'a line for each failure' "$(grep -c '^hs-batch: failed: ' two.log) of $broken"
row 'E within 5 % of the truth' "$(awk -F, 'NR > 1 && $3 == "done" { ++n; e = $5 / $NF - 1; good += e < 0.05 && e > -0.05 }
  END { printf "%d of %d done", good, n }' two/summary.csv)"
grep -m 1 'median error' two.log | sed 's/^  MODELS *//' | while read -r line; do row 'errors' "$line"; done
for part in 1 2 3; do
  setsid env XDG_CACHE_HOME="$work/cache-killed" make -s -j2 -f "$root/Makefile.pipeline" batch BIN="$bin" \
    MANIFEST=manifest.csv OUT=killed BATCH_FLAGS="--stages $stage" >/dev/null 2>&1 &
  sleep "$(awk -v t="$wall" 'BEGIN { print t / 5 }')"
  kill -KILL -- -$!
  wait $! 2>/dev/null || true
  row "killed by SIGKILL ($part)" "$(find killed/recordings -name model.csv | wc -l) models were there"
done
batch killed 2
same() { cmp -s <(sed "s#\b$1/#two/#g" "$1/summary.csv") two/summary.csv && echo "the same bytes" || echo "DIFFERENT"; }
row 'summary of killed and resumed' "$(same killed)"
row 'summary of -j1 and of -j2' "$(same one)"
if slurm_start >why; then
  batch slurm 1 CLUSTER=slurm
  row 'through Slurm' "$wall s; summary: $(same slurm)"
  batch requeued 1 CLUSTER=slurm &
  models() { find requeued/recordings -name model.csv 2>/dev/null | wc -l; }
  while (($(models) < count / 3)) && kill -0 $! 2>/dev/null; do sleep 0.2; done
  slurm_kill_node
  row 'Slurm, node daemon killed' "$(models) models were there"
  for _ in {1..300}; do ! slurm_node_is_missed || break; sleep 0.2; done
  row 'missed and started again' "$(models) models were there"
  slurm_node
  wait $! || true
  row 'through Slurm in the end' "summary: $(same requeued)"
else
  row 'through Slurm' "SKIPPED: $(cat why)"
fi
row 'all of this' "$(since "$begin") s"
