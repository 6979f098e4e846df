"""The energy account of a run: what there was, what came in, what was turned into heat, and what nobody can explain."""

from dataclasses import dataclass

import numpy as np

from orchestrator.results.channels import Array, Channels, finite
from orchestrator.results.schema import ResultsTable

OUTSIDE_WRENCHES = ("engine", "effect1", "effect2", "effect3", "effect4")


@dataclass(frozen=True)
class EnergyAccount:
    """Energies in J over the recorded instants, all counted from the start of the run. See `account` for the signs."""

    mechanical: Array  # kinetic plus potential of all units, above its value at the end of the run
    dissipated: Array  # in the units that keep an account of their own (the struts)
    absorbed: Array  # by what has no account of its own (the soil)
    supplied: Array  # by engine and effects to the vehicle
    residual: Array  # unexplained: lost if positive, made from nothing if negative
    initial: float  # kinetic energy at the start plus potential energy above that at the end

    def summary(self) -> dict[str, float | None]:
        """The account at the end of the run, J, and the residual as a fraction of the initial energy."""
        fraction = self.residual[-1] / self.initial if self.initial > 0.0 else np.nan
        return {
            "initial_J": finite(self.initial),
            "final_J": finite(self.mechanical[-1]),
            "supplied_J": finite(self.supplied[-1]),
            "dissipated_J": finite(self.dissipated[-1] + self.absorbed[-1]),
            "dissipated_in_units_J": finite(self.dissipated[-1]),
            "absorbed_by_soil_J": finite(self.absorbed[-1]),
            "residual_J": finite(self.residual[-1]),
            "residual_fraction": finite(fraction),
        }


def account(kinetic: Array, potential: Array, dissipated: Array, supplied: Array, pad_work: Array) -> EnergyAccount:
    """Balance the energies of a run, J, each a sum over units, each a column over time.

        residual(t) = E(0) − E(t) + W_supplied − D − A,    E = kinetic + potential,    A = −W_pad

    Signs: `supplied` is the work done ON the vehicle from outside (an engine that brakes supplies a negative amount).
    `pad_work` is the work the soil does ON the legs as the legs report it; sinking pads make it negative, and the soil,
    which keeps no account, has absorbed its opposite. `dissipated` grows from 0. Works and dissipation count from the
    first row. A positive residual was lost at the ports or by the integration, a negative one came from nowhere.
    """
    total = kinetic + potential
    gained, heat, soil = (column - column[0] for column in (supplied, dissipated, -pad_work))
    initial = float(kinetic[0] + potential[0] - potential[-1])
    return EnergyAccount(
        mechanical=total - potential[-1],
        dissipated=heat,
        absorbed=soil,
        supplied=gained,
        residual=total[0] - total + gained - heat - soil,
        initial=initial,
    )


def account_of(channels: Channels, table: ResultsTable) -> EnergyAccount | None:
    """The account from recorded columns; None where no unit reports a kinetic energy or nobody says where energy may leave.

    Works from outside are the columns named in `[results] work`, else `engine.work` and `effectN.work` of the body.
    What the soil took up is what the legs named in `[results.legs]` report; without legs, the works done on all units
    that report work and no energy. Without any of these the residual would only show what was left out.
    """
    kinetic = channels.ending(".energy.kinetic")
    legs, silent = [f"{names.leg}.pad.work" for names in table.legs.values()], _works_on_silent_units(channels)
    if not kinetic or len(channels.times) == 0 or not (legs or silent or table.work is not None):
        return None
    outside = table.work
    if outside is None:
        outside = [name for wrench in OUTSIDE_WRENCHES if (name := f"{table.body}.{wrench}.work") in channels.columns]
    return account(
        kinetic=channels.total(kinetic),
        potential=channels.total(channels.ending(".energy.potential")),
        dissipated=channels.total(channels.ending(".energy.dissipated")),
        supplied=channels.total(outside),
        pad_work=channels.total(legs) if legs else -channels.total(silent),
    )


def _works_on_silent_units(channels: Channels) -> list[str]:
    """Columns of work done on units that report no energy of their own, and so are outside the account."""
    accounted = {name.partition(".")[0] for name in channels.ending(".energy.kinetic")}
    return [name for name in channels.ending(".work") if name.partition(".")[0] not in accounted]
