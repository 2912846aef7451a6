#!/usr/bin/env bash
# fmu.sh BIN: a body and a model as an FMU of FMI 2.0: what is in it, the states an importer takes it through, calls that
# are wrong, and forces that are those of hs-simulate --live to the last digit.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
need python3 xmllint
export PATH=$bin:$PATH
library=$(dirname "$bin")/lib
export CFLAGS="-Wall -Wextra -Werror -I$root/lib/c" LDFLAGS="-L$library -Wl,-rpath,$library" ACCURACY=0.3
make=$root/share/examples/fmu/make-fmu.sh

hs-tetmesh box.off --edge 0.012 -q -o body.ply || complain 'no body'
printf 'effect,region,parameter,value\nelastic,0,E,12000\nelastic,0,nu,0.4\nviscoelastic,0,E1,6000\nviscoelastic,0,tau1,0.1\n' >model.csv
printf '# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz\n1,0,0.03,0.025,0.04,0,0,0\n1,1,0.03,0.025,0.04,0,0,-0.001\n' >contacts.csv
mkdir 'a folder'
"$make" 'a folder/soft block.fmu' body.ply model.csv 0.004 contacts.csv >log 2>err || complain 'no FMU'
mkdir unpacked && (cd unpacked && python3 -m zipfile -e '../a folder/soft block.fmu' .)
find unpacked -type f | LC_ALL=C sort >files
printf 'unpacked/%s\n' binaries/linux64/soft_block.so modelDescription.xml resources/body.ply resources/contacts.csv resources/model.csv |
  cmp -s - files || complain "it holds $(cat files)"
xmllint --noout unpacked/modelDescription.xml 2>err || complain 'modelDescription.xml is no XML'
python3 - >log <<'END' || complain "modelDescription.xml: $(cat log)"
import xml.etree.ElementTree as tree
top = tree.parse("unpacked/modelDescription.xml").getroot()
assert top.get("fmiVersion") == "2.0" and top.find("CoSimulation").get("modelIdentifier") == "soft_block"
variables = top.find("ModelVariables").findall("ScalarVariable")
seen = [(v[0].tag, v.get("valueReference")) for v in variables]
assert len(set(seen)) == len(seen), "two of one type and reference"
outputs = [i for i, v in enumerate(variables, 1) if v.get("causality") == "output"]
for part in ("Outputs", "InitialUnknowns"):
    assert [int(u.get("index")) for u in top.find("ModelStructure").find(part)] == outputs, part
for v in variables:
    assert (v[0].get("start") is not None) == (v.get("causality") in ("input", "parameter")), v.get("name")
END
guid=$(xmllint --xpath 'string(/fmiModelDescription/@guid)' unpacked/modelDescription.xml)
"$make" again.fmu body.ply model.csv 0.004 >log 2>err || complain 'no FMU without contacts'
mkdir second && (cd second && python3 -m zipfile -e ../again.fmu .)
[[ $(xmllint --xpath 'string(/fmiModelDescription/@guid)' second/modelDescription.xml) != "$guid" ]] || complain 'one guid for two contents'

# A motion of steps of any length: touches, presses, slides, leaves, and comes back elsewhere.
awk 'BEGIN { srand(4); t = 0.25
  for (i = 0; i < 300; ++i) { t += 0.0005 + 0.01 * rand() * rand(); s = i % 150
    d = s < 20 ? -0.001 : s < 60 ? 0.00004 * (s - 20) : s < 110 ? 0.0016 : s < 130 ? 0.0016 - 0.00015 * (s - 110) : -0.002
    printf "%.9f %.6f %.6f %.9f\n", t, (i < 150 ? 0.03 : 0.024) + 0.000003 * s, 0.025, 0.04 - d } }' >motion
"${CC:-cc}" -std=gnu99 -Wall -Wextra -Werror -I "$root/share/examples/fmu" "$root/tests/support/fmu_master.c" -ldl -o master 2>err ||
  complain 'the master is not compiled'
mv unpacked 'unpacked here'
cp -r 'unpacked here/resources' other
./master "$work/unpacked here/binaries/linux64/soft_block.so" "$guid" "file://$work/unpacked%20here/resources" motion "$work/other" >fmu.csv 2>err ||
  complain 'the importer finds faults'
{ echo t,x,y,z; tr ' ' , <motion; } | hs-simulate --live --uncertainty --accuracy 0.3 --tool-radius 0.004 --contacts contacts.csv \
  --body body.ply --model model.csv -q >live.csv 2>err || complain 'no live forces'
python3 - >log <<'END' || complain "not the forces of --live: $(cat log)"
import csv
fmu = [row for row in csv.reader(open("fmu.csv"))]
live = list(csv.DictReader(line for line in open("live.csv") if not line.startswith("#")))
assert len(fmu) == len(live) == 300, (len(fmu), len(live))
most = 0
for ours, theirs in zip(fmu, live):
    names = ("t", "fx", "fy", "fz", "uncertainty", "beyond", "press", "contact")
    for name, value in zip(names, ours):
        assert float(value) == float(theirs[name]), (theirs["t"], name, value, theirs[name])
    most = max(most, float(theirs["fz"]))
assert most > 0.05 and int(live[-1]["press"]) == 2, (most, live[-1])
print("largest force", most)
END
cat log

# What is refused when it is made.
refused() { # CODE WORDS ARGUMENTS...
  "$make" "${@:3}" >log 2>err
  [[ $? == "$1" && $(wc -l <err) == 1 ]] && grep -qF -- "$2" err || complain "make-fmu.sh ${*:3}: not exit $1, '$2'"
}
refused 2 'usage: make-fmu.sh OUT.fmu' a.fmu body.ply
refused 2 'a.zip does not end in .fmu' a.zip body.ply model.csv 0.004
refused 2 "TOOL_RADIUS: '4mm' is no number from 1e-6 to 1" a.fmu body.ply model.csv 4mm
refused 5 'none.csv: cannot be read' a.fmu body.ply none.csv 0.004
refused 2 "TOOL_RADIUS: '0.0.4' is no number" a.fmu body.ply model.csv 0.0.4
refused 5 'a folder: cannot be read' a.fmu body.ply model.csv 0.004 'a folder'
refused 5 'nodir/t.fmu: there is no such folder; make it first' nodir/t.fmu body.ply model.csv 0.004
ACCURACY=0.1.2 refused 2 "ACCURACY: '0.1.2' is no number from 0.002 to 1" a.fmu body.ply model.csv 0.004
[[ ! -e a.fmu ]] || complain 'something is left of what was refused'
((failures == 0)) && echo 'fmu: passed'
exit $((failures > 0))
