# Recordings by another solver: bodies of their surfaces and of their scans; of each recording the elastic model,
# its forces and report, its diagnosis and what --effects auto makes of it; on the scanned body the elastic model.
if [[ ! -d $shared/independent ]]; then
  echo "record: SKIPPED independent: no data in $shared/independent; set HAPSIM_SHARED" >&2
  return 0
fi
use in "$shared/independent"
for body in cuboid ball blob; do
  step $body "hs-tetmesh in/$body.stl --json $body.json -o $body.ply
    hs-reconstruct in/$body.stl --json $body-surface.json -o $body-surface.ply"
  step $body-scan "hs-scan2ply in/${body}_scan.csv --json $body-points.json -o $body-points.ply
    hs-reconstruct $body-points.ply --json $body-scanned.json -o $body-scanned.ply
    hs-tetmesh $body-scanned.ply -o $body-scan.ply"
done
while read -r name body; do
  data="in/$name.csv --body $body.ply"
  step $name-elastic "rm -f $name-history.csv
    hs-identify $data --effects elastic --history $name-history.csv -o $name-0.csv
    hs-simulate $data --model $name-0.csv -o $name-forces.csv"
  step $name-diagnosis "hs-diagnose $data --model $name-0.csv --json $name.json -o $name-effects.csv
    hs-compare in/$name.csv --simulated $name-forces.csv --body $body.ply --model $name-0.csv --diagnosis $name-effects.csv --json $name-compare.json --html $name.html -o $name-residuals.csv"
  step $name-auto "rm -f $name-steps.csv
    hs-identify $data --effects auto --history $name-steps.csv -o $name-auto.csv
    hs-simulate $data --model $name-auto.csv -o $name-best.csv"
  step $name-scan "hs-identify in/$name.csv --body $body-scan.ply --effects elastic -o $name-scan.csv"
done <<'END'
null cuboid
regions cuboid
hyperelastic blob
viscoelastic ball
bias_drift ball
END
