"""The form in which every law of the regolith gives its normal force."""

from typing import NamedTuple


class Normal(NamedTuple):
    """Normal force with its derivatives by depth and sink rate."""

    force: float  # N
    stiffness: float  # dF/dδ, N/m
    damping: float  # dF/dδ̇, N s/m
