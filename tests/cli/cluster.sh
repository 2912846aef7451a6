#!/usr/bin/env bash
# cluster.sh BIN: what hs-cluster prints, writes and returns.
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/tool.sh" "$1/hs-cluster"
# samples FACTOR: 20 positions on 120 x 210 mm, FACTOR times stiffer beyond a slanting line; known scatter
samples() {
  awk -v factor="$1" 'BEGIN {
    srand(3)
    print "# tool_radius: 0.005"
    print "x,y,z,E,nu,E_std,nu_std,n,site"
    for (j = 0; j < 5; ++j)
      for (i = 0; i < 4; ++i) {
        x = 0.015 + 0.03 * i; y = 0.021 + 0.042 * j
        e = 10000 * (y > 0.1 + 0.7 * (x - 0.06) ? factor : 1)
        g = -6; for (k = 0; k < 12; ++k) g += rand()
        h = -6; for (k = 0; k < 12; ++k) h += rand()
        printf "%.4f,%.4f,0.06,%.1f,%.4f,%.1f,0.02,300,s%d\n", x, y, e * (1 + 0.02 * g), 0.4 + 0.02 * h,
               0.02 * e, 4 * j + i
      }
  }'
}
samples 2.5 >two.csv
samples 1 >one.csv

expect 0 '2 regions' two.csv --boundary boundary.csv --dendrogram tree.csv --svg tree.svg \
  --write-model model.csv -o classified.csv
[[ $(sed -n '/^[^#]/{p;q}' classified.csv) == x,y,z,E,nu,E_std,nu_std,n,region,site ]] ||
  complain 'columns of the samples'
awk -F, '!/^[#x]/ { if ($9 != ($2 > 0.1 + 0.7 * ($1 - 0.06))) wrong = 1 } END { exit wrong }' \
  classified.csv || complain 'each position has its region'
awk -F, 'NR > 1 { d = $6 - 0.1 - 0.7 * ($5 - 0.06); s += d < 0 ? -d : d; ++n }
  END { exit !(n == 8 && s / n < 0.012) }' boundary.csv || complain 'eight key points near the boundary'
grep -q '^# regions: 2' classified.csv || complain 'the number of regions is recorded'
grep -q '^# cophenetic: 0.9' classified.csv || complain 'the cophenetic correlation is recorded'
grep -q '^# tool_radius: 0.005' classified.csv || complain 'metadata is carried through'
[[ $(wc -l <tree.csv) == 20 && $(head -1 tree.csv) == node,left,right,height,size,inconsistency ]] ||
  complain 'the tree has 19 merges'
grep -q '<svg xmlns' tree.svg && grep -q 'region 1' tree.svg || complain 'the tree is drawn'
[[ $(grep -c '^elastic,.,E,' model.csv) == 2 && $(grep -c '^regions,' model.csv) -ge 24 ]] ||
  complain 'the model has two moduli and key points'

expect 0 'one region' one.csv -o out.csv
expect 0 'one region' one.csv --components 1 -o out.csv
expect 0 '3 regions, as asked' two.csv --regions 3 -o out.csv
expect 0 '2 regions' two.csv --components 2 --linkage complete -o out.csv
expect 0 '2 regions' two.csv --features E --rule nearest --boundary nearest.csv -o out.csv
"$tool" -q two.csv --seed 4 -o a.csv && "$tool" -q - --seed 4 <two.csv | cmp -s - a.csv ||
  complain 'the same seed gives the same bytes; standard input and output'

head -5 two.csv >few.csv
sed '6s/,0.4/,nan/' two.csv >nan.csv
sed '7s/,0.06,/,0.06,-/' two.csv >negative.csv
cut -d, -f1-5,7- two.csv >missing.csv
awk -F, -v OFS=, '/^[0-9]/ { $1 = 0.01; $2 = 0.02 } 1' two.csv >place.csv
sed '8s/,0.02,300/,0,300/' two.csv >held.csv
sed 's/^0\.\([0-9]*\),0\.\([0-9]*\)/\1,\2/' two.csv >units.csv
rm -f out.csv boundary.csv
expect 3 'few.csv: 3 location samples are too few' few.csv --boundary boundary.csv -o out.csv
expect 3 'nan.csv: a cell is not a finite number: nu is' nan.csv -o out.csv
expect 3 'negative.csv:7: E = -' negative.csv -o out.csv
expect 3 "missing.csv: column 'E_std' is missing" missing.csv -o out.csv
expect 3 'place.csv: all location samples lie at one place' place.csv -o out.csv
expect 3 'held.csv: nu_std is 0 in 1 of 20 rows' held.csv -o out.csv
expect 3 'the position is more than 10 m away' units.csv -o out.csv
expect 3 '--regions 30 is more than the 20 samples' two.csv --regions 30 -o out.csv
expect 2 '--labels needs a body' two.csv --labels l.ply -o out.csv
expect 5 'none.csv' none.csv -o out.csv
[[ ! -e out.csv && ! -e boundary.csv ]] || complain 'a failed run leaves nothing behind'
[[ -z $(find . -name '*.csv.*' -o -name '*.tmp*') ]] || complain 'no stray files'

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
