"""Three-vectors, 3x3 matrices (tuples of rows) and unit quaternions (w, x, y, z) as plain tuples.

Tuples, because they cost no allocation in compiled code, cannot be changed by accident, and read the same in plain Python.
"""

from math import atan2, cos, sin, sqrt

from .compiled import jit

Vector = tuple[float, float, float]
Matrix = tuple[Vector, Vector, Vector]
Quaternion = tuple[float, float, float, float]

ZERO: Vector = (0.0, 0.0, 0.0)


@jit
def add(a: Vector, b: Vector) -> Vector:
    """a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


@jit
def sub(a: Vector, b: Vector) -> Vector:
    """a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


@jit
def scale(k: float, a: Vector) -> Vector:
    """k a."""
    return (k * a[0], k * a[1], k * a[2])


@jit
def axpy(k: float, a: Vector, b: Vector) -> Vector:
    """k a + b."""
    return (k * a[0] + b[0], k * a[1] + b[1], k * a[2] + b[2])


@jit
def dot(a: Vector, b: Vector) -> float:
    """a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@jit
def cross(a: Vector, b: Vector) -> Vector:
    """a x b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@jit
def norm(a: Vector) -> float:
    """Length of a."""
    return sqrt(dot(a, a))


@jit
def across(e: Vector, a: Vector) -> Vector:
    """The part of a perpendicular to the unit vector e: (I - e eᵀ) a."""
    return axpy(-dot(e, a), e, a)


@jit
def apply(m: Matrix, a: Vector) -> Vector:
    """m a."""
    return (dot(m[0], a), dot(m[1], a), dot(m[2], a))


@jit
def apply_transposed(m: Matrix, a: Vector) -> Vector:
    """mᵀ a."""
    return add(scale(a[0], m[0]), axpy(a[1], m[1], scale(a[2], m[2])))


@jit
def transpose(m: Matrix) -> Matrix:
    """mᵀ."""
    return ((m[0][0], m[1][0], m[2][0]), (m[0][1], m[1][1], m[2][1]), (m[0][2], m[1][2], m[2][2]))


@jit
def product(a: Matrix, b: Matrix) -> Matrix:
    """a b."""
    return (apply_transposed(b, a[0]), apply_transposed(b, a[1]), apply_transposed(b, a[2]))


@jit
def plus(a: Matrix, b: Matrix) -> Matrix:
    """a + b."""
    return (add(a[0], b[0]), add(a[1], b[1]), add(a[2], b[2]))


@jit
def times(k: float, a: Matrix) -> Matrix:
    """k a."""
    return (scale(k, a[0]), scale(k, a[1]), scale(k, a[2]))


@jit
def outer(a: Vector, b: Vector) -> Matrix:
    """a bᵀ."""
    return (scale(a[0], b), scale(a[1], b), scale(a[2], b))


@jit
def identity(k: float) -> Matrix:
    """k I."""
    return ((k, 0.0, 0.0), (0.0, k, 0.0), (0.0, 0.0, k))


@jit
def skew(a: Vector) -> Matrix:
    """[a x], so that [a x] b = a x b."""
    return ((0.0, -a[2], a[1]), (a[2], 0.0, -a[0]), (-a[1], a[0], 0.0))


@jit
def times_skew(m: Matrix, a: Vector) -> Matrix:
    """m [a x]."""
    return (cross(m[0], a), cross(m[1], a), cross(m[2], a))


@jit
def skew_times(a: Vector, m: Matrix) -> Matrix:
    """[a x] m."""
    return (
        sub(scale(a[1], m[2]), scale(a[2], m[1])),
        sub(scale(a[2], m[0]), scale(a[0], m[2])),
        sub(scale(a[0], m[1]), scale(a[1], m[0])),
    )


@jit
def solve(m: Matrix, b: Vector) -> Vector:
    """x with m x = b, by Cramer's rule; m must be regular."""
    c0 = cross(m[1], m[2])
    c1 = cross(m[2], m[0])
    c2 = cross(m[0], m[1])
    k = 1.0 / dot(m[0], c0)
    return scale(k, add(scale(b[0], c0), axpy(b[1], c1, scale(b[2], c2))))


@jit
def multiply(p: Quaternion, q: Quaternion) -> Quaternion:
    """Hamilton product p q: first q, then p, as rotations."""
    return (
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    )


@jit
def normalise(q: Quaternion) -> Quaternion:
    """q / |q|."""
    k = 1.0 / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return (k * q[0], k * q[1], k * q[2], k * q[3])


@jit
def rotation(q: Quaternion) -> Matrix:
    """Rotation matrix of the unit quaternion q."""
    w, x, y, z = q
    return (
        (1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)),
    )


@jit
def from_rotation_vector(r: Vector) -> Quaternion:
    """Unit quaternion of the rotation by |r| about r."""
    angle = norm(r)
    if angle < 1e-8:  # sin(a/2)/a to first order: exact to rounding here
        return normalise((1.0, 0.5 * r[0], 0.5 * r[1], 0.5 * r[2]))
    k = sin(0.5 * angle) / angle
    return (cos(0.5 * angle), k * r[0], k * r[1], k * r[2])


@jit
def from_yaw_pitch_roll(yaw: float, pitch: float, roll: float) -> Quaternion:
    """B to L by Rz(roll) Ry(pitch) Rx(yaw): yaw about X, pitch about Y, roll about Z (physics.md, frames)."""
    about_x = (cos(0.5 * yaw), sin(0.5 * yaw), 0.0, 0.0)
    about_y = (cos(0.5 * pitch), 0.0, sin(0.5 * pitch), 0.0)
    about_z = (cos(0.5 * roll), 0.0, 0.0, sin(0.5 * roll))
    return multiply(about_z, multiply(about_y, about_x))


@jit
def yaw_pitch_roll(q: Quaternion) -> Vector:
    """Inverse of `from_yaw_pitch_roll`; pitch in (-π/2, π/2)."""
    r = rotation(q)
    return (
        atan2(r[2][1], r[2][2]),
        atan2(-r[2][0], sqrt(r[2][1] * r[2][1] + r[2][2] * r[2][2])),
        atan2(r[1][0], r[0][0]),
    )
