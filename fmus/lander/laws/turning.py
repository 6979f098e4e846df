"""What the turning of the surface's normal adds to a contact point's stiffness; nothing on a plane."""

from .compiled import jit
from .height import bend_of, normal_of
from .normal import Normal
from .relief import Relief
from .surface import Surface, height_at
from .vectors import Matrix, Vector, add, apply_transposed, dot, identity, outer, plus, product, scale, times


@jit(inline=True)
def with_turning(
    k: Matrix, surface: Surface, relief: Relief | None, x: Vector, velocity: Vector, push: Normal, along: Vector, drag: float, turn: Matrix
) -> Matrix:
    """-∂F/∂x (N/m) of a point at x (m) with a velocity (m/s), L, from k, that at a fixed normal.

    With B = ∂N/∂x, c = h - X: ∂δ/∂x = -N + c B_X; ∂δ̇/∂x = -Bᵀ v; v_s = v + δ̇ N, ∂v_s/∂x = δ̇ B + N ∂δ̇/∂x. The slide of plowing is taken
    as it lies.

    push  F_n with its slopes;  along  ∂F/∂F_n;  drag (N s/m) and turn: -∂F/∂v_s = drag (1 + turn)
    """
    if relief is None:
        return k
    h = height_at(surface, relief, x)
    normal = normal_of(h)
    bend = bend_of(h, normal)
    rate, by_rate = -dot(normal, velocity), scale(-1.0, apply_transposed(bend, velocity))
    pressed = add(scale(push.stiffness * (h.value - x[0]), bend[0]), scale(push.damping, by_rate))
    force = plus(outer(along, pressed), times(push.force, bend))
    slips = plus(times(rate, bend), outer(normal, by_rate))
    dragged = times(drag, product(plus(identity(1.0), turn), slips))
    return plus(k, plus(dragged, times(-1.0, force)))
