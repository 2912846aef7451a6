#!/usr/bin/env bash
# faults_library.sh BIN: a model library when the machine fails: two writers at once, a kill at every write
# of the database, a full disk. Prints a table of fault, tool, outcome. After any of it the file is a whole
# database with the old entries or the new ones.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh"
. "$(dirname "${BASH_SOURCE[0]}")/full_disk.sh"
need strace sqlite3
PATH=$bin:$PATH

hs-tetmesh -q box.off --max-volume 2e-8 -o body.ply || exit 1
box_presses 8 1e-4 >motion.csv
printf 'effect,region,parameter,value\nelastic,0,E,8000\nelastic,0,nu,0.4\n' >model.csv
hs-simulate -q motion.csv --body body.ply --model model.csv --rim-edge 0.3 --add-noise 0.002 -o data.csv || exit 1
identify=(hs-identify data.csv --body body.ply --rim-edge 0.3 --folds 0 --threads 1 -q)
"${identify[@]}" --library one.db --material one -o m.csv || exit 1

row() { printf '%-28s %-12s %s\n' "$1" "$2" "$3"; }
entries() { hs-library "$1" -q 2>list.err | tail -n +2 | cut -d, -f1 | tr '\n' ' '; } # DATABASE
whole() { # WHAT DATABASE
  hs-library "$2" -q -o list.csv 2>err || complain "$1: the library cannot be read"
  [[ $(sqlite3 "$2" 'pragma integrity_check') == ok ]] || complain "$1: the database is damaged"
}

# Two that add entries, and one that lists and removes, all at once.
cp one.db busy.db
for k in 1 2 3; do "${identify[@]}" --library busy.db --material left -o left.csv || echo failed; done >left.log 2>&1 &
for k in 1 2 3; do "${identify[@]}" --library busy.db --material right -o right.csv || echo failed; done >right.log 2>&1 &
hs-library -q busy.db --remove 1 2>err || complain 'two writers: an entry cannot be removed'
while [[ -n $(jobs -rp) ]]; do
  hs-library -q busy.db -o list.csv 2>err || complain 'two writers: the list cannot be read'
  jobs >/dev/null
done
wait
cat left.log right.log >err
[[ ! -s err ]] || complain 'two writers: an identification failed'
whole 'two writers' busy.db
[[ $(entries busy.db) == '2 3 4 5 6 7 ' ]] || complain "two writers: the entries are $(entries busy.db)"
row 'two writers of one library' hs-identify 'six entries of two writers, each whole'

# What is to be written into, large enough for several pages.
cp one.db many.db
for k in 1 2 3 4 5 6 7 8 9; do "${identify[@]}" --library many.db --material "$k" -o m.csv || exit 1; done
before=$(entries many.db)
# killed TOOL AFTER COMMAND...: at each system call by which the database writes; the entries are
# then those from before or AFTER, and the next writer goes on.
killed() {
  local tool=$1 after=$2 call n count=0
  shift 2
  for call in pwrite64 fdatasync unlink; do
    for n in {1..40}; do
      rm -f lab.db* && cp many.db lab.db
      # In a shell of its own, which says nothing of the kill.
      (ASAN_OPTIONS=detect_leaks=0 strace -f -qq -o trace -e trace=$call -e inject=$call:signal=KILL:when="$n" "$@" 2>err; exit $?) 2>/dev/null && break
      grep -q SIGKILL trace || complain "killed: $tool was not"
      count=$((count + 1))
      whole "killed at $call $n" lab.db
      [[ $(entries lab.db) == "$before" || $(entries lab.db) == "$after" ]] || complain "killed at $call $n: $(entries lab.db)"
      hs-library -q lab.db --remove 1 2>err || complain "killed at $call $n: nobody can write any more"
    done
  done
  rm -f .hapsim-*.tmp
  ((count > 5)) || complain "killed: $tool was ended only $count times"
  row 'killed while it writes' "$tool" "$count kills: the old entries or the new, whole"
}
strace -qq -o trace true 2>err || complain 'strace cannot trace here: a container needs the capability SYS_PTRACE'
killed hs-library "${before#1 2 }" hs-library -q lab.db --remove 1,2
killed hs-identify "${before}11 " "${identify[@]}" --library lab.db --material new -o new.csv

# Filled to the last page.
full_disk 128
for left in 0 8192 49152; do
  rm -f full/* && cp many.db full/lab.db
  fill $left full/lab.db
  filling "${identify[@]}" --library full/lab.db --material full -o new.csv 2>err; code=$?
  now=$(entries full/lab.db)
  if ((code == 0)); then
    [[ $now == "${before}11 " ]] || complain "full disk: exit 0 and $now"
  else
    [[ $code == 5 && $now == "$before" && $(grep -c '^hs-identify: ' err) == 1 ]] || complain "full disk: exit $code and $now"
    [[ $left != 0 ]] || row "$full_disk" hs-identify "exit 5, the old entries are whole"
  fi
  whole 'full disk' full/lab.db
  [[ -z $(find . -name '.hapsim-*.tmp') ]] || complain 'full disk: a temporary file is left'
done
rm -f full/* && cp many.db full/lab.db
hs-library -q full/lab.db -o /dev/full 2>err; code=$?
[[ $code == 5 ]] || complain "a full device: exit $code"
((failures == 0)) && echo 'faults_library: passed'
exit $((failures > 0))
