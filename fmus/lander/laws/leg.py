"""Dynamics of one cantilever leg in minimal coordinates: the position p of its footpad's ball joint in the body frame.

The primary strut runs from the upper joint U along the unit vector e to the ball joint, p = U + s e; its cylinder ends at
C = U + l_c e, where both secondaries from T_right and T_left arrive; its piston's head is H = p - l_p e. So p fixes everything:
three stroking freedoms, no constraint equation. Struts are thin rods, whose mass between end points i and j acts as the consistent
mass m/6 [2 1; 1 2] on the accelerations of those points (exact for momentum and its moment; the secondaries' rods stretch). The pad's mass
sits at the ball joint; its rotation is a separate equation (`pad_spin`). With N = I - e eᵀ the mass matrix is m_e e eᵀ + m_n N: it
inverts by hand, and the lateral half solves before the axial one, so that bearing friction, which needs the wall force, closes no loop.

All vectors in B unless said otherwise; the base's accelerations are those of a frame in free fall removed (a - g).
"""

from math import sqrt
from typing import NamedTuple

from .compiled import jit
from .honeycomb import Core, Stop, Tangent, bearing_friction, primary_force, secondary_force
from .leg_geometry import LegGeometry
from .vectors import (
    ZERO,
    Matrix,
    Vector,
    across,
    add,
    axpy,
    cross,
    dot,
    identity,
    norm,
    outer,
    plus,
    product,
    scale,
    skew,
    sub,
    times,
    transpose,
)


class Leg(NamedTuple):
    """Everything constant about one leg."""

    geometry: LegGeometry
    cylinder_mass: float  # kg
    piston_mass: float
    secondary_mass: float
    pad_mass: float
    pad_inertia: Vector  # about the pad's own axes, kg m2
    primary: Core
    tension: Core  # of each secondary
    compression: Core
    stop: Stop
    bearing: float  # μ_B
    bearing_slip: float  # v_b, m/s
    joint_damping: float  # N s/m in sliding joints, N m s/rad in turning ones


class Crush(NamedTuple):
    """Memory of the five cores: d_MAX, m. Latched by `crushed`."""

    primary: float
    right_tension: float
    right_compression: float
    left_tension: float
    left_compression: float


class Base(NamedTuple):
    """Motion of the body frame at one instant, expressed in B."""

    pull: Vector  # acceleration of B's origin less gravity, m/s2
    rate: Vector  # angular velocity, rad/s
    spin_up: Vector  # angular acceleration, rad/s2


class Shape(NamedTuple):
    """Where the leg is and how it moves relative to the body."""

    axis: Vector  # e
    length: float  # s, m
    stretch: float  # ds/dt, m/s
    swing: Vector  # de/dt, rad/s
    joint: Vector  # C, m
    joint_velocity: Vector
    head: Vector  # H, m
    head_velocity: Vector
    right: Vector  # unit vector T_right -> C
    right_length: float
    left: Vector
    left_length: float


class Loads(NamedTuple):
    """Axial forces with tangents; primary: compression pushes out; secondaries: tension."""

    primary: Tangent
    right: Tangent
    left: Tangent


class Nodes(NamedTuple):
    """A vector at each of the leg's points (accelerations, or forces)."""

    upper: Vector
    joint: Vector
    pad: Vector
    head: Vector
    right: Vector
    left: Vector


class Motion(NamedTuple):
    """Answer of the leg at one instant."""

    acceleration: Vector  # of p relative to B, m/s2
    nodes: Nodes  # accelerations less gravity, m/s2
    loads: Loads  # without bearing friction
    primary: float  # axial force incl. bearing friction, compression positive, N
    right: float  # axial force incl. bearing friction, tension positive, N
    left: float
    damping: float  # dF/dv of the primary's bearing friction, N s/m
    power: float  # of all forces inside the leg; negative: taken from the motion, W


@jit
def shape(leg: Leg, p: Vector, v: Vector) -> Shape:
    """Kinematics from the ball joint's position p (m) and velocity v (m/s) relative to B."""
    g = leg.geometry
    w = sub(p, g.upper)
    s = norm(w)
    e = scale(1.0 / s, w)
    stretch = dot(e, v)
    swing = scale(1.0 / s, axpy(-stretch, e, v))
    joint = axpy(g.cylinder, e, g.upper)
    to_right, to_left = sub(joint, g.right), sub(joint, g.left)
    right, left = norm(to_right), norm(to_left)
    return Shape(
        e,
        s,
        stretch,
        swing,
        joint,
        scale(g.cylinder, swing),
        axpy(-g.piston, e, p),
        axpy(-g.piston, swing, v),
        scale(1.0 / right, to_right),
        right,
        scale(1.0 / left, to_left),
        left,
    )


