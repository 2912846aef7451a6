"""A node of ROS 1 that answers poses of a tool with the forces of a model.

hs-simulate --live is its child: a line t,x,y,z [s, m] in, a line with the force [N] out, before the next pose is
read. In the frame of the body, which the poses must be in.

    python3 live_node.py _body:=body.ply _model:=model.csv _tool_radius:=4mm tip_pose:=/tip_pose

Subscribes to tip_pose (geometry_msgs/PoseStamped), publishes force (geometry_msgs/WrenchStamped: of the body on the
tool). ~contacts may name a recording whose contact positions are solved finely before the first pose.
"""
import subprocess
import sys

import rospy
from geometry_msgs.msg import PoseStamped, WrenchStamped


class Forces:
    """The child: made ready when it is constructed, which may take a minute."""

    def __init__(self, arguments):
        self.child = subprocess.Popen(["hs-simulate", "--live", "-q", *arguments], stdin=subprocess.PIPE,
                                      stdout=subprocess.PIPE, universal_newlines=True, bufsize=1)
        self.child.stdin.write("t,x,y,z\n")
        line = "#"
        while line.startswith("#"):
            line = self._read()
        self.columns = line.split(",")

    def _read(self):
        line = self.child.stdout.readline()
        if not line:  # it has said why on standard error
            raise RuntimeError("hs-simulate ended with exit code %d" % self.child.wait())
        return line.rstrip("\n")

    def at(self, t, x, y, z):
        """The answer's columns by name: press, fx, fy, fz, beyond, ..."""
        self.child.stdin.write("%.9f,%.9g,%.9g,%.9g\n" % (t, x, y, z))
        return dict(zip(self.columns, map(float, self._read().split(","))))

    def close(self):
        try:
            self.child.stdin.close()
        except OSError:  # it has ended before
            pass
        return self.child.wait()


def main():
    rospy.init_node("hapsim")
    arguments = []
    for name in ("body", "model", "tool_radius", "contacts"):
        value = rospy.get_param("~" + name, None)
        if value is None and name != "contacts":
            sys.exit("live_node.py: the parameter ~%s is not set; say _%s:=..." % (name, name))
        if value is not None:
            arguments += ["--" + name.replace("_", "-"), str(value)]
    try:
        forces = Forces(arguments)
    except (RuntimeError, OSError) as failure:
        sys.exit("live_node.py: %s" % failure)
    publisher = rospy.Publisher("force", WrenchStamped, queue_size=1)
    begin = []
    told = []
    failed = []

    def answer(pose):
        if not begin:
            begin.append(pose.header.stamp)
        at = pose.pose.position
        try:
            row = forces.at((pose.header.stamp - begin[0]).to_sec(), at.x, at.y, at.z)
        except (RuntimeError, OSError) as failure:
            failed.append(True)
            rospy.signal_shutdown(str(failure))
            return
        if row["beyond"] and not told:
            told.append(True)
            rospy.logwarn("a force is beyond what the model is known for: %d (hs-simulate(1))", int(row["beyond"]))
        wrench = WrenchStamped()
        wrench.header = pose.header
        wrench.wrench.force.x, wrench.wrench.force.y, wrench.wrench.force.z = row["fx"], row["fy"], row["fz"]
        publisher.publish(wrench)

    # One pose waits at most: a force for a pose that is long gone helps nobody.
    rospy.Subscriber("tip_pose", PoseStamped, answer, queue_size=1, tcp_nodelay=True)
    rospy.loginfo("ready")
    rospy.spin()
    code = forces.close()
    if failed:
        sys.exit("live_node.py: hs-simulate ended with exit code %d" % code)


if __name__ == "__main__":
    main()
