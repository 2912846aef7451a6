#!/usr/bin/env bash
# calibrate.sh BIN: what hs-calibrate prints, writes and returns; what readers of recordings make of its file; and the
# example: the sensor is named before the calibration, nothing is missing after it.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
example=$root/share/examples/calibrate
. "$(dirname "${BASH_SOURCE[0]}")/tool.sh" "$1/hs-calibrate"
bin=$(dirname "$tool")
export PATH=$bin:$PATH XDG_CACHE_HOME=$work/cache
# number FILE PARAMETER COLUMN
number() { awk -F, -v name="$2" -v c="$3" '$1 == name { print $c }' "$1"; }
near() { awk -v a="$1" -v b="$2" -v tolerance="$3" 'BEGIN { d = a - b; exit !(a != "" && d < tolerance && d > -tolerance) }'; }

# --- The example.
if "$example/calibrate.sh" . >.out 2>.err; then
  near "$(number cal.csv rotation_x 2)" 0.02 0.0017 && near "$(number cal.csv rotation_y 2)" -0.03 0.0017 || complain 'rotation within 0.1 degrees'
  near "$(number cal.csv crosstalk_yz 2)" 0.02 0.005 && near "$(number cal.csv crosstalk_xx 2)" 1.02 0.005 || complain 'cross-talk within 0.5 %'
  near "$(number cal.csv mass 2)" 0.15 0.0015 && near "$(number cal.csv offset_z 2)" 0.5 0.005 || complain 'mass and offset within 1 %'
  near "$(number cal.csv arm_zz 2)" 5e-6 5e-8 || complain 'the arm within 1 %'
  verdict() { awk -F, '$1 == 0 { print $3 }' "$1"; }
  missing=$(awk -F, '$1 > 0 && $3 != "absent" && $3 != "not testable" { printf "%s (%s) ", $2, $3 }' effects-raw.csv)
  [[ $(verdict effects-raw.csv) != complete && $missing == *sensor-* ]] || complain "before: $(verdict effects-raw.csv), $missing"
  [[ $(verdict effects-calibrated.csv) == complete ]] || { complain "after: $(verdict effects-calibrated.csv)"; cat effects-calibrated.csv; }
else
  complain 'calibrate.sh fails'
fi
cp poses.csv all.csv

# --- Poses of any kind; the joints of a robot.
expect 0 'noise 0.00' all.csv -o a.csv
"$tool" -q - -o b.csv <all.csv && sed 's/stdin/all.csv/' b.csv | cmp -s - a.csv || complain 'standard input'
awk -F, '/^[#q]/ || $5 == 0' all.csv >alone.csv
expect 0 'the mean gain is taken for 1' alone.csv -o tool.csv
grep -q '^# scale: mean gain' tool.csv || complain 'the scale is in the metadata'
expect 0 'GRAVITY' all.csv --gravity estimate -o g.csv
near "$(number g.csv gravity_z 2)" -9.80665 0.01 || complain 'the direction of gravity'
expect 0 '5 poses to record' --robot "$root/share/examples/robot/arm.urdf" --tip-link sensor --plan joints.csv --plan-poses 5
awk -F, -v OFS=, '$1 == "pose" { print "q1,q2,q3,q4,q5,q6,fx,fy,fz"; next } { print $2, $3, $4, $5, $6, $7, 5 * $12 + 0.002 * ($1 % 2), 5 * $13 - 0.1, 5 * $14 }' joints.csv >driven.csv
expect 0 'the sensor is calibrated' driven.csv --robot "$root/share/examples/robot/arm.urdf" --tip-link sensor --crosstalk off -o robot.csv
near "$(number robot.csv offset_y 2)" -0.1 0.01 && near "$(number robot.csv mass 2)" 0.5099 0.001 || complain 'poses by joint angles'