@jit
def strut_loads(leg: Leg, at: Shape, crush: Crush) -> Loads:
    """Core and stop forces of the three struts, N."""
    g = leg.geometry
    primary = primary_force(leg.primary, leg.stop, g.length - at.length, -at.stretch, crush.primary)
    right = secondary_force(
        leg.tension,
        leg.compression,
        leg.stop,
        at.right_length - g.right_length,
        dot(at.right, at.joint_velocity),
        crush.right_tension,
        crush.right_compression,
    )
    left = secondary_force(
        leg.tension,
        leg.compression,
        leg.stop,
        at.left_length - g.left_length,
        dot(at.left, at.joint_velocity),
        crush.left_tension,
        crush.left_compression,
    )
    return Loads(primary, right, left)


@jit
def strokes(leg: Leg, p: Vector) -> Vector:
    """Primary compression, right and left elongation, m."""
    at = shape(leg, p, ZERO)
    g = leg.geometry
    return (g.length - at.length, at.right_length - g.right_length, at.left_length - g.left_length)


@jit
def bottomed(leg: Leg, primary: float, right: float, left: float) -> bool:
    """Whether any strut is beyond the end of its cartridge; strokes as `strokes` gives them, m."""
    near, far = -leg.compression.limit, leg.tension.limit
    return primary > leg.primary.limit or not (near <= right <= far and near <= left <= far)


@jit
def crushed(leg: Leg, p: Vector, crush: Crush) -> Crush:
    """Memories after the leg has been at p: each d_MAX only grows."""
    d = strokes(leg, p)
    return Crush(
        max(crush.primary, d[0]),
        max(crush.right_tension, d[1]),
        max(crush.right_compression, -d[1]),
        max(crush.left_tension, d[2]),
        max(crush.left_compression, -d[2]),
    )


@jit
def carried(base: Base, r: Vector) -> Vector:
    """Acceleration less gravity of a point r fixed in B: a + ω' x r + ω x (ω x r), m/s2."""
    return add(base.pull, add(cross(base.spin_up, r), cross(base.rate, cross(base.rate, r))))


@jit
def moving(base: Base, r: Vector, v: Vector) -> Vector:
    """As `carried`, with the Coriolis term of a point moving at v relative to B."""
    return axpy(2.0, cross(base.rate, v), carried(base, r))


@jit
def bias(leg: Leg, base: Base, at: Shape, p: Vector, v: Vector) -> Nodes:
    """Accelerations of the leg's points for p'' = 0."""
    g = leg.geometry
    bend = scale(-2.0 * at.stretch / at.length, at.swing)
    bend = axpy(-dot(at.swing, at.swing), at.axis, bend)  # e'' for p'' = 0
    return Nodes(
        carried(base, g.upper),
        axpy(g.cylinder, bend, moving(base, at.joint, at.joint_velocity)),
        moving(base, p, v),
        axpy(-g.piston, bend, moving(base, at.head, at.head_velocity)),
        carried(base, g.right),
        carried(base, g.left),
    )


@jit
def accelerated(leg: Leg, at: Shape, still: Nodes, a: Vector) -> Nodes:
    """`still` with the relative acceleration p'' = a (m/s2) added."""
    lateral = scale(1.0 / at.length, across(at.axis, a))
    return Nodes(
        still.upper,
        axpy(leg.geometry.cylinder, lateral, still.joint),
        add(still.pad, a),
        axpy(-leg.geometry.piston, lateral, add(still.head, a)),
        still.right,
        still.left,
    )


