#!/usr/bin/env bash
# mujoco.sh BIN: a tool that MuJoCo lets fall comes to rest where hapsim's body bears its weight.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
example=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../share/examples/mujoco" && pwd)
if [[ ! -e /usr/include/mujoco/mujoco.h ]]; then
  echo 'SKIPPED: MuJoCo is not installed (libmujoco-dev; share/install-deps.sh --tests): its example was not tried'
  exit 0
fi
library=$(dirname "$bin")/lib
"$bin/hs-tetmesh" box.off --edge 0.012 -q -o body.ply || complain 'no body'
printf 'effect,region,parameter,value\nelastic,0,E,12000\nelastic,0,nu,0.4\nviscoelastic,0,E1,6000\nviscoelastic,0,tau1,0.1\n' >model.csv
"${CC:-cc}" -std=c99 -Wall -Wextra -Werror -I "$example" -I "$example/../../../lib/c" "$example/press.c" -L "$library" \
  -lhapsim -lmujoco -lm -Wl,-rpath,"$library" -o press 2>err || complain 'not compiled'
./press 0.03 0.025 0.041 "$example/press.xml" body.ply model.csv 4mm >out 2>err || complain 'the tool did not fall'
# weight 0.196200 N, the body bears 0.19... N, ... mm deep, speed ... m/s
awk '/^weight/ { w = $2; b = $7; deep = $9; v = $13; d = w - b; if (d < 0) d = -d; ok = d < 2e-3 * w && v < 1e-3 && deep > 0.1 }
  END { exit !ok }' out || complain "the tool does not rest on the body: $(cat out)"
# As deep as the batch mode has it, within what the prepared places are within.
deep=$(awk '/^weight/ { print $9 / 1000 }' out)
printf '# tool_radius: 0.004\npress,x,y,z,ux,uy,uz\n0,0.03,0.025,0.04,0,0,-%s\n' "$deep" >motion.csv
grep -v viscoelastic model.csv >rest.csv
"$bin/hs-simulate" -q motion.csv --body body.ply --model rest.csv -o forces.csv || complain 'no force'
awk -F, -v w="$(awk '{ print $2 }' out)" '/^[0-9]/ { d = $NF / w - 1; ok = d < 0.05 && d > -0.05 } END { exit !ok }' forces.csv ||
  complain "the depth is not that of the batch mode: $(cat out) $(tail -n 1 forces.csv)"
./press 0.03 0.025 0.041 "$example/press.xml" body.ply none.csv 4mm >/dev/null 2>err
(($? == 5)) && grep -q '^none.csv: ' err || complain 'what is missing is not told'

# The springs of hs-export: MuJoCo's force at each key frame is that of hs-simulate.
cat >springs.c <<'END'
#include <mujoco/mujoco.h>
#include <stdio.h>
int main(int argc, char** argv) {
  char error[500] = "";
  mjModel* m = argc > 1 ? mj_loadXML(argv[1], NULL, error, sizeof error) : NULL;
  if (!m) return fprintf(stderr, "%s\n", error), 1;
  mjData* d = mj_makeData(m);
  for (int key = 0; key < m->nkey; ++key) {
    mj_resetDataKeyframe(m, d, key);
    mj_forward(m, d);
    double f[3] = {0, 0, 0};
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) f[k] += d->qfrc_passive[j] * m->jnt_axis[3 * j + k];
    printf("%.9g %.9g %.9g\n", f[0], f[1], f[2]);
  }
  return 0;
}
END
"${CC:-cc}" -std=c99 -Wall -Wextra -Werror springs.c -lmujoco -o springs 2>err || complain 'not compiled'
printf '# tool_radius: 0.004\npress,t,x,y,z,ux,uy,uz\n0,0,0.02,0.03,0.04,0,0,0\n0,1,0.02,0.03,0.04,0.0003,-0.0002,-0.001\n0,2,0.02,0.03,0.04,0,0,-0.002\n' >motion.csv
"$bin/hs-export" -q rest.csv --body body.ply --data motion.csv --format mujoco -o springs.xml 2>err || complain 'no springs'
"$bin/hs-simulate" -q motion.csv --body body.ply --model rest.csv -o forces.csv || complain 'no force'
./springs springs.xml >felt 2>err || complain 'MuJoCo does not load the springs'
paste -d' ' felt <(awk -F, '/^0,[12],/ { print $(NF - 2), $(NF - 1), $NF }' forces.csv) |
  awk '{ for (k = 1; k <= 3; ++k) { d = $k - $(k + 3); if (d > 1e-6 || d < -1e-6) bad = 1 } most = $3 } END { exit bad || NR != 2 || most < 0.1 }' ||
  complain "the springs are another body: $(cat felt; tail -n 2 forces.csv)"
"$bin/hs-export" -q model.csv --body body.ply --data motion.csv --format mujoco -o none.xml 2>err
(($? == 3)) && grep -q 'model.csv: springs of MuJoCo have no relaxation' err || complain 'relaxation is not refused'
((failures == 0)) && echo 'mujoco: passed'
exit $((failures > 0))
