"""A cap in MuJoCo's flex: how many seconds of it MuJoCo simulates in a second of one core.

    cargo run --release -p seeone-sim --example winding_grid -- cap-train-024 out/peer
    cargo bench -p seeone-sim --bench world -- --quick 1029
    python3 -m venv out/venv && out/venv/bin/pip install mujoco
    taskset -c 0 out/venv/bin/python benches/mujoco_flex.py out/peer/mesh.obj

The first command writes the cap's worn shape as a mesh of about 1,000 vertices, the second
measures our own world on the same cap. Here the mesh falls from 0.12 m onto the ground, upside
down, with self-contact; speed is counted while it falls and then where it lies crumpled.
MuJoCo's shell knows one stiffness for the whole: this one is as stiff as fabric, and its visor
bends.
"""

import sys
import time

import mujoco
import numpy as np

LENGTH_M = 0.27
MASS_KG = 0.09
CRUMPLED_S = 1.0
MEASURED_S = 0.25

MODEL = """
<mujoco>
  <option timestep="0.002" solver="CG" tolerance="1e-6" integrator="discrete"/>
  <size memory="200M"/>
  <worldbody>
    <geom type="plane" size="1 1 .1" friction="0.5"/>
    <flexcomp name="cap" type="mesh" file="mesh.obj" dim="2" mass="{mass}" radius="0.0015"
              scale="{scale} {scale} {scale}" pos="0 0 0.3" euler="180 0 0">
      <elasticity young="1e6" poisson="0.2" thickness="1e-3" elastic2d="both" damping="1e-3"/>
      <contact selfcollide="{selfcollide}" friction="0.5"/>
    </flexcomp>
  </worldbody>
</mujoco>
"""


def extent(obj):
    """The longest side of the box around an OBJ file's vertices."""
    rows = [line.split()[1:] for line in obj.decode().splitlines() if line.startswith("v ")]
    return np.ptp(np.array(rows, dtype=float), axis=0).max()


def simulate(model, data, seconds):
    """Simulated seconds a second of this process."""
    start, end = time.process_time(), data.time + seconds
    while data.time < end:
        mujoco.mj_step(model, data)
    return seconds / (time.process_time() - start)


def main():
    with open(sys.argv[1], "rb") as file:
        obj = file.read()
    scale = LENGTH_M / extent(obj)
    for selfcollide in ("none", "auto"):
        text = MODEL.format(mass=MASS_KG, scale=scale, selfcollide=selfcollide)
        model = mujoco.MjModel.from_xml_string(text, {"mesh.obj": obj})
        data = mujoco.MjData(model)
        falling = simulate(model, data, MEASURED_S)
        simulate(model, data, CRUMPLED_S - data.time)
        crumpled = simulate(model, data, MEASURED_S)
        speed = np.sqrt((data.qvel**2).sum() / model.nflexvert)
        print(
            f"MuJoCo {mujoco.__version__}, {model.nflexvert} vertices, self-contact {selfcollide}: "
            f"{falling:.3f} falling, {crumpled:.3f} crumpled, then at {1e3 * speed:.1f} mm/s"
        )


if __name__ == "__main__":
    main()