@jit
def nodal_inertia(leg: Leg, a: Nodes) -> Nodes:
    """Mass times acceleration lumped to the points by the rods' consistent masses, N."""
    c, k, m = leg.cylinder_mass / 6.0, leg.piston_mass / 6.0, leg.secondary_mass / 6.0
    at_joint = add(
        scale(c, axpy(2.0, a.joint, a.upper)),
        scale(m, add(axpy(4.0, a.joint, a.right), a.left)),
    )
    return Nodes(
        scale(c, axpy(2.0, a.upper, a.joint)),
        at_joint,
        axpy(leg.pad_mass, a.pad, scale(k, axpy(2.0, a.pad, a.head))),
        scale(k, axpy(2.0, a.head, a.pad)),
        scale(m, axpy(2.0, a.right, a.joint)),
        scale(m, axpy(2.0, a.left, a.joint)),
    )


@jit
def axial_mass(leg: Leg) -> float:
    """m_e: what moves along the primary, kg."""
    return leg.piston_mass + leg.pad_mass


@jit
def lateral_mass(leg: Leg, at: Shape) -> float:
    """m_n: what the ball joint feels across the primary, kg."""
    arm = leg.geometry.cylinder / at.length
    k = 1.0 - leg.geometry.piston / at.length
    swinging = (leg.cylinder_mass + 2.0 * leg.secondary_mass) / 3.0
    return arm * arm * swinging + leg.piston_mass / 3.0 * (1.0 + k + k * k) + leg.pad_mass


@jit
def on_pad(leg: Leg, at: Shape, force: Vector) -> Vector:
    """Generalised force on p of a force at the connection C: (l_c/s) N f."""
    return scale(leg.geometry.cylinder / at.length, across(at.axis, force))


@jit
def rod_damping(leg: Leg, at: Shape, u: Vector, length: float) -> Matrix:
    """Damping of one secondary's joints against p', N s/m: sliding, turning at the truss and turning at the connection."""
    arm = leg.geometry.cylinder / at.length
    along = scale(arm, across(at.axis, u))  # d(length)/dp
    lateral = plus(identity(1.0), times(-1.0, outer(at.axis, at.axis)))
    turn = times(arm / length, product(skew(u), lateral))  # rod's rate from p'
    cylinder = times(1.0 / at.length, skew(at.axis))
    free = plus(identity(1.0), times(-1.0, outer(u, u)))  # a rod does not feel torque about itself
    bend = plus(turn, times(-1.0, product(free, cylinder)))
    both = plus(product(transpose(turn), turn), product(transpose(bend), bend))
    return times(leg.joint_damping, plus(outer(along, along), both))


@jit
def joint_damping(leg: Leg, at: Shape) -> Matrix:
    """All joints' viscous damping but the ball joint's against p', N s/m (paper: of the order of 100 in every joint)."""
    lateral = plus(identity(1.0), times(-1.0, outer(at.axis, at.axis)))
    primary = plus(outer(at.axis, at.axis), times(1.0 / (at.length * at.length), lateral))
    secondaries = plus(rod_damping(leg, at, at.right, at.right_length), rod_damping(leg, at, at.left, at.left_length))
    return plus(times(leg.joint_damping, primary), secondaries)


@jit
def ball_torque(leg: Leg, base: Base, at: Shape, pad_rate: Vector) -> Vector:
    """Torque of the ball joint on the pad, N m, in B; pad_rate is the pad's angular velocity, rad/s, in B.

    The piston turns with the body and with the strut's swing (a constant-velocity joint at U; a Hooke joint differs in second order).
    """
    return scale(-leg.joint_damping, sub(pad_rate, add(base.rate, cross(at.axis, at.swing))))


@jit
def side_friction(leg: Leg, u: Vector, rate: float, truss: Vector, joint: Vector) -> Tangent:
    """Bearing friction of a secondary, N: its wall force is what its own inertia puts across its end at the connection."""
    wall = across(u, scale(leg.secondary_mass / 6.0, axpy(2.0, joint, truss)))
    return bearing_friction(leg.bearing, norm(wall), rate, leg.bearing_slip)


