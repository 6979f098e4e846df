"""A rigid body falls, answers forces in its own frame as mass does, spins as its quaternion says, and gives work back as energy."""

import numpy as np
import pytest
from piece import Array, Piece, of, turned

KIND = "VehicleBody"
H = 5e-3


def flown(piece: Piece, stop: float, start: float = 0.0, **wrench: tuple[float, float, float]) -> dict[str, Array]:
    """Under a constant wrench, `engine_force` for engine.force; other ports have none."""
    ports = {f"{port}.{member}": (0.0, 0.0, 0.0) for port in ("leg1", "leg2", "leg3", "leg4", "engine") for member in ("force", "torque")}
    ports |= {name.replace("_", "."): value for name, value in wrench.items()}
    return piece.run(lambda t: ports, stop, H, start)


def gain(piece: Piece, **wrench: tuple[float, float, float]) -> Array:
    """Change of velocity in 0.2 s beyond that of free fall."""
    piece.ready({})
    free = of(flown(piece, 0.2), "body.velocity")[-1]
    piece.ready({})
    return np.asarray(of(flown(piece, 0.2, **wrench), "body.velocity")[-1] - free)


def test_it_falls_freely_straight_down(piece: Piece) -> None:
    """x = x0 + v0 t + a t²/2 with one constant a along -x of L; 1e-3 of the fall for an integrator of its own."""
    piece.ready({})
    start, v0 = piece.vector("body.position"), piece.vector("body.velocity")
    columns = flown(piece, 0.5)
    position, velocity = of(columns, "body.position"), of(columns, "body.velocity")
    a = (velocity[-1] - v0) / 0.5
    assert a[0] < -0.1
    assert np.abs(a[1:]).max() < 1e-3 * abs(a[0])
    assert position[-1] - start == pytest.approx(v0 * 0.5 + 0.125 * a, abs=1e-3 * 0.125 * abs(a[0]))


def test_a_force_on_any_port_gives_every_direction_the_same_mass(piece: Piece) -> None:
    """From the wrench in B to the velocity in L with the attitude of the start; 1e-3."""
    piece.ready({})
    q = piece.vector("body.quaternion")
    along = gain(piece, engine_force=(1000.0, 0.0, 0.0))
    mass = 1000.0 * 0.2 / np.linalg.norm(along)
    assert 100.0 < mass < 1e5
    for port in ("engine", "leg1", "leg3"):
        for axis in range(3):
            force = np.zeros(3)
            force[axis] = 1000.0
            gained = gain(piece, **{f"{port}_force": tuple(force)})
            assert gained == pytest.approx(turned(q, force) * 0.2 / mass, abs=1e-3 * 1000.0 * 0.2 / mass), f"{port}.force[{axis + 1}]"


def test_forces_add_up(piece: Piece) -> None:
    one, other = gain(piece, leg1_force=(500.0, 0.0, 200.0)), gain(piece, engine_force=(0.0, 300.0, 0.0))
    both = gain(piece, leg1_force=(500.0, 0.0, 200.0), engine_force=(0.0, 300.0, 0.0))
    assert both == pytest.approx(one + other, abs=1e-3 * float(np.abs(both).max()))


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_torque_turns_it_the_right_way_and_the_quaternion_follows(piece: Piece, axis: int) -> None:
    """dq/dt = ½ q ω: the angle turned is the rate's integral, about the same axis, with the same sign; 1 % for the way of integrating."""
    piece.ready({})
    q0 = piece.vector("body.quaternion")
    torque = np.zeros(3)
    torque[axis] = 2000.0
    columns = flown(piece, 1.0, leg2_torque=tuple(torque))
    rates, quaternions = of(columns, "body.angular_velocity"), of(columns, "body.quaternion")
    assert rates[-1][axis] > 1e-3
    assert np.linalg.norm(quaternions, axis=1) == pytest.approx(1.0, abs=1e-6)
    angle = float(np.trapezoid(np.r_[0.0, rates[:, axis]], dx=H))
    unit = np.eye(3)[axis]
    for v in np.eye(3):
        expected = v * np.cos(angle) + np.cross(unit, v) * np.sin(angle) + unit * (unit @ v) * (1.0 - np.cos(angle))
        assert turned(quaternions[-1], v) == pytest.approx(turned(q0, expected), abs=0.01 * angle + 1e-6)


def test_a_force_turns_with_the_body(piece: Piece) -> None:
    """Spun about Z, then pushed along its X: the velocity gained points along X of B as it is by then; 2 % for 0.05 s of turning on."""
    gained = []
    for push in (0.0, 20000.0):
        piece.ready({})
        flown(piece, 2.0, leg1_torque=(0.0, 0.0, 4000.0))
        q = piece.vector("body.quaternion")
        gained.append(of(flown(piece, 2.05, 2.0, engine_force=(push, 0.0, 0.0)), "body.velocity")[-1])
    direction = (gained[1] - gained[0]) / np.linalg.norm(gained[1] - gained[0])
    expected = turned(q, np.array([1.0, 0.0, 0.0]))
    assert abs(expected[1]) > 0.05
    assert direction == pytest.approx(expected, abs=0.02)


def test_without_torque_angular_momentum_keeps_its_direction(piece: Piece) -> None:
    """A spin about a principal axis stays as it is: no wobble, no decay; 1e-3."""
    piece.ready({})
    before = of(flown(piece, 1.0, leg1_torque=(0.0, 3000.0, 0.0)), "body.angular_velocity")[-1]
    after = of(flown(piece, 3.0, 1.0), "body.angular_velocity")[-1]
    assert after == pytest.approx(before, abs=1e-3 * float(np.abs(before).max()))


def test_the_work_of_a_port_is_what_the_energy_grows_by(piece: Piece) -> None:
    """engine.work = Δ(kinetic + potential), where the unit reports them; 1e-3 of the work."""
    if not piece.has("engine.work", "energy.kinetic", "energy.potential"):
        pytest.skip("reports no energy")
    piece.ready({})
    before = piece["energy.kinetic"] + piece["energy.potential"]
    columns = flown(piece, 1.0, engine_force=(30000.0, 500.0, 0.0))
    after = columns["energy.kinetic"][-1] + columns["energy.potential"][-1]
    assert columns["engine.work"][-1] == pytest.approx(after - before, rel=1e-3)
    assert columns["engine.work"][-1] > 0.0
