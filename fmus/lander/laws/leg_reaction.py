"""What a leg does to the body: by d'Alembert from its points' inertia, less what the rigid undeformed leg would take. Vectors in B."""

from .compiled import jit
from .leg import Leg, Shape
from .leg_inertia import Base, Nodes, carried, nodal_inertia, times_diagonal
from .vectors import Vector, add, axpy, cross, scale, sub


@jit(inline=True)
def total(f: Nodes) -> Vector:
    """Sum over the points."""
    return add(add(f.upper, f.joint), add(add(f.pad, f.head), add(f.right, f.left)))


@jit(inline=True)
def moment(r: Nodes, f: Nodes) -> Vector:
    """Sum of r x f over the points."""
    first = add(cross(r.upper, f.upper), add(cross(r.joint, f.joint), cross(r.pad, f.pad)))
    return add(first, add(cross(r.head, f.head), add(cross(r.right, f.right), cross(r.left, f.left))))


@jit(inline=True)
def rigid_wrench(leg: Leg, base: Base) -> tuple[Vector, Vector]:
    """Force (N) and moment about B's origin (N m) that move the undeformed leg rigidly with the body.

    The body's own equations carry the undeformed leg; the leg returns the difference (coupling.md).
    """
    g = leg.geometry
    e = scale(1.0 / g.length, sub(g.pad, g.upper))
    joint, head = axpy(g.cylinder, e, g.upper), axpy(-g.piston, e, g.pad)
    a = Nodes(
        carried(base, g.upper),
        carried(base, joint),
        carried(base, g.pad),
        carried(base, head),
        carried(base, g.right),
        carried(base, g.left),
    )
    f = nodal_inertia(leg, a)
    r = Nodes(g.upper, joint, g.pad, head, g.right, g.left)
    spin = add(times_diagonal(leg.pad_inertia, base.spin_up), cross(base.rate, times_diagonal(leg.pad_inertia, base.rate)))
    return total(f), add(moment(r, f), spin)


@jit(inline=True)
def mount_wrench(leg: Leg, base: Base, p: Vector, at: Shape, nodes: Nodes, force: Vector, ball: Vector) -> tuple[Vector, Vector]:
    """Force (N) and moment (N m, about B's origin) of the leg on the body, plus what the rigid undeformed leg would take.

    By d'Alembert: what acts on the leg from outside less its own inertia; internal forces cancel. The pad's spin reaches the body
    through the ball joint's torque `ball` alone.
    """
    g = leg.geometry
    f = nodal_inertia(leg, nodes)
    r = Nodes(g.upper, at.joint, p, at.head, g.right, g.left)
    rigid_force, rigid_moment = rigid_wrench(leg, base)
    f_body = add(sub(force, total(f)), rigid_force)
    m_body = add(sub(sub(cross(p, force), ball), moment(r, f)), rigid_moment)
    return f_body, m_body
