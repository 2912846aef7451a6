#!/usr/bin/env bash
# haptic_device.sh BIN: the example's header drives hs-simulate as a device would; killed at any
# moment, hs-simulate --live has lost nothing but the last line.
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
example=$(cd "$(dirname "${BASH_SOURCE[0]}")/../../share/examples/haptic-device" && pwd)

"$bin/hs-tetmesh" box.off --edge 0.02 -q -o body.ply || complain 'no body'
printf 'effect,region,parameter,value,unit\nelastic,0,E,20000,Pa\nelastic,0,nu,0.4,1\n' >model.csv
common=(--body body.ply --model model.csv --tool-radius 0.004 --accuracy 0.3)
"${CXX:-c++}" -std=c++17 -Wall -Wextra -Werror "$example/device_none.cpp" -o device 2>err || complain 'not compiled'
PATH=$bin:$PATH ./device 0.03 0.025 0.04 "${common[@]}" >out 2>err || complain 'the device failed'
grep -Eq '^largest force along z 0\.[1-9].*, torque about z [0-9.e-]*[1-9][0-9.e-]* N m, 0 late, [0-9]+ limited$' out || complain "no force was felt: $(cat out)"
PATH=$bin:$PATH ./device 0.03 0.025 0.04 --body none.ply --model model.csv --tool-radius 0.004 >out 2>err
(($? == 4)) || complain 'a stream that ended is not noticed'

# The same motion by the C interface, in one process.
library=$(dirname "$bin")/lib
"${CC:-cc}" -std=c99 -Wall -Wextra -Werror -I "$example/../../../lib/c" "$example/device_linked.c" -L "$library" -lhapsim -lm -Wl,-rpath,"$library" -o linked 2>err ||
  complain "not compiled: $(cat err)"
./linked 0.03 0.025 0.04 body.ply model.csv 4mm >linked-out 2>err || complain 'the linked device failed'
grep -Eq '^largest force along z 0\.[1-9][0-9]* N, [0-9]+ limited$' linked-out || complain "the linked device felt nothing: $(cat linked-out)"
./linked 0.03 0.025 0.04 body.ply none.csv 4mm >/dev/null 2>err
(($? == 5)) && grep -q '^none.csv: ' err || complain 'the linked device does not say what it lacks'

# A stream that is late: what is felt is the newest force, said to be old, and fades; later it goes on.
cat >late.cpp <<'END'
#include <cstdio>

#include "hapsim_stream.h"

int main(int, char** argv) {
  HapsimStream hapsim({argv + 1, argv + 9}, 2);
  LateForce late(0.01, 0.05);
  std::vector<HapsimPose> poses(2);
  poses[0].tip = {0.02, 0.025, 0.041}, poses[1].tip = {0.04, 0.025, 0.041};
  bool fresh = hapsim.exchange(0, poses, 10);
  poses[0].tip[2] = poses[1].tip[2] = 0.039;
  fresh = fresh && hapsim.exchange(0.001, poses, 10);
  const double felt = hapsim.feel()[0].force[2] * late.factor(0.001, fresh);
  kill(hapsim.child(), SIGSTOP);
  int old = 0;
  double faded = felt;
  for (int i = 2; i < 300; ++i) {
    const bool now = hapsim.exchange(0.001 * i, poses, 0.0002);
    old += now ? 0 : 1;
    faded = hapsim.feel()[1].force[2] * late.factor(0.001 * i, now);
  }
  kill(hapsim.child(), SIGCONT);
  const bool again = hapsim.exchange(0.3, poses, 30);
  std::printf("%d %g %d %g %d\n", fresh, felt, old, faded, again);
}
END
"${CXX:-c++}" -std=c++17 -Wall -Wextra -Werror -I "$example" late.cpp -o late 2>err || complain "not compiled: $(cat err)"
PATH=$bin:$PATH ./late "${common[@]}" >out 2>err || complain 'the late stream failed'
awk '$1 == 1 && $2 > 0.1 && $3 == 298 && $4 == 0 && $5 == 1 { ok = 1 } END { exit !ok }' out || complain "a late stream: $(cat out)"

# For a hand: a child that is ended says zero first; one that is killed leaves zero; one that is stopped does not
# keep the program from its end.
cat >ended.cpp <<'END'
#include <cstdio>

#include "hapsim_stream.h"

int main(int, char** argv) {
  for (const int signal : {SIGTERM, SIGKILL, SIGSTOP}) {
    std::vector<std::string> words(argv + 1, argv + 9);
    words.push_back("--hand");
    HapsimStream hapsim(words);
    std::vector<HapsimPose> poses(1);
    poses[0].tip = {0.03, 0.025, 0.041};
    hapsim.exchange(0, poses, 10);
    for (int i = 1; i < 100; ++i) {
      poses[0].tip[2] = 0.0401 - 1e-5 * i;
      hapsim.exchange(0.001 * i, poses, 10);
    }
    const double felt = hapsim.feel()[0].force[2];
    kill(hapsim.child(), signal);
    double left = felt;
    try {
      const int last = signal == SIGSTOP ? 700 : 10000;  // a busy machine takes its time to end one
      for (int i = 100; i < last; ++i) {
        hapsim.exchange(0.001 * i, poses, 0.001);
        left = hapsim.feel()[0].force[2];
        if (hapsim.ended()) break;
      }
    } catch (const std::exception&) {
      left = hapsim.feel()[0].force[2];
    }
    std::printf("%d %g %g %d\n", signal, felt, left, hapsim.ended());
  }
}
END
"${CXX:-c++}" -std=c++17 -Wall -Wextra -Werror -I "$example" ended.cpp -o ended 2>err || complain "not compiled: $(cat err)"
PATH=$bin:$PATH ./ended "${common[@]}" >out 2>err || complain 'the streams that end failed'
awk -v term=15 -v kill=9 '$2 > 0.05 { ++felt } $1 == term && $3 == 0 && $4 == 1 { ++ok } $1 == kill && $3 == 0 { ++ok }
  END { exit !(felt == 3 && ok == 2 && NR == 3) }' out || complain "streams that end: $(cat out)"

# Killed in mid-stream: what was answered before is there, whole lines but perhaps the last.
mkfifo motion
"$bin/hs-simulate" --live "${common[@]}" -q <motion >forces.csv 2>err &
simulate=$!
exec {to}>motion
printf 't,x,y,z\n' >&"$to"
for i in {1..400}; do printf '0.%03d,0.03,0.025,0.039\n' "$i"; done >&"$to"
until_true 60 rows_in forces.csv 400
{ kill -KILL $simulate && wait $simulate; } 2>/dev/null
exec {to}>&-
[[ $(grep -Ec '^[0-9]+,0\.[0-9]+(,[^,]+){9},1,0$' forces.csv) == 400 ]] || complain 'lines were lost'

((failures == 0)) || { printf '%d failures\n' "$failures"; exit 1; }
