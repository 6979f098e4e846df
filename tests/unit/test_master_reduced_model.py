"""Verifies: the reduced interface model carries a cut that is too stiff for explicit coupling.

Setup: one dimension. A mass of 1233 kg on a strut (1e6 N/m, 1e4 N s/m) with a pad of 11 kg, 10 mm above a soil that pushes with
3e5 N/m · depth · (1 + 5 s/m · rate), never pulling; both at 1 m/s down. Cut between pad and soil, where explicit coupling is stable up to
2m/C = 0.3 ms at 50 mm depth. Against the same equations in one piece.
Tolerance: 1e-4 of the peak penetration at intervals of 2 ms (measured: 3e-5). A model that misstates the strut by half, as the
linearisation of a nonlinear leg would, is where estimate, rejection and second pass must show (asserted), so the tests can fail.
"""

from typing import Any

import numpy as np
from master_samples import prepared

from orchestrator.master.function_unit import FunctionUnit
from orchestrator.master.master import Master
from orchestrator.master.settings import MasterSettings
from orchestrator.master.system import Link, PortPair, System

M, PAD, K, C, G = 1233.0, 11.0, 1e6, 1e4, 1.62
KS, RATE = 3e5, 5.0
START = (1.01, -1.0, 0.01, -1.0)      # mass: height, velocity; pad: height, velocity
STOP = 0.1
MODEL = ("acceleration", "mobility", "stiffness", "damping", "base_velocity", "base_acceleration")


def soil_force(x: float, v: float) -> float:
    return max(0.0, -KS * x * (1.0 - RATE * v)) if x < 0.0 else 0.0


def strut(s: Any) -> float:
    return K * (1.0 - (s[0] - s[2])) - C * (s[1] - s[3])


def rate_of(s: Any, force: float) -> Any:
    f = strut(s)
    return np.array([s[1], f / M - G, s[3], (force - f) / PAD - G])


def runge_kutta(rate: Any, s: Any, h: float, count: int) -> Any:
    d = h / count
    for i in range(count):
        t = i * d
        a = rate(s, t)
        b = rate(s + d / 2 * a, t + d / 2)
        c = rate(s + d / 2 * b, t + d / 2)
        s = s + d / 6 * (a + 2 * b + 2 * c + rate(s + d * c, t + d))
    return s


def leg(share: float = 1.0) -> FunctionUnit:
    """`share` of the strut's stiffness and damping is what the model tells."""

    def outputs(s: Any) -> dict:
        f = strut(s)
        values = (-f / PAD - G, 1 / PAD, -share * K / PAD, -share * C / PAD, s[1], f / M - G)
        return {"pad.position[1]": s[2], "pad.velocity[1]": s[3]} | {f"pad.model_{n}": v for n, v in zip(MODEL, values, strict=True)}

    def advance(state: dict, u: dict, t: float, h: float) -> dict:
        force = lambda t: u["pad.force[1]"] + u["pad.force_slope[1]"] * t  # noqa: E731
        state["s"] = runge_kutta(lambda s, t: rate_of(s, force(t)), state["s"], h, 20)
        return outputs(state["s"])

    inputs = {"pad.force[1]": 0.0, "pad.force_slope[1]": 0.0}
    return FunctionUnit("leg", inputs, {"s": np.array(START)}, lambda state, u: outputs(state["s"]), advance)


def soil(mobility: float = 1.0) -> FunctionUnit:
    """`mobility` scales how far the soil believes the pad to answer its force."""

    def observe(s: dict, u: dict) -> dict:
        f = soil_force(u["pad.position[1]"], u["pad.velocity[1]"])
        return outputs(f, f, 0.0, u["pad.velocity[1]"])

    def outputs(f: float, mean: float, slope: float, v: float) -> dict:
        return {"pad.force[1]": f, "pad.force_mean[1]": mean, "pad.force_slope[1]": slope, "pad.predicted_velocity[1]": v}

    def advance(state: dict, u: dict, t: float, h: float) -> dict:
        a_f, y, a_x, a_v, v_b, a_b = (u[f"pad.model_{name}"] for name in MODEL)
        x0, v0, shift = u["pad.position[1]"], u["pad.velocity[1]"], u["pad.mismatch_velocity[1]"]

        def seen(s: Any, t: float) -> tuple[float, float]:
            return s[0] + shift * t * t / (2 * h), s[1] + shift * t / h

        def rate(s: Any, t: float) -> Any:
            f = soil_force(*seen(s, t))
            a = a_f + mobility * y * f + a_x * (s[0] - x0 - v_b * t - a_b * t * t / 2) + a_v * (s[1] - v0 - a_b * t)
            return np.array([s[1], a, f, f * t])

        end = runge_kutta(rate, np.array([x0, v0, 0.0, 0.0]), h, 40)
        x, v = seen(end, h)
        mean = end[2] / h
        return outputs(soil_force(x, v), mean, 12 / h**3 * (end[3] - end[2] * h / 2), v)

    inputs = {"pad.position[1]": 0.0, "pad.velocity[1]": 0.0, "pad.mismatch_velocity[1]": 0.0} | {f"pad.model_{n}": 0.0 for n in MODEL}
    return FunctionUnit("soil", inputs, {}, observe, advance)


