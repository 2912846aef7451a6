#!/usr/bin/env bash
# python_step.sh BUILD [STEPS]: what a live step costs in Python, in microseconds by the clock, whose own 0.05 are in
# it: a tool that wanders over a block and dips into it, its tip a row of an array. Recorded in
# bench/results/python-step.txt (bench/record.sh).
set -euo pipefail
build=$(cd "$1" && pwd) steps=${2:-300000}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
awk 'BEGIN {
  print "OFF"; print 8, 12, 0
  for (i = 0; i < 8; ++i) print (i % 2) * 0.06, (int(i / 2) % 2) * 0.05, (i >= 4) * 0.04
  split("0 2 1,1 2 3,4 5 6,5 7 6,0 1 4,1 5 4,2 6 3,3 6 7,0 4 2,2 4 6,1 3 5,3 7 5", f, ",")
  for (i = 1; i <= 12; ++i) print 3, f[i]
}' >box.off
"$build/bin/hs-tetmesh" -q box.off --edge 0.012 -o body.ply
printf 'effect,region,parameter,value\nelastic,0,E,12000\nelastic,0,nu,0.4\nviscoelastic,0,E1,6000\nviscoelastic,0,tau1,0.3\n' >model.csv
PYTHONPATH=$build/python "${PYTHON:-/usr/bin/python3}" - "$steps" <<'END'
import sys
import time

import numpy as np

import hapsim

steps = int(sys.argv[1])
ready = hapsim.prepare(hapsim.Body.read("body.ply"), hapsim.Model.read("model.csv"), tool_radius=0.004, accuracy=0.1)
t = 1e-3 * np.arange(steps)
tips = np.column_stack([0.03 + 0.01 * np.sin(0.37 * t), 0.025 + 0.01 * np.sin(0.53 * t + 1), 0.0395 - 0.002 * np.sin(5 * t)])
clock = time.perf_counter_ns


def measure(name, call):
    took = np.empty(steps)
    rows, times = list(tips), t.tolist()
    touching = 0
    for k in range(steps):
        start = clock()
        force = call(rows[k], times[k])
        took[k] = clock() - start
        touching += force[2] > 0
    us = np.percentile(took, [50, 99, 99.9, 100]) / 1000
    print(f"{name}: median {us[0]:.2f} us, 99 % {us[1]:.2f}, 99.9 % {us[2]:.2f}, longest {us[3]:.0f}; "
          f"{100 * touching / steps:.0f} % of {steps} in contact")


live = hapsim.Live(ready)
measure("step(tip, t)", live.step)
live = hapsim.Live(ready)
measure("step(tip), by the clock", lambda tip, _: live.step(tip))
hand = hapsim.Live(ready, hand=True)
measure("for a hand", hand.step)
live = hapsim.Live(ready)
start = clock()
live.run(t, tips)
print(f"run(t, tips): {(clock() - start) / steps / 1000:.2f} us a step")
END
