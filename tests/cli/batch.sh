#!/usr/bin/env bash
# batch.sh BIN: a manifest of good and broken recordings; interruption and resumption; what is made again.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh"

# Two presses of a box of two stiffnesses, named so that nobody takes the names apart by accident.
"$bin/hs-tetmesh" -q box.off --max-volume 2e-8 -o box.ply || exit 1
awk 'BEGIN {
  print "# tool_radius: 0.004\n# force_noise: 0.002\npress,t,x,y,z,ux,uy,uz"
  for (p = 0; p < 3; ++p)
    for (i = 0; i <= 8; ++i)
      printf "%d,%.2f,%.3f,0.025,0.04,%.6f,0,%.6f\n", p, 0.05 * i, 0.02 + 0.01 * p, i * 2e-5 * (p == 2), -i * 1e-4
}' >motion.csv
for E in 8000 15000; do
  printf 'effect,region,parameter,value\nelastic,0,E,%s\nelastic,0,nu,0.4\n' $E >truth.csv
  "$bin/hs-simulate" -q motion.csv --body box.ply --model truth.csv --rim-edge 0.3 --add-noise 0.002 -o $E.csv || exit 1
done
mkdir 'data of "May" $5'
cp 8000.csv "data of \"May\" \$5/it's one.csv"
head -c 300 8000.csv >cut.csv
sed 's/^0,0.1,.*/0,0.1,0.02,x,0.04,0,0,0,0,0,0/' 8000.csv >text.csv
grep -v '^[012],' 8000.csv >empty.csv
cat >all.csv <<'CSV'
name,body,data,tool,effects,options,common_options,patient
soft,box.ply,8000.csv,,elastic,--folds 0,--rim-edge 0.3,7
stiff,box.ply,15000.csv,4mm,,--folds 0 --fix nu=0.4,--rim-edge 0.3,8
"it's ""one"", $(date) of #5",box.ply,"data of ""May"" $5/it's one.csv",0.004,elastic,--folds 0,--rim-edge '0.3',9
again,box.ply,8000.csv,,,--folds 0,--rim-edge 0.3,9
soft,box.ply,8000.csv,,,,,
missing,box.ply,nowhere.csv,,,,,
no body,,8000.csv,,,,,
strange tool,box.ply,8000.csv,4 parsec,,,,
quote,box.ply,8000.csv,,,--fix 'nu,,
text,box.ply,text.csv,,,--folds 0,--rim-edge 0.3,
cut,box.ply,cut.csv,,,--folds 0,--rim-edge 0.3,
empty,box.ply,empty.csv,,,--folds 0,--rim-edge 0.3,
flag,box.ply,8000.csv,,,--foldz 0,--rim-edge 0.3,
effect,box.ply,8000.csv,,magic,--folds 0,--rim-edge 0.3,
CSV
batch() { # OUT MANIFEST FLAGS...: exit code in `code`
  local out=$1 manifest=$2
  shift 2
  make --no-print-directory -s -j2 -f "$root/Makefile.pipeline" batch BIN="$bin" MANIFEST="$manifest" \
    OUT="$out" BATCH_FLAGS='--stages model' "$@" >log 2>err
  code=$?
}
field() { # SUMMARY NAME COLUMN
  awk -F, -v name="$2" -v column="$3" '!h { h = 1; for (i = 1; i <= NF; ++i) c[$i] = i; next } $1 == name { print $c[column] }' "$1"
}

batch out all.csv
((code != 0)) || complain 'a batch with failures must not end with 0'
summary=out/summary.csv
grep -q '✗ 4 of 14 recordings done, 10 failed$' err || complain 'the count of failures is told'
for line in 'failed: soft: all.csv:6: the name .soft. stands in line 2 already;' \
  "failed: missing: all.csv:7: data 'nowhere.csv': No such file or directory;" \
  'failed: no body: all.csv:8: there is neither body nor scan;' \
  'failed: strange tool: all.csv:9: tool: ' \
  "failed: quote: all.csv:10: a quote (') opens and never closes;" \
  'failed: text: hs-identify: text.csv: a cell is not a finite number' \
  'failed: cut: hs-identify: cut.csv:[0-9]*: ' \
  'failed: empty: hs-identify: empty.csv: ' \
  "failed: flag: hs-identify: unknown flag '--foldz'; did you mean '--folds'?" \
  "failed: effect: hs-identify: .*magic"; do
  [[ $(grep -c -- "$line" err) == 1 ]] || complain "one line says: $line"
