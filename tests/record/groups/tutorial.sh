# The tutorial's commands as its README prints them, each a step that is named by what it makes; and of each of the
# five recordings the report, the diagnosis as JSON, and what --effects auto makes of it.
use phantom "$examples/phantom"
mkdir -p work
cd work
for name in a b c d e; do use $name.csv "$examples/hidden-effects/$name.csv"; done
while IFS= read -r command; do
  name=${command##*-o }
  begun=$(sed -n 's/.*--effects .*--history \([^ ]*\).*/rm -f \1; /p' <<<"$command")  # not by an interrupted run
  step "${name%.*}" "$begun$command"
done < <(awk '/^```sh$/ { on = 1; next } /^```/ { on = 0 } on' "$examples/hidden-effects/README.md")
for name in a b c d e; do
  data="$name.csv --body body.ply"
  step $name-auto "rm -f steps-$name.csv
    hs-identify $data --effects auto --history steps-$name.csv -o $name-auto.csv"
  step $name-json "hs-diagnose $data --model ${name}0.csv --json $name.json --plan $name-plan.csv -o $name-again.csv"
  step $name-html "hs-simulate $data --model ${name}0.csv -o $name-first.csv
    hs-simulate $data --model $name-auto.csv -o $name-best.csv
    hs-compare $name.csv --simulated first=$name-first.csv --simulated auto=$name-best.csv --body body.ply --model $name-auto.csv --history steps-$name.csv --diagnosis first=$name-again.csv --json $name-compare.json --html $name-auto.html -o $name-residuals.csv"
done
cd ..