@jit
def leg_motion(leg: Leg, base: Base, p: Vector, v: Vector, force: Vector, ball: Vector, crush: Crush) -> Motion:
    """Acceleration of the ball joint relative to B, and what the struts carry.

    p, v    ball joint's position (m) and velocity (m/s) relative to B
    force   on the pad at the ball joint, N;  ball  torque of the ball joint on the pad, N m
    """
    at = shape(leg, p, v)
    loads = strut_loads(leg, at, crush)
    e = at.axis
    still = bias(leg, base, at, p, v)
    drag = apply_damping(joint_damping(leg, at), v)
    lever = scale(1.0 / at.length, cross(e, ball))  # reaction -ball on the piston, as a force on p
    outside = add(force, add(drag, lever))
    m_n = lateral_mass(leg, at)

    right, left = loads.right.force, loads.left.force
    lateral = lateral_acceleration(leg, at, still, outside, right, left, m_n)
    joint = axpy(leg.geometry.cylinder / at.length, lateral, still.joint)
    right_rate, left_rate = dot(at.right, at.joint_velocity), dot(at.left, at.joint_velocity)
    right += side_friction(leg, at.right, right_rate, still.right, joint).force
    left += side_friction(leg, at.left, left_rate, still.left, joint).force
    lateral = lateral_acceleration(leg, at, still, outside, right, left, m_n)

    k = 1.0 - leg.geometry.piston / at.length
    middle = add(axpy(0.5, add(still.pad, still.head), ZERO), scale(0.5 * (1.0 + k), lateral))
    carried_load = axpy(leg.pad_mass, add(still.pad, lateral), scale(leg.piston_mass, middle))
    wall = norm(across(e, sub(carried_load, force)))
    friction = bearing_friction(leg.bearing, wall, -at.stretch, leg.bearing_slip)
    primary = loads.primary.force + friction.force
    inertia = nodal_inertia(leg, still)
    axial = (dot(e, sub(outside, add(inertia.pad, inertia.head))) + primary) / axial_mass(leg)

    a = axpy(axial, e, lateral)
    power = primary * at.stretch - right * right_rate - left * left_rate + dot(drag, v)
    return Motion(a, accelerated(leg, at, still, a), loads, primary, right, left, friction.damping, power)


@jit
def apply_damping(d: Matrix, v: Vector) -> Vector:
    """-D v."""
    return (-dot(d[0], v), -dot(d[1], v), -dot(d[2], v))


@jit
def lateral_acceleration(leg: Leg, at: Shape, still: Nodes, outside: Vector, right: float, left: float, m_n: float) -> Vector:
    """N p'' from the forces across the primary, m/s2."""
    inertia = nodal_inertia(leg, still)
    struts = on_pad(leg, at, add(scale(-right, at.right), axpy(-left, at.left, scale(-1.0, inertia.joint))))
    k = 1.0 - leg.geometry.piston / at.length
    rest = sub(outside, add(inertia.pad, scale(k, inertia.head)))
    return scale(1.0 / m_n, add(across(at.axis, rest), struts))


@jit
def tangents(leg: Leg, at: Shape, loads: Loads, friction: float) -> tuple[Matrix, Matrix]:
    """-dQ/dp (N/m) and -dQ/dv (N s/m) of the struts' forces on p, for Newton's matrix and the reduced interface model.

    Material and geometric stiffness of the struts and all damping; inertia's dependence on p is left out (a thousandth of these).
    friction   slope of the primary's bearing friction, N s/m
    """
    e, s = at.axis, at.length
    arm = leg.geometry.cylinder / s
    lateral = plus(identity(1.0), times(-1.0, outer(e, e)))
    p = loads.primary
    stiffness = plus(times(p.stiffness, outer(e, e)), times(-p.force / s, lateral))
    damping = plus(times(p.damping + friction, outer(e, e)), joint_damping(leg, at))
    for u, length, load in ((at.right, at.right_length, loads.right), (at.left, at.left_length, loads.left)):
        along = scale(arm, across(e, u))
        side = across(e, u)
        turn = plus(lateral, times(-1.0, outer(side, side)))
        lean = plus(times(dot(e, u), lateral), plus(outer(e, side), outer(side, e)))  # how (l_c/s) N u follows e and s
        geometric = times(load.force, plus(times(arm * arm / length, turn), times(-arm / s, lean)))
        stiffness = plus(stiffness, plus(times(load.stiffness, outer(along, along)), geometric))
        damping = plus(damping, times(load.damping, outer(along, along)))
    return stiffness, damping


@jit
def mobility(leg: Leg, at: Shape) -> Matrix:
    """Y = e eᵀ/m_e + N/m_n: acceleration of the ball joint by a force on it, 1/kg."""
    axial, lateral = 1.0 / axial_mass(leg), 1.0 / lateral_mass(leg, at)
    return plus(identity(lateral), times(axial - lateral, outer(at.axis, at.axis)))


