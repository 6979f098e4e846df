"""Records and layout: companions, places in memory, units."""

import numpy as np
import pytest
from lander.shell import input_, output, parameter, state
from lander.shell.layout import Layout
from lander.shell.unit_strings import exponents, rate_of


@pytest.mark.parametrize(("unit", "powers"), [
    ("N.m", {"kg": 1, "m": 2, "s": -2}), ("m/s2", {"m": 1, "s": -2}), ("kg.m2", {"kg": 1, "m": 2}), ("N.s/m", {"kg": 1, "s": -1}),
    ("1/s", {"s": -1}), ("1/kg", {"kg": -1}), ("N.m.s/rad", {"kg": 1, "m": 2, "s": -1, "rad": -1}), ("1", {}), ("", {}),
    ("N/m.s", {"kg": 1, "s": -3}), ("Pa", {"kg": 1, "m": -1, "s": -2})])
def test_a_unit_string_gives_its_exponents(unit: str, powers: dict[str, int]) -> None:
    assert exponents(unit) == powers


@pytest.mark.parametrize("unit", ["deg", "N*m", "m/s/s", "m^2", "N.", "/s"])
def test_an_unknown_unit_is_refused(unit: str) -> None:
    with pytest.raises(ValueError, match="unit"):
        exponents(unit)


@pytest.mark.parametrize(("unit", "rate"), [
    ("N", "N/s"), ("m/s", "m/s2"), ("m/s2", "m/s3"), ("rad/s", "rad/s2"), ("1", "1/s"), ("N.s/rad", "N.s/rad.s"), ("", "1/s")])
def test_the_unit_of_a_rate(unit: str, rate: str) -> None:
    assert rate_of(unit) == rate
    assert exponents(rate).get("s", 0) == exponents(unit).get("s", 0) - 1


def test_companions_follow_their_variable_and_declared_order_is_memorys_order() -> None:
    layout = Layout((parameter("mass", 2.0, "kg", "of it"),
                     input_("pad.force", (0.0, 0.0, 1.0), "N", "frame L", slope=True, added=True),
                     state("hidden", (7.0, 8.0)),
                     output("mount.force", (0.0,), "N", "frame B", mean=True, slope=True)))
    assert [scalar.name for scalar in layout.scalars] == [
        "mass", "pad.force[1]", "pad.force[2]", "pad.force[3]", "pad.force_slope[1]", "pad.force_slope[2]", "pad.force_slope[3]",
        "pad.force_added[1]", "pad.force_added[2]", "pad.force_added[3]", "hidden[1]", "hidden[2]",
        "mount.force[1]", "mount.force_mean[1]", "mount.force_slope[1]"]
    assert [scalar.slot for scalar in layout.scalars] == list(range(15))
    assert layout.template[:12].tolist() == [2.0, 0.0, 0.0, 1.0] + [0.0] * 6 + [7.0, 8.0]
    units = {record.name: record.unit for record in layout.records}
    assert (units["pad.force_slope"], units["pad.force_added"], units["mount.force_mean"]) == ("N/s", "N", "N")


def test_a_name_declared_twice_is_refused() -> None:
    with pytest.raises(ValueError, match="x_slope is declared twice"):
        Layout((input_("x", 0.0, "m", "", slope=True), input_("x_slope", 0.0, "m/s", "")))


def test_hidden_states_have_no_value_reference() -> None:
    layout = Layout((state("hidden", 0.0), parameter("p", 1.0, "1", "")))
    assert layout.access([1])[0] == slice(1, 2)
    for reference in (0, 2, -1):
        with pytest.raises(IndexError, match="unknown"):
            layout.access([1, reference])


def test_any_order_of_references_gives_the_values_in_that_order() -> None:
    layout = Layout((input_("x", tuple(float(i) for i in range(9)), "m", ""),))
    memory = np.arange(20.0)
    for references in ([3], [0, 1, 2], [2, 1, 0], [0, 1, 3], [4, 4], []):
        assert memory[layout.access(references)[0]].tolist() == references
