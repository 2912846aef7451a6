#!/usr/bin/env bash
# compare.sh BIN: what hs-compare prints, writes and returns.
set -uo pipefail
. "$(dirname "${BASH_SOURCE[0]}")/tool.sh" "$1/hs-compare"
# recording GAIN: eight presses on four positions, stiffness 200 N/m, times GAIN
recording() {
  awk -v gain="$1" 'BEGIN {
    print "# force_noise: 0.005"
    print "press,t,x,y,z,ux,uy,uz,fx,fy,fz,note"
    for (p = 0; p < 8; ++p)
      for (i = 0; i <= 20; ++i) {
        d = 0.004 * (i < 10 ? i / 10 : 1)
        wobble = 0.005 * (((i * 7 + p * 3) % 5) - 2) / 1.4
        printf "%d,%.2f,%.2f,%.2f,0.05,0,0,%.6f,%.5f,0,%.5f,a\n", p, 10 * p + 0.02 * i,
               0.03 * (p % 2), 0.03 * int(p % 4 / 2), -d, wobble, gain * 200 * d + wobble
      }
  }'
}
recording 1 >data.csv
recording 1.2 | sed 's/,note$//; s/,a$//' >stiff.csv

expect 0 'too stiff by 20 %' data.csv --simulated stiff.csv
expect 0 ' x noise' data.csv --simulated stiff.csv -o residuals.csv
[[ $(sed -n 2p residuals.csv) == press,t,x,y,z,ux,uy,uz,fx,fy,fz,note,sx,sy,sz,rx,ry,rz ]] ||
  complain 'columns of the residuals'
"$tool" -q data.csv --simulated - <stiff.csv | cmp -s - residuals.csv ||
  complain 'standard input and output carry the same'

expect 0 '' data.csv --simulated stiff.csv --fail-above 1N -o residuals.csv
expect 1 'exceeds 0.01 N' data.csv --simulated stiff.csv --fail-above 0.01N -o residuals.csv
expect 1 'exceeds' data.csv --simulated stiff.csv --fail-above 5% -o residuals.csv
expect 0 '' data.csv --simulated stiff.csv --fail-above 50% -o residuals.csv
expect 1 'exceeds' data.csv --simulated stiff.csv --fail-above 1.5xnoise -o residuals.csv
expect 2 "--fail-above '5' is not a limit" data.csv --simulated stiff.csv --fail-above 5
expect 2 "--fail-above '-1N' is not a limit" data.csv --simulated stiff.csv --fail-above=-1N
expect 2 '--simulated' data.csv
expect 2 'add --body' data.csv --simulated stiff.csv --ply surface.ply

rm -f ./*.html ./*.json residuals.csv
expect 0 'plain: ' data.csv --simulated plain=data.csv --simulated stiff=stiff.csv --html r.html \
  --json r.json -o residuals.csv --title '<b>title</b>'
grep -q '&lt;b&gt;title' r.html || complain 'the title is escaped'
grep -q '"rmse"' r.json || complain 'JSON has the rmse'

head -20 stiff.csv >short.csv
sed 's/^3,/9,/' stiff.csv >renamed.csv
sed '9s/-0.002800/-0.002900/; 9s/-0.002400/-0.002900/' stiff.csv >moved.csv
sed '9s/,[^,]*$/,nan/' stiff.csv >nan.csv
cut -d, -f1-8 stiff.csv >motion.csv
rm -f residuals.csv r.html
expect 3 '18 rows of forces for 168 measured rows' data.csv --simulated short.csv -o residuals.csv
expect 3 'renamed.csv:66: press 9 where data.csv:66 has press 3' data.csv --simulated renamed.csv \
  -o residuals.csv --html r.html
expect 3 'moved.csv:9: displacement' data.csv --simulated moved.csv -o residuals.csv
expect 3 'nan.csv' data.csv --simulated nan.csv -o residuals.csv
expect 3 'fx' data.csv --simulated motion.csv -o residuals.csv
expect 5 'missing.csv' data.csv --simulated missing.csv -o residuals.csv
expect 5 'No space left' data.csv --simulated stiff.csv -o /dev/full
expect 5 'No space left' data.csv --simulated stiff.csv --html r.html -o /dev/full
[[ ! -e residuals.csv && ! -e r.html ]] || complain 'a failed run leaves nothing behind'
[[ -z $(find . -name '*.csv.*' -o -name '*.tmp*' -o -name '.*.html*') ]] || complain 'no stray files'

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
