#!/usr/bin/env bash
# page.sh BIN MODULE PYTHON: the blocks of share/doc/python/README.md run as one program, and draw their pictures.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
module=$(realpath "$2") python=$3
. "$root/tests/cli/scratch.sh" "$1"
cp "$root"/share/examples/phantom/*.csv .
page=$root/share/doc/python/README.md
eval "$(PATH=$bin:$PATH; awk '/^```sh$/ { on = 1; next } /^```/ { on = 0 } on && /^hs-/' "$page" | sed "s|hs-|$bin/hs-|g")" 2>err || complain 'no body'
awk '/^```python$/ { on = 1; next } /^```/ { if (on) print ""; on = 0 } on' "$page" >page.py
(($(wc -l <page.py) > 50)) || complain 'the blocks were not found'
MPLBACKEND=Agg PYTHONPATH=$module "$python" page.py >out 2>err || complain 'the page does not run'
for picture in press.png held.png; do [[ $(head -c 8 $picture | tail -c 7 | head -c 3) == PNG ]] || complain "$picture is no picture"; done
grep -qx '2 nu = 45 is out of bounds; give a value from 0 to 0.499' out || complain "an error has other words: $(tail -n 1 out)"
# What the module finds is what the tools find.
"$bin/hs-identify" data.csv --body body.ply --effects elastic --folds 0 -q -o tool.csv 2>err && cmp -s tool.csv m0.csv || complain "m0.csv is not the tool's"
((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
