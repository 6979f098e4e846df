"""Regression through the simulator: which generic terms the residual follows once the nuisances have had their share, and their real fits.

Every term's slopes are flown at the base fit and at the nuisances of the best library effect, where the nuisances have absorbed less.
Those that gain most at either are probed as the library's effects are: held where they would stand out, and let go. The slopes at the
winner's nuisances judge the others once more. A base fit that explains nothing sits in a false minimum, where slopes mislead and a wrench
on the body seems to explain most: there the few climb from the first touch on, as the library's effects do.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from orchestrator.diagnosis.climb import explains
from orchestrator.diagnosis.fit import Fit
from orchestrator.diagnosis.hypothesis import NULL, Hypothesis
from orchestrator.diagnosis.search import Search
from orchestrator.diagnosis.tasks.fits import FitAt, Point, point_of
from orchestrator.diagnosis.tasks.predict import slopes_beside
from orchestrator.diagnosis.terms.linear import Linear, View, linear, whitened
from orchestrator.diagnosis.terms.term import Term

Array = NDArray[np.float64]
PROBED, CLIMBING = 24, 8  # terms with fits of their own at first; that climb where the base fit explains nothing
LATER = 3  # fitted after the last view, beside the forms at the winner's own port
LAST_VIEW, ALIKE = 20, 12  # terms whose slopes are flown there, forms at the winner's port among them
REACH = 30.0  # of ln evidence: who is further behind the best fit is not refined
STALE = 6.0  # of ln evidence: a promise that the last view did not confirm makes no rival of the best fit
AHEAD = 3.0  # of ln evidence, by which an unfitted term must promise more than the best fit has
REFINED = 5
STEPS = 4


@dataclass
class Regression:
    """What is known of the terms: promised by slopes at each view, and fitted."""

    search: Search
    terms: Mapping[str, Term]
    hypotheses: Mapping[str, Hypothesis]
    views: list[View] = field(default_factory=list)
    promised: dict[str, float] = field(default_factory=dict)
    """ln evidence by the last view that has the term."""
    gains: dict[str, float] = field(default_factory=dict)
    """The most that it gains at any view over the nuisances alone there."""
    estimates: dict[str, tuple[int, float]] = field(default_factory=dict)
    """View of it, z of the coefficient there."""
    fits: dict[str, Fit] = field(default_factory=dict)

    @property
    def ports(self) -> dict[str, str]:
        return {name: term.port for name, term in self.terms.items()}

    @property
    def evidence(self) -> dict[str, float]:
        """Of the fits where there are any, else what is promised, but no more than the best fit has; STALE less from earlier views."""
        ceiling = max((fit.log_evidence for fit in self.fits.values()), default=np.inf)
        last = len(self.views) - 1
        promised = {name: min(value, ceiling - STALE * (self.estimates[name][0] != last)) for name, value in self.promised.items()}
        return promised | {name: fit.log_evidence for name, fit in self.fits.items()}

    def ranked(self, names: Sequence[str] | None = None) -> list[str]:
        """By what is promised, best first."""
        return sorted(self.promised if names is None else names, key=lambda n: -self.promised[n])

    def gaining(self, names: Sequence[str]) -> list[str]:
        """By what they gain, best first. Nuisances that fit worse at one view say nothing of a term."""
        return sorted(names, key=lambda n: -self.gains[n])

    def look_from(self, view: View, names: Sequence[str]) -> Linear:
        """Slopes of these terms at a view, and what they promise."""
        search = self.search
        terms = [self.hypotheses[n].coordinates for n in names]
        asks = [slopes_beside(search.landings, search.nuisances, view.z, view.predicted, term) for term in terms]
        columns = search.run("terms", asks)
        view.columns = {n: column[:, 0] for n, column in zip(names, columns, strict=True)}
        self.views.append(view)
        found = linear(whitened(search.landings, search.nuisances, view))
        for n, value, estimate in zip(names, found.evidence.tolist(), found.estimate.tolist(), strict=True):
            self.promised[n] = value
            self.gains[n] = max(self.gains.get(n, -np.inf), value - found.null)
            self.estimates[n] = (len(self.views) - 1, estimate)
        return found

    def fit(self, names: Sequence[str]) -> None:
        """Fits of their own, from where each promised most, at what it promised."""
        search = self.search
        tasks = []
        for n in names:
            place, estimate = self.estimates[n]
            view, coordinates = self.views[place], self.hypotheses[n].coordinates
            low, high = coordinates[0].bounds
            start = np.concatenate([view.z, [float(np.clip(estimate, low, high))]])
            point = Point(view.z, view.predicted, view.slopes, np.inf)
            tasks.append(FitAt(search.landings, (*search.nuisances, *coordinates), point, start, STEPS))
        self.keep(dict(zip(names, search.run("terms", tasks), strict=True)))

    def keep(self, fits: Mapping[str, Fit | None]) -> None:
        """Those that are better than what there was."""
        for name, fit in fits.items():
            if fit is not None and (name not in self.fits or fit.objective < self.fits[name].objective):
                self.fits[name] = fit

    def size(self, name: str) -> float:
        """The coefficient as fitted, else as promised."""
        coordinate = self.hypotheses[name].coordinates[0]
        return coordinate.value(float(self.fits[name].z[-1]) if name in self.fits else self.estimates[name][1])

    def best(self, names: Sequence[str]) -> str | None:
        """Of these the fitted one with most evidence."""
        return max((n for n in names if n in self.fits), key=lambda n: self.fits[n].log_evidence, default=None)


def regressed(regression: Regression, base: Fit, better: Fit | None, offered: Sequence[str]) -> str | None:
    """All of it; the best of the terms `offered`, None where none of them can be flown.

    Where some have fits already, only these are probed.
    """
    search = regression.search
    here = point_of(base)
    there = search.without(better) if better is not None else None
    begun = list(regression.fits)
    for point in (here, there) if not begun else (there or here,):
        if point is not None:
            regression.look_from(View(point.z, point.predicted, point.slopes), list(regression.hypotheses))
    first = begun or chosen(regression, offered)
    if not first:
        return None
    regression.keep(search.probed([regression.hypotheses[n] for n in first], here, "terms"))
    if not explains(base.chi2, search.landings.size):
        few = [regression.hypotheses[n] for n in first[:CLIMBING]]
        fits = search.fit_all(few, base)
        regression.keep(fits if search.explained_by(fits) else search.race(few, fits, base))
    if regression.best(offered) is None:
        return None
    _refine(regression, offered)
    winner = regression.best(offered)
    if winner is not None and _look_again(regression, winner, offered):
        _refine(regression, offered)
    return regression.best(offered)


def chosen(regression: Regression, offered: Sequence[str]) -> list[str]:
    """PROBED terms: the best of every port, since a trapped base fit promises to the wrong one, then the best of the others."""
    ranked = regression.gaining(offered)
    best = {regression.terms[n].port: n for n in reversed(ranked)}
    first = [n for n in ranked if n in best.values()]
    return (first + [n for n in ranked if n not in first])[:PROBED]


def _look_again(regression: Regression, winner: str, offered: Sequence[str]) -> bool:
    """From the winner's nuisances: the other forms at its port are fitted from there, and whoever promises clearly more than it has."""
    point = regression.search.without(regression.fits[winner])
    if point is None:
        return False
    view = View(point.z, point.predicted, point.slopes)
    forms = [n for n in regression.gaining(offered) if n != winner and regression.terms[n].port == regression.terms[winner].port][:ALIKE]
    names = list(dict.fromkeys([winner, *forms, *regression.ranked()]))[:LAST_VIEW]
    regression.look_from(view, names)
    ahead = regression.fits[winner].log_evidence - AHEAD
    alike = [n for n in forms if regression.promised[n] > ahead - REACH]
    ranked = [n for n in regression.ranked(offered) if n in names and n not in regression.fits and n not in alike]
    late = [n for n in ranked if regression.promised[n] > ahead][:LATER]
    regression.fit([*alike, *late])
    return regression.best(offered) != winner


def _refine(regression: Regression, offered: Sequence[str]) -> None:
    top = sorted((n for n in offered if n in regression.fits), key=lambda n: -regression.fits[n].log_evidence)[:REFINED]
    near = [n for n in top if regression.fits[n].log_evidence > regression.fits[top[0]].log_evidence - REACH]
    refined = regression.search.refine_all([regression.fits[n] for n in near], "terms")
    regression.fits |= dict(zip(near, refined, strict=True))


def best_of_library(fits: Mapping[str, Fit]) -> Fit | None:
    """Whose nuisances have absorbed least."""
    names = [n for n in fits if n != NULL.name]
    return max((fits[n] for n in names), key=lambda fit: fit.log_evidence, default=None)
