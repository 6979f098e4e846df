"""What the turning of the surface's normal adds to a contact point's stiffness; nothing on a plane."""

from typing import NamedTuple

from .compiled import jit
from .height import bend_of, normal_of
from .relief import Relief
from .surface import Surface, height_at
from .vectors import Matrix, Vector, add, apply_transposed, dot, outer, plus, product, scale, times


class Hold(NamedTuple):
    """How a point's force on the pad follows depth, sink rate and slip."""

    force: float  # F_n, N
    stiffness: float  # ∂F_n/∂δ, N/m
    damping: float  # ∂F_n/∂δ̇, N s/m
    along: Vector  # ∂F/∂F_n
    drag: Matrix  # -∂F/∂v_s, N s/m


@jit
def with_turning(k: Matrix, surface: Surface, relief: Relief | None, x: Vector, velocity: Vector, hold: Hold) -> Matrix:
    """-∂F/∂x (N/m) of a point at x (m) with a velocity (m/s), L, from k, that at a fixed normal.

    With B = ∂N/∂x, c = h - X: ∂δ/∂x = -N + c B_X; ∂δ̇/∂x = -Bᵀ v; v_s = v + δ̇ N, ∂v_s/∂x = δ̇ B + N ∂δ̇/∂x. The slide of plowing is taken
    as it lies.
    """
    if relief is None:
        return k
    h = height_at(surface, relief, x)
    normal = normal_of(h)
    bend = bend_of(h, normal)
    rate, by_rate = -dot(normal, velocity), scale(-1.0, apply_transposed(bend, velocity))
    pressed = add(scale(hold.stiffness * (h.value - x[0]), bend[0]), scale(hold.damping, by_rate))
    force = plus(outer(hold.along, pressed), times(hold.force, bend))
    dragged = product(hold.drag, plus(times(rate, bend), outer(normal, by_rate)))
    return plus(k, plus(dragged, times(-1.0, force)))