done
[[ $(grep -c '^hs-batch: failed: ' err) == 10 ]] || complain 'a line each failure'
[[ $(wc -l <"$summary") == 15 ]] || complain 'a row each recording'
[[ $(field "$summary" soft state | head -n 1) == done && $(field "$summary" soft patient | head -n 1) == 7 ]] ||
  complain 'a good recording is done, its own columns are there'
awk -v E="$(field "$summary" stiff E)" 'BEGIN { exit !(E > 14000 && E < 16000) }' || complain 'E is found'
grep -q '"it.s ""one"", $(date) of #5",4,done,elastic' "$summary" || complain 'any name will do'
# The command of a failure repeats it.
command=$(field "$summary" text command)
[[ $(PATH=$bin:$PATH sh -c "$command" 2>&1) == "$(field "$summary" text message | tr -d '"')"* ]] ||
  complain 'the command repeats the failure'

# Nothing is made twice, neither what is done nor what would fail again.
"$bin/hs-batch" all.csv --out out --stages model -q --junit cases.xml >again.csv && complain "the summary alone tells of failures"
cmp -s again.csv "$summary" || complain "the summary alone is the same"
grep -q 'tests="14" failures="10"' cases.xml || complain "a test a recording"
touch before
batch out all.csv
[[ -z $(find out/recordings -newer before -type f) ]] || complain 'a second run makes nothing'
((code != 0)) || complain 'failures are told again'
# A changed recording, and a changed row, are made again; no other.
touch -d '+1 sec' 15000.csv && cp 8000.csv text.csv
sed -i '/^again/s/--folds 0/--folds 0 --seed 2/' all.csv
until touch before && [[ before -nt all.csv ]]; do :; done  # until the clock of files has gone on
batch out all.csv
made=$(cd out/recordings && find . -name model.csv -newer ../../before | sort | tr '\n' ' ')
[[ $made == './again/model.csv ./stiff/model.csv ./text/model.csv ' ]] || complain "made again: $made"
grep -q '5 of 14 recordings done, 9 failed' err || complain 'a mended recording is done'

# Killed at any moment and begun again, the result is the same.
batch whole all.csv
for delay in 0.1 0.2 0.3 0.5 0.6 0.8; do
  setsid make --no-print-directory -s -j2 -f "$root/Makefile.pipeline" batch BIN="$bin" MANIFEST=all.csv \
    OUT=killed BATCH_FLAGS='--stages model' >log 2>&1 &
  sleep $delay
  [[ $delay == *[15] ]] && victim=-$! || victim=$!  # everything, or make alone
  signal=KILL
  [[ $delay != *[26] ]] || signal=TERM victim=-$!     # an identification then leaves the best so far
  kill -$signal -- $victim 2>/dev/null
  wait $! 2>/dev/null
done
batch killed all.csv
sed 's/killed/whole/g' killed/summary.csv | cmp - whole/summary.csv || complain 'killed and resumed gives the same bytes'
[[ -z $(find killed -name '.hapsim-*' -newer log) ]] || complain 'nothing temporary is left by the last run'
grep -q 'all.csv' killed/overview.html && grep -q '</html>' killed/overview.html || complain 'there is an overview'
! grep -q '"it' killed/overview.html || complain 'names are escaped'

# The folder may be named like a target, and JUnit's XML goes where JUNIT says.
printf 'name,body,data,options,common_options\none,box.ply,8000.csv,--folds 0,--rim-edge 0.3\n' >single.csv
batch batch single.csv JUNIT=single.xml
((code == 0)) && ! grep -q warning err && grep -q 'tests="1" failures="0"' single.xml || complain 'OUT=batch JUNIT=...'

# What was interrupted is no failure of the recording, what did not converge is one.
mkdir fake
printf 'name,body,data\none,box.ply,8000.csv\n' >one.csv
for words in 'the fit was interrupted after 3 of 9 starts' 'the fit did not converge'; do
  printf '#!/bin/sh\necho "hs-identify: 8000.csv: %s; what to do" >&2\nexit 4\n' "$words" >fake/hs-identify
  chmod +x fake/hs-identify
  "$bin/hs-batch" one.csv --prepare --stages model --out faked --bin fake -q
  make --no-print-directory -s -k -C faked -f batch.mk >log 2>err
  [[ $words == *interrupted* && -e faked/recordings/one/failure ]] && complain 'an interruption is no failure'
  [[ $words == *converge* && ! -e faked/recordings/one/failure ]] && complain 'no convergence is a failure'
done

# With -j2 two recordings are under way at once: each waits for the other.
printf 'name,body,data\none,box.ply,8000.csv\ntwo,box.ply,8000.csv\n' >two.csv
cat >fake/hs-identify <<'SH'
#!/bin/sh
touch "running-$$"
n=0
until [ "$(ls running-* | wc -l)" = 2 ]; do n=$((n + 1)); [ $n -lt 600 ] || exit 5; sleep 0.05; done
while [ "$1" != -o ]; do shift; done
printf '# rmse: 1\neffect,region,parameter,value\nelastic,0,E,1\n' >"$2"
SH
ln -s "$bin/hs-batch" fake/
(bin=fake; batch together two.csv; exit $code) || complain 'two recordings at once'

# Recordings are gone through one after the other (two with -j2), so that what is done grows steadily.
{ echo name,body,data; for name in a b c d e; do echo "$name,box.ply,8000.csv"; done; } >orderly.csv
head='#!/bin/sh\nwhile [ "$1" != -o ]; do shift; done\n'
printf "$head"'printf "# rmse: 1\\neffect,region,parameter,value\\nelastic,0,E,1\\n" >"$2"\n' >fake/hs-identify
printf "$head"'echo rank,effect,verdict >"$2"\n' >fake/hs-diagnose && chmod +x fake/hs-diagnose
"$bin/hs-batch" orderly.csv --prepare --stages diagnosis --out orderly --bin fake -q
make -s -k -j2 -C orderly -f batch.mk >log 2>err
[[ $(grep -c '^step [a-e]$' log) == 10 && $(grep -c '^finished' log) == 5 &&
  $(grep -n -m1 '^finished' log | cut -d: -f1) -lt $(grep -n -m1 '^step d' log | cut -d: -f1) ]] ||
  complain "the order of steps: $(tr '\n' ' ' <log)"

# Files that options name are the recording's too; --help among the options is a failure, not a wait; quotes
# in the names that make is given.
mkdir "it's"
cp 15000.csv "it's/more.csv"
printf 'name,body,data,options,common_options\na,../box.ply,../8000.csv,--folds 0 --data more.csv,--rim-edge 0.3\nb,../box.ply,../8000.csv,--help,\n' >"it's/two.csv"
batch "it's out" "it's/two.csv"
grep -q 'failed: b: model made no output' err && grep -q '1 of 2 recordings done, 1 failed' err || complain "a step without output fails"
! grep -qi 'warning' err || complain 'make warns of the names'
before=$(field "it's out/summary.csv" a E)
cp 8000.csv "it's/more.csv"
batch "it's out" "it's/two.csv"
awk -v a="$before" -v b="$(field "it's out/summary.csv" a E)" 'BEGIN { exit !(a > 10000 && b < 9000) }' ||
  complain "what the options read is made from again: $before"

# Manifests that cannot be read at all.
refused() { # TEXT
  local text=$1
  "$bin/hs-batch" bad.csv --out none --prepare 2>err
  [[ $? == 3 && $(wc -l <err) == 1 ]] && grep -qF -- "$text" err || complain "refused: $text"
  [[ ! -e none ]] || complain 'nothing is made of a bad manifest'
}
printf 'name,body\na,box.ply\n' >bad.csv && refused "column 'data' is missing"
printf 'name,data\na,8000.csv\n' >bad.csv && refused "neither a column 'body' nor a column 'scan'"
printf 'name,body,data\n' >bad.csv && refused 'has no rows'
printf 'name,body,data,efects\na,box.ply,8000.csv,elastic\n' >bad.csv && refused "did you mean 'effects'"
printf 'name,body,data\na,box.ply\n' >bad.csv && refused 'bad.csv:2: 2 fields where the header names 3'

((failures == 0)) && echo 'batch: passed'
exit $((failures > 0))
