"""The vehicle as MuJoCo's MJCF: a free body, and on each leg a cylinder on two hinges, a sliding piston and a pad on a ball joint.

The body's own inertia is Table 1's less the legs'. Half of a secondary's mass sits at either end.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import cos, pi, sin

import mujoco
import numpy as np

from .landing import AZIMUTHS, CONNECTION, CYLINDER_MASS, LEGS, LIMIT, PAD_HEIGHT, PAD_MASS, PAD_RADIUS, PISTON_MASS, Array, Landing

Part = tuple[float, Array, Array]  # mass, centre, inertia about it
PAD_SHAPE = (0.5, 0.25, 0.25)  # of a disc, times m r²
SITES = ("origin", *(f"{n}{k}" for n in LEGS for k in "rl"), *(f"{n}c" for n in LEGS), *(f"{n}p{j}" for n in LEGS for j in range(5)))


def model(landing: Landing) -> mujoco.MjModel:
    """Compiled."""
    legs = [leg(landing, name, azimuth) for name, azimuth in zip(LEGS, AZIMUTHS, strict=True)]
    sensors = [f'<{what} objtype="site" objname="{it}"/>' for what in ("framepos", "framelinvel") for it in SITES]
    sensors += [f'<frame{axis}axis objtype="site" objname="origin"/>' for axis in "xyz"]
    sensors += [f'<frameangvel objtype="site" objname="{it}"/>' for it in ("origin", *(f"{name}c" for name in LEGS))]
    sensors += [f'<force site="{name}wall"/>' for name in LEGS]
    return mujoco.MjModel.from_xml_string(f"""<mujoco>
        <compiler angle="radian"/>
        <option gravity="{-landing.gravity} 0 0" timestep="{landing.step}"><flag contact="disable" constraint="disable"/></option>
        <worldbody><body name="vehicle"><freejoint/>{rest_of_table_1(landing, [it for _, parts in legs for it in parts])}
          <site name="origin"/>{"".join(xml for xml, _ in legs)}
        </body></worldbody><sensor>{"".join(sensors)}</sensor></mujoco>""")


def leg(landing: Landing, name: str, azimuth: float) -> tuple[str, list[Part]]:
    """Its bodies, and all that it weighs (body axes)."""
    outward = np.array([0.0, sin(azimuth), cos(azimuth)])
    right = np.cross(outward, [1.0, 0.0, 0.0])
    upper, foot = ring(landing, 3.061, 2.874, outward), ring(landing, 4.242, PAD_HEIGHT, outward)
    trusses = [ring(landing, 2.996, 1.19, outward) + side * 0.5 * 2.239 * right for side in (1.0, -1.0)]
    length = float(np.linalg.norm(foot - upper))
    e = (foot - upper) / length
    lever, piston = length - CONNECTION, length - LIMIT
    turn = np.zeros(4)
    mujoco.mju_mat2Quat(turn, np.column_stack([right, np.cross(e, right), e]).ravel())
    back = np.zeros(4)
    mujoco.mju_negQuat(back, turn)
    swung = CYLINDER_MASS + landing.secondary_mass  # half of two secondaries at its end
    middle = (0.5 * CYLINDER_MASS + landing.secondary_mass) * lever / swung
    about = CYLINDER_MASS * (lever**2 / 12 + (0.5 * lever - middle) ** 2) + landing.secondary_mass * (lever - middle) ** 2
    rim = [(0.0, 0.0), *((PAD_RADIUS, 0.5 * pi * n) for n in range(4))]
    disc = [share * PAD_MASS * PAD_RADIUS**2 for share in PAD_SHAPE]
    damped = f'damping="{landing.joint_damping}"'
    points = "".join(f'<site name="{name}p{j}" pos="{-PAD_HEIGHT} {r * sin(b)} {r * cos(b)}"/>' for j, (r, b) in enumerate(rim))
    across = (np.eye(3) - np.outer(e, e)) / 12.0
    parts = [
        (CYLINDER_MASS, upper + 0.5 * lever * e, CYLINDER_MASS * lever**2 * across),
        (PISTON_MASS, foot - 0.5 * piston * e, PISTON_MASS * piston**2 * across),
        (PAD_MASS, foot, np.diag(disc)),
        (landing.secondary_mass, upper + lever * e, np.zeros((3, 3))),
    ]
    xml = f"""
        <site name="{name}r" pos="{text(trusses[0])}"/><site name="{name}l" pos="{text(trusses[1])}"/>
        <body name="{name}cylinder" pos="{text(upper)}" quat="{text(turn)}">
          <inertial pos="0 0 {middle}" mass="{swung}" diaginertia="{about} {about} 1e-5"/>
          <joint type="hinge" axis="1 0 0" {damped}/><joint type="hinge" axis="0 1 0" {damped}/><site name="{name}c" pos="0 0 {lever}"/>
          <body pos="0 0 {length}">
            <inertial pos="0 0 {-0.5 * piston}" mass="{PISTON_MASS}" diaginertia="{text([PISTON_MASS * piston**2 / 12] * 2)} 1e-5"/>
            <joint name="{name}slide" type="slide" axis="0 0 1" {damped}/><site name="{name}wall"/>
            <body quat="{text(back)}">
              <inertial pos="0 0 0" mass="{PAD_MASS}" diaginertia="{text(disc)}"/><joint type="ball" {damped}/>{points}
            </body>
          </body>
        </body>"""
    return xml, parts


def rest_of_table_1(landing: Landing, legs: Iterable[Part]) -> str:
    """What the body carries: the composite about the origin, less the legs. The secondaries' upper halves stay with it."""
    mass, moment, inertia = landing.mass, np.zeros(3), np.diag(landing.inertia)
    for m, r, own in legs:
        mass, moment, inertia = mass - m, moment - m * r, inertia - own - m * spread(r)
    centre = moment / mass
    about = inertia - mass * spread(centre)
    order = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
    return f'<inertial pos="{text(centre)}" mass="{mass}" fullinertia="{text([about[it] for it in order])}"/>'


def ring(landing: Landing, radius: float, height: float, outward: Array) -> Array:
    """A point of Table 2 in body axes."""
    return np.array([height - landing.height, 0.0, 0.0]) + radius * outward


def spread(r: Array) -> Array:
    """Inertia of a unit mass at r."""
    return np.asarray(r @ r * np.eye(3) - np.outer(r, r))


def text(numbers: Iterable[float]) -> str:
    return " ".join(repr(float(it)) for it in numbers)
