"""RingUnit: does nothing, quickly: it passes twelve numbers on."""

from ..shell import Unit, input_, output


class RingUnit(Unit):
    """taken → given, at the end of each interval."""

    description = "Passes twelve numbers on."
    variables = (
        input_("in.value", (0.0,) * 12, "1", "twelve numbers"),
        output("out.value", (0.0,) * 12, "1", "the same, an interval later", mean=True),
    )

    def advance(self, time: float, step: float) -> None:
        self["out.value"] = self["in.value"]
