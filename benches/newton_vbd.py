"""A cap in Newton's VBD: how many seconds of it Newton simulates in a second of one core.

    cargo run --release -p seeone-sim --example winding_grid -- cap-train-024 out/peer
    cargo bench -p seeone-sim --bench world -- --quick 1029
    python3 -m venv out/venv && out/venv/bin/pip install newton
    taskset -c 0 out/venv/bin/python benches/newton_vbd.py out/peer/mesh.obj

The scene is that of `mujoco_flex.py`: the cap's worn shape as a mesh of about 1,000 vertices falls
from 0.12 m onto the ground, upside down, without and with self-contact; speed is counted while it
falls and then where it lies crumpled. Steps and iterations are those of Newton's own examples of
cloth, 600 a second and 10 each. Its cloth knows one stiffness for the whole: this one is as stiff
as fabric, and its visor bends. Kernels are compiled before anything is timed.
"""

import sys
import time

import newton
import numpy as np
import warp as wp

LENGTH_M = 0.27
HEIGHT_M = 0.12
MASS_KG = 0.09
THICKNESS_M = 0.003
STEP_S = 1 / 600
ITERATIONS = 10
CRUMPLED_S = 1.0
MEASURED_S = 0.25
# Lame's constants times thickness of the fabric in `mujoco_flex.py` (E t 1 kN/m, nu 0.2), and
# its bending: an edge has sqrt(3) B / l by its angle, which Newton counts by the edge's length l.
SHEAR_N_M, AREA_N_M = 417.0, 278.0
BENDING_N = 0.0125


def read_obj(path):
    """Vertices (n x 3) and triangles (m x 3) of an OBJ file."""
    with open(path, encoding="ascii") as file:
        rows = [line.split() for line in file]
    vertices = [[float(x) for x in row[1:]] for row in rows if row[0] == "v"]
    triangles = [[int(i) - 1 for i in row[1:]] for row in rows if row[0] == "f"]
    return np.array(vertices), np.array(triangles)


def upside_down(vertices):
    """The cap in metres, its crown down and its lowest point at `HEIGHT_M`."""
    vertices = vertices * (LENGTH_M / np.ptp(vertices, axis=0).max()) * [1, -1, -1]
    return vertices + [0, 0, HEIGHT_M - vertices[:, 2].min()]


def area(vertices, triangles):
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


class Fall:
    """The cap above the ground, and how long it has been simulated."""

    def __init__(self, vertices, triangles, self_contact):
        builder = newton.ModelBuilder()
        builder.add_cloth_mesh(
            pos=wp.vec3(),
            rot=wp.quat_identity(),
            scale=1.0,
            vel=wp.vec3(),
            vertices=[wp.vec3(*v) for v in vertices],
            indices=triangles.ravel().tolist(),
            density=MASS_KG / area(vertices, triangles),
            tri_ke=SHEAR_N_M,
            tri_ka=AREA_N_M,
            tri_kd=1e-3,
            edge_ke=BENDING_N,
            edge_kd=1e-3,
            particle_radius=THICKNESS_M / 2,
        )
        builder.color(include_bending=True)
        builder.add_ground_plane()
        model = builder.finalize(device="cpu")
        model.soft_contact_ke, model.soft_contact_kd, model.soft_contact_mu = 1e3, 1e-3, 0.5
        self.solver = newton.solvers.SolverVBD(
            model,
            iterations=ITERATIONS,
            particle_enable_self_contact=self_contact,
            particle_self_contact_margin=THICKNESS_M,
            particle_self_contact_gap=THICKNESS_M / 2,
            particle_rest_shape_contact_exclusion_radius=2 * THICKNESS_M,
            collision_pipeline=newton.CollisionPipeline(model, soft_contact_gap=0.01),
        )
        self.control = model.control()
        self.now, self.next = model.state(), model.state()
        self.time_s = 0.0

    def until(self, end_s):
        """Simulated seconds a second of this process until `end_s`."""
        start, begin_s = time.process_time(), self.time_s
        while self.time_s < end_s - STEP_S / 2:
            self.now.clear_forces()
            self.solver.step(self.now, self.next, self.control, None, STEP_S)
            self.now, self.next = self.next, self.now
            self.time_s += STEP_S
        return (self.time_s - begin_s) / (time.process_time() - start)


def main():
    vertices, triangles = read_obj(sys.argv[1])
    vertices = upside_down(vertices)
    for self_contact in (False, True):
        Fall(vertices, triangles, self_contact).until(5 * STEP_S)
        fall = Fall(vertices, triangles, self_contact)
        falling = fall.until(MEASURED_S)
        fall.until(CRUMPLED_S)
        crumpled = fall.until(CRUMPLED_S + MEASURED_S)
        speed = np.sqrt((fall.now.particle_qd.numpy() ** 2).sum() / len(vertices))
        print(
            f"Newton {newton.__version__}, {len(vertices)} vertices, "
            f"self-contact {'yes' if self_contact else 'no'}: {falling:.3f} falling, "
            f"{crumpled:.3f} crumpled, then at {1e3 * speed:.1f} mm/s"
        )


if __name__ == "__main__":
    main()
