"""multigrid.py BIN OUT [EDGE]: a press of a body's own mesh by hapsim's conjugate gradients, beside PETSc's.

The body is a block of 120 x 210 x 60 mm of tetrahedra of first order with that edge [m] (0.00195: a million),
held below; a bonded tool of 4 mm radius is moved 1 mm in x, y and z (three right-hand sides), at nu 0.3, 0.45
and 0.49. hapsim: hs-simulate --own-mesh --solver iterative on one thread, from the files to the forces.
PETSc (Debian's python3-petsc4py): conjugate gradients preconditioned by its GAMG with rigid motions as near
null space, and by hypre's BoomerAMG, on the assembled matrix of the free nodes: set-up and three solutions to
a relative residual of 1e-8, one thread; assembly, in numpy, is not counted. The forces of both are compared.
Seconds are of the processor; memory is the largest of the process, PETSc's with Python's assembly in it.
Recorded in bench/results/multigrid.txt (bench/record.sh).
"""
import glob
import os
import resource
import subprocess
import sys
import time

import numpy as np

sys.path += glob.glob("/usr/lib/petscdir/petsc*/*-real/lib/python3/dist-packages")  # where no alternative is set
import petsc4py  # noqa: E402

petsc4py.init(["multigrid"])
from petsc4py import PETSc  # noqa: E402

SIZE = (0.12, 0.21, 0.06)
CONTACT, RADIUS, MOVE = np.array([0.05, 0.1, 0.06]), 0.004, 1e-3
HERE = os.path.dirname(os.path.abspath(__file__))


def run(command, **more):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    process = subprocess.Popen(command, **more)
    _, status, used = os.wait4(process.pid, 0)
    if status:
        sys.exit("multigrid.py: failed: " + " ".join(command))
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def make_body(binaries, out, edge):
    path = "%s/body-%g.ply" % (out, edge)
    if not os.path.exists(path):
        off = out + "/block.off"
        with open(off, "w") as file:
            run(["awk", "-v", "what=cuboid", "-v", "a=%g" % SIZE[0], "-v", "b=%g" % SIZE[1], "-v", "c=%g" % SIZE[2],
                 "-f", HERE + "/../../share/examples/shapes.awk"], stdout=file)
        run([binaries + "/hs-tetmesh", "-q", off, "--edge", str(edge), "-o", path])
    return path


def read_body(path):
    with open(path, "rb") as file:
        counts = {}
        for line in iter(file.readline, b"end_header\n"):
            words = line.split()
            if words[0] == b"element":
                counts[words[1].decode()] = int(words[2])
        nodes = np.fromfile(file, np.dtype("3<f8,u1"), counts["vertex"])
        file.seek(13 * counts["face"], 1)
        tets = np.fromfile(file, np.dtype([("n", "u1"), ("tet", "<i4", 4), ("region", "<i4")]), counts["tetrahedron"])
    return nodes["f0"].copy(), nodes["f1"] != 0, tets["tet"].copy()


def surface_nodes_under(points, tets):
    """Free nodes of the top within the radius about the node next to the contact."""
    top = np.flatnonzero(points[:, 2] > SIZE[2] - 1e-9)
    nearest = points[top[np.argmin(np.linalg.norm(points[top] - CONTACT, axis=1))]]
    return nearest, top[np.linalg.norm(points[top] - nearest, axis=1) <= RADIUS]


