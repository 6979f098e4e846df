"""The reference experiment of a unit: what it gives for its own stimulus, as a file that is kept and packed with it.

First lines "# name = value": parameters other than their defaults. Then a header and one row a communication point: time, the inputs
set for the interval that begins there, the outputs at that point. Numbers read back to the last bit.
"""

from pathlib import Path
from typing import TYPE_CHECKING

from .layout import Layout, Scalar

if TYPE_CHECKING:
    from .unit import Unit

FOLDER = Path(__file__).parents[2] / "reference"  # beside the package, not in it: results are no source


def elements(layout: Layout, name: str) -> list[Scalar]:
    """The scalars of a variable."""
    return layout.scalars[layout.slices[name]]


def reference_text(unit: "type[Unit]") -> str:
    """Run the default experiment with the unit's stimulus."""
    start, stop, step = unit.experiment
    layout, one = unit.layout, unit(instance_name="reference")
    inputs = [scalar for name in unit.stimulus(start) for scalar in elements(layout, name)]
    outputs = [scalar for scalar in layout.visible if scalar.record.causality == "output"]
    lines = []
    for name, value in unit.reference_parameters:
        one[name] = value
        lines += [f"# {scalar.name} = {float(one.memory[scalar.slot])!r}" for scalar in elements(layout, name)]
    lines.append(",".join(["time", *(scalar.name for scalar in (*inputs, *outputs))]))
    one.setup_experiment(start, stop, None)
    one.enter_initialization_mode()
    count = round((stop - start) / step)
    for n in range(count + 1):
        time = start + n * step
        for name, value in unit.stimulus(time).items():
            one[name] = value
        if n == 0:
            one.exit_initialization_mode()
        lines.append(",".join(repr(float(x)) for x in (time, *one.memory[[scalar.slot for scalar in (*inputs, *outputs)]])))
        if n < count and not one.do_step(time, step):
            raise RuntimeError(f"{unit.__name__}: the reference experiment stops: {one.message}")
    return "\n".join(lines) + "\n"
