"""terminalsAndIcons.xml: one terminal a port, so that a connection of two ports is one line. FMI 2 has it since 2.0.4.

Terminals stand round the unit's icon: ports that only give on its right, the others on its left.
"""

from typing import TYPE_CHECKING
from xml.etree.ElementTree import Element, SubElement

from .layout import Layout, Scalar

if TYPE_CHECKING:
    from .unit import Unit


def ports(layout: Layout) -> dict[str, list[Scalar]]:
    """The coupled variables of each port: what stands before the first point of their names."""
    found: dict[str, list[Scalar]] = {}
    for scalar in layout.visible:
        port, point, _ = scalar.name.partition(".")
        if point and scalar.record.causality in ("input", "output"):
            found.setdefault(port, []).append(scalar)
    return found


def terminals_and_icons(unit: "type[Unit]") -> Element:
    """The terminals; a member's name is the variable's less its port, so that partners match member by member."""
    root = Element("fmiTerminalsAndIcons", {"fmiVersion": "3.0"})
    graphics = SubElement(root, "GraphicalRepresentation")
    box = {"x1": "-100", "y1": "-100", "x2": "100", "y2": "100"}
    SubElement(graphics, "CoordinateSystem", {**box, "suggestedScalingFactorTo_mm": "0.1"})
    SubElement(graphics, "Icon", box)
    terminals = SubElement(root, "Terminals")
    named = ports(unit.layout)
    sides = [port for port, members in named.items() if takes(members)], [port for port, members in named.items() if not takes(members)]
    for port, members in named.items():
        terminal = SubElement(terminals, "Terminal", {"name": port, "matchingRule": "bus", "terminalKind": "lander.port"})
        for scalar in members:
            SubElement(
                terminal,
                "TerminalMemberVariable",
                {"variableName": scalar.name, "memberName": scalar.name.partition(".")[2], "variableKind": "signal"},
            )
        terminal.append(place_of(port, *sides))
    return root


def takes(members: list[Scalar]) -> bool:
    """Whether a port has an input."""
    return any(scalar.record.causality == "input" for scalar in members)


def place_of(port: str, left: list[str], right: list[str]) -> Element:
    """Where a terminal is drawn: evenly down its side, 10 wide."""
    side, x = (left, -100.0) if port in left else (right, 100.0)
    y = 100.0 - 200.0 * (side.index(port) + 0.5) / len(side)
    edges = {"x1": x - 5.0, "y1": y - 5.0, "x2": x + 5.0, "y2": y + 5.0}
    colour = {"defaultConnectionColor": "31 58 95", "defaultConnectionStrokeSize": "1"}
    return Element(
        "TerminalGraphicalRepresentation", {**colour, **{name: f"{edge:.4g}" for name, edge in edges.items()}, "iconBaseName": "port"}
    )
