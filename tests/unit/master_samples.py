"""Units made of functions, for tests of the master: a mass, a spring, and how to run them."""

from typing import Any

import numpy as np

from orchestrator.master.function_unit import FunctionUnit
from orchestrator.master.master import Master
from orchestrator.master.settings import MasterSettings
from orchestrator.master.system import Link, Scheme, System

STIFFNESS, STRETCH, HEAVY = 100.0, 0.2, 2.0
OMEGA = float(np.sqrt(STIFFNESS * (1.0 + 1.0 / HEAVY)))


def mass(name: str, m: float, x: float, **options: Any) -> FunctionUnit:
    """m v' = f + f_slope t, exactly."""

    def observe(s: dict, u: dict) -> dict:
        return {"x": s["x"], "velocity": s["v"], "velocity_mean": s["v"], "velocity_slope": 0.0}

    def advance(s: dict, u: dict, t: float, h: float) -> dict:
        a, jerk, v = u["f"] / m, u["f_slope"] / m, s["v"]
        s["x"] += v * h + a * h * h / 2 + jerk * h**3 / 6
        s["v"] += a * h + jerk * h * h / 2
        return {"x": s["x"], "velocity": s["v"], "velocity_mean": v + a * h / 2 + jerk * h * h / 6, "velocity_slope": (s["v"] - v) / h}

    return FunctionUnit(name, {"f": 0.0, "f_slope": 0.0}, {"x": x, "v": 0.0}, observe, advance, **options)


def spring(**options: Any) -> FunctionUnit:
    """f = k e, e' = the difference of its ends' velocities, exactly."""

    def give(before: float, mean: float, after: float, h: float) -> dict:
        out: dict[str, float] = {"stretch": after}
        for end, k in (("fa", STIFFNESS), ("fb", -STIFFNESS)):
            out |= {end: k * after, f"{end}_mean": k * mean, f"{end}_slope": k * (after - before) / h}
        return out

    def advance(s: dict, u: dict, t: float, h: float) -> dict:
        rate, slope, e = u["vb"] - u["va"], u["vb_slope"] - u["va_slope"], s["e"]
        s["e"] += rate * h + slope * h * h / 2
        return give(e, e + rate * h / 2 + slope * h * h / 6, s["e"], h)

    inputs = {"va": 0.0, "vb": 0.0, "va_slope": 0.0, "vb_slope": 0.0}
    return FunctionUnit("spring", inputs, {"e": STRETCH}, lambda s, u: give(s["e"], s["e"], s["e"], 1.0), advance, **options)


def links(slope: bool = True, scheme: Scheme | None = None) -> list[Link]:
    return [
        Link(0, "velocity", 2, "va", slope, scheme),
        Link(1, "velocity", 2, "vb", slope, scheme),
        Link(2, "fa", 0, "f", slope, scheme),
        Link(2, "fb", 1, "f", slope, scheme),
    ]


def oscillator(
    settings: MasterSettings, slope: bool = True, spring_unit: FunctionUnit | None = None, scheme: Scheme | None = None
) -> Master:
    units = [mass("a", 1.0, 0.0), mass("b", HEAVY, 1.2), spring_unit or spring()]
    return prepared(System(units, links(slope, scheme), recorded=[["x"], ["x"], ["stretch"]]), settings)


def prepared(system: System, settings: MasterSettings, stop: float = 1.0) -> Master:
    master = Master(system, settings)
    master.initialise(0.0, stop, [{}] * len(system.slaves))
    master.prepare()
    return master


def fixed(interval: float, passes: int) -> MasterSettings:
    """Steps of one length, whatever the estimate says."""
    return MasterSettings(max_interval=interval, min_interval=interval, tolerance=1e9, passes=passes)


def error_of(master: Master) -> float:
    """Largest departure from e = e0 cos(ωt), m."""
    columns, times = master.recorder.columns(), master.recorder.times
    return float(np.abs(columns["b.x"] - columns["a.x"] - 1.0 - STRETCH * np.cos(OMEGA * times)).max())
