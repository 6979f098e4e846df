"""Connections by name: what is joined, and what is refused."""

import pytest

from orchestrator.errors import WiringError
from orchestrator.master.slave import Interface, Kind, Variable
from orchestrator.scenario.conversion import unit_conversion
from orchestrator.scenario.expand import Connection
from orchestrator.scenario.wiring import Wiring

METRE = (0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)
NEWTON = (1.0, 1.0, -2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0)


def unit(**variables: str) -> Interface:
    """name = "causality unit", e.g. pad__force="input N"; a name with 3 in front is a vector."""
    found = {}
    for key, text in variables.items():
        causality, _, unit_name = text.partition(" ")
        name = key.replace("__", ".")
        names = [f"{name[1:]}[{i}]" for i in (1, 2, 3)] if name[0] == "v" and name[1] == "_" else [name]
        for n in names:
            n = n.removeprefix("_")
            kind = Kind.BOOLEAN if unit_name == "flag" else Kind.REAL
            dimension = {"N": NEWTON, "m": METRE, "metre": METRE}.get(unit_name)
            found[n] = Variable(n, kind, causality, "" if unit_name == "flag" else unit_name, dimension)
    return Interface("M", found)


LEG = unit(
    v_pad__position="output m", v_pad__velocity="output m/s", v_pad__force="input N", v_pad__force_slope="input N/s",
    v_pad__force_added="input N", pad__model_mobility="output 1/kg", pad__work="output J", height="input m", bend="output rad",
)  # fmt: skip
SOIL = unit(
    v_pad__position="input m", v_pad__force="output N", v_pad__force_mean="output N", v_pad__force_slope="output N/s",
    pad__work="output J", pad__contact="output flag", normal_force="output N", v_pad__mismatch_velocity="input m/s",
)  # fmt: skip
UNITS = {"leg": LEG, "soil": SOIL, "soil2": SOIL}


def wired(*connections: Connection) -> Wiring:
    wiring = Wiring(UNITS, "case.toml")
    for connection in connections:
        wiring.connect(connection)
    return wiring


def test_ports_join_both_ways_by_member_and_companions_stay_out() -> None:
    wiring = wired(Connection("leg.pad", "soil.pad", True, True))
    expected = {(unit, f"pad.{member}[{i}]") for unit, member in ((0, "position"), (1, "force")) for i in (1, 2, 3)}
    assert {(k.source_unit, k.source) for k in wiring.links} == expected
    assert all(k.source == k.target for k in wiring.links)
    assert [(p.first_unit, p.first_port, p.second_unit, p.second_port) for p in wiring.pairs] == [(0, "pad", 1, "pad")]


def test_a_single_variable_and_a_whole_vector_connect_one_way() -> None:
    one = Connection("leg.pad.position[1]", "leg.height", False, True)
    wiring = wired(one, Connection("leg.pad.position", "soil.pad.position", False, True))
    assert [(k.source, k.target) for k in wiring.links][:2] == [("pad.position[1]", "height"), ("pad.position[1]", "pad.position[1]")]
    assert len(wiring.links) == 4


def test_an_undeclared_unit_fits_and_names_of_one_dimension_fit() -> None:
    assert unit_conversion(Variable("a", unit=""), Variable("b", unit="N")) == (1.0, 0.0)
    assert unit_conversion(Variable("a", unit="m", dimension=METRE), Variable("b", unit="metre", dimension=METRE)) == (1.0, 0.0)
    assert unit_conversion(Variable("a", unit="m", dimension=METRE), Variable("b", unit="N", dimension=NEWTON)) is None
    assert unit_conversion(Variable("a", unit="m"), Variable("b", unit="km")) is None


REFUSED = {
    Connection("soil.normal_force", "leg.height", False, True): "case.toml: soil.normal_force -> leg.height: sends N, expects m;",
    Connection("soil.pad.contact", "leg.height", False, True): "sends Boolean, expects Real",
    Connection("leg.pad.position", "leg.height", False, True): "sends 3 elements, expects 1",
    Connection("sol.pad", "leg.pad", True, True): 'case.toml: sol.pad: no unit "sol"; did you mean "soil"?',
    Connection("soil.pda", "leg.pad", True, True): 'case.toml: soil.pda: unit soil has no port "pda"; did you mean "pad"?',
    Connection("leg.bnd", "soil.pad", False, True): 'case.toml: leg.bnd: unit leg has no output "bnd"; did you mean "bend"?',
    Connection("leg.height", "soil.pad.position", False, True): "leg.height: is of causality input, expects output",
    Connection("leg", "soil.pad", True, True): "case.toml: leg: expects unit.port or unit.variable",
    Connection("soil.pad", "soil2.pad", True, True): "case.toml: soil.pad <-> soil2.pad: no member in common: one gives force, work",
}


@pytest.mark.parametrize(("connection", "message"), REFUSED.items())
def test_what_does_not_fit_is_said_in_one_line(connection: Connection, message: str) -> None:
    with pytest.raises(WiringError) as caught:
        wired(connection)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_an_input_is_fed_once() -> None:
    with pytest.raises(WiringError, match=r"leg\.pad\.force\[1\]: fed by soil\.pad\.force\[1\] and by soil2\.pad\.force\[1\]; remove one"):
        wired(Connection("leg.pad", "soil.pad", True, True), Connection("soil2.pad.force", "leg.pad.force", False, True))
