#!/usr/bin/env bash
# robot_bag.sh BIN: a bag of ROS 1 becomes a recording and a motion that is answered live, in the recipe and by the
# node; bags that cannot be read are one line and an exit code.
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
. "$(dirname "${BASH_SOURCE[0]}")/scratch.sh" "$1"
need python3
export PATH=$bin:$PATH
robot=$root/share/examples/robot

# The recipe: the bag's forces are of E = 20 kPa, E1 = 8 kPa, tau1 = 0.3 s on a finer mesh, with noise of 5 mN.
"$robot/bag.sh" "$robot/press.bag" . >log 2>err || complain 'the recipe fails'
awk -F, '/^elastic,0,E,/ { E = $4 } /,E1,/ { E1 = $4 } /,tau1,/ { tau = $4 }
  END { exit !(E > 19400 && E < 20600 && E1 > 7600 && E1 < 8400 && tau > 0.28 && tau < 0.32) }' model.csv ||
  complain "the model: $(grep free model.csv)"
# Measured and live forces at the deepest pose of each press, and in the air.
deepest() { # FILE: fz by press where uz is least
  awk -F, '/^#/ { next } !h { h = 1; for (i = 1; i <= NF; ++i) c[$i] = i; next }
    $c["press"] > 0 && $c["contact"] != 0 && $c["uz"] <= u[$c["press"]] + 1e-9 { if (!($c["press"] in f)) f[$c["press"]] = 0
      if ($c["uz"] < u[$c["press"]] - 1e-9) { u[$c["press"]] = $c["uz"]; f[$c["press"]] = $c["fz"] } }
    END { print f[1], f[2] }' "$1"
}
echo "$(deepest data.csv) $(deepest forces.csv)" | awk '
  function near(a, b) { return b > 0.5 && (a > b ? a - b : b - a) < 0.05 * b }
  { print "measured and live [N]:", $0; exit !(near($1, $3) && near($2, $4)) }' || complain 'live forces are not those that were measured'
(($(grep -c '^[0-9]' forces.csv) == 160)) || complain 'not every pose is answered'

# The node, with the few names of ROS that it uses: the same forces, in the same header.
mkdir -p ros/geometry_msgs
touch ros/geometry_msgs/__init__.py
cat >ros/geometry_msgs/msg.py <<'END'
from types import SimpleNamespace as N
def PoseStamped(stamp, x, y, z):
    return N(header=N(stamp=stamp, frame_id="base"), pose=N(position=N(x=x, y=y, z=z)))
class WrenchStamped:
    def __init__(self):
        self.header, self.wrench = None, N(force=N(x=0, y=0, z=0))
END
cat >ros/rospy.py <<'END'
import sys
from geometry_msgs.msg import PoseStamped
class Time:
    def __init__(self, t): self.t = t
    def __sub__(self, other): return Time(self.t - other.t)
    def to_sec(self): return self.t
parameters, callback, stopped = {}, [], []
def init_node(name):
    parameters.update(a[1:].split(":=") for a in sys.argv[1:])
def get_param(name, default): return parameters.get(name[1:], default)
class Publisher:
    def __init__(self, topic, kind, queue_size): pass
    def publish(self, w): print("%.9f,%r,%r,%r" % (w.header.stamp.t, w.wrench.force.x, w.wrench.force.y, w.wrench.force.z))
def Subscriber(topic, kind, call, queue_size, tcp_nodelay): callback.append(call)
def loginfo(words): pass
def logwarn(words): print(words, file=sys.stderr)
def signal_shutdown(why):
    stopped.append(why)
    print(why, file=sys.stderr)
def spin():
    for line in open("poses.csv"):
        if line[0] in "#t": continue
        if not stopped:
            t, x, y, z = map(float, line.split(","))
            callback[0](PoseStamped(Time(1.7e9 + t), x, y, z))
END
hs-import "$robot/press.bag" --tip-motion -q -o poses.csv || complain 'no poses'
node() { PYTHONPATH=ros python3 "$robot/live_node.py" "$@"; }
node _body:=body.ply _model:=model.csv _tool_radius:=4mm _contacts:=data.csv >node.csv 2>err || complain 'the node fails'
(($(wc -l <node.csv) == 160)) || complain 'the node does not answer every pose'
paste -d, <(grep '^[0-9]' forces.csv) node.csv | awk -F, '{ for (k = 0; k < 3; ++k) { d = $(9 + k) - $(15 + k); if (d * d > 1e-10) bad = 1 } }
  END { exit bad || NR != 160 }' || complain 'the node gives other forces'
node _body:=body.ply _tool_radius:=4mm >log 2>err
[[ $? == 1 && $(cat err) == 'live_node.py: the parameter ~model is not set; say _model:=...' ]] || complain 'a missing parameter'
node _body:=none.ply _model:=model.csv _tool_radius:=4mm >log 2>err && complain 'no body, and all is well'
grep -q 'none.ply: cannot be opened' err && grep -q '^live_node.py: hs-simulate ended with exit code' err && ! grep -q Traceback err || complain 'why the child ended'

# A child that dies at a pose (a position of 99 m) ends the node in words.
mv poses.csv ordered.csv
{ head -n 5 ordered.csv; echo 900,0,0,99; tail -n 5 ordered.csv; } >poses.csv
node _body:=body.ply _model:=model.csv _tool_radius:=4mm _contacts:=data.csv >log 2>err
[[ $? == 1 ]] && tail -n 1 err | grep -q '^live_node.py: hs-simulate ended with exit code 3$' && ! grep -q Traceback err ||
  complain 'a child that dies'
mv ordered.csv poses.csv

