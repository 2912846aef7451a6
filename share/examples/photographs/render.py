"""Photographs of a body that is known, to try photographs.sh on: render.py FOLDER [COUNT [WIDTH]].

Half an ellipsoid (half axes 50, 40, 30 mm), textured, on a sheet of A4 whose corners are the marks. Writes
FOLDER/photographs/NN.png, marks.csv (the corners in every third, as somebody would click them: to half a pixel) and
sheet.csv (where they are on the sheet). Needs numpy.
"""
import os
import struct
import sys
import zlib

import numpy as np

AXES = np.array([0.05, 0.04, 0.03])
SHEET = np.array([0.297, 0.21])
CORNERS = {"a": (-0.5, -0.5), "b": (0.5, -0.5), "c": (0.5, 0.5), "d": (-0.5, 0.5)}


CHANCE = np.random.default_rng(3).random(1 << 16)


def blocks(p, cell, seed):
    """Values from 0 to 1, one in each cube of edge `cell` [m], at points p, count x 3."""
    q = np.floor(p / cell + 0.5).astype(np.int64)  # no boundary on the plane z = 0
    h = (q[:, 0] * 73856093) ^ (q[:, 1] * 19349663) ^ (q[:, 2] * 83492791) ^ seed * 2654435761
    return CHANCE[(h ^ h >> 15) & 0xFFFF]


def texture(p, seed):
    return 0.35 * blocks(p, 0.0047, seed) + 0.35 * blocks(p, 0.0021, seed + 1) + 0.3 * blocks(p, 0.0011, seed + 2)


def look(eye, at):
    """Rows: the camera's right, down and ahead."""
    ahead = (at - eye) / np.linalg.norm(at - eye)
    right = np.cross(ahead, [0, 0, 1])
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(ahead, right), ahead])


def brightness(eye, rays):
    """Of what each ray meets: the body, the sheet, or the dark."""
    value = np.full(len(rays), 0.1)
    a = np.sum((rays / AXES) ** 2, axis=1)
    b = np.sum(rays / AXES * (eye / AXES), axis=1)
    root = b * b - a * (np.sum((eye / AXES) ** 2) - 1)
    s = (-b - np.sqrt(np.maximum(root, 0))) / a
    body = (root > 0) & (eye[2] + s * rays[:, 2] > 0)
    p = eye + s[body, None] * rays[body]
    normal = p / AXES**2
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    value[body] = (0.25 + 0.9 * texture(p, 7)) * (0.7 + 0.3 * np.abs(normal @ [0.3, 0.2, 0.93]))
    s = -eye[2] / rays[:, 2]
    q = eye + s[:, None] * rays
    sheet = ~body & (rays[:, 2] < 0) & (np.abs(q[:, 0]) < SHEET[0] / 2) & (np.abs(q[:, 1]) < SHEET[1] / 2)
    value[sheet] = 0.35 + 0.6 * texture(q[sheet], 40)
    return value


def write_png(path, grey):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + row.tobytes() for row in grey)
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", grey.shape[1], grey.shape[0], 8, 0, 0, 0, 0))
                  + chunk(b"IDAT", zlib.compress(rows, 6)) + chunk(b"IEND", b""))


def main():
    folder = sys.argv[1]
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 36
    width = int(sys.argv[3]) if len(sys.argv) > 3 else 1000
    height, focus = width * 3 // 4, 0.95 * width
    os.makedirs(folder + "/photographs", exist_ok=True)
    chance, clicks = np.random.default_rng(5), np.random.default_rng(9)
    marks = []
    for n in range(count):
        turn, up, far = 2 * np.pi * n / count * 2, np.radians(28 if n < count / 2 else 55), 0.36
        eye = far * np.array([np.cos(up) * np.cos(turn), np.cos(up) * np.sin(turn), np.sin(up)])
        axes = look(eye, np.array([0, 0, 0.01]) + 0.01 * chance.standard_normal(3))
        grey = np.zeros(width * height)
        v, u = np.mgrid[0:height, 0:width]
        for du, dv in ((0.25, 0.25), (0.75, 0.25), (0.25, 0.75), (0.75, 0.75)):
            rays = np.stack([(u.ravel() + du - width / 2) / focus, (v.ravel() + dv - height / 2) / focus,
                             np.ones(width * height)], axis=1) @ axes
            grey += brightness(eye, rays) / 4
        grey = 255 * grey + 2 * chance.standard_normal(len(grey))
        name = "%02d.png" % n
        write_png(folder + "/photographs/" + name, np.clip(grey, 0, 255).astype(np.uint8).reshape(height, width))
        if n % 3 != 0:
            continue
        for mark, (x, y) in CORNERS.items():
            p = axes @ (np.array([x * SHEET[0], y * SHEET[1], 0]) - eye)
            at = focus * p[:2] / p[2] + [width / 2, height / 2]
            if 0 < at[0] < width and 0 < at[1] < height:
                marks.append("%s,%s,%.1f,%.1f" % (mark, name, *(at + 0.5 * clicks.standard_normal(2))))
    with open(folder + "/marks.csv", "w") as out:
        out.write("mark,photograph,u,v\n" + "\n".join(marks) + "\n")
    with open(folder + "/sheet.csv", "w") as out:
        out.write("mark,x,y,z\n")
        for mark, (x, y) in CORNERS.items():
            out.write("%s,%g,%g,0\n" % (mark, x * SHEET[0], y * SHEET[1]))


if __name__ == "__main__":
    main()