@jit
def base_coupling(leg: Leg, at: Shape, p: Vector) -> tuple[Matrix, Matrix]:
    """How the base's accelerations load p, kg and kg m: inertia force on p = M_c pull + S spin_up.

    The body feels p'' through the transposes.
    """
    g, e = leg.geometry, at.axis
    arm = g.cylinder / at.length
    k = 1.0 - g.piston / at.length
    c, m, w = leg.cylinder_mass / 6.0, leg.secondary_mass / 6.0, leg.piston_mass / 6.0
    swinging = arm * (3.0 * c + 6.0 * m) + 3.0 * w * (1.0 + k) + leg.pad_mass
    ends = add(scale(c, g.upper), scale(m, add(g.right, g.left)))
    q_n = axpy(arm, axpy(2.0 * c + 4.0 * m, at.joint, ends), axpy(w * (2.0 + k) + leg.pad_mass, p, scale(w * (1.0 + 2.0 * k), at.head)))
    q_e = axpy(3.0 * w + leg.pad_mass, p, scale(3.0 * w, at.head))
    along = outer(e, e)
    lateral = plus(identity(1.0), times(-1.0, along))
    straight = plus(times(swinging, lateral), times(axial_mass(leg), along))
    turning = times(-1.0, plus(product(along, skew(q_e)), product(lateral, skew(q_n))))
    return straight, turning


@jit
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


@jit
def times_diagonal(d: Vector, a: Vector) -> Vector:
    """diag(d) a."""
    return (d[0] * a[0], d[1] * a[1], d[2] * a[2])


@jit
def total(f: Nodes) -> Vector:
    """Sum over the points."""
    return add(add(f.upper, f.joint), add(add(f.pad, f.head), add(f.right, f.left)))


@jit
def moment(r: Nodes, f: Nodes) -> Vector:
    """Sum of r x f over the points."""
    first = add(cross(r.upper, f.upper), add(cross(r.joint, f.joint), cross(r.pad, f.pad)))
    return add(first, add(cross(r.head, f.head), add(cross(r.right, f.right), cross(r.left, f.left))))


@jit
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


@jit
def rod_energy(mass: float, a: Vector, b: Vector) -> float:
    """Kinetic energy of a rod whose ends move at a and b (m/s), J."""
    return mass / 6.0 * (dot(a, a) + dot(a, b) + dot(b, b))


@jit
def leg_kinetic(leg: Leg, velocity: Nodes, pad_rate: Vector) -> float:
    """Kinetic energy, J, from the points' absolute velocities and the pad's angular velocity in pad axes."""
    moving_rods = (
        rod_energy(leg.cylinder_mass, velocity.upper, velocity.joint)
        + rod_energy(leg.piston_mass, velocity.pad, velocity.head)
        + rod_energy(leg.secondary_mass, velocity.right, velocity.joint)
        + rod_energy(leg.secondary_mass, velocity.left, velocity.joint)
    )
    spin = 0.5 * dot(pad_rate, times_diagonal(leg.pad_inertia, pad_rate))
    return moving_rods + 0.5 * leg.pad_mass * dot(velocity.pad, velocity.pad) + spin


@jit
def first_moment(leg: Leg, r: Nodes) -> Vector:
    """Mass times centre of mass, kg m, of the leg with its points at r."""
    rods = add(
        scale(0.5 * leg.cylinder_mass, add(r.upper, r.joint)),
        scale(0.5 * leg.piston_mass, add(r.pad, r.head)),
    )
    sides = scale(0.5 * leg.secondary_mass, add(axpy(2.0, r.joint, r.right), r.left))
    return axpy(leg.pad_mass, r.pad, add(rods, sides))


def leg_mass(leg: Leg) -> float:
    """Mass of the whole leg, kg."""
    return leg.cylinder_mass + leg.piston_mass + 2.0 * leg.secondary_mass + leg.pad_mass


def disc_inertia(mass: float, radius: float) -> Vector:
    """Principal inertia of a thin disc with its axis along x, kg m2: ½ m r², ¼ m r², ¼ m r²."""
    return (0.5 * mass * radius * radius, 0.25 * mass * radius * radius, 0.25 * mass * radius * radius)


def swing_frequency(leg: Leg) -> float:
    """Highest natural frequency of the virgin struts, rad/s: sets the substep that resolves them."""
    return sqrt(3.0 * leg.primary.load_2 / leg.primary.width / axial_mass(leg))
