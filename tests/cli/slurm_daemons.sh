# Sourced with a folder in $work: a Slurm controller and node daemon of their own on loopback, with everything
# below that folder, as whoever calls.
slurm_conf() { # PORT
  cat <<CONF
ClusterName=loopback
SlurmctldHost=$slurm_host(127.0.0.1)
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
CredType=cred/munge
SlurmctldPort=$1
SlurmdPort=$(($1 + 1))
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
NodeName=$slurm_host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$slurm_host Default=YES MaxTime=INFINITE State=UP
CONF
}
slurm_munge() {
  munged --force --key-file="$work/munge.key" --socket="$work/munge.socket" --pid-file="$work/munged.pid" \
    --log-file="$work/munged.log" --seed-file="$work/munge.seed" 2>munge.err
}
slurm_node() { slurmd -N "$slurm_host" 2>>daemon.err; }
slurm_kill_node() { kill -KILL "$(cat "$work/slurmd.pid")" && rm -f "$work/slurmd.pid"; }
slurm_node_is_missed() { sinfo -h -o %T 2>/dev/null | grep -q down; }
slurm_start() { # prints why not, where it cannot; to be stopped by slurm_stop either way
  local program
  PATH=$PATH:/usr/sbin
  for program in slurmctld slurmd sbatch munged; do
    command -v $program >/dev/null || { echo "$program is not installed (apt-get install slurm-wlm munge)"; return 1; }
  done
  slurm_host=$(hostname -s)
  mkdir state spool
  slurm_munge || { head -c 1024 /dev/urandom >munge.key && chmod 400 munge.key && slurm_munge; } ||
    { echo "munged does not start: $(tail -n 1 munge.err)"; return 1; }
  slurm_conf $((20000 + $$ % 20000)) >slurm.conf
  export SLURM_CONF=$work/slurm.conf
  slurmctld 2>daemon.err && slurm_node || { echo "Slurm does not start: $(tail -n 1 daemon.err)"; return 1; }
  for _ in {1..600}; do
    ! sinfo -h -o %T 2>/dev/null | grep -q idle || return 0
    sleep 0.1
  done
  echo "the node does not come up: $(tail -n 1 slurmd.log)"
  return 1
}
slurm_stop() { # by the ids that the daemons wrote down
  local name
  for name in slurmd slurmctld munged; do
    [[ ! -s $work/$name.pid ]] || kill -KILL "$(cat "$work/$name.pid")" 2>/dev/null || true
  done
}