# What cannot be read.
refused() { # FILE WORDS
  hs-import "$1" -o never.csv >log 2>err
  local code=$?
  [[ $code == 3 && $(wc -l <err) == 1 && ! -s log && ! -e never.csv ]] || complain "$1: exit code $code, not 3 and one line"
  grep -qF -- "$2" err || complain "$1: not '$2'"
}
head -c 40000 "$robot/press.bag" >cut.bag
refused cut.bag "cut.bag: the bag is cut off: the record at byte "
refused cut.bag "; 'rosbag reindex cut.bag' keeps what is whole"
head -c 13 "$robot/press.bag" >begun.bag
refused begun.bag 'begun.bag: the bag is cut off'
{ printf '#ROSBAG V1.2\n'; tail -c +14 "$robot/press.bag"; } >old.bag
refused old.bag "old.bag: '#ROSBAG V1.2' is a bag of another version than 2.0; 'rosbag reindex old.bag' writes it as 2.0"
{ printf '#ROSBOG V2.0\n'; tail -c +14 "$robot/press.bag"; } >other.bag
refused other.bag 'other.bag'
damage() { # OFFSET BYTES: into wrong.bag
  cp "$robot/press.bag" wrong.bag
  printf "$2" | dd of=wrong.bag bs=1 seek="$1" conv=notrunc status=none
}
damage 13 '\xff\xff\xff\xff'
refused wrong.bag 'wrong.bag: the bag is cut off: the record at byte 13 does not end'
damage 17 '\xff\x00\x00\x00'
refused wrong.bag 'wrong.bag: the record at byte 13 is damaged: a field is longer than its header'
hs-import "$robot/press.bag" --topic /wrist -o never.csv 2>err
[[ $? == 3 ]] && grep -q "has no topic '/wrist'; it holds .*/wrench (geometry_msgs/WrenchStamped)" err || complain 'a topic that is not there'
hs-import data.csv --topic /wrench -o never.csv 2>err
[[ $? == 3 ]] && grep -q 'this is no bag of ROS; leave out --topic' err || complain '--topic of a table'
hs-import "$robot/press.bag" --tip-motion --scan s.csv -o never.csv 2>err
[[ $? == 2 ]] || complain '--tip-motion with --scan'
# What a motion has no use for is not dropped in silence.
motion() { # CODE WORDS ARGUMENTS...
  hs-import "${@:3}" --tip-motion -q -o never.csv >log 2>err
  [[ $? == "$1" && ! -e never.csv ]] && grep -qF -- "$2" err || complain "--tip-motion ${*:3}: not exit $1, '$2'"
}
for option in --rate=50 --split-by=force --estimate-noise=on --force=normal --drop-air --at=0,0,0.04 --contact=find --specimen=1; do
  motion 2 "--tip-motion makes no presses, ${option%%=*} is for them" "$robot/press.bag" "$option"
done
motion 2 "'/wrench' has forces, --tip-motion needs none" "$robot/press.bag" --topic /wrench --topic /tip_pose
motion 2 'needs the radius of the ball' "$robot/press.bag" --tip centre
motion 2 '--direction says where the tip is from the centre' "$robot/press.bag" --direction 0,0,-1
# Of a ball's centres the tip is a radius along the direction; the unit of a bag is the one that is told.
moved() { # TEST of the first x,y,z and those of poses.csv as a, b, c, and ARGUMENTS of hs-import
  hs-import "$robot/press.bag" --tip-motion "${@:2}" -q -o moved.csv 2>err || complain "--tip-motion ${*:2}"
  paste -d, <(grep '^[0-9]' poses.csv) <(grep '^[0-9]' moved.csv) | awk -F, 'function same(p, q) { p -= q; return p * p < 1e-18 }
    { a = $2; b = $3; c = $4; x = $6; y = $7; z = $8; if ($1 != $5 || !('"$1"')) bad = 1 } END { exit bad || NR != 160 }' ||
    complain "--tip-motion ${*:2}: not $1"
}
moved 'same(x, a) && same(y, b) && same(z, c - 0.004)' --tool sphere --tip centre --tool-radius 4mm
moved 'same(x, a + 0.004) && same(y, b) && same(z, c)' --tip centre --tool-radius 4mm --direction 2,0,0
moved 'same(x, a / 1000) && same(y, b / 1000) && same(z, c / 1000)' --unit mm
printf 't,tipx [m],tipy [m],tipz [m]\n0,0,0,0.04\n1,0,0,0.03\n' >named.csv
sed 's/0.04$/39/; s/0.03$/38.5/' named.csv >far.csv
motion 3 'a position of the tip is 39 m away; in millimetres it is 1000 times less: say --unit mm, or ' far.csv
sed 's/0.04$/2/' named.csv >wide.csv
motion 3 'the tip moves over 1.97 m; in millimetres it is 1000 times less: say --unit mm, or ' wide.csv
hs-import far.csv --tip-motion --yes -o far.out 2>err && grep -q 'WARNING: a position of the tip is 39 m away' err || complain '--yes of a size'
motion 3 'the positions are in m by their columns, not mm' named.csv --unit mm
printf '# units: mm\nt,tip_x,tip_y,tip_z\n0,0,0,0.5\n1,0,0,0.25\n' >comment.csv
hs-import comment.csv --tip-motion -q -o small.csv 2>err && tail -n 1 small.csv | grep -qx '1,0,0,0.00025' || complain 'a unit in a comment'
printf 't,x,y\n0,0,0\n1,0,0\n' >flat.csv
motion 3 'the positions of the tip have not all of x, y and z' flat.csv
((failures == 0)) && echo 'robot_bag: passed'
exit $((failures > 0))
