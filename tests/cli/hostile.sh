#!/usr/bin/env bash
# hostile.sh BIN: names, manifests and libraries that would run a command, overwrite a file or hang.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
need sqlite3

# Makefile.pipeline: names are text. What make could not take is refused, nothing of it is run.
pipeline() { make --no-print-directory -s -f "$root/Makefile.pipeline" BIN="$bin" "$@" >log 2>err; }
printf 'no recording\n' >'q`>PWNED`.csv'
cp 'q`>PWNED`.csv' "it's_\$(>PWNED2).csv"
cp 'q`>PWNED`.csv' "it's\$\${x}.csv"
pipeline report RAW='q`>PWNED`.csv' && complain 'no recording, and a report'
grep -q 'hs-import: q`>PWNED`.csv' err || complain 'the name is given as it is'
pipeline report RAW="it's\$\${x}.csv"
grep -qF "hs-import: it's\$\${x}.csv" err || complain 'a quote and dollars are a name'
for name in RAW DATA SCAN OUT; do
  for value in '$(shell touch PWNED)' '${shell touch PWNED}' 'a;touch PWNED' 'a: ; touch PWNED' $'a\n\ttouch PWNED' '-o' 'x=$(touch PWNED)'; do
    for goal in report auto clean; do
      pipeline "$goal" "$name=$value" && complain "taken: make $goal $name=$value"
    done
  done
done
for name in BIN TITLE SCAN_UNIT CLUSTER MANIFEST JUNIT; do
  for value in '$(shell touch PWNED)' "'; touch PWNED; '" '`touch PWNED`' $'a\ntouch PWNED'; do
    pipeline -n report "$name=$value"
    pipeline batch "$name=$value" OUT=none
  done
done
pipeline batch MANIFEST='--junit=PWNED' OUT=none
pipeline batch MANIFEST=none.csv OUT='$(shell touch PWNED); touch PWNED'
[[ -z $(find . -name 'PWNED*') ]] || complain "run: $(find . -name 'PWNED*')"

# Manifests: options that write, names that a spreadsheet would run, data that never come.
"$bin/hs-tetmesh" -q box.off --max-volume 2e-8 -o box.ply || exit 1
box_presses 6 1e-4 >motion.csv
printf 'effect,region,parameter,value\nelastic,0,E,8000\nelastic,0,nu,0.4\n' >truth.csv
"$bin/hs-simulate" -q motion.csv --body box.ply --model truth.csv --rim-edge 0.3 -o data.csv || exit 1
batch() { # FLAGS...
  make --no-print-directory -s -f "$root/Makefile.pipeline" batch BIN="$bin" MANIFEST=all.csv OUT=out \
    BATCH_FLAGS="--stages model $*" >log 2>err
}
echo whole >victim.txt
mkfifo pipe
cat >all.csv <<'CSV'
name,body,data,options,common_options,note
good,box.ply,data.csv,--folds 0 --history h.csv,--rim-edge 0.3,
"=cmd|' /C calc'!A0",box.ply,data.csv,--folds 0,--rim-edge 0.3,@SUM(1+1)
history,box.ply,data.csv,--folds 0 --history ../../../victim.txt,--rim-edge 0.3,
absolute,box.ply,data.csv,--folds 0 --history=/tmp/hapsim-victim,--rim-edge 0.3,
library,box.ply,data.csv,--folds 0 --library victim.txt,--rim-edge 0.3,
new library,box.ply,data.csv,--folds 0 --library new.db,--rim-edge 0.3,
output,box.ply,data.csv,--folds 0 -o out/recordings/good/model.sh,--rim-edge 0.3,
pipe,box.ply,pipe,--folds 0,--rim-edge 0.3,
device,box.ply,/dev/zero,--folds 0,--rim-edge 0.3,
CSV
batch && complain 'hostile rows, and all is well'
[[ $(cat victim.txt) == whole && ! -e /tmp/hapsim-victim && ! -e new.db ]] || complain 'a file was overwritten or made'
grep -q '✗ 2 of 9 recordings done, 7 failed$' err || complain 'the two that are good are done'
[[ -s out/recordings/good/files/h.csv ]] || complain 'what options write stands in the own folder'
for line in "failed: history: all.csv:4: the options write outside the recording's own folder: --history ../../../victim.txt" \
  "failed: absolute: all.csv:5: the options write outside" \
  'failed: library: hs-identify: victim.txt: this is no model library' \
  'failed: new library: hs-identify: new.db: this file may not be written from here' \
  'failed: output: hs-identify: --output is given twice' \
  "failed: pipe: all.csv:9: data 'pipe' is no file but a pipe" "failed: device: all.csv:10: data '/dev/zero'"; do
  grep -qF -- "$line" err || complain "one line says: $line"
