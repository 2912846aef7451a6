# share/examples that need neither network nor hardware nor a compiler (those of their own: phantom, tutorial and
# thesis): robot, calibrate, import, batch, ci, and of telepresence the body and its forces without the link. What the scripts
# take from their users is made here by closed forms.
use share "$examples"
step robot 'mkdir -p robot && share/robot/robot.sh robot'
step calibrate 'mkdir -p calibrate && share/calibrate/calibrate.sh calibrate'

# An organ, half an ellipsoid of 45 x 35 x 25 mm, probed at 204 places, five depths each, as a robot records it.
organ='BEGIN {
  print "site,depth_index,ContactPoint_x,ContactPoint_y,ContactPoint_z,ContactSurfNorm_x,ContactSurfNorm_y,ContactSurfNorm_z,CurrentPos_x,CurrentPos_y,CurrentPos_z,DeformedForce_x,DeformedForce_y,DeformedForce_z"
  for (s = 1; s <= 204; ++s) {
    u = sqrt(s / 230); v = 2.399963 * s; x = 45 * u * cos(v); y = 35 * u * sin(v); z = 25 * sqrt(1 - u * u)
    l = sqrt((x / 2025) ^ 2 + (y / 1225) ^ 2 + (z / 625) ^ 2); a = x / 2025 / l; b = y / 1225 / l; c = z / 625 / l
    for (k = 0; k < 5; ++k) { d = 0.8 * k; f = 0.12 * d * (1 + 0.1 * d) + 0.004 * (((7 * s + 3 * k) % 11) - 5)
      printf "%d,%d,%.4f,%.4f,%.4f,%.5f,%.5f,%.5f,%.4f,%.4f,%.4f,%.5f,%.5f,%.5f\n", s, k, x, y, z, a, b, c, x - d * a, y - d * b, z - d * c, f * a, f * b, f * c } } }'
step organ "mkdir -p organ && awk '$organ' >organ/probed.csv && cd organ
  hs-import probed.csv --list
  ../share/import/organ.sh probed.csv 3mm --unit mm
  awk -F, '/^#/ || !n++ || \$1 % 10 == 0' data.csv >some.csv
  hs-identify some.csv --body body.ply --fix nu=0.45 -o model.csv"

# Tables of a testing machine: approach through the air, ramp, hold, retreat; a soft sample and one that relaxes.
table='function row(t, s, f) { line = sprintf("%.2f;%.4f;%.5f", t, s, f); gsub(/\./, ",", line); print line }
  BEGIN { srand(5)
    print "Material;meat"; print ""
    for (p = 1; p <= 4; ++p) { rise = 0.4 * p; depth = 0.8 + 0.2 * p; slow = 0
      print "Prüfzeit;Standardweg;Standardkraft"; print "s;mm;N"
      for (i = -25; i <= 100; ++i) { t = 0.04 * i; s = t < 0 ? 0 : t < rise ? t / rise : t < 2.5 ? 1 : t < 3.5 ? 3.5 - t : 0
        slow = slow + (depth * s - slow) * (1 - exp(-0.04 / 0.5))
        row(t + 1, t < 0 ? 0.5 * t : depth * s, k * depth * s + (t >= 0) * g * (depth * s - slow) + 0.004 * (rand() - 0.5)) } } }'
step machine "mkdir -p machine
  awk -v k=0.15 -v g=0 '$table' >machine/soft.csv
  awk -v k=0.25 -v g=0.2 '$table' >machine/tough.csv
  printf 'Prüfzeit;Standardweg\ns;mm\n0,0;0,1\n0,1;0,2\n' >machine/broken.csv
  touch -d @1000000000 machine/*.csv  # the batch keeps it
  cd machine
  hs-import soft.csv --list
  ../share/import/machine.sh 60x50x40mm 4mm tough.csv
  hs-identify data.csv --body body.ply --effects elastic,viscoelastic --fix nu=0.49 -o model.csv"
# One after the other, so that calls are numbered alike.
step batch "JOBS=1 PIPELINE='$root/Makefile.pipeline' share/batch/machines.sh 60x50x40mm 4mm batch machine/soft.csv machine/tough.csv machine/broken.csv || echo \"ended with \$?\""

step ci "mkdir -p ci && cd ci
  awk -v what=cuboid -v a=0.06 -v b=0.05 -v c=0.04 -f ../share/shapes.awk >box.off
  hs-tetmesh box.off --max-volume 2e-8 -o body.ply
  awk 'BEGIN { print \"# tool_radius: 0.004\n# force_noise: 0.002\npress,t,x,y,z,ux,uy,uz\"
    for (p = 0; p < 6; ++p) for (i = 0; i <= 20; ++i)
      printf \"%d,%.2f,%.3f,0.025,0.04,%.6f,0,%.6f\n\", p, 0.05 * i, 0.02 + 0.01 * (p % 3), i * 4e-5 * (p > 2), -i * 8e-5 }' >motion.csv
  printf 'effect,region,parameter,value\nelastic,0,E,8000\nelastic,0,nu,0.4\n' >truth.csv
  hs-simulate motion.csv --body body.ply --model truth.csv --add-noise 0.002 -o data.csv
  hs-identify data.csv --body body.ply --folds 3 -o golden.csv
  sed -n 's/^ *run: \(hs-.*\)/\1/p' ../share/ci/github.yml >steps.sh
  bash -e -o pipefail steps.sh"

step telepresence "mkdir -p telepresence && cd telepresence
  awk -v what=dome -v a=0.05 -v b=0.05 -v c=0.05 -v n=28 -v m=9 -f ../share/shapes.awk >ball.off
  hs-tetmesh ball.off --edge 0.011 -o real.ply
  hs-tetmesh ball.off --edge 0.02 -o ball.ply
  printf 'effect,region,parameter,value,unit\nelastic,0,E,22000,Pa\nelastic,0,nu,0.45,1\nviscoelastic,0,E1,6000,Pa\nviscoelastic,0,tau1,0.15,s\n' >hidden.csv
  awk 'BEGIN { print \"# tool_radius: 0.004\"; print \"press,t,x,y,z,ux,uy,uz\"
    for (i = 0; i <= 5000; ++i) { t = i / 1000; d = 0.002 * (1 - cos(3.6 * t)) * (1 + 0.35 * sin(1.3 * t)); s = 0.25 * d * sin(2.3 * t)
      printf \"1,%.3f,0.004,0.002,0.0496,%.9g,0,%.9g\n\", t, s, -d } }' >motion.csv
  hs-simulate --live motion.csv --body real.ply --model hidden.csv -o felt.csv"
