"""The quarter vehicle of the coupling study as two units made of functions, and the same equations in one piece.

Two masses on a vertical line, 1233 kg and the pad's 11 kg, a strut of 1e6 N/m, 1e4 N s/m and 1 m free length between them, g = 1.62 m/s²;
both at 1 m/s down, the pad 10 mm above the soil of Table 4, Adams-like (eqs. 6 and 7 without w_b and w_r, never pulling). Cut at pad|soil.
"""

from functools import cache
from math import cos, pi
from typing import Any

import numpy as np
from master_samples import prepared
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from orchestrator.master.function_unit import FunctionUnit
from orchestrator.master.master import Master
from orchestrator.master.settings import MasterSettings
from orchestrator.master.system import Link, PortPair, Scheme, System

M, PAD, K, C, G = 1233.0, 11.0, 1e6, 1e4, 1.62
START = (1.01, -1.0, 0.01, -1.0)      # mass: height, velocity; pad: height, velocity
STOP = 0.3


def soil_force(x: float, v: float) -> float:
    depth = -x
    if depth <= 0.0:
        return 0.0
    w = 0.5 * (1.0 - cos(pi * depth / 0.1)) if depth < 0.1 else 1.0
    return max(0.0, 150000.0 * depth**1.5 - w * 150000.0 * v)


@cache
def transition(h: float) -> Any:
    """Of (mass, its velocity, pad, its velocity, force, its slope, 1) over h: exact."""
    a = np.zeros((7, 7))
    a[0, 1] = a[2, 3] = a[4, 5] = 1.0
    a[1] = np.array([-K, -C, K, C, 0.0, 0.0, K]) / M
    a[3] = np.array([K, C, -K, -C, 1.0, 0.0, -K]) / PAD
    a[1, 6] -= G
    a[3, 6] -= G
    return expm(a * h)


def vehicle(sloped: bool = True, **options: Any) -> FunctionUnit:
    def outputs(s: Any) -> dict:
        return {"pad.position": float(s[2]), "pad.velocity": float(s[3])}

    def advance(state: dict, u: dict, t: float, h: float) -> dict:
        slope = u.get("pad.force_slope", u.get("der(pad.force)", 0.0))
        state["s"] = (transition(h) @ np.array([*state["s"], u["pad.force"], slope, 1.0]))[:4]
        return outputs(state["s"])

    inputs = {"pad.force": 0.0} | ({"pad.force_slope": 0.0} if sloped else {})
    return FunctionUnit("vehicle", inputs, {"s": np.array(START)}, lambda state, u: outputs(state["s"]), advance, **options)


def soil(sloped: bool = True, **options: Any) -> FunctionUnit:
    def advance(state: dict, u: dict, t: float, h: float) -> dict:
        x, v = (u[f"pad.{n}"] + h * u.get(f"pad.{n}_slope", u.get(f"der(pad.{n})", 0.0)) for n in ("position", "velocity"))
        return {"pad.force": soil_force(x, v)}

    inputs = {"pad.position": 1.0, "pad.velocity": 0.0}
    inputs |= {"pad.position_slope": 0.0, "pad.velocity_slope": 0.0} if sloped else {}

    def observe(s: dict, u: dict) -> dict:
        return {"pad.force": soil_force(u["pad.position"], u["pad.velocity"])}

    return FunctionUnit("soil", inputs, {}, observe, advance, **options)


def quarter_vehicle(
    settings: MasterSettings,
    scheme: Scheme | None = None,
    sloped: bool = True,
    stop: float = STOP,
    interpolates: bool = False,
    **soil_options: Any,
) -> Master:
    links = [Link(0, f"pad.{n}", 1, f"pad.{n}", scheme=scheme) for n in ("position", "velocity")]
    links.append(Link(1, "pad.force", 0, "pad.force", scheme=scheme))
    units = [vehicle(sloped, interpolates=interpolates), soil(sloped, interpolates=interpolates, **soil_options)]
    return prepared(System(units, links, [PortPair(0, "pad", 1, "pad")], recorded=[["pad.position"], ["pad.force"]]), settings, stop)


def _rate(_: float, y: Any) -> list[float]:
    strut = K * (1.0 - (y[0] - y[2])) - C * (y[1] - y[3])
    return [y[1], strut / M - G, y[3], (soil_force(y[2], y[3]) - strut) / PAD - G]


@cache
def monolithic() -> Any:
    return solve_ivp(_rate, (0.0, STOP), START, method="Radau", rtol=1e-11, atol=1e-13, dense_output=True, max_step=2e-3)


def peak() -> float:
    """Penetration, m."""
    return float(-monolithic().y[2].min())


def error_of(master: Master) -> float:
    """Largest error of the pad's position over the peak penetration."""
    found = master.recorder.columns()["vehicle.pad.position"]
    return float(np.abs(found - monolithic().sol(master.recorder.times)[2]).max()) / peak()


def pad_steps(master: Master) -> int:
    return master.system.slaves[0].steps
