"""Points of a COLMAP model in metres and in the frame of known marks.

    scale_points.py MODEL MARKS KNOWN [--above Z] [--beside METRES] [--track N] [--error PIXELS] > points.csv

MODEL: a folder with cameras.txt, images.txt and points3D.txt (colmap model_converter --output_type TXT). MARKS: a table
mark,photograph,u,v of marks that somebody saw in two photographs or more [pixels from the left and the top edge]. KNOWN: a
table mark,x,y,z of where they are [m], three or more not on one line: the points are turned into that frame. With two the
length between them gives the scale alone.

--above: leaves out what lies lower [m], the support on which the body stands. --beside: leaves out what is farther than
that from the marks' middle, to the side. Both are of the frame of three marks, and refused with two. --track: of how many
photographs a point must be (3). --error: the largest reprojection error of a point (1.5 pixels). Standard error says how
well the marks fit. Needs numpy.
"""
import argparse
import csv
import math
import sys

import numpy as np

# Of COLMAP's camera models: how many of its numbers are focal lengths, and how many distort radially.
CAMERAS = {"SIMPLE_PINHOLE": (1, 0), "PINHOLE": (2, 0), "SIMPLE_RADIAL": (1, 1), "RADIAL": (1, 2)}


def fail(words, code=3):
    print("scale_points.py: " + words, file=sys.stderr)
    raise SystemExit(code)


def lines(path):
    """Lines of a file of COLMAP, without comments; empty ones stay, where they mean an image without points."""
    try:
        with open(path) as text:
            return [line.rstrip("\n") for line in text if not line.startswith("#")]
    except OSError as failure:
        fail("%s: %s; convert the model to text first" % (path, failure.strerror), 5)


def numbers(path, line, words):
    try:
        values = [float(word) for word in words]
    except ValueError:
        values = [math.nan]
    if not all(map(math.isfinite, values)):
        fail("%s: %r is no row of a COLMAP model; convert it by colmap model_converter" % (path, line[:40]))
    return values


def read_cameras(path):
    cameras = {}
    for line in filter(None, lines(path)):
        words = line.split()
        if len(words) < 5 or words[1] not in CAMERAS:
            fail("%s: a camera of the model %s; extract features with --ImageReader.camera_model SIMPLE_RADIAL"
                 % (path, words[1] if len(words) > 1 else "?"))
        values = numbers(path, line, words[4:])
        if len(values) != 2 + sum(CAMERAS[words[1]]) or not all(values[:CAMERAS[words[1]][0]]):
            fail("%s: %r is no row of a camera %s; convert it by colmap model_converter" % (path, line[:40], words[1]))
        cameras[words[0]] = (words[1], values)
    return cameras


def rotation(q):
    w, x, y, z = np.array(q) / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def read_images(path):
    """By name: rotation from the world to the camera, translation, camera."""
    images = {}
    for line in lines(path)[::2]:  # every second line has the image's points
        words = line.split()
        if len(words) < 10:
            continue
        pose = numbers(path, line, words[1:8])
        images[" ".join(words[9:])] = (rotation(pose[:4]), np.array(pose[4:]), words[8])
    return images


def direction(camera, u, v):
    """Of the ray of a pixel, in the camera's frame (x right, y down, z ahead)."""
    model, values = camera
    focal, radial = CAMERAS[model]
    centre = values[focal:focal + 2]
    distorted = np.array([(u - centre[0]) / values[0], (v - centre[1]) / values[focal - 1]])
    k = (values[focal + 2:focal + 2 + radial] + [0, 0])[:2]
    plain = distorted
    for _ in range(50):
        r2 = plain @ plain
        plain = distorted / (1 + k[0] * r2 + k[1] * r2 * r2)
    return np.array([plain[0], plain[1], 1])


def table(path, columns):
    try:
        with open(path, newline="") as text:
            rows = list(csv.DictReader(line for line in text if not line.startswith("#")))
    except OSError as failure:
        fail("%s: %s" % (path, failure.strerror), 5)
    for number, row in enumerate(rows, 1):
        for name in columns[0]:
            if not row.get(name):
                fail("%s: row %d has no %s; its columns are %s" % (path, number, name, ",".join(sum(columns, []))))
        for name in columns[1]:
            try:
                row[name] = float(row[name])
            except (TypeError, ValueError, KeyError):
                row[name] = math.nan
            if not math.isfinite(row[name]):
                fail("%s: row %d has no number %s; its columns are %s" % (path, number, name, ",".join(sum(columns, []))))
    return rows


