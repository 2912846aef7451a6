#!/usr/bin/env bash
# photographs.sh BIN: a model of COLMAP becomes points in metres in the frame of known marks, and a surface. COLMAP itself
# is not run: a stand-in gives the model that it would make of a body that is known.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
need python3
export PATH=$bin:$PATH
example=$root/share/examples/photographs
# Half an ellipsoid of 50, 40, 30 mm on a sheet, seen by six cameras that distort, in COLMAP's own frame and scale.
mkdir model none
/usr/bin/python3 - <<'END' || complain 'no model'
import sys
import numpy as np
chance = np.random.default_rng(2)
axes = np.array([0.05, 0.04, 0.03])
p = chance.standard_normal((4000, 3))
p = np.abs(p / np.linalg.norm(p, axis=1)[:, None]) * np.sign(chance.standard_normal((4000, 3))) * axes
p[:, 2] = np.abs(p[:, 2])
sheet = np.column_stack([chance.uniform(-0.14, 0.14, 800), chance.uniform(-0.1, 0.1, 800), np.zeros(800)])
far = np.array([[0.4, 0.1, 0.02], [-0.3, 0.3, 0.05]])
points = np.vstack([p, sheet, far])
np.savetxt("truth.csv", points, delimiter=",", fmt="%.9f")
def turn(w):
    a = np.linalg.norm(w)
    k = w / a
    K = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    return np.eye(3) + np.sin(a) * K + (1 - np.cos(a)) * K @ K, np.concatenate([[np.cos(a / 2)], np.sin(a / 2) * k])
G, _ = turn(np.array([0.4, -1.1, 0.7]))
scale, shift = 7.3, np.array([1.0, -2.0, 5.0])
theirs = lambda q: scale * q @ G.T + shift
with open("model/cameras.txt", "w") as out:
    out.write("# cameras\n3 SIMPLE_RADIAL 1200 900 1100 600 450 -0.08\n")
corners = {"a": (-0.1485, -0.105), "b": (0.1485, -0.105), "c": (0.1485, 0.105), "d": (-0.1485, 0.105)}
with open("sheet.csv", "w") as out:
    out.write("mark,x,y,z\n" + "".join("%s,%g,%g,0\n" % (m, *xy) for m, xy in corners.items()))
marks = open("marks.csv", "w")
marks.write("# clicked\nmark,photograph,u,v\n")
with open("model/images.txt", "w") as out:
    out.write("# two lines an image\n")
    for n in range(6):
        R, q = turn(np.array([2.0, 0.3 * n, 0.2 * n - 0.5]))
        middle = theirs(np.zeros((1, 3)))[0]
        t = np.array([0.05 * n, -0.03 * n, 3.5]) - R @ middle
        out.write("%d %s %s 3 a photograph %d.png\n%s\n" % (n + 1, " ".join("%.12g" % v for v in q), " ".join("%.12g" % v for v in t), n,
                  "" if n == 2 else "10.5 20.5 -1"))
        for mark, xy in corners.items():
            c = R @ theirs(np.array([[*xy, 0]]))[0] + t
            x = c[:2] / c[2]
            x = x * (1 - 0.08 * x @ x)
            marks.write("%s,a photograph %d.png,%.6f,%.6f\n" % (mark, n, *(1100 * x + [600, 450])))
marks.write("a,lost.png,3,4\n")
with open("model/points3D.txt", "w") as out:
    out.write("# points\n")
    for i, q in enumerate(theirs(points)):
        track = " ".join("%d %d" % (k + 1, i) for k in range(2 if i % 100 == 7 else 4))
        out.write("%d %s 9 9 9 %g %s\n" % (i + 1, " ".join("%.12g" % v for v in q), 4 if i % 100 == 8 else 0.7, track))
END
scale() { /usr/bin/python3 "$example/scale_points.py" "$@"; }
scale model marks.csv sheet.csv >points.csv 2>err || complain 'the points are not scaled'
grep -q '^scale_points.py: not in the model, their marks are left out: lost.png$' err && grep -q '4 marks, 0.00 mm off' err && grep -q '4706 of 4802 points' err ||
  complain "what is told"
# Every point where it is, but for the two in a hundred that are seen too seldom or fit badly.
awk 'NR % 100 != 8 && NR % 100 != 9' truth.csv | paste -d, - <(tail -n +2 points.csv) |
  awk -F, '{ for (k = 1; k <= 3; ++k) { d = $k - $(k + 3); if (d > 2e-6 || d < -2e-6) bad = 1 } } END { exit bad || NR != 4706 }' ||
  complain 'points lie elsewhere'
scale model marks.csv sheet.csv --above 0.002 --beside 0.1 >body.csv 2>err || complain 'the body alone'
awk -F, 'NR > 1 { if ($3 < 0.002 || $1 * $1 > 0.0026) bad = 1; if ($3 > top) top = $3 } END { exit bad || top < 0.0299 || top > 0.0301 }' body.csv ||
  complain 'the support is cut off'
