#!/usr/bin/env bash
# slurm.sh BIN: the batch through a Slurm controller and node daemon of its own on loopback: the same summary
# as without; a node daemon that is killed on the way and started again loses nothing.

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh"
skip() { echo "SKIPPED: $*"; exit 77; }
for program in slurmctld slurmd sbatch munged; do
  PATH=$PATH:/usr/sbin command -v $program >/dev/null || skip "$program is not installed (apt-get install slurm-wlm munge)"
done
PATH=$PATH:/usr/sbin
[[ $(id -u) == 0 ]] || skip 'slurmd needs root'

# Daemons with everything below this folder.
host=$(hostname -s)
mkdir state spool
munged --force --key-file="$work/munge.key" --socket="$work/munge.socket" --pid-file="$work/munged.pid" \
  --log-file="$work/munged.log" --seed-file="$work/munge.seed" 2>munge.err ||
  { head -c 1024 /dev/urandom >munge.key && chmod 400 munge.key && munged --force --key-file="$work/munge.key" \
    --socket="$work/munge.socket" --pid-file="$work/munged.pid" --log-file="$work/munged.log" \
    --seed-file="$work/munge.seed" 2>munge.err; } || skip "munged does not start: $(tail -n 1 munge.err)"
port=$((20000 + $$ % 20000))
cat >slurm.conf <<CONF
ClusterName=loopback
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
CredType=cred/munge
SlurmctldPort=$port
SlurmdPort=$((port + 1))
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
ReturnToService=2
SlurmdTimeout=5
KillWait=1
SchedulerParameters=batch_sched_delay=0,sched_min_interval=100000,sched_interval=1
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$work/slurm.conf
stop() { # by the ids that the daemons wrote down
  [[ $BASHPID == "$$" ]] || return 0
  local name
  for name in slurmd slurmctld munged; do
    [[ ! -s $work/$name.pid ]] || kill -KILL "$(cat "$work/$name.pid")" 2>/dev/null
  done
  rm -rf "$work"
}
trap stop EXIT
slurmctld 2>daemon.err && slurmd -N "$host" 2>>daemon.err || skip "Slurm does not start: $(tail -n 1 daemon.err)"
for try in {1..100}; do
  sinfo -h -o %T 2>/dev/null | grep -q idle && break
  sleep 0.1
done
sinfo -h -o %T 2>/dev/null | grep -q idle || skip "the node does not come up: $(tail -n 1 slurmd.log)"

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
for try in {1..200}; do
  [[ $(find again/recordings -name model.csv 2>/dev/null | wc -l) -ge 2 ]] && break
  sleep 0.05
done
kill -KILL "$(cat slurmd.pid)" && sleep 1 && rm -f slurmd.pid && slurmd -N "$host" 2>>daemon.err
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
