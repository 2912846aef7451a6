#!/usr/bin/env bash
# ssh.sh BIN: the batch by GNU parallel over SSH, as README.md says, on two hosts that are this machine behind
# an sshd of its own on loopback: the same summary as by make alone; connections that are cut on the way, and
# the same commands again, lose nothing.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh"
PATH=$bin:$PATH:/usr/sbin
need sshd ssh ssh-keygen parallel pgrep

# Keys, server and client, all below this folder.
port=$((20000 + $$ % 20000))
ssh-keygen -q -t ed25519 -N '' -f host_key && ssh-keygen -q -t ed25519 -N '' -f key && cp key.pub authorized_keys || exit 1
[[ $(id -u) != 0 ]] || mkdir -p /run/sshd
cat >sshd_config <<CONF
Port $port
ListenAddress 127.0.0.1
HostKey $work/host_key
AuthorizedKeysFile $work/authorized_keys
PidFile $work/sshd.pid
StrictModes no
UsePAM no
PasswordAuthentication no
PermitRootLogin prohibit-password
MaxStartups 100
CONF
cat >ssh_config <<CONF
Host node1 node2
  HostName 127.0.0.1
  Port $port
  User $(id -un)
  IdentityFile $work/key
  IdentitiesOnly yes
  UserKnownHostsFile $work/known_hosts
  StrictHostKeyChecking accept-new
  BatchMode yes
  LogLevel ERROR
CONF
answers() { ssh -F ssh_config node1 true 2>err; }
serve() { "$(command -v sshd)" -f "$work/sshd_config" -E "$work/sshd.log" && until_true 60 answers; }
# The server and, with `all`, the connections that it has taken.
stop() {
  [[ -s sshd.pid ]] || return 0
  local server; server=$(cat sshd.pid)
  [[ ${1:-} != all ]] || kill -KILL $(pgrep -P "$server") 2>/dev/null
  kill -KILL "$server" 2>/dev/null
  rm -f sshd.pid
}
trap '[[ $BASHPID != "$$" ]] || { stop all; rm -rf "$work"; }' EXIT
serve || { complain "sshd does not answer: $(tail -n 1 sshd.log)"; exit 1; }

hs-tetmesh -q box.off --max-volume 2e-8 -o box.ply || exit 1
box_presses 8 1e-4 >motion.csv
printf 'effect,region,parameter,value\nelastic,0,E,9000\nelastic,0,nu,0.4\n' >truth.csv
box_scan >scan.csv
echo 'name,body,scan,scan_unit,data,options,common_options' >recordings.csv
for i in 1 2 3 4 5 6 7 8; do
  hs-simulate -q motion.csv --body box.ply --model truth.csv --rim-edge 0.3 --add-noise 0.002 --seed $i -o $i.csv || exit 1
  ((i < 6)) && echo "recording $i,box.ply,,,$i.csv,--folds 0,--rim-edge 0.3" >>recordings.csv
done
for i in 6 7; do echo "from scan $i,,scan.csv,mm,$i.csv,--folds 0,--rim-edge 0.3" >>recordings.csv; done
sed -i 's/^1,.*/1,nonsense/' 8.csv
echo 'broken,box.ply,,,8.csv,--folds 0,--rim-edge 0.3' >>recordings.csv

# The commands of README.md, with these hosts and where these tools are.
grep -q '^parallel --sshlogin 4/node1,8/node2 --wd \. make -C batch -k -f batch.mk {} <batch/targets$' "$root/README.md" ||
  complain 'README.md says something else than what is tried here'
over_ssh() { # OUT
  hs-batch recordings.csv --prepare --out "$1" --stages model --bin "$bin" -q && make -s -C "$1" -f batch.mk -k -j2 bodies >log 2>&1
  parallel --ssh "ssh -F $work/ssh_config" --sshlogin 1/node1,1/node2 --wd . make -C "$1" -k -f batch.mk {} <"$1/targets" >log 2>&1
  hs-batch recordings.csv --out "$1" --stages model --html "$1/overview.html" -o "$1/summary.csv" 2>err
}
models() { (($(find "$1/recordings" -name model.csv 2>/dev/null | wc -l) >= $2)); } # OUT COUNT
same() { cmp -s <(sed "s/\b$1\b/here/g" "$1/summary.csv") here/summary.csv || complain "the summary of $1 is another"; }
make --no-print-directory -s -j2 -f "$root/Makefile.pipeline" batch BIN="$bin" MANIFEST=recordings.csv OUT=here \
  BATCH_FLAGS='--stages model' >log 2>err
grep -q '7 of 8 recordings done, 1 failed' err || complain 'the batch by itself'
over_ssh far && complain 'a failure must be told by the exit code'
grep -q '7 of 8 recordings done, 1 failed' err || { complain 'the batch over SSH'; cat log; }
[[ $(grep -c 'Accepted publickey' sshd.log) -ge 8 ]] || complain 'the recordings did not go over SSH'
same far
# Cut on the way.
over_ssh cut & far=$!
until_true 120 models cut 2 || complain 'the batch over SSH does not begin'
stop all
wait $far
serve || complain 'sshd does not come again'
over_ssh cut
same cut
((failures == 0)) && echo 'ssh: passed'
exit $((failures > 0))
