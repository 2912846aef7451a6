#!/usr/bin/env bash
# simulate_live.sh BIN: hs-simulate --live answers line by line, like the batch mode, and ends well.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"

"$bin/hs-tetmesh" box.off --edge 0.012 -q -o body.ply || complain 'no body'
cat >model.csv <<'END'
effect,region,parameter,value,unit,std_error,lower,upper,state
elastic,0,E,20000,Pa,,1,1e12,fixed
elastic,0,nu,0.4,1,,0,0.499,fixed
viscoelastic,0,E1,8000,Pa,,0,1e12,fixed
viscoelastic,0,tau1,0.2,s,,0.0001,100000,fixed
END
awk 'BEGIN {
  print "# tool_radius: 0.004"; print "press,t,x,y,z,ux,uy,uz"
  for (p = 1; p <= 3; ++p)
    for (i = 0; i <= 30; ++i)
      printf "%d,%g,%g,%g,0.04,%g,0,%g\n", p, 0.02 * i, 0.015 + 0.01 * p, 0.025, 2e-5 * i * (p == 3), -1e-4 * i
}' >motion.csv
common=(--body body.ply --model model.csv --rim-edge 0.3)

# The same numbers as the batch mode, to 1e-6 of the largest force.
"$bin/hs-simulate" motion.csv "${common[@]}" -q -o batch.csv 2>err || complain 'the batch mode failed'
"$bin/hs-simulate" --live --accuracy 0.3 --contacts motion.csv "${common[@]}" <motion.csv >live.csv 2>err ||
  complain 'the live mode failed'
grep -q 'between them [0-9.]* % expected; 3 contacts solved finely' err && grep -q '^# off_contacts: 0' live.csv ||
  complain 'how far it is off between contacts is not told'
grep -q '93 samples: median' err || complain 'no latencies are told'
grep -q '# simulated: elastic+viscoelastic' live.csv || complain 'the output does not say what it is'
forces() {
  awk -F, '/^#/ { next } !n++ { for (i = 1; i <= NF; ++i) at[$i] = i; next }
    { print $at["fx"], $at["fy"], $at["fz"] }' "$1"
}
agree() { # FILE FILE [TOLERANCE]: relative to the largest force
  paste -d' ' <(forces "$1") <(forces "$2") | awk -v tolerance="${3:-1e-6}" '
    { for (k = 1; k <= 3; ++k) {
        d = $k - $(k + 3); if (d < 0) d = -d; if (d > worst) worst = d
        a = $k < 0 ? -$k : $k; if (a > most) most = a } }
    END { printf "live against batch: %g of %g N, %d rows\n", worst, most, NR
          exit !(NR == 93 && most > 0 && worst < tolerance * most) }'
}
agree batch.csv live.csv || complain 'live differs from batch'

# Regions that relax each in its own way, in both modes.
cat >regions.csv <<'END'
effect,region,parameter,value,unit,state
elastic,0,E,20000,Pa,fixed
elastic,1,E,10000,Pa,fixed
elastic,0,nu,0.4,1,fixed
viscoelastic,0,E1,8000,Pa,fixed
viscoelastic,0,tau1,0.2,s,fixed
viscoelastic,1,E1,15000,Pa,fixed
viscoelastic,1,tau1,0.03,s,fixed
regions,0,local,0,1,fixed
regions,0,x1,0.015,m,fixed
regions,0,y1,0.025,m,fixed
regions,1,x1,0.045,m,fixed
regions,1,y1,0.025,m,fixed
END
two=(--body body.ply --model regions.csv --rim-edge 0.3)
"$bin/hs-simulate" motion.csv "${two[@]}" -o regions-batch.csv 2>err || complain 'batch of regions failed'
grep -q 'relax each in its own way: [0-9]* Maxwell elements' err || complain 'the elements are not told'
"$bin/hs-simulate" --live --accuracy 0.3 --contacts motion.csv "${two[@]}" <motion.csv >regions-live.csv 2>err ||
  complain 'live regions failed'
agree regions-batch.csv regions-live.csv || complain 'live differs from batch in regions that relax'

# Each force comes before the next line is sent.
coproc live { "$bin/hs-simulate" --live --accuracy 0.3 "${common[@]}" --tool-radius 0.004 -q 2>err; }
exec {to}>&"${live[1]}" {from}<&"${live[0]}"
printf 't,x,y,z\n' >&"$to"
header=
while [[ $header != press,* ]]; do read -r -t 60 -u "$from" header || { complain 'no header'; break; }; done
for z in 0.041 0.0395 0.039; do
  printf '0,0.03,0.025,%s\n' "$z" >&"$to"
  read -r -t 60 -u "$from" answer || complain "no answer to z = $z"
done
[[ $answer == 1,0,0.03,0.025,0.04,* ]] || complain "the contact was not found: $answer"
exec {to}>&- {from}<&-
eval "exec ${live[1]}>&-" 2>/dev/null
wait

# A body of second order serves as well: the same forces where the contacts are solved finely.
"$bin/hs-tetmesh" box.off --edge 0.012 --order 2 -q -o body2.ply || complain 'no body of second order'
"$bin/hs-simulate" --live --accuracy 0.3 --contacts motion.csv --body body2.ply --model model.csv --rim-edge 0.3 \
  motion.csv -q -o second.csv 2>err || complain 'live on second order failed'
agree batch.csv second.csv 2e-3 || complain 'second order differs'

