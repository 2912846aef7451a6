#!/usr/bin/env bash
# slurm.sh BIN: the batch through a Slurm controller and node daemon of its own on loopback: the same summary
# as without; a node daemon that is killed on the way and started again loses nothing.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh"
. "$(dirname "${BASH_SOURCE[0]}")/slurm_daemons.sh"
trap '[[ $BASHPID != "$$" ]] || { slurm_stop; rm -rf "$work"; }' EXIT
need slurmctld slurmd sbatch munged
slurm_start || exit 1

"$bin/hs-tetmesh" -q box.off --max-volume 2e-8 -o box.ply || exit 1
box_presses 8 1e-4 >motion.csv
printf 'effect,region,parameter,value\nelastic,0,E,9000\nelastic,0,nu,0.4\n' >truth.csv
box_scan >scan.csv
echo 'name,body,scan,scan_unit,data,options,common_options' >all.csv
for i in 1 2 3 4 5 6 7 8; do
  "$bin/hs-simulate" -q motion.csv --body box.ply --model truth.csv --rim-edge 0.3 --add-noise 0.002 --seed $i -o $i.csv || exit 1
  ((i < 7)) && echo "recording $i,box.ply,,,$i.csv,--folds 0,--rim-edge 0.3" >>all.csv
done
echo 'from scan,,scan.csv,mm,7.csv,--folds 0,--rim-edge 0.3' >>all.csv
sed -i 's/^1,.*/1,nonsense/' 8.csv
echo 'broken,box.ply,,,8.csv,--folds 0,--rim-edge 0.3' >>all.csv
batch() { # OUT FLAGS...
  make --no-print-directory -s -f "$root/Makefile.pipeline" batch BIN="$bin" MANIFEST=all.csv OUT="$1" \
    BATCH_FLAGS='--stages model' "${@:2}" >log 2>err
}
same() { cmp -s <(sed "s/\b$1\b/here/g" "$1/summary.csv") here/summary.csv || complain "the summary of $1 is another"; }
batch here -j2
grep -q '7 of 8 recordings done, 1 failed' err || complain 'the batch by itself'
batch slurm CLUSTER=slurm
grep -q '7 of 8 recordings done, 1 failed' err || { complain 'the batch through Slurm'; cat slurm/slurm.log; }
same slurm
batch again CLUSTER=slurm & wait_for=$!
models() { (($(find again/recordings -name model.csv 2>/dev/null | wc -l) >= 2)); }
until_true 120 models || complain 'the batch through Slurm does not begin'
slurm_kill_node && until_true 120 slurm_node_is_missed && slurm_node || complain 'the node daemon is not missed'
wait $wait_for
same again
# Whatever the requeued tasks left open is made by the same command again.
batch again CLUSTER=slurm
same again
grep -q '7 of 8 recordings done, 1 failed' err || complain 'nothing is lost'
batch none CLUSTER=pbs && complain 'an unknown cluster is refused'
grep -q 'CLUSTER=pbs is not known' err || complain 'an unknown cluster is named'
((failures == 0)) && echo 'slurm: passed'
exit $((failures > 0))
