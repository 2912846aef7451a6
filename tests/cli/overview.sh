#!/usr/bin/env bash
# overview.sh BIN: the overview of a batch in a browser, as wide as a desk's screen and a phone's: what is missing is
# counted, a click or a key on a head sorts, a word filters, links lead to the reports, failures have their command,
# everything has a name and can be read, and the console stays silent.
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
. "$here/scratch.sh" "$1"
. "$here/browser.sh" || exit 1

# Six recordings by tools that say what is wanted: error, E and verdict go with the data's name, the sixth fails.
"$bin/hs-tetmesh" box.off -q -o box.ply || exit 1
mkdir fake
cat >fake/hs-identify <<'SH'
#!/bin/sh
data=$1
while [ "$1" != -o ]; do shift; done
case $data in *6.csv) echo "hs-identify: 6.csv: a cell is not a finite number; mend it" >&2; exit 3 ;; esac
n=$(basename "$data" .csv)
printf '# rmse: 0.0%s\n# heldout: 0.1%s\n# force_noise: 0.01\neffect,region,parameter,value,unit,std_error,lower,upper,state\nelastic,0,E,%s000,Pa,1,1,1e9,free\nelastic,0,nu,0.4,1,0.1,0,0.499,free\n' "$n" "$n" "$n" >"$2"
SH
cat >fake/hs-diagnose <<'SH'
#!/bin/sh
data=$1
while [ "$1" != -o ]; do shift; done
echo 'rank,effect,verdict,rmse_now,rmse_after' >"$2"
case $data in
  *1.csv) echo '0,model,complete,0.01,0.01' >>"$2" ;;
  *2.csv) printf '0,model,incomplete,0.02,0.01\n1,viscoelastic,missing,0.02,0.01\n2,friction,missing,0.02,0.01\n' >>"$2" ;;
  *) printf '0,model,incomplete,0.02,0.01\n1,viscoelastic,missing,0.02,0.01\n' >>"$2" ;;
esac
SH
chmod +x fake/*
{ echo name,body,data; for n in 1 2 3 4 5 6; do box_presses 3 1e-4 >$n.csv; echo "liver <$n>,box.ply,$n.csv"; done; } >all.csv
"$bin/hs-batch" all.csv --prepare --stages diagnosis --out batch --bin fake -q || complain 'not prepared'
make --no-print-directory -s -k -C batch -f batch.mk >log 2>err
"$bin/hs-batch" all.csv --stages diagnosis --out batch --html overview.html --json counts.json -o summary.csv 2>err
[[ $? == 1 ]] || complain 'a failure is no success'
grep -q '^✗ 5 of 6 recordings done, 1 failed$' err || complain 'the verdict is not first'
flat err | grep -q 'viscoelastic missing in 4 of 5, friction in 1' || complain 'what is missing is not counted'
/usr/bin/python3 -c 'import json; v = json.load(open("counts.json"))["values"]
assert v["missing.viscoelastic"]["value"] == 4 and v["verdict.complete"]["value"] == 1 and v["failed"]["value"] == 1' 2>>err ||
  complain 'programs do not get the counts'

cat >probe.js <<'END_OF_PROBE'
function steps(say) {
  const table = document.querySelector("table.sortable"), body = table.tBodies[0];
  const names = () => [...body.rows].filter(r => !r.hidden).map(r => r.cells[0].textContent.match(/\d/)[0]).join("");
  const head = name => [...table.tHead.rows[0].cells].find(h => h.textContent === name);
  say("first", names());
  head("E [Pa]").querySelector("button").click();
  say("by E", names() + " " + head("E [Pa]").getAttribute("aria-sort"));
  head("E [Pa]").querySelector("button").click();
  say("turned", names() + " " + head("E [Pa]").getAttribute("aria-sort"));
  head("recording").querySelector("button").click();
  say("by name", names());
  const filter = document.getElementById("filter"), type = text => { filter.value = text; filter.dispatchEvent(new Event("input")); };
  type("friction");
  say("filtered", names() + " " + document.getElementById("count").textContent);
  type("complete");
  say("complete", document.getElementById("count").textContent);
  type("");
  say("all", document.getElementById("count").textContent);
  say("heads", [...table.tHead.rows[0].cells].filter(h => h.querySelector("button").tabIndex === 0).length);
  say("told", document.body.textContent.includes("viscoelastic missing in 4 of 5, friction in 1"));
  say("failure", [...document.querySelectorAll("pre")].some(p => p.textContent.includes("hs-identify")));
  const box = document.querySelector(".verdict").getBoundingClientRect();
  say("verdict", box.top >= 0 && box.bottom < innerHeight / 2);
}
END_OF_PROBE
probed overview.html probe.js
for size in '1280 800' '390 844'; do
  shown_at $size
  seen first 54321
  seen 'by E' '54321 descending'
  seen turned '12345 ascending'
  seen 'by name' '12345'
  seen filtered '2 1 of 5'
  seen complete '1 of 5'
  seen all '5 of 5'
  seen heads 9
  seen told true
  seen failure true
  seen verdict true
done
((failures == 0)) && echo 'overview: as expected'
exit $((failures > 0))
