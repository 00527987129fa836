"""A cap in PyBullet: how many seconds of it are simulated in a second of one core.

    cargo run --release -p seeone-sim --example winding_grid -- cap-train-024 out/peer
    cargo bench -p seeone-sim --bench world -- --quick 1029
    python3 -m venv out/venv && out/venv/bin/pip install numpy pybullet
    taskset -c 0 out/venv/bin/python benches/pybullet_springs.py out/peer/mesh.obj

The scene is that of `mujoco_flex.py`: the cap's worn shape as a mesh of about 1,000 vertices falls
from 0.12 m onto the ground, upside down, without and with self-contact; speed is counted while it
falls and then where it lies crumpled. The springs are softer than fabric (stiffer ones shake the
more at a step of 1 ms), one stiffness serves for the whole, and the visor bends.
"""

import sys
import time

import numpy as np
import pybullet

LENGTH_M = 0.27
HEIGHT_M = 0.12
MASS_KG = 0.09
STEP_S = 1e-3
CRUMPLED_S = 1.0
MEASURED_S = 0.25
SPRING_N_M, BENDING_N_M = 40.0, 2.0


def read_vertices(path):
    """The vertices (n x 3) of an OBJ file."""
    with open(path, encoding="ascii") as file:
        rows = [line.split()[1:] for line in file if line.startswith("v ")]
    return np.array(rows, dtype=float)


def simulate(seconds):
    """Simulated seconds a second of this process."""
    start = time.process_time()
    for _ in range(round(seconds / STEP_S)):
        pybullet.stepSimulation()
    return seconds / (time.process_time() - start)


def positions(body):
    return np.array(pybullet.getMeshData(body, flags=pybullet.MESH_DATA_SIMULATION_MESH)[1])


def main():
    vertices = read_vertices(sys.argv[1])
    scale = LENGTH_M / np.ptp(vertices, axis=0).max()
    for self_contact in (False, True):
        pybullet.connect(pybullet.DIRECT)
        pybullet.resetSimulation(pybullet.RESET_USE_DEFORMABLE_WORLD)
        pybullet.setTimeStep(STEP_S)
        pybullet.setGravity(0, 0, -9.81)
        ground = pybullet.createCollisionShape(pybullet.GEOM_BOX, halfExtents=[1, 1, 0.05])
        pybullet.createMultiBody(0, ground, basePosition=[0, 0, -0.05])
        body = pybullet.loadSoftBody(
            sys.argv[1],
            basePosition=[0, 0, HEIGHT_M + scale * vertices[:, 2].max()],
            baseOrientation=pybullet.getQuaternionFromEuler([np.pi, 0, 0]),
            scale=scale,
            mass=MASS_KG,
            useMassSpring=1,
            springElasticStiffness=SPRING_N_M,
            springDampingStiffness=0.1,
            useBendingSprings=1,
            springBendingStiffness=BENDING_N_M,
            useSelfCollision=self_contact,
            useFaceContact=1,
            frictionCoeff=0.5,
            collisionMargin=0.0015,
        )
        falling = simulate(MEASURED_S)
        simulate(CRUMPLED_S - MEASURED_S)
        crumpled = simulate(MEASURED_S)
        before = positions(body)
        pybullet.stepSimulation()
        speed = np.sqrt((((positions(body) - before) / STEP_S) ** 2).sum() / len(before))
        print(
            f"PyBullet {pybullet.getAPIVersion()}, {len(before)} vertices, "
            f"self-contact {'yes' if self_contact else 'no'}: {falling:.3f} falling, "
            f"{crumpled:.3f} crumpled, then at {1e3 * speed:.1f} mm/s"
        )
        pybullet.disconnect()


if __name__ == "__main__":
    main()