def triangulate(rays):
    """The point nearest to all rays (origin, direction)."""
    A, b = np.zeros((3, 3)), np.zeros(3)
    for origin, along in rays:
        across = np.eye(3) - np.outer(along, along) / (along @ along)
        A += across
        b += across @ origin
    if np.linalg.cond(A) > 1e8:
        return None
    return np.linalg.solve(A, b)


def similarity(source, target):
    """s, R, t with target = s R source + t, least squares: Umeyama, IEEE PAMI 13, 1991."""
    a, b = source - source.mean(0), target - target.mean(0)
    U, S, V = np.linalg.svd(b.T @ a)
    flip = np.diag([1, 1, np.sign(np.linalg.det(U @ V))])
    R = U @ flip @ V
    s = np.trace(np.diag(S) @ flip) / np.sum(a * a)
    return s, R, target.mean(0) - s * R @ source.mean(0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("model")
    parser.add_argument("marks")
    parser.add_argument("known")
    parser.add_argument("--above", type=float)
    parser.add_argument("--beside", type=float)
    parser.add_argument("--track", type=int, default=3)
    parser.add_argument("--error", type=float, default=1.5)
    asked = parser.parse_args()

    cameras = read_cameras(asked.model + "/cameras.txt")
    images = read_images(asked.model + "/images.txt")
    known = {row["mark"]: np.array([row["x"], row["y"], row["z"]])
             for row in table(asked.known, (["mark"], ["x", "y", "z"]))}
    rays, lost = {}, set()
    for row in table(asked.marks, (["mark", "photograph"], ["u", "v"])):
        if row["mark"] not in known:
            fail("%s: the mark %s is not in %s" % (asked.marks, row["mark"], asked.known))
        if row["photograph"] not in images:  # COLMAP has found no place for it
            lost.add(row["photograph"])
            continue
        R, t, camera = images[row["photograph"]]
        if camera not in cameras:
            fail("%s/images.txt: the camera %s is not in cameras.txt" % (asked.model, camera))
        rays.setdefault(row["mark"], []).append((-R.T @ t, R.T @ direction(cameras[camera], row["u"], row["v"])))
    if lost:
        print("scale_points.py: not in the model, their marks are left out: " + ", ".join(sorted(lost)), file=sys.stderr)
    seen = {}
    for mark, its in rays.items():
        point = triangulate(its) if len(its) > 1 else None
        if point is not None:
            seen[mark] = point
    names = sorted(seen)
    if len(names) < 2:
        fail("%s: fewer than two marks are in two photographs of the model; mark more" % asked.marks)
    source = np.array([seen[name] for name in names])
    target = np.array([known[name] for name in names])
    if len(names) == 2:
        s, R, t = np.linalg.norm(target[1] - target[0]) / np.linalg.norm(source[1] - source[0]), np.eye(3), np.zeros(3)
        print("scale_points.py: two marks: the scale alone; nothing says how good it is", file=sys.stderr)
        if asked.above is not None or asked.beside is not None:  # COLMAP's frame knows neither up nor the side
            fail("two marks give no frame for --above and --beside; mark a third, or leave both out (photographs.sh: "
                 "ABOVE= BESIDE=) and cut the body from the support yourself")
    else:
        if np.linalg.svd(target - target.mean(0))[1][1] < 1e-3 * np.linalg.norm(target - target.mean(0)):
            fail("%s: the marks lie on one line; use three that do not" % asked.known)
        s, R, t = similarity(source, target)
        off = np.linalg.norm(s * source @ R.T + t - target, axis=1)
        print("scale_points.py: %d marks, %.2f mm off (root mean square), %s by %.2f mm at most"
              % (len(names), 1e3 * np.sqrt(np.mean(off**2)), names[int(np.argmax(off))], 1e3 * off.max()), file=sys.stderr)

    path = asked.model + "/points3D.txt"
    middle = target.mean(0)
    kept = total = 0
    print("x,y,z")
    for line in filter(None, lines(path)):
        words = line.split()
        values = numbers(path, line, words[1:8])
        if len(values) < 7:
            fail("%s: %r is no row of a COLMAP model; convert it by colmap model_converter" % (path, line[:40]))
        total += 1
        p = s * R @ np.array(values[:3]) + t
        if (values[6] > asked.error or (len(words) - 8) // 2 < asked.track
                or (asked.above is not None and p[2] < asked.above)
                or (asked.beside is not None and np.hypot(*(p - middle)[:2]) > asked.beside)):
            continue
        kept += 1
        print("%.6f,%.6f,%.6f" % tuple(p))
    print("scale_points.py: %d of %d points" % (kept, total), file=sys.stderr)
    if kept == 0:
        fail("no point is left; see --above, --beside, --track and --error")


if __name__ == "__main__":
    main()
