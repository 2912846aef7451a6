#!/usr/bin/env bash
# interrupt.sh BIN: hs-identify ended by a signal, and gone on with.
set -uo pipefail
bin=$(cd "$1" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/tool.sh" "$1/hs-identify"
. "$here/identify_data.sh"
common=(--body block.ply --rim-edge 0.3 --folds 0)
# A search of many starts takes long; what comes before it is in the cache.
"$tool" -q data.csv "${common[@]}" -o m0.csv || complain 'the elastic model is identified'
search=(data.csv "${common[@]}" --add viscoelastic --terms 2 --starts 100000 --seed 3)

# searching ARGUMENTS...: starts it on a terminal, where it says how far it is, and waits until it has done
# some starts; leaves its process in `searcher`, its terminal's in `terminal`.
searching() {
  rm -f shown process
  TERM=xterm script -qefc "$(printf '%q ' sh -c 'echo $$ >process; exec env --default-signal=INT "$@"' sh "$tool" "$@")" \
    shown </dev/null >/dev/null &
  terminal=$!
  until_true 300 grep -Eqs 'start ([3-9]|[1-9][0-9]+)/100000' shown || complain 'the search does not begin'
  searcher=$(cat process)
}
ended() { # leaves the exit code in `code`
  wait $terminal
  code=$?
  tr '\r' '\n' <shown >.err
}
# interrupted SIGNAL ARGUMENTS...
interrupted() {
  searching "${@:2}"
  kill -s "$1" "$searcher"
  ended
}
for signal in INT TERM; do
  rm -f m.csv
  interrupted "$signal" "${search[@]}" -o m.csv
  ((code == 4)) || complain "exit code $code, not 4, after SIG$signal"
  grep -q 'data.csv: the fit was interrupted after [0-9]* of 100000 starts; the best so far, error' .err ||
    complain "what SIG$signal did is told"
  grep -q '^# converged: no' m.csv && grep -q '^# search: [0-9]* of 100000 starts, seed 3' m.csv ||
    complain 'the model is marked'
done
grep -q 'fitting, error [0-9.]* N, start [0-9]*/100000' .err || complain 'progress with the error'
done_first=$(sed -n 's/^# search: \([0-9]*\) .*/\1/p' m.csv)
((done_first > 0)) || complain 'some starts were done'
"$bin/hs-simulate" motion.csv --body block.ply --model m.csv --rim-edge 0.3 -o forces.csv 2>.err ||
  complain 'the best so far gives forces'
grep -q 'm.csv: the fit of this model was ended before it converged' .err ||
  complain 'hs-simulate tells what it was given'

interrupted TERM data.csv "${common[@]}" --model m.csv --resume -o m2.csv
((code == 4)) || complain 'interrupted again'
done_then=$(sed -n 's/^# search: \([0-9]*\) .*/\1/p' m2.csv)
((done_then > done_first)) || complain "the search goes on: $done_first, then $done_then"
# To its end: the mark is gone.
sed "s/^# search: .*/# search: 99990 of 100000 starts, seed 3/" m2.csv >nearly.csv
expect 0 ', tau2 = ' data.csv "${common[@]}" --model nearly.csv --resume -o m3.csv
! grep -q 'converged\|search' m3.csv || complain 'a finished search has no mark'
expect 2 'm3.csv is no model of an interrupted search' data.csv "${common[@]}" --model m3.csv --resume
expect 2 '--resume needs the model' data.csv "${common[@]}" --resume
expect 2 '--resume and --starts exclude each other' data.csv "${common[@]}" --model m.csv --resume \
  --starts 5 -q

# A second signal ends it at once; before the fit a signal ends it as it always did.
rm -f m.csv
searching "${search[@]}" -o m.csv
kill -TERM "$searcher"; kill -TERM "$searcher" 2>/dev/null
ended
((code == 4 || code == 143)) || complain "exit code $code after two signals"
[[ -z $(find . -name '.hapsim-*') ]] || complain 'no temporary file is left'

# Killed without a word, it goes on from what was saved beside the model.
rm -f m.csv
searching "${search[@]}" -o m.csv
until_true 60 test -s m.csv.search || complain 'the search is not saved'
kill -KILL "$searcher"
ended
[[ ! -e m.csv ]] || complain 'a model out of a killed search'
saved=$(sed -n 's/^# search: \([0-9]*\) of 100000 starts, seed 3/\1/p' m.csv.search)
((saved > 0)) || complain 'what was saved says how far it is'
sed "s/^# search: .*/# search: 99990 of 100000 starts, seed 3/" m.csv.search >m.csv && mv m.csv m.csv.search
expect 0 ', tau2 = ' data.csv "${common[@]}" --model m.csv.search --resume -o m.csv
[[ -e m.csv && ! -e m.csv.search ]] || complain 'what was saved is of no use any more'

# While the model is improved: a signal that comes once the diagnosis has begun. Rows enough that it
# takes its time.
awk -F, -v OFS=, '/^[#p]/ { print; next } { for (k = 0; k < 40; ++k) { $2 = $2 + 0.001; print } }' data.csv >long.csv
"$tool" -q long.csv "${common[@]}" -o m0.csv || complain 'the elastic model of many rows is identified'
# interrupted_at WORDS SIGNAL ARGUMENTS...: the signal as soon as the words are said; once more where a
# busy machine sent it when all was done.
interrupted_at() {
  local words=$1 signal=$2
  shift 2
  for attempt in 1 2 3 4 5; do
    : >.err # or the words of the run before are found, before the new one has opened its own
    env --default-signal=INT "$tool" "$@" 2>.err &
    pid=$!
    until grep -q "$words" .err || ! kill -0 $pid 2>/dev/null; do sleep 0.02; done
    kill -s "$signal" $pid 2>/dev/null
    wait $pid
    code=$?
    ((code == 0)) || return
  done
}
for signal in INT TERM; do
  rm -f m.csv
  interrupted_at 'diagnosing elastic' "$signal" long.csv "${common[@]}" --effects auto -v -o m.csv
  ((code == 4)) || complain "exit code $code, not 4, after SIG$signal in the diagnosis"
  grep -q 'long.csv: interrupted while the model was improved; the model that was fitted is written' .err ||
    complain "what SIG$signal did in the diagnosis is told"
  grep -q '^# interrupted: while the model was improved' m.csv && grep -q '^elastic,0,E,' m.csv ||
    complain 'the model that was not improved further is marked'
done
expect 0 'm.csv: interrupted while the model was improved, so more may be missing' data.csv \
  "${common[@]}" --model m.csv -o m2.csv
! grep -q interrupted m2.csv || complain 'a fit to its end has no mark'
interrupted_at 'fitting elastic' INT long.csv "${common[@]}" --effects auto -v -o m.csv
((code == 4)) && grep -q '^# interrupted\|^# converged: no' m.csv ||
  complain "exit code $code after a signal in the first fit, or a model without a mark"

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
