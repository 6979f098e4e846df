"""terminalsAndIcons.xml: one terminal a port, so that a connection of two ports is one line. FMI 2 has it since 2.0.4."""

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
    terminals = SubElement(root, "Terminals")
    for port, members in ports(unit.layout).items():
        terminal = SubElement(terminals, "Terminal", {"name": port, "matchingRule": "bus", "terminalKind": "lander.port"})
        for scalar in members:
            SubElement(
                terminal,
                "TerminalMemberVariable",
                {"variableName": scalar.name, "memberName": scalar.name.partition(".")[2], "variableKind": "signal"},
            )
    return root
