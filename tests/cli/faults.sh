#!/usr/bin/env bash
# faults.sh BIN: what each tool does when the machine fails: a full disk, a reader that goes away, an
# unreadable input, two writers of one file, interrupted system calls, a kill at any moment, a clock that is
# stepped back. Prints a table of fault, tool, outcome.
# After any of it an output is whole or as it was before, and nothing temporary is left.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh"
. "$(dirname "${BASH_SOURCE[0]}")/full_disk.sh"
need strace pgrep
PATH=$bin:$PATH

# What every tool reads and makes.
hs-tetmesh -q box.off --max-volume 1e-8 -o body.ply || exit 1
box_presses 40 4e-5 >motion.csv
printf 'effect,region,parameter,value\nelastic,0,E,8000\nelastic,0,nu,0.4\n' >model.csv
hs-simulate -q motion.csv --body body.ply --model model.csv --rim-edge 0.3 --add-noise 0.002 -o data.csv || exit 1
cp data.csv forces.csv
awk 'BEGIN { OFS = ","; print "x,y,z"; for (i = 0; i < 4000; ++i) print 0.06 * rand(), 0.05 * rand(), 0.04 }' >scan.csv
awk 'BEGIN { print "time [s],force [N],displacement [mm]"; for (i = 0; i < 400; ++i) print i * 0.01 "," (i > 100 ? (i - 100) * 0.01 : 0) "," i * 0.02 }' >machine.csv
hs-scan2ply -q scan.csv -o points.ply || exit 1
hs-calibrate -q --plan turns.csv --plan-poses 12 || exit 1
awk -F, -v OFS=, '$1 == "pose" { print "qw,qx,qy,qz,fx,fy,fz"; next } { print $2, $3, $4, $5, 4 * $6 + 0.001 * ($1 % 3), 4 * $7 + 0.2, 4 * $8 }' turns.csv >poses.csv
printf 'name,body,data,options,common_options\na,body.ply,data.csv,--folds 0,--rim-edge 0.3\n' >manifest.csv
awk 'BEGIN { srand(3); print "x,y,z,E,nu,E_std,nu_std,n"; for (i = 0; i < 20; ++i)
  printf "%.2f,%.2f,0.04,%.0f,%.3f,200,0.01,90\n", 0.01 * (i % 4), 0.01 * int(i / 4), (i < 10 ? 8000 : 16000) + 300 * rand(), 0.4 + 0.02 * rand() }' >samples.csv
hs-identify -q data.csv --body body.ply --rim-edge 0.3 --folds 0 --threads 1 --library lab.db -o identified.csv || exit 1
declare -A command=(
  [hs-tetmesh]='hs-tetmesh box.off --max-volume 1e-8'
  [hs-scan2ply]='hs-scan2ply scan.csv'
  [hs-reconstruct]='hs-reconstruct points.ply'
  [hs-calibrate]='hs-calibrate poses.csv'
  [hs-import]='hs-import machine.csv --block 60x50x40mm --tool-radius 4mm'
  [hs-simulate]='hs-simulate data.csv --body body.ply --model model.csv --rim-edge 0.3 --threads 1'
  [hs-identify]='hs-identify data.csv --body body.ply --rim-edge 0.3 --folds 0 --threads 1'
  [hs-diagnose]='hs-diagnose data.csv --body body.ply --model model.csv --rim-edge 0.3 --flips 99'
  [hs-plan]='hs-plan data.csv --body body.ply --rim-edge 0.3'
  [hs-compare]='hs-compare data.csv --simulated forces.csv'
  [hs-check]='hs-check model.csv --golden model.csv'
  [hs-export]='hs-export model.csv --body body.ply --data data.csv --format calculix'
  [hs-batch]='hs-batch manifest.csv --out batch'
  [hs-cluster]='hs-cluster samples.csv'
  [hs-library]='hs-library lab.db'
  [hs-fuse]='hs-fuse forces.csv --slow data.csv'
)
tools=($(printf '%s\n' "${!command[@]}" | sort))
declare -A input=([hs-tetmesh]=box.off [hs-scan2ply]=scan.csv [hs-reconstruct]=points.ply [hs-import]=machine.csv [hs-simulate]=data.csv
  [hs-identify]=data.csv [hs-diagnose]=data.csv [hs-plan]=data.csv [hs-compare]=data.csv [hs-check]=model.csv [hs-export]=model.csv
  [hs-batch]=manifest.csv [hs-calibrate]=poses.csv [hs-cluster]=samples.csv [hs-library]=lab.db [hs-fuse]=forces.csv)

row() { printf '%-28s %-14s %s\n' "$1" "$2" "$3"; }
temporaries() { find . -name '.hapsim-*.tmp' | wc -l; }
# told FAULT TOOL CODES: the exit code is one of CODES, and an error is one line
told() {
  [[ " $3 " == *" $code "* ]] || complain "$1: $2 ends with $code, not with $3"
  [[ $code == [0134] || $(grep -c "^$2: " err) == 1 ]] || complain "$1: $2 says it in one line"
  [[ $(temporaries) == 0 ]] || complain "$1: $2 leaves a temporary file"
}
for tool in "${tools[@]}"; do
  ${command[$tool]} -q -o /dev/full >/dev/null 2>err; code=$?
  told '/dev/full' $tool 5
  row 'output to a full device' $tool "exit $code, $(cut -c1-60 err | head -n 1)"