done
grep -q "^'=cmd|" out/summary.csv && grep -q ",'@SUM(1+1)" out/summary.csv || complain 'a formula stands in the summary'
! grep -Eq '(^|,)"?[=@]' out/summary.csv || complain 'a formula stands in the summary'
# A step whose input becomes a pipe afterwards is ended, with its tool.
printf 'name,body,data,options\none,box.ply,late.csv,--folds 0\n' >all.csv
cp data.csv late.csv
"$bin/hs-batch" all.csv --prepare --stages model --out late --step-time 1 --bin "$bin" -q
rm late.csv && mkfifo late.csv
make --no-print-directory -s -k -C late -f batch.mk >log 2>err
grep -q 'had not ended after 1 s' late/recordings/one/failure || complain 'a step without end is ended'
[[ -z $(pgrep -f "$work/late") ]] || complain 'something is left running'
# A step that the user allows to write elsewhere.
printf 'name,body,data,options,common_options\none,box.ply,data.csv,--folds 0 --history %s/kept.csv --library lab.db,--rim-edge 0.3\n' "$work" >all.csv
batch --writes . && [[ -s kept.csv && -s lab.db ]] || complain '--writes allows it'

# A library that somebody has put a trigger into is refused; so is a view, which hangs who reads it.
for planted in 'CREATE TRIGGER t AFTER INSERT ON entry BEGIN DELETE FROM entry; END' \
  'CREATE VIEW v AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i FROM n) SELECT i FROM n'; do
  cp lab.db planted.db && sqlite3 planted.db "$planted" || complain 'sqlite3 cannot plant'
  timeout 60 "$bin/hs-identify" data.csv --body box.ply --rim-edge 0.3 --folds 0 -q --library planted.db -o m.csv 2>err
  [[ $? == 3 ]] && grep -q 'planted.db: it holds a .* that no model library has' err || complain "taken: $planted"
done

# Files that lead to another file, or have no end.
echo secretsecretsecret >secret
for field in 'data file' 'Data File' datafile ' data file'; do
  printf 'NRRD0004\ntype: short\ndimension: 3\nencoding: raw\nendian: little\nsizes: 2 2 2\n%s: %s/secret\n\n' "$field" "$work" >v.nrrd
  "$bin/hs-scan2ply" v.nrrd --threshold 1 -o p.ply 2>err
  [[ $? == 3 && ! -e p.ply ]] && grep -q 'header and voxels are in two files' err || complain "read: $field"
done
awk 'BEGIN {
  print "<robot name=\"r\"><link name=\"l0\"/>"
  for (i = 0; i < 200000; ++i)
    printf "<link name=\"l%d\"/><joint name=\"j%d\" type=\"continuous\"><parent link=\"l%d\"/><child link=\"l%d\"/><axis xyz=\"0 0 1\"/></joint>\n", i + 1, i, i, i + 1
  print "</robot>" }' >long.urdf
printf 'q1,d\n0,1\n' >joints.csv
"$bin/hs-scan2ply" joints.csv --robot long.urdf -o p.ply 2>err
[[ $? == 3 ]] && grep -q 'more than 10000 links' err || complain 'a robot without end'

# Little memory is said (127: the loader's own word), or enough: never waited for.
for limit in 60000 100000 150000 250000 400000; do
  (ulimit -v $limit; exec timeout 60 "$bin/hs-identify" data.csv --body box.ply --rim-edge 0.3 --folds 0 -q -o m.csv) >log 2>err
  code=$?
  ((limit >= 200000 || code == 4 || code == 127)) || complain "exit code $code under ulimit -v $limit"
  [[ $code != 124 && $code != 137 ]] || complain "without end under ulimit -v $limit"
done

((failures == 0)) && echo 'hostile: passed'
exit $((failures > 0))