# --- What the poses do not tell.
head -5 all.csv | cut -d, -f1-4,7- >three.csv
expect 3 'three.csv: 3 poses' three.csv -o none.csv
expect 3 'record the poses of next.csv too' three.csv --plan next.csv -o none.csv
[[ ! -e none.csv && $(grep -c '^[0-9]' next.csv) == 6 ]] || complain 'a plan without a calibration'
expect 0 'the sensor is not calibrated yet' three.csv --plan next.csv
[[ ! -s .out ]] || complain 'no calibration on standard output'
cut -d, -f1-4,6- all.csv >forgotten.csv
expect 3 'is a weight missing in the column load' forgotten.csv -o none.csv
awk 'BEGIN { OFS = ","; print "qw,qx,qy,qz,fx,fy,fz"; for (i = 0; i < 9; ++i) print cos(i / 3), 0, 0, sin(i / 3), 0.001 * (i % 2), 0, -4 }' >still.csv
expect 3 'do not determine the sensor' still.csv -o none.csv

# --- Bad input and use.
expect 2 'there is nothing to calibrate from'
expect 2 '--gravity: ' all.csv --gravity 0,0,-1
sed '4s/^[^,]*/2/' all.csv >long.csv
expect 3 'long.csv:4: the quaternion has length' long.csv -o none.csv
cut -d, -f5- all.csv >flat.csv
expect 3 'no columns say how the tool was turned' flat.csv -o none.csv
expect 5 'none-there.csv' none-there.csv -o none.csv
[[ ! -e none.csv ]] || complain 'a failed run leaves nothing behind'

# --- Readers.
reads() { # CODE TEXT COMMAND...
  local code=$1 text=$2
  shift 2
  "$@" >.out 2>.err </dev/null
  local got=$?
  ((got == code)) || complain "exit code $got, not $code: $*"
  flat .err | grep -qF -- "$text" || complain "'$text' is not told by: $*"
}
taken='data.csv: by cal.csv: cross-talk, rotation, offset, weight, drift and arm taken out'
reads 0 "$taken" hs-simulate data.csv --calibration cal.csv --body body.ply --model truth.csv --rim-edge 0.3 -o f.csv
grep -q '^# calibrated: cal.csv' f.csv || complain 'the correction is in the metadata'
reads 0 "$taken" hs-compare data.csv --calibration cal.csv --simulated f.csv -o residuals.csv
reads 3 'corrected before, by cal.csv' hs-compare residuals.csv --calibration cal.csv --simulated f.csv -o none.csv
sed '/^# orientation/d' data.csv >unknown.csv
grep -v '^arm' cal.csv >sensor.csv
reads 0 'its weight stays in the force' hs-compare unknown.csv --calibration sensor.csv --simulated unknown.csv -o none2.csv
reads 2 '--calibration is of recordings' hs-compare --follow data.csv --calibration cal.csv --model truth.csv --body body.ply
reads 2 '--calibration is of recordings' hs-simulate --live data.csv --calibration cal.csv --model truth.csv --body body.ply
reads 2 '--calibration is of recordings' hs-identify --follow data.csv --calibration cal.csv --body body.ply
sed 's/mass,/mas,/' cal.csv >wrong.csv
reads 3 "a calibration has no parameter 'mas'; did you mean 'mass'?" hs-compare data.csv --calibration wrong.csv --simulated f.csv -o none.csv
# A foreign table is put right before contact is looked for, so that it is as the recording put right.
sed '/^# tool_radius/d' data.csv >table.csv
reads 0 'by cal.csv: ' hs-import table.csv --calibration cal.csv --tool-radius 4mm -o imported.csv
reads 0 '' hs-compare imported.csv --simulated f.csv --json same.json -o residuals.csv
reads 3 'corrected before' hs-import imported.csv --calibration cal.csv -o none.csv
[[ ! -e none.csv ]] || complain 'a refused recording leaves nothing behind'

((failures == 0)) && echo 'all as expected'
exit $((failures > 0))