done
# An old output on a full disk must survive.
full_disk 64
for tool in hs-tetmesh hs-simulate hs-compare hs-export; do
  echo old >full/out; fill 0
  filling ${command[$tool]} -q -o full/out >/dev/null 2>err; code=$?
  told 'full disk' $tool 5
  [[ $(cat full/out) == old && $(ls -A full | tr '\n' ' ') == @('filler '|)'out ' ]] || complain "full disk: $tool touches the old file"
  rm -f full/filler full/out
  row "$full_disk" $tool "exit $code, the old file is whole"
done
for tool in "${tools[@]}"; do
  ${command[$tool]} -q 2>err | head -c 0; code=${PIPESTATUS[0]}
  [[ ! -s err ]] || complain "closed pipe: $tool is not silent"
  [[ $code == 0 || $code == 1 || $code == 141 ]] || complain "closed pipe: $tool ends with $code"
  row 'reader of the pipe is gone' $tool "exit $code, silent"
done
# Inputs that cannot be read: a folder in their place (root reads everything else), and nothing at all.
for tool in "${tools[@]}"; do
  mkdir -p folder
  echo old >out
  ${command[$tool]/${input[$tool]}/folder} -q -o out >/dev/null 2>err; code=$?
  [[ $tool == hs-scan2ply ]] || told 'folder as input' $tool 5  # a folder holds DICOM slices
  [[ $(cat out) == old ]] || complain "unreadable: $tool touches the old file"
  ${command[$tool]/${input[$tool]}/missing} -q -o out >/dev/null 2>err; code=$?
  told 'missing input' $tool 5
  row 'input missing or unreadable' $tool "exit $code, the old file is whole"
done
# Two that write one file: it is one of both, whole.
for tool in hs-tetmesh hs-simulate hs-fuse hs-export; do
  ${command[$tool]} -q -o alone 2>/dev/null
  for try in 1 2 3; do
    ${command[$tool]} -q -o both 2>err & ${command[$tool]} -q -o both 2>err2 & wait
    cmp -s alone both || complain "two writers: $tool"
  done
  [[ $(temporaries) == 0 ]] || complain "two writers: $tool leaves a temporary file"
  row 'two writers of one file' $tool 'one of both, whole'
done
# Stopped and continued, again and again, while it waits for the rest of a pipe: system calls are interrupted.
mkfifo slow
is() { local word state; read -r word word state word <"/proc/$2/stat" && [[ $state == "$1" ]]; } # STATE PROCESS
for tool in hs-simulate hs-compare; do
  ${command[$tool]} -q -o expected 2>/dev/null
  ${command[$tool]/data.csv/-} -q -o out <slow 2>err &
  victim=$!
  exec {to}>slow
  head -c 500 data.csv >&"$to"
  for k in {1..40}; do
    until_true 60 is S $victim && kill -STOP $victim && until_true 60 is T $victim && kill -CONT $victim || complain "stopped and continued: $tool is not"
  done
  tail -c +501 data.csv >&"$to"
  exec {to}>&-
  wait $victim; code=$?
  grep -v '^#' out >out.rows; grep -v '^#' expected >expected.rows
  [[ $code == 0 ]] && cmp -s out.rows expected.rows || complain "stopped and continued: $tool (exit $code)"
  row 'stopped and continued' $tool "exit $code, the same result"
done
# System calls that a signal interrupts before they have done anything: every other one of those that
# read the input, write, or wait for a child.
strace -qq -o trace true 2>err || complain 'strace cannot trace here: a container needs the capability SYS_PTRACE'
for tool in "${tools[@]}"; do
  # The path as strace sees it: the whole one.
  whole=${command[$tool]/${input[$tool]}/$work/${input[$tool]}}
  $whole -q -o expected 2>/dev/null; calm=$?
  calls=0
  for at in "-P $work/${input[$tool]} -e inject=openat,read,pread64:error=EINTR:when=1+2" \
    '-e inject=write,writev,fsync,fdatasync,flock,wait4,poll,select,ppoll:error=EINTR:when=1+2'; do
    # The leak sanitizer, where the tools are built with it, cannot look while strace does.
    ASAN_OPTIONS=detect_leaks=0 XDG_CACHE_HOME=$work/fresh-$tool strace -f -qq -o trace $at $whole -q -o out 2>err; code=$?
    calls=$((calls + $(grep -c INJECTED trace)))
    [[ $code == "$calm" ]] && cmp -s out expected || complain "interrupted: $tool (exit $code)"
    [[ $(temporaries) == 0 ]] || complain "interrupted: $tool leaves a temporary file"
  done
  ((calls > 0)) || complain "interrupted: no system call of $tool was"
  row 'interrupted system call' $tool "exit $code, the same result ($calls interrupted)"
