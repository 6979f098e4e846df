"""The landing flown: MuJoCo's semi-implicit Euler at a constant step."""

from __future__ import annotations

from math import asin, atan2, cos, sin

import mujoco
import numpy as np

from .forces import Constants, Memory, legs
from .landing import LEGS, Array, Course, Landing
from .vehicle import SITES, model

EVERY = 1e-3  # s between rows


def land(landing: Landing) -> Course:
    """From the instant at which the first pad touches."""
    craft = model(landing)
    state = mujoco.MjData(craft)
    normal = ground(landing)
    turn = rotation(*landing.attitude)
    mujoco.mju_mat2Quat(state.qpos[3:7], turn.ravel())
    state.qvel[:3], state.qvel[3:6] = turn @ landing.velocity, landing.rates
    mujoco.mj_forward(craft, state)
    n = len(SITES)
    p, v = (state.sensordata[k * 3 * n : (k + 1) * 3 * n].reshape(n, 3) for k in (0, 1))
    axes, spins, across = (state.sensordata[6 * n + a : 6 * n + b].reshape(-1, 3) for a, b in ((0, 9), (9, 24), (24, 36)))
    state.qpos[0] -= np.min(p[13:] @ normal) / normal[0] - 1e-7
    mujoco.mj_forward(craft, state)

    joints = [craft.joint(f"{name}slide") for name in LEGS]
    slide, rate = [int(it.qposadr[0]) for it in joints], [int(it.dofadr[0]) for it in joints]
    memory = Memory(np.full((4, 5), landing.crush_width), np.zeros((4, 5, 4)), np.full(4, -1.0), np.zeros((4, 3)))
    lengths = np.array([[np.linalg.norm(p[9 + i] - p[1 + 2 * i + k]) for k in (0, 1)] for i in range(4)])
    strengths = landing.bearing_strength * np.array(landing.strength_of_pad)
    it, pushes, rows = constants(landing), np.zeros(4), []
    steps, every = round(landing.duration / landing.step), round(EVERY / landing.step)
    for k in range(steps + 1):
        mujoco.mj_step1(craft, state)
        t = k * landing.step
        if k % every == 0:
            rows.append([t, *state.qvel[3:6], *angles(axes)])
        state.xfrc_applied[:] = 0.0
        walls = np.hypot(across[:, 0], across[:, 1])  # of the step before
        slides = np.column_stack([state.qpos[slide], state.qvel[rate]])
        legs(t, landing.step, p, v, spins, slides, walls, lengths, strengths, normal, state.xipos, memory, it, state.xfrc_applied, pushes)
        state.qfrc_applied[rate] = pushes
        body(landing, t, p[0] - state.xipos[1], axes, float(state.qvel[5]), memory, state.xfrc_applied[1])
        mujoco.mj_step2(craft, state)
    mujoco.mj_forward(craft, state)
    table = np.array(rows)
    return Course(table[:, 0], table[:, 1:4], table[:, 4:7], final(p, -state.qpos[slide], lengths, normal, memory))


def body(landing: Landing, t: float, arm: Array, axes: Array, roll_rate: float, memory: Memory, applied: Array) -> None:
    """Engine, and what may be hidden at the body. arm: from its centre of mass to the origin of the axes."""
    touched = memory.touched[memory.touched >= 0.0]
    since = t - touched.min() if len(touched) else 0.0
    y, z = landing.thrust_offset
    force = landing.thrust * max(0.0, 1.0 - since / landing.decay) * axes[0]
    applied[:3] += force
    applied[3:] += np.cross(arm + y * axes[1] + z * axes[2], force)
    applied[3:] -= landing.roll_drag * roll_rate * abs(roll_rate) * axes[2]


def final(p: Array, strokes: Array, lengths: Array, normal: Array, memory: Memory) -> dict[str, float]:
    """Scalars under the names of the data format. A skid is the slide in the soil."""
    values = {}
    for i, name in enumerate(LEGS):
        values[f"stroke.{name}.primary"] = float(strokes[i])
        for side, word in enumerate(("right", "left")):
            values[f"stroke.{name}.{word}"] = float(np.linalg.norm(p[9 + i] - p[1 + 2 * i + side]) - lengths[i, side])
        values[f"penetration.{name}"] = float(-p[13 + 5 * i] @ normal)
        values[f"skid.{name}"] = float(np.linalg.norm(memory.soil[i, 0, 1:]))
        values[f"contact_time.{name}"] = float(memory.touched[i] - np.min(memory.touched))
    return values


def constants(it: Landing) -> Constants:
    brakes = (it.brake(it.primary_loads[1]), it.brake(it.compression_load), it.brake(it.tension_loads[1]))
    return Constants(
        *it.primary_loads, it.compression_load, *it.tension_loads, it.crush_width, *brakes, it.bearing_friction, it.joint_damping,
        it.compaction_exponent, it.damping, it.damping_depth, it.friction, it.plowing, it.rebound_band, it.inertial_drag,
    )  # fmt: skip


def ground(landing: Landing) -> Array:
    """Rx(azimuth) Ry(slope) x̂."""
    return np.array([cos(landing.slope), sin(landing.azimuth) * sin(landing.slope), -cos(landing.azimuth) * sin(landing.slope)])


def rotation(yaw: float, pitch: float, roll: float) -> Array:
    """Body to local: Rz(roll) Ry(pitch) Rx(yaw)."""
    cx, sx, cy, sy, cz, sz = cos(yaw), sin(yaw), cos(pitch), sin(pitch), cos(roll), sin(roll)
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cx, -sx], [0.0, sx, cx]])
    about_y = np.array([[cy, 0.0, sy], [0.0, 1.0, 0.0], [-sy, 0.0, cy]])
    about_z = np.array([[cz, -sz, 0.0], [sz, cz, 0.0], [0.0, 0.0, 1.0]])
    return np.asarray(about_z @ about_y @ about_x)


def angles(axes: Array) -> list[float]:
    """Yaw, pitch, roll; rows of axes: the body's X, Y, Z in the local frame."""
    return [atan2(axes[1, 2], axes[2, 2]), -asin(axes[0, 2]), atan2(axes[0, 1], axes[0, 0])]