# A bad line: one error with its line, exit 3, the forces before it written, to a file too.
{ cat motion.csv; echo '4,0,0.03,0.025,0.04,0,0,much'; } >bad.csv
for target in - kept.csv; do
  "$bin/hs-simulate" --live --accuracy 0.3 bad.csv "${common[@]}" -q -o "$target" >out.csv 2>err
  code=$?
  [[ $target == - ]] || mv kept.csv out.csv
  ((code == 3)) || complain "exit code $code for a bad line"
  [[ $(wc -l <err) == 1 ]] && grep -q "^hs-simulate: bad.csv:96: uz is 'much'" err || complain 'the error'
  [[ $(forces out.csv | wc -l) == 93 ]] || complain 'forces were lost'
done

# A closed pipe ends quietly.
yes '0,0.03,0.025,0.039' | { echo t,x,y,z; cat; } |
  "$bin/hs-simulate" --live --accuracy 0.3 "${common[@]}" --tool-radius 0.004 -q 2>err | head -5 >out.csv
[[ $(wc -l <out.csv) == 5 && ! -s err ]] || complain 'a closed pipe is not quiet'

# Records: the same forces as the lines, to the last bit; a cut one is an error.
need python3
python3 - motion.csv <<'END' >motion.bin || complain 'no records were made'
import struct, sys
rows = [l.split(",") for l in open(sys.argv[1]) if l[0] not in "#p"]
for r in rows:
    sys.stdout.buffer.write(struct.pack("<ii7d", int(r[0]), 1, *map(float, r[1:8])))
END
"$bin/hs-simulate" --live --accuracy 0.3 --binary press "${common[@]}" --tool-radius 0.004 -q <motion.bin >forces.bin 2>err ||
  complain 'records failed'
"$bin/hs-simulate" --live --accuracy 0.3 motion.csv "${common[@]}" -q >lines.csv 2>err || complain 'lines failed'
python3 - <<'END' || complain 'records and lines differ'
import struct
data = open("forces.bin", "rb").read()
lines = [l.split(",") for l in open("lines.csv") if l[0] not in "#p"]
assert len(data) == 88 * len(lines) == 88 * 93, len(data)
for k, line in enumerate(lines):
    press, contact, *numbers = struct.unpack_from("<ii10d", data, 88 * k)
    assert (press, contact) == (int(line[0]), int(line[11]))
    assert numbers == [float(x) for x in line[1:11]]
END
head -c 100 motion.bin | "$bin/hs-simulate" --live --accuracy 0.3 --binary press "${common[@]}" --tool-radius 0.004 -q >out.bin 2>err
(($? == 3)) && grep -q '^hs-simulate: stdin: record 2: it has 36 bytes of 64' err &&
  [[ $(wc -c <out.bin) == 88 ]] || complain 'a cut record'

# Paced by the clock: 93 lines at 1 kHz take 92 ms or more.
"$bin/hs-simulate" --live --accuracy 0.3 --rate 1000 motion.csv "${common[@]}" 2>err >out.csv || complain 'paced'
grep -Eq 'memory (not )?locked' err && grep -q 'of 93 later than a period' err || complain 'the pace'

refuse() { # CODE TEXT ARGUMENTS...
  local code=$1 text=$2 got
  shift 2
  "$bin/hs-simulate" "$@" >/dev/null 2>err
  got=$?
  ((got == code)) && grep -qF -- "$text" err || complain "exit $got, not $code with '$text': $*"
}
refuse 2 'live mode' motion.csv "${common[@]}" --rate 1000
refuse 2 'live mode' motion.csv "${common[@]}" --binary tip
refuse 2 'batch mode' --live motion.csv "${common[@]}" --add-noise 1
refuse 2 'live mode' motion.csv "${common[@]}" --uncertainty
refuse 2 'records of tip have no place' --live --binary tip --uncertainty "${common[@]}" --tool-radius 0.004
{ head -n 3 model.csv; printf 'shift,0,%s,,-1,1,fixed\n' dx,0.003,m dy,0,m dz,0,m rx,0,rad ry,0,rad rz,0,rad; } >shift.csv
refuse 3 'hs-simulate --live --contacts' --live motion.csv --body body.ply --model shift.csv

# A second start finds the field, and says the same; each force has its uncertainty, and beside the support it is
# said that the place was not sampled.
awk 'NR <= 2 || /^1,/ { print } END { for (i = 0; i < 5; ++i) printf "2,%g,0.03,0,0.002,0,%g,0\n", i, 1e-4 * i }' motion.csv >beside.csv
for turn in first second; do
  "$bin/hs-simulate" --live --accuracy 0.3 --uncertainty beside.csv "${common[@]}" -o $turn.csv 2>$turn.txt ||
    complain 'no uncertainties'
done
cmp -s first.csv second.csv || complain 'the field of the cache is another'
grep -q 'samples of the contact stiffness' second.txt && grep -q 'beside the support' second.txt || complain 'the summary'
awk -F, '/^[0-9]/ { size = sqrt($9 ^ 2 + $10 ^ 2 + $11 ^ 2); share = size > 0 ? $14 / size : 0.1
  if ($1 == 1 && ($13 % 8 >= 4 || share <= 0 || share > 0.5) || $1 == 2 && $13 % 8 < 4) ++wrong; ++n } END { exit !(n == 36 && !wrong) }' \
  first.csv || complain 'the uncertainties or places'

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