done
# Killed at any moment: by SIGTERM nothing is left; by SIGKILL what was there is whole.
for tool in hs-tetmesh hs-simulate hs-identify; do
  XDG_CACHE_HOME=$work/fresh ${command[$tool]} -q -o whole 2>/dev/null
  cut=0
  for delay in 0.005 0.02 0.05 0.1 0.2; do
    for signal in TERM KILL; do
      rm -rf fresh
      echo old >out
      XDG_CACHE_HOME=$work/fresh ${command[$tool]} -q -o out 2>err &
      sleep $delay; kill -$signal $! 2>/dev/null; wait $! 2>/dev/null; code=$?
      ((code < 128 && code != 4)) || cut=$((cut + 1))
      # An identification that has begun to fit leaves the best so far, marked.
      [[ $(head -c 4 out) == "old" ]] || cmp -s out whole || { grep -q "^# converged: no" out && tail -n 1 out | grep -q ","; } ||
        complain "SIG$signal: $tool leaves half a file"
      [[ $signal == KILL || $(temporaries) == 0 ]] || complain "SIGTERM: $tool leaves a temporary file"
      rm -f .hapsim-*.tmp
    done
  done
  # The cache that a killed process was writing does no harm.
  XDG_CACHE_HOME=$work/fresh ${command[$tool]} -q -o after 2>/dev/null && cmp -s after whole || complain "$tool after kills"
  rm -rf fresh  # a SIGKILL may have left its temporary file there
  row "killed ($cut of 10 in time)" $tool 'old or new, whole; the cache serves on'
done
# An operator whose output cannot be written, or that is killed on the way: the teleoperator lives on and
# serves the next one.
awk 'BEGIN { print "# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz"
  for (i = 0; i < 600; ++i) printf "1,%.3f,0.03,0.025,0.04,0,0,%.9g\n", i / 1000, -0.001 * (1 - cos(0.02 * i)) }' >hand.csv
hs-tetmesh -q box.off --edge 0.015 -o coarse.ply
hs-link --listen 0 --accuracy 0.3 --body coarse.ply --model model.csv --tool-radius 0.004 --idle 600 2>far.err &
far=$!
until_true 60 grep -qs listening far.err
operator="hs-link hand.csv --accuracy 0.3 --peer $(sed -n 's/.*listening at 127.0.0.1:\([0-9]*\).*/\1/p' far.err) --body coarse.ply -q"
$operator -o /dev/full 2>err; code=$?
told '/dev/full' hs-link 5
row 'output to a full device' hs-link "exit $code, $(cut -c1-60 err | head -n 1)"
for signal in TERM KILL; do
  for delay in 0.05 0.3; do
    echo old >out
    $operator -o out 2>err &
    sleep $delay; kill -$signal $! 2>/dev/null; wait $! 2>/dev/null
    # What was felt until then may stay: whole lines.
    [[ $(head -c 4 out) == "old" || $(tail -c 1 out | od -An -c) == *'\n'* ]] || complain "SIG$signal: hs-link leaves half a line"
    [[ $signal == KILL || $(temporaries) == 0 ]] || complain "SIGTERM: hs-link leaves a temporary file"
    rm -f .hapsim-*.tmp
  done
done
$operator -o out 2>err || complain 'hs-link after kills'
[[ $(grep -c '^1,' out) == 600 ]] || complain 'hs-link after kills: not every line was answered'
kill $far 2>/dev/null || complain 'the teleoperator died with its operators'
wait $far || true
row 'operator killed 4 times' hs-link 'the teleoperator serves the next one'
# TetGen's process ends with the one that asked it.
none_left() { for p in $(pgrep -x hs-tetmesh); do [[ $(readlink /proc/$p/cwd) != "$PWD" ]] || return 1; done; }
until_true 60 none_left || complain 'a killed hs-tetmesh leaves a process'
# The clock was three hours ahead while a batch ran and has been set right; then a recording changes. make alone
# would take the old results for newer than it.
batch() { # prints E; its files' times as they are
  make --no-print-directory -s -f "$root/Makefile.pipeline" batch BIN="$bin" MANIFEST=manifest.csv OUT=clock \
    BATCH_FLAGS='--stages model -q' >/dev/null 2>err || complain 'clock: the batch'
  awk -F, 'NR == 2 { printf "%.0f", $5 }' clock/summary.csv
}
cp -p data.csv data.kept
first=$(batch)
find clock -exec touch -h -d '+3 hours' {} +
awk -F, -v OFS=, '/^[0-9]/ { $11 *= 1.2 } 1' data.kept >data.csv
second=$(batch)
((second > 11 * first / 10)) || complain "clock: the changed recording is not noticed ($first, then $second)"
find clock -exec touch -h -d '+3 hours' {} +
touch before && [[ $(batch) == "$second" && -z $(find clock/recordings -name model.csv -newer before ! -newermt '+1 hour') ]] ||
  complain 'clock: what is done is made again'
mv data.kept data.csv  # as old as it was
[[ $(batch) == "$first" ]] || complain 'clock: an older recording that is put back is not noticed'
row 'clock stepped back' hs-batch 'what changed is made again, nothing else is'
((failures == 0)) && echo 'faults: passed'
exit $((failures > 0))
