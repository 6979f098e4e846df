"""Crushable honeycomb attenuator: stages, latching, memory, damping, stops and bearing friction (paper, eqs. 1 to 4).

Sign convention: a core is described in its own crushing direction. Its stroke d and rate v are positive while it crushes and its
force is never negative: it resists crushing and does not pull. `strut_force` joins the cores and stops of one strut.
"""

from math import tanh
from typing import NamedTuple

from .compiled import jit

DATUM_WEIGHT = 0.5 * (1.0 + tanh(3.0))  # w_L of eq. 3 at d = d_MAX: 0.99753


class Core(NamedTuple):
    """One cartridge. A one-stage core has load_2 = load_1 and boundary >= limit."""

    load_1: float  # F_1, N
    load_2: float  # F_2, N
    boundary: float  # d_2: stroke at which stage 1 is spent, m
    limit: float  # stroke at which the cartridge is spent and the strut bottoms, m
    width: float  # s, m
    damping: float  # c, N s/m
    datum_weight: float  # what w_L is divided by: DATUM_WEIGHT, or 1 for eq. 3 to the letter
    hardening: float = 0.0  # k, s/m: the loads grow by 1 + k v with the rate of crushing


class Stop(NamedTuple):
    """Stiff but finite end of travel."""

    stiffness: float  # N/m
    damping: float  # N s/m
    ramp: float  # depth over which the damping comes in, m


class Tangent(NamedTuple):
    """A force with its derivatives."""

    force: float  # N
    stiffness: float  # dF/dd, N/m
    damping: float  # dF/dv, N s/m


@jit
def transition(x: float, width: float) -> Tangent:
    """½ [1 - tanh(6/s (x - s/2))] and its derivative by x: the weight of eqs. 2, 3 and 8.

    Near 1 at x = 0, near 0 at x = s.
    """
    t = tanh(6.0 / width * (x - 0.5 * width))
    return Tangent(0.5 * (1.0 - t), -3.0 / width * (1.0 - t * t), 0.0)


@jit
def stage_load(core: Core, d: float, d_max: float) -> Tangent:
    """F_k + w_S (F_{k+1} - F_k), N. The stage latches once its boundary has been passed (d_MAX >= d_{k+1}). Eq. 2."""
    if d_max >= core.boundary:
        return Tangent(core.load_2, 0.0, 0.0)
    w = transition(core.boundary - d, core.width)
    step = core.load_2 - core.load_1
    return Tangent(core.load_1 + w.force * step, -w.stiffness * step, 0.0)


@jit
def hardened(core: Core, load: Tangent, v: float) -> Tangent:
    """A stage's load times 1 + k max(0, v): honeycomb that crushes faster resists more. Dissipative."""
    if v <= 0.0:
        return load
    more = 1.0 + core.hardening * v
    return Tangent(more * load.force, more * load.stiffness, core.hardening * load.force)


@jit
def core_force(core: Core, d: float, v: float, crushed: float) -> Tangent:
    """F = min(F_s, w_L (F_s + c v)) >= 0, N: eqs. 1 and 3 with the paper's damping.

    d, v      stroke (m) and rate (m/s) in the crushing direction
    crushed   d_MAX before this instant, m; a virgin core has d_MAX = s
    F_s is the current stage's load. Damping acts inside the elastic band only (through w_L) and elastic plus damping force is
    saturated at F_s, so that the load-stroke table is conserved. w_L is divided by its value at the datum, 0.9975: eq. 3 to the letter
    crushes at 0.25 % less than Table 3's load, which the paper's own Fig. 8 (0.07 %) rules out (docs/decisions/0004).
    With `hardening` F_s grows with the rate.
    """
    d_max = max(crushed, d)
    load = stage_load(core, d, d_max)
    if core.hardening > 0.0:
        load = hardened(core, load, v)
    w = transition(d_max - d, core.width)
    w_L = w.force / core.datum_weight
    slope = -w.stiffness / core.datum_weight if d < d_max else 0.0  # on the virgin curve d_MAX moves along
    viscous = load.force + core.damping * v
    force = w_L * viscous
    if force >= load.force:
        return load
    if force <= 0.0:
        return Tangent(0.0, 0.0, 0.0)
    return Tangent(force, slope * viscous + w_L * load.stiffness, w_L * (load.damping + core.damping))


@jit
def stop_force(stop: Stop, depth: float, v: float) -> Tangent:
    """Force of an end stop at `depth` (m) beyond its face, closing at v (m/s): K x + c min(1, x/ramp) v, never pulling."""
    if depth <= 0.0:
        return Tangent(0.0, 0.0, 0.0)
    share = min(1.0, depth / stop.ramp)
    force = stop.stiffness * depth + stop.damping * share * v
    if force <= 0.0:
        return Tangent(0.0, 0.0, 0.0)
    slope = stop.damping * v / stop.ramp if depth < stop.ramp else 0.0
    return Tangent(force, stop.stiffness + slope, stop.damping * share)


@jit(inline=True)
def primary_force(core: Core, stop: Stop, d: float, v: float, crushed: float) -> Tangent:
    """Axial force that pushes the piston out, N; d is the compression of the strut, m. It crushes in compression only.

    Stops: the spent cartridge at core.limit, and the retaining ring at d = 0, which keeps the piston from falling out.
    """
    core_ = core_force(core, d, v, crushed)
    bottom = stop_force(stop, d - core.limit, v)
    ring = stop_force(stop, -d, -v)
    return Tangent(
        core_.force + bottom.force - ring.force,
        core_.stiffness + bottom.stiffness + ring.stiffness,
        core_.damping + bottom.damping + ring.damping,
    )


@jit(inline=True)
def secondary_force(tension: Core, compression: Core, stop: Stop, d: float, v: float, pulled: float, pushed: float) -> Tangent:
    """Axial tension, N; d is the elongation of the strut, m. Each direction crushes a core of its own with a memory of its own.

    pulled, pushed   d_MAX of the tension and of the compression core, m
    """
    pull = core_force(tension, d, v, pulled)
    push = core_force(compression, -d, -v, pushed)
    far = stop_force(stop, d - tension.limit, v)
    near = stop_force(stop, -d - compression.limit, -v)
    return Tangent(
        pull.force - push.force + far.force - near.force,
        pull.stiffness + push.stiffness + far.stiffness + near.stiffness,
        pull.damping + push.damping + far.damping + near.damping,
    )


@jit(inline=True)
def bearing_friction(mu: float, wall_force: float, v: float, slip_velocity: float) -> Tangent:
    """μ_B |F_c| tanh(v / v_b), N, along v: the strut takes it away from the motion. Eq. 1's second term; the sign is ours.

    The tanh regularises the sign over v_b (m/s).
    """
    t = tanh(v / slip_velocity)
    limit = mu * wall_force
    return Tangent(limit * t, 0.0, limit * (1.0 - t * t) / slip_velocity)


def brake_damping(zeta: float, load: float, width: float, mass: float) -> float:
    """c = 2 ζ ω m, N s/m, with ω = sqrt(K/m), K = F/s: the paper's mass-normalised form times the mass (physics.md)."""
    return float(2.0 * zeta * (load / width * mass) ** 0.5)
