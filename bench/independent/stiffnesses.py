"""stiffnesses.py OUT BODY RADIUS VARIANT...: contact stiffness of every place by CalculiX.

Kept in OUT/stiffness/BODY-RADIUS/VARIANT-PLACE.txt, and not computed again."""
import concurrent.futures
import pathlib
import sys
import tempfile

import numpy as np

import bodies
import calculix
import meshes
import variants


def file_of(out, body, radius, variant, k):
    return pathlib.Path(out) / "stiffness" / ("%s-%g" % (body, radius)) / ("%s-%02d.txt" % (variant, k))


def solve_place(out, body, radius, names, k):
    names = [v for v in names if not file_of(out, body, radius, v, k).exists()]
    if not names:
        return
    middle, ball, _ = variants.INCLUSION[body]
    with tempfile.TemporaryDirectory(prefix="hapsim-bench-") as folder:
        folder = pathlib.Path(folder)
        mesh = None
        for name in sorted(names, key=lambda n: n == "layer"):
            if mesh is None or name == "layer":
                skin = variants.SKIN[body][0] if name == "layer" else 0.0
                mesh = meshes.Mesh(body, bodies.places(body)[k], radius, folder, (middle, ball, ball / 3),
                                   growth=0.3, skin=skin, quarter_points=True)
            K = calculix.stiffness(folder, mesh, *variants.build(name, body, mesh))
            target = file_of(out, body, radius, name, k)
            target.parent.mkdir(parents=True, exist_ok=True)
            part = target.with_suffix(".part")
            np.savetxt(part, K)
            part.rename(target)
    print(body, radius, k, *names, flush=True)


def load(out, body, radius, variant):
    """(12, 3, 3) [N/m]: force on the tool = -K u."""
    return np.array([np.loadtxt(file_of(out, body, radius, variant, k)) for k in range(len(bodies.places(body)))])


if __name__ == "__main__":
    out, body, radius, names = sys.argv[1], sys.argv[2], float(sys.argv[3]), sys.argv[4:]
    with concurrent.futures.ProcessPoolExecutor(2) as pool:
        list(pool.map(solve_place, *zip(*[(out, body, radius, names, k) for k in range(len(bodies.places(body)))])))
