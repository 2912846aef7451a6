#!/usr/bin/env bash
# ci.sh BIN: the steps of share/examples/ci as a CI server would run them: they pass on an unchanged
# project; a model made worse on purpose fails, with a line that says where. And hs-check by itself.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh"
PATH=$bin:$PATH

hs-tetmesh -q box.off --max-volume 2e-8 -o body.ply || exit 1
awk 'BEGIN {
  print "# tool_radius: 0.004\n# force_noise: 0.002\npress,t,x,y,z,ux,uy,uz"
  for (p = 0; p < 6; ++p)
    for (i = 0; i <= 20; ++i)
      printf "%d,%.2f,%.3f,0.025,0.04,%.6f,0,%.6f\n", p, 0.05 * i, 0.02 + 0.01 * (p % 3), i * 4e-5 * (p > 2), -i * 8e-5
}' >motion.csv
printf 'effect,region,parameter,value\nelastic,0,E,8000\nelastic,0,nu,0.4\n' >truth.csv
hs-simulate -q motion.csv --body body.ply --model truth.csv --add-noise 0.002 -o data.csv &&
  hs-identify -q data.csv --body body.ply --folds 3 -o golden.csv || exit 1

# The commands between `run:` or `- ` that call hapsim, one a line.
github() { sed -n 's/^ *run: \(hs-.*\)/\1/p' "$root/share/examples/ci/github.yml"; }
gitlab() { sed -n 's/^ *- \(hs-.*\)/\1/p' "$root/share/examples/ci/gitlab.yml"; }
[[ $(github) == "$(gitlab)" && $(github | wc -l) == 4 ]] || complain 'both workflows have the same four steps'
server() { # runs the steps until one fails; its number in `failed`, 0: none
  failed=0
  local step=0 command
  while IFS= read -r command; do
    step=$((step + 1))
    bash -e -o pipefail -c "$command" >out 2>err </dev/null || { failed=$step code=$?; return; }
  done < <(github)
}
server
((failed == 0)) || complain "an unchanged project passes (step $failed)"
for file in junit-model.xml junit-forces.xml junit-effects.xml; do
  grep -q 'failures="0"' $file && tail -n 1 $file | grep -q '</testsuites>' || complain "$file has no failure"
done
cp golden.csv accepted.csv

# The recording is of a stiffer object: the model differs.
awk -F, -v OFS=, '/^[0-9]/ { for (k = 9; k <= 11; ++k) $k *= 1.2 } 1' data.csv >stiffer && cp data.csv good.csv && cp stiffer data.csv
server
((failed == 2 && code == 1)) || complain "another object fails at the golden model (step $failed)"
grep -q '^hs-check: elastic.E = 8.* Pa differs from 7.* Pa by .* %; allowed' err ||
  grep -q '^hs-check: elastic.E = .* differs from .* by .* %; allowed' err || complain 'the line says which parameter'
grep -q '<testcase classname="hs-check" name="elastic.E"><failure message="elastic.E = ' junit-model.xml ||
  complain 'so does the XML'
cp good.csv data.csv

# A model made worse on purpose: the golden one is changed, so that the check of the forces must tell.
awk -F, -v OFS=, '$1 == "elastic" && $3 == "E" { $4 *= 1.08; $6 = 1000 } 1' accepted.csv >golden.csv
server
((failed == 3 && code == 1)) || complain "a model made worse fails at the forces (step $failed)"
grep -q '^hs-compare: typical error .* exceeds .* (1.5noise)' err && grep -q 'worst position' err ||
  complain 'the line says by how much, and where'
grep -q 'worst position' junit-forces.xml || complain 'so does the XML of the forces'

# hs-check by itself.
check() { # CODE TEXT ARGUMENTS...
  local wanted=$1 text=$2
  shift 2
  hs-check accepted.csv "$@" >out 2>err
  local got=$?
  ((got == wanted)) && grep -qF -- "$text" err || complain "$got: hs-check $*"
}
check 0 'are those of accepted.csv' --golden accepted.csv
sed '/elastic,0,nu/s/free/fixed/' accepted.csv >fixed.csv
check 1 'elastic.nu is estimated, in the golden model fixed' --golden fixed.csv
{ cat accepted.csv; echo 'sensor-bias,0,bx,0,N,,-10,10,free
sensor-bias,0,by,0,N,,-10,10,free
sensor-bias,0,bz,0,N,,-10,10,free'; } >more.csv
check 1 'sensor-bias.bz = 0 N is only in the golden model' --golden more.csv
sed 's/^# rmse: .*/# rmse: 0.001/' accepted.csv >better.csv
check 1 'rmse = ' --golden better.csv
check 0 'are those of better.csv' --golden better.csv --worse 200%
check 2 "--tolerance 'much' is no tolerance" --golden accepted.csv --tolerance much
check 2 "no parameter is named 'tau7'" --golden accepted.csv --tolerance tau7=1%
check 3 'a model has no column' --golden data.csv
((failures == 0)) && echo 'ci: passed'
exit $((failures > 0))
