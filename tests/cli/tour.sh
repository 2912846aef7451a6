#!/usr/bin/env bash
# tour.sh BIN: the tour's pictures are made, and its README states what is said and shows the pictures that there are.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
need chromium
export PATH=$bin:$PATH
tour=$root/share/doc/tour
"$tour/make-tour.sh" made >log 2>&1 || { complain 'the tour is not made'; cat log; exit 1; }
for picture in $(grep -o '([a-z]*\.png)' "$tour/README.md" | tr -d '()'); do
  [[ -s $tour/$picture ]] || complain "there is no $picture"
  # A picture of one colour is some kilobytes.
  (($(stat -c %s "made/$picture") > 40000)) || complain "made: $picture is empty"
  [[ $(head -c 24 "made/$picture" | tail -c 8 | od -An -tx1) == "$(head -c 24 "$tour/$picture" | tail -c 8 | od -An -tx1)" ]] ||
    complain "$picture has another size than it is made in"
done
awk -v least=8 -f "$root/tests/cli/numbers.awk" mode=told made/said.txt mode=text "$tour/README.md" >wrong
[[ ! -s wrong ]] || { complain 'the README states other numbers'; cat wrong; }
flat made/said.txt >told
while IFS= read -r line; do
  grep -qF -- "$(tr -s ' ' <<<"$line" | sed 's/^ //; s/ $//')" told || complain "nobody says: $line"
done < <(grep '^    ' "$tour/README.md" | grep -v '\.\.\.')
# The report that the last picture is cut from has both models and the next step.
grep -q 'viscoelastic' made/after.html && grep -q "id='next'" made/after.html || complain 'the report is not whole'
((failures == 0)) && echo 'tour: as it is written'
exit $((failures > 0))
