"""What a report shows of each landing: measured and simulated courses, values at rest, contacts. SI throughout."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Contact:
    """A pad's first contact."""

    pad: str
    time: float
    """s, in the time of the courses."""


@dataclass
class ChannelCourse:
    """One measured channel with what the simulation makes of it."""

    series: str
    channel: str
    """As the data call it, e.g. rates.yaw."""
    unit: str
    data_times: Array
    data: Array
    sigma: float
    times: Array
    """Of the simulated courses, s."""
    before: Array
    """The scenario as it stands, uncertain parameters at their prior means."""
    before_fitted: Array | None = None
    """The same, uncertain parameters fitted."""
    after: Array | None = None
    """With the effect."""
    band: Array | None = None
    """One standard deviation of `after`, from what is not known of its parameters."""
    residual_before: Array | None = None
    """(data - simulation)/σ at data_times, best fit without the effect."""
    residual_after: Array | None = None


@dataclass
class RestValue:
    """One number at rest: value ± sigma, or low to high where only bounds are known."""

    name: str
    unit: str
    before: float
    before_fitted: float | None = None
    after: float | None = None
    value: float | None = None
    sigma: float | None = None
    low: float | None = None
    high: float | None = None
    edge: float | None = None
    """Of an interval: what counts as one standard deviation outside it."""


@dataclass
class LandingCourses:
    """One landing; `kind` says whether the search saw it."""

    name: str
    kind: Literal["fit", "holdout"]
    channels: list[ChannelCourse] = field(default_factory=list)
    rest: list[RestValue] = field(default_factory=list)
    contacts: list[Contact] = field(default_factory=list)
    title: str = ""
    shift: float = 0.0
    """s: the data's clock at first contact, from which windows of disagreement count."""

    @property
    def heading(self) -> str:
        return self.title or self.name

    @property
    def series(self) -> dict[str, list[ChannelCourse]]:
        """Channels by their series, in the order given."""
        found: dict[str, list[ChannelCourse]] = {}
        for channel in self.channels:
            found.setdefault(channel.series, []).append(channel)
        return found


def rms(residual: Array | None) -> float:
    """Root mean square of what is a number; NaN where nothing is."""
    if residual is None:
        return float("nan")
    kept = residual[np.isfinite(residual)]
    return float(np.sqrt(np.mean(kept**2))) if len(kept) else float("nan")
