"""draw.py OUT NUMBER LENGTH SPREAD: a body whose modulus is a random field, as body-NUMBER.ply and truth-NUMBER.csv.

The logarithm of the modulus is a normal field of the standard deviation SPREAD that loses its correlation over
LENGTH [m], exp(-(d / LENGTH)^2), drawn by 400 random waves (Mantoglou and Wilson, Water Resour. Res. 18, 1982).
OUT/true.ply, a body of hs-tetmesh on a mesh of its own, gets 24 regions by its levels."""
import sys

import numpy as np

LEVELS, WAVES = 24, 400


def read_body(path):
    """Nodes, tetrahedra with their region, and where in the bytes these begin."""
    data = open(path, "rb").read()
    begin = data.index(b"end_header\n") + 11
    count = {w[1]: int(w[2]) for w in (l.split() for l in data[:begin].decode().split("\n")) if w[:1] == ["element"]}
    nodes = np.frombuffer(data, [("p", "<f8", 3), ("fixed", "u1")], count["vertex"], begin)
    at = begin + 25 * count["vertex"] + 13 * count["face"]
    kind = [("n", "u1"), ("v", "<i4", 4), ("region", "<i4")]
    kind += [(l.split()[2], "<f8") for l in data[:begin].decode().split("element tetrahedron")[1].split("\n")
             if l.startswith("property double")]
    return data, at, nodes["p"], np.frombuffer(data, kind, count["tetrahedron"], at)


class Field:
    def __init__(self, number, length, spread):
        random = np.random.default_rng(number)
        self.wave = random.normal(size=(WAVES, 3)) * np.sqrt(2) / length
        self.phase = random.uniform(0, 2 * np.pi, WAVES)
        self.spread = spread

    def __call__(self, p):
        return self.spread * np.sqrt(2 / WAVES) * np.cos(p @ self.wave.T + self.phase).sum(axis=1)


def main():
    out, number, length, spread = sys.argv[1], int(sys.argv[2]), float(sys.argv[3]), float(sys.argv[4])
    data, at, nodes, tets = read_body(f"{out}/true.ply")
    log_modulus = Field(number, length, spread)(nodes[tets["v"]].mean(axis=1))
    edges = np.linspace(-3 * spread, 3 * spread, LEVELS + 1) if spread > 0 else np.linspace(-1e-9, 1e-9, LEVELS + 1)
    level = np.clip(np.digitize(log_modulus, edges) - 1, 0, LEVELS - 1)
    used = np.unique(level)
    numbered = tets.copy()
    numbered["region"] = np.searchsorted(used, level)
    open(f"{out}/body-{number}.ply", "wb").write(data[:at] + numbered.tobytes())
    with open(f"{out}/truth-{number}.csv", "w") as f:
        f.write("effect,region,parameter,value,unit,std_error,lower,upper,state\n")
        for r, k in enumerate(used):
            f.write(f"elastic,{r},E,{1e4 * np.exp(0.5 * (edges[k] + edges[k + 1])):.6g},Pa,,1,1e12,free\n")
        f.write("elastic,0,nu,0.45,1,,0,0.499,fixed\n")


if __name__ == "__main__":
    main()