# Two marks: the scale alone.
grep -E '^(mark|a|b),' sheet.csv >two.csv
grep -vE '^[cd],' marks.csv >marks2.csv
scale model marks2.csv two.csv >scaled.csv 2>err || complain 'two marks'
grep -q 'the scale alone' err || complain 'two marks are told'
extent() { awk -F, 'NR > 1 { for (k = 1; k <= 3; ++k) { s[k] += $k; q[k] += $k * $k } } END { for (k = 1; k <= 3; ++k) v += q[k] / (NR - 1) - (s[k] / (NR - 1)) ^ 2; printf "%.9f\n", sqrt(v) }' "$1"; }
awk -v a="$(extent points.csv)" -v b="$(extent scaled.csv)" 'BEGIN { d = a / b - 1; exit !(d < 1e-4 && d > -1e-4) }' || complain 'another size'

refused() { # CODE WORDS ARGUMENTS...
  scale "${@:3}" >out 2>err
  local code=$?
  [[ $code == "$1" ]] && tail -n 1 err | grep -q '^scale_points.py: ' && grep -qF -- "$2" err || complain "scale_points.py ${*:3}: $code, not $1 and '$2'"
}
refused 5 'none/cameras.txt: No such file' none marks.csv sheet.csv
refused 5 'no.csv: No such file' model no.csv sheet.csv
refused 3 'the mark c is not in two.csv' model marks.csv two.csv
head -n 3 marks.csv >one.csv
refused 3 'fewer than two marks' model one.csv sheet.csv
sed 's/,-\{0,1\}0.105,/,0,/' sheet.csv >line.csv
refused 3 'lie on one line' model marks.csv line.csv
sed '3s/[^,]*$/nan/' sheet.csv >nan.csv
refused 3 'nan.csv: row 2 has no number z; its columns are mark,x,y,z' model marks.csv nan.csv
sed '3s/,[0-9.]*$/,here/' marks.csv >text.csv
refused 3 'row 1 has no number v; its columns are mark,photograph,u,v' model text.csv sheet.csv
refused 3 'no point is left' model marks.csv sheet.csv --above 1
cp -r model fisheye && sed -i 's/SIMPLE_RADIAL/OPENCV_FISHEYE/' fisheye/cameras.txt
refused 3 'a camera of the model OPENCV_FISHEYE' fisheye marks.csv sheet.csv
cp -r model short && echo '3 SIMPLE_RADIAL 1200 900 1100 600' >short/cameras.txt
refused 3 "short/cameras.txt: '3 SIMPLE_RADIAL 1200 900 1100 600' is no row of a camera SIMPLE_RADIAL" short marks.csv sheet.csv
cp -r model cut && { head -n 30 model/points3D.txt; echo '5 1 two'; } >cut/points3D.txt
refused 3 'cut/points3D.txt: ' cut marks.csv sheet.csv

# The recipe, from photographs to a body.
mkdir 'my photographs' tools
cat >tools/colmap <<'END'
#!/bin/sh
echo "$*" >>commands
[ "$1" != mapper ] || { for last; do :; done; mkdir -p "$last/0" && cp model/*.txt "$last/0"; }
END
chmod +x tools/colmap
"$example/photographs.sh" none marks.csv sheet.csv made >log 2>err && complain 'without colmap'
[[ -n $(command -v colmap) ]] || grep -qx 'photographs.sh: colmap is not installed; on Debian 12: apt install --no-install-recommends colmap' err ||
  complain 'what is missing is not told'
PATH=$PWD/tools:/usr/bin:$PATH "$example/photographs.sh" 'my photographs' marks.csv sheet.csv made >log 2>err || complain 'the recipe fails'
cp commands all
PATH=$PWD/tools:/usr/bin:$PATH "$example/photographs.sh" 'my photographs' marks2.csv two.csv made2 >log 2>err
[[ $? == 3 ]] && tail -n 1 err | grep -q '^scale_points.py: two marks give no frame for --above and --beside; mark a third, or .*ABOVE= BESIDE=' ||
  complain 'two marks and a support'
PATH=$PWD/tools:/usr/bin:$PATH ABOVE= BESIDE= "$example/photographs.sh" 'my photographs' marks2.csv two.csv made2 >log 2>err ||
  complain 'the recipe fails with two marks'
cmp -s made2/points.csv scaled.csv && [[ -s made2/surface.ply ]] || complain 'points are lost with two marks'
mv all commands
[[ $(cut -d' ' -f1 commands | tr '\n' ' ') == 'feature_extractor exhaustive_matcher mapper model_converter ' ]] || complain "other commands: $(cat commands)"
(($(grep -c 'use_gpu 0' commands) == 2)) || complain 'a GPU is asked for'
hs-tetmesh made/surface.ply -q --json body.json -o body.ply 2>err || complain 'no body'
/usr/bin/python3 - <<'END' || complain 'the body is another one'
import re
data = open("body.ply", "rb").read()
head, rest = data.split(b"end_header\n", 1)
import numpy as np
count = int(re.search(rb"element vertex (\d+)", head).group(1))
kinds = re.findall(rb"property (\w+) (\w+)", head.split(b"element face")[0].split(b"element vertex")[1])
size = {b"double": "f8", b"float": "f4", b"uchar": "u1"}
rows = np.frombuffer(rest, np.dtype([(name.decode(), "<" + size[kind]) for kind, name in kinds]), count)
extent = [rows[a].max() - rows[a].min() for a in "xyz"]
print(extent)
assert abs(extent[0] - 0.1) < 0.004 and abs(extent[1] - 0.08) < 0.004 and abs(rows["z"].max() - 0.03) < 0.001, extent
END
((failures == 0)) && echo 'photographs: passed'
exit $((failures > 0))
