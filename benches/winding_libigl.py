"""libigl's winding numbers beside ours, on the same mesh and the same 128^3 points.

    cargo run --release -p seeone-sim --example winding_grid -- cap-train-000 out/winding
    python3 -m venv out/venv && out/venv/bin/pip install libigl
    OMP_NUM_THREADS=1 taskset -c 0 out/venv/bin/python benches/winding_libigl.py out/winding

The first command prints our time. This one prints the time of libigl's exact and of its
fast, approximate version, and how far each lies from our numbers.
"""

import sys
import time
from pathlib import Path

import igl
import numpy as np

VOXELS = 128


def read_obj(path):
    """Vertices (n x 3) and triangles (m x 3) of an OBJ file."""
    rows = [line.split() for line in path.read_text().splitlines()]
    vertices = [[float(x) for x in row[1:]] for row in rows if row[0] == "v"]
    triangles = [[int(i) - 1 for i in row[1:]] for row in rows if row[0] == "f"]
    return np.array(vertices), np.array(triangles, dtype=np.int64)


def main():
    folder = Path(sys.argv[1])
    vertices, triangles = read_obj(folder / "mesh.obj")
    ours = np.fromfile(folder / "winding.f64", dtype="<f8")
    centres = (np.arange(VOXELS) + 0.5) / VOXELS
    points = np.stack(np.meshgrid(centres, centres, centres, indexing="ij"), -1).reshape(-1, 3)
    print(f"{len(vertices)} vertices, {len(triangles)} triangles, {len(points)} points")
    for name, function in [
        ("exact", igl.winding_number),
        ("fast", igl.fast_winding_number),
    ]:
        start = time.perf_counter()
        theirs = np.asarray(function(vertices, triangles, points)).ravel()
        seconds = time.perf_counter() - start
        difference = np.abs(theirs - ours)
        print(
            f"libigl {name:5}: {seconds:6.2f} s, from ours: "
            f"largest {difference.max():.1e}, mean {difference.mean():.1e}"
        )


if __name__ == "__main__":
    main()