def coupled(settings: MasterSettings, mobility: float = 1.0, share: float = 1.0) -> Master:
    members = ["position[1]", "velocity[1]", *(f"model_{name}" for name in MODEL)]
    links = [Link(1, f"pad.{m}", 0, f"pad.{m}") for m in members] + [Link(0, "pad.force[1]", 1, "pad.force[1]")]
    system = System([soil(mobility), leg(share)], links, [PortPair(0, "pad", 1, "pad")], recorded=[[], ["pad.position[1]"]])
    return prepared(system, settings, stop=STOP)


def error_of(master: Master) -> float:
    """Largest error of the pad's position over the peak penetration."""
    s, reached, depth, worst = np.array(START), 0.0, 0.0, 0.0
    for time, x in zip(master.recorder.times, master.recorder.columns()["leg.pad.position[1]"], strict=True):
        if time > reached:
            s = runge_kutta(lambda s, t: rate_of(s, soil_force(s[2], s[3])), s, time - reached, max(1, round((time - reached) / 5e-6)))
            reached = time
        depth, worst = max(depth, -s[2]), max(worst, abs(x - s[2]))
    return worst / depth


def test_the_model_holds_a_cut_seven_times_too_stiff_for_explicit_steps() -> None:
    master = coupled(MasterSettings(max_interval=2e-3, min_interval=5e-5, tolerance=1e-5))
    master.run()
    assert len(master.log) == 50
    assert error_of(master) < 1e-4
    assert master.unresolved == 0


def test_a_misstated_model_shortens_the_steps_by_rejection_and_the_answer_stays_right() -> None:
    master = coupled(MasterSettings(max_interval=2e-3, min_interval=2e-5, tolerance=1e-7), share=0.5)
    master.run()
    rejected = [row for row in master.log if not row.accepted]
    assert rejected
    assert all(row.estimate > 1e-7 and row.limit == "soil.pad" for row in rejected)
    assert error_of(master) < 1e-3
    assert master.unresolved == 0


def test_without_the_answer_to_force_the_cut_is_not_resolved_and_says_so() -> None:
    master = coupled(MasterSettings(max_interval=2e-3, min_interval=1e-3, tolerance=1e-5), mobility=0.0)
    master.run()
    assert master.unresolved > 0.05 * sum(row.accepted for row in master.log)


def test_the_second_pass_pays_when_the_model_is_not_exact() -> None:
    errors = []
    for passes in (1, 2):
        master = coupled(MasterSettings(max_interval=1e-3, min_interval=1e-3, tolerance=1e9, passes=passes), share=0.5)
        master.run()
        errors.append(error_of(master))
    assert errors[1] < 0.4 * errors[0]


def test_the_mismatch_is_zero_in_the_first_pass_and_what_was_missed_in_the_second() -> None:
    master = coupled(MasterSettings(max_interval=1e-3, min_interval=1e-3, tolerance=1e9), share=0.5)
    told: list[float] = []
    unit = master.system.slaves[0]
    inner = unit._advance
    unit._advance = lambda s, u, t, h: (told.append(u["pad.mismatch_velocity[1]"]), inner(s, u, t, h))[1]
    for _ in range(15):                   # past touchdown at 10 ms
        master._advance(1_000_000)
    assert told[0::2] == [0.0] * 15
    assert 0.0 < abs(told[-1]) < 0.1


def test_the_two_sides_of_the_cut_agree_better_after_the_second_pass() -> None:
    largest = []
    for passes in (1, 2, 3):
        master = coupled(MasterSettings(max_interval=1e-3, min_interval=1e-3, tolerance=1e9, passes=passes), share=0.5)
        master.run()
        largest.append(max(row.estimate for row in master.log))
    assert largest[0] > 4.0 * largest[1] > 16.0 * largest[2]
