#!/usr/bin/env bash
# tutorial.sh BIN MODULE PYTHON [SECTION...]: the tutorial as a script writes the bytes that the commands of the tutorial
# write; by default of section d, which is the quickest.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
module=$(realpath "$2") python=$3 sections=("${@:4}")
((${#sections[@]})) || sections=(d)
. "$root/tests/cli/scratch.sh" "$1"
export PATH=$bin:$PATH PYTHONPATH=$module
cp -r "$root/share/examples" examples
cd examples/hidden-effects || exit 1
blocks() { awk -v wanted="$1" 'BEGIN { name = 0 } /^## / { name = substr($2, 1, 1) } /^```sh$/ { on = 1; next } /^```/ { on = 0 } on && name == wanted' README.md; }
bash -euo pipefail -c "$(blocks 0)" 2>err || complain 'no body'
cp -r . ../script
for section in "${sections[@]}"; do
  before=$SECONDS
  bash -euo pipefail -c "$(blocks "$section")" 2>err || complain "section $section: a command failed"
  between=$SECONDS
  (cd ../script && "$python" ../python/tutorial.py "$section") 2>err || complain "section $section: the script failed"
  files=0
  for file in ../script/"$section"*.csv; do
    name=${file##*/}
    [[ $name == "$section.csv" ]] && continue
    cmp -s "$file" "$name" || complain "$name is not the tools': $(diff "$file" "$name" | head -n 4)"
    files=$((files + 1))
  done
  ((files > 0)) || complain "section $section: the script wrote $files files"
  printf '%s: %d files, the same bytes; commands %d s, script %d s\n' "$section" $files $((between - before)) $((SECONDS - between))
done
((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
