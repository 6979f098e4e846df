"""Runs beside a nominal one: the same landing, its derivative against tightly integrated ones, and on its own where it must be."""

from typing import NamedTuple

import numpy as np
import pytest
from apollo_samples import ADAMS, ADAMS_SOIL, started, vehicle
from lander.laws.soil import RATE_INDEPENDENT
from lander.laws.twin import VX, WX, Engine, Flight, V, Vehicle
from lander.laws.twin_effects import no_effects
from lander.laws.twin_nominal import ALONE, BESIDE, KEPT, Nominal, nominal_room
from lander.laws.twin_stepping import Ride, Settings, fly, start_accelerations
from lander.laws.vectors import ZERO

ENGINE = Engine((5000.0, 0.0, 0.0), ZERO, (-5000.0, 0.0, 0.0), ZERO)
SOIL = ADAMS_SOIL._replace(law=RATE_INDEPENDENT)
INTERVALS = [0.01] * 30


class Flown(NamedTuple):
    rates: np.ndarray  # of the body after each interval, (k, 6): velocities in L, rates in B
    flight: Flight
    steps: int
    rejected: int


def landing(nominal: Nominal, mode: int, friction: float = 0.36, tolerance: float = 3e-4, intervals: list[float] = INTERVALS) -> Flown:
    """The first contacts of a landing, with friction as the parameter."""
    craft: Vehicle = vehicle(ADAMS, SOIL._replace(friction=friction))
    flight, a = started(craft, ADAMS, 1e-4), np.zeros((5, 6))
    assert start_accelerations(craft, ENGINE, flight, a)
    ride = Ride(flight, a, np.zeros((5, 4)), -np.ones(4), np.zeros(4))
    nominal.use[0] = mode
    t, h, rows, steps, rejected = 0.0, 1e-5, [], 0, 0
    for interval in intervals:
        done = fly(craft, no_effects(), ENGINE, Settings(tolerance, 0.02, h), ride, nominal, t, interval)
        assert done.ok
        t, h, steps, rejected = t + interval, done.next_step, steps + done.steps, rejected + done.rejected
        rows.append([*flight.body[VX : VX + 3], *flight.body[WX : WX + 3]])
    return Flown(np.array(rows), flight, steps, rejected)


@pytest.fixture(scope="module")
def kept() -> tuple[Nominal, Flown]:
    nominal = nominal_room(4, 2000)
    return nominal, landing(nominal, KEPT)


def test_keeping_the_steps_changes_nothing(kept: tuple[Nominal, Flown]) -> None:
    alone = landing(nominal_room(0, 0), ALONE)
    assert np.array_equal(alone.rates, kept[1].rates)
    assert alone.steps == kept[1].steps == kept[0].use[1]


def test_beside_itself_it_is_the_same_landing_without_a_rejected_step(kept: tuple[Nominal, Flown]) -> None:
    """Tolerance: what Newton leaves of a stage, 2.7e-7 m/s, a few times over: it does not add up, contacts forget it."""
    again = landing(kept[0], BESIDE)
    assert (again.steps, again.rejected) == (kept[1].steps, 0)
    assert np.abs(again.rates - kept[1].rates).max() < 1e-6
    assert np.allclose(again.flight.memory, kept[1].flight.memory, atol=1e-7)


def test_a_small_difference_beside_gives_the_derivative(kept: tuple[Nominal, Flown]) -> None:
    """By friction, against central differences of landings of their own at 3e-7 m/s, a thousand times finer.

    Tolerance: the nominal run's discretisation leaves 2 %, the differences' curvature 1.6 % (40 % over 0.01 of friction).
    """
    d, wide = 1e-4, 1e-3
    exact = (landing(kept[0], ALONE, 0.36 + wide, 3e-7).rates - landing(kept[0], ALONE, 0.36 - wide, 3e-7).rates) / (2.0 * wide)
    beside = (landing(kept[0], BESIDE, 0.36 + d).rates - kept[1].rates) / d
    assert np.linalg.norm(beside - exact) < 0.04 * np.linalg.norm(exact)


def test_far_from_the_nominal_it_is_as_fine_as_on_its_own(kept: tuple[Nominal, Flown]) -> None:
    """Half the friction, against 3e-7 m/s. Tolerance: thrice what a run of its own at this tolerance is off."""
    exact = landing(kept[0], ALONE, 0.18, 3e-7).rates
    alone, beside = landing(kept[0], ALONE, 0.18).rates, landing(kept[0], BESIDE, 0.18).rates
    assert np.abs(beside - exact).max() < 3.0 * np.abs(alone - exact).max()


def test_other_communication_points_than_the_nominal_cut_its_steps(kept: tuple[Nominal, Flown]) -> None:
    """Tolerance: 3e-4 m/s a step, of which contacts let a few stand."""
    other = [0.004, *[0.01] * 29, 0.006]
    assert np.abs(landing(kept[0], BESIDE, intervals=other).rates[-1] - kept[1].rates[-1]).max() < 2e-3


def test_a_nominal_flown_again_from_an_earlier_instant_forgets_what_came_after() -> None:
    nominal = nominal_room(4, 2000)
    landing(nominal, KEPT)
    long = int(nominal.use[1])
    landing(nominal, KEPT, intervals=INTERVALS[:5])
    assert 0 < nominal.use[1] < long


def test_past_the_room_for_steps_it_goes_on_alone() -> None:
    nominal = nominal_room(4, 10)
    whole = landing(nominal, KEPT)
    assert nominal.use[1] == 10
    assert np.abs(landing(nominal, BESIDE).rates - whole.rates).max() < 2e-3


def test_legs_rates_are_the_nominals_too(kept: tuple[Nominal, Flown]) -> None:
    again = landing(kept[0], BESIDE)
    assert np.abs(again.flight.legs[:, V : V + 3] - kept[1].flight.legs[:, V : V + 3]).max() < 1e-5