def stiffness(points, tets, nu, modulus=1e4):
    """Blocks of 3 x 3 by pairs of nodes: rows, columns, blocks, in the order of rows and columns."""
    mu, lame = modulus / (2 * (1 + nu)), modulus * nu / ((1 + nu) * (1 - 2 * nu))
    a, b, c, d = (points[tets[:, k]] for k in range(4))
    edges = np.stack([b - a, c - a, d - a], axis=1)
    volume = np.abs(np.linalg.det(edges)) / 6
    gradient = np.zeros((len(tets), 4, 3))
    gradient[:, 1:] = np.linalg.inv(edges).transpose(0, 2, 1)
    gradient[:, 0] = -gradient[:, 1:].sum(axis=1)
    del a, b, c, d, edges
    count = len(points)
    keys = (tets[:, :, None].astype(np.int64) * count + tets[:, None, :]).ravel()
    unique, where = np.unique(keys, return_inverse=True)
    del keys
    blocks = np.empty((len(unique), 3, 3))
    dot = np.einsum("tik,tjk->tij", gradient, gradient)
    for r in range(3):
        for s in range(3):
            entry = lame * gradient[:, :, None, r] * gradient[:, None, :, s] + mu * gradient[:, :, None, s] * gradient[:, None, :, r]
            if r == s:
                entry += mu * dot
            blocks[:, r, s] = np.bincount(where, (volume[:, None, None] * entry).ravel(), len(unique))
    return (unique // count).astype(np.int64), (unique % count).astype(np.int64), blocks


def free_system(points, fixed, under, pairs):
    rows, columns, blocks = pairs
    free = ~fixed
    free[under] = False
    number = np.cumsum(free) - 1
    tool = np.zeros(len(points), bool)
    tool[under] = True
    inside = free[rows] & free[columns]
    count = int(free.sum())
    i, j, B = number[rows[inside]], number[columns[inside]], blocks[inside]
    starts = np.searchsorted(i, np.arange(count + 1))
    loads = np.zeros((count, 3, 3))  # node, component, direction of the tool
    across = free[rows] & tool[columns]
    np.add.at(loads, number[rows[across]], -MOVE * blocks[across])
    return count, free, tool, number, starts, j, B, loads.reshape(3 * count, 3)


def scalar_matrix(count, starts, j, B):
    lengths = np.diff(starts)
    indptr = np.zeros(3 * count + 1, PETSc.IntType)
    indptr[1:] = np.cumsum(np.repeat(3 * lengths, 3))
    order = np.repeat(np.arange(count), lengths)
    values, columns = np.empty(9 * len(j)), np.empty(9 * len(j), PETSc.IntType)
    within = np.arange(len(j)) - starts[order]
    for r in range(3):
        at = indptr[3 * order + r] + 3 * within
        for s in range(3):
            values[at + s], columns[at + s] = B[:, r, s], 3 * j + s
    matrix = PETSc.Mat().createAIJ((3 * count, 3 * count), bsize=3, csr=(indptr, columns, values), comm=PETSc.COMM_SELF)
    matrix.setOption(PETSc.Mat.Option.SPD, True)
    return matrix


OPTIONS = {
    "GAMG": "-pc_type gamg -pc_gamg_threshold 0.01 -mg_levels_ksp_type chebyshev -mg_levels_pc_type jacobi",
    "hypre": "-pc_type hypre -pc_hypre_type boomeramg -pc_hypre_boomeramg_strong_threshold 0.5 "
             "-pc_hypre_boomeramg_coarsen_type HMIS -pc_hypre_boomeramg_interp_type ext+i -pc_hypre_boomeramg_P_max 4",
}


def petsc(name, matrix, loads, points):
    for option in (OPTIONS[name] + " -ksp_type cg -ksp_rtol 1e-8 -ksp_max_it 2000").split(" -"):
        key, _, value = option.lstrip("-").partition(" ")
        PETSc.Options().setValue(key, value)
    if name == "GAMG":
        near = PETSc.Vec().createSeq(points.size)
        near.setBlockSize(3)
        near.array = points.ravel()
        matrix.setNearNullSpace(PETSc.NullSpace().createRigidBody(near))
    solver = PETSc.KSP().create(PETSc.COMM_SELF)
    solver.setOperators(matrix)
    solver.setFromOptions()
    begin = time.process_time()
    solver.setUp()
    middle = time.process_time()
    x, y, iterations = matrix.createVecRight(), matrix.createVecLeft(), 0
    fields = []
    for k in range(3):
        y.array = loads[:, k]
        solver.solve(y, x)
        if solver.getConvergedReason() < 0:
            return None, middle - begin, time.process_time() - middle, 0
        iterations = max(iterations, solver.getIterationNumber())
        fields.append(x.array.copy())
    end = time.process_time()
    solver.destroy()
    PETSc.Options().clear()
    return np.stack(fields, axis=1), middle - begin, end - middle, iterations


def tool_forces(fields, free, tool, number, pairs):
    """On the tool, by direction: 3 x 3."""
    rows, columns, blocks = pairs
    of_tool = tool[rows]
    r, c, B = rows[of_tool], columns[of_tool], blocks[of_tool]
    u = np.zeros((len(c), 3, 3))
    u[tool[c]] = MOVE * np.eye(3)
    if fields is not None:
        moved = free[c]
        u[moved] = fields.reshape(-1, 3, 3)[number[c[moved]]]
    return -np.einsum("nrs,nsk->rk", B, u)


def hapsim(binaries, body, out, contact, nu):
    motion, model, forces = out + "/motion.csv", out + "/model.csv", out + "/forces.csv"
    with open(motion, "w") as file:
        file.write("press,t,x,y,z,ux,uy,uz\n")
        for k in range(3):
            u = [MOVE * (k == i) for i in range(3)]
            file.write("%d,%d,%.17g,%.17g,%.17g,%g,%g,%g\n" % (k, k, *contact, *u))
    with open(model, "w") as file:
        file.write("effect,region,parameter,value\nelastic,0,E,10000\nelastic,0,nu,%g\n" % nu)
    seconds, memory = run([binaries + "/hs-simulate", "-q", motion, "--body", body, "--model", model, "--own-mesh", "--solver",
                           "iterative", "--tool-radius", str(RADIUS), "--threads", "1", "--cache", "none", "-o", forces],
                          env=dict(os.environ, OPENBLAS_NUM_THREADS="1"))
    with open(forces) as file:
        rows = [line.strip().split(",") for line in file if not line.startswith("#")]
    at = [rows[0].index(c) for c in ("fx", "fy", "fz")]
    return seconds, memory, np.array([[float(r[c]) for r in rows[1:]] for c in at])


def main():
    binaries, out = sys.argv[1], sys.argv[2]
    edge = float(sys.argv[3]) if len(sys.argv) > 3 else 0.00195
    os.makedirs(out, exist_ok=True)
    body = make_body(binaries, out, edge)
    points, fixed, tets = read_body(body)
    contact, under = surface_nodes_under(points, tets)
    print("%d tetrahedra, %d nodes, %d under the tool" % (len(tets), len(points), len(under)))
    print("%-5s %-7s %8s %8s %8s %7s %5s %9s %6s" % ("nu", "by", "set-up", "solve", "all_s", "MB", "its", "force", "ratio"))
    ratios = (0.3, 0.45, 0.49)
    # Before this process is large: the largest memory of what it calls counts from its own size.
    of_hapsim = [hapsim(binaries, body, out, contact, nu) for nu in ratios]
    for nu, (seconds, memory, ours) in zip(ratios, of_hapsim):
        print("%-5g %-7s %8s %8s %8.1f %7.0f" % (nu, "hapsim", "", "", seconds, memory), flush=True)
        pairs = stiffness(points, tets, nu)
        count, free, tool, number, starts, j, B, loads = free_system(points, fixed, under, pairs)
        matrix = scalar_matrix(count, starts, j, B)
        for name in OPTIONS:
            fields, setup, solve, iterations = petsc(name, matrix, loads, points[free])
            peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
            if fields is None:
                print("%-5g %-7s %8.1f %8.1f %8s" % (nu, name, setup, solve, "not in 2000 iterations"), flush=True)
                continue
            theirs = tool_forces(fields, free, tool, number, pairs)
            off = np.abs(theirs - ours).max() / np.abs(theirs).max()
            print("%-5g %-7s %8.1f %8.1f %8.1f %7.0f %5d %9.1e %6.2f" % (
                nu, name, setup, solve, setup + solve, peak, iterations, off, (setup + solve) / seconds), flush=True)
        del matrix


if __name__ == "__main__":
    main()
