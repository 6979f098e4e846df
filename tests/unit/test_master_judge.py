"""The judge and the clock: arithmetic only."""

from math import nan

import pytest

from orchestrator.master.judge import StepLimits, fit_to_stop, halve, judge
from orchestrator.master.settings import in_ns

LIMITS = StepLimits(50_000, 2_000_000, 1e-5)


def test_a_step_at_the_tolerance_is_accepted_and_the_next_is_a_little_shorter() -> None:
    assert judge(1_000_000, 1e-5, LIMITS) == (True, False, 900_000)


def test_a_quarter_of_the_tolerance_allows_almost_twice_the_interval() -> None:
    assert judge(1_000_000, 0.25e-5, LIMITS).next_interval == pytest.approx(1_800_000, abs=1)


@pytest.mark.parametrize(("estimate", "factor"), [(0.0, 2.0), (1e-9, 2.0), (1.0, 0.2)])
def test_the_interval_changes_at_most_by_two_and_by_a_fifth(estimate: float, factor: float) -> None:
    assert judge(1_000_000, estimate, LIMITS).next_interval == factor * 1_000_000


def test_a_rejected_step_is_always_retried_with_a_shorter_one() -> None:
    verdict = judge(1_000_000, 1.0000001e-5, LIMITS)
    assert not verdict.accepted
    assert verdict.next_interval < 1_000_000


def test_soon_after_a_rejection_the_interval_does_not_grow_but_may_shrink() -> None:
    assert judge(1_000_000, 1e-9, LIMITS, settling=True).next_interval == 1_000_000
    assert judge(1_000_000, 1e-5, LIMITS, settling=True).next_interval == 900_000


def test_the_smallest_interval_is_accepted_but_counts_as_unresolved() -> None:
    assert judge(50_000, 1.0, LIMITS) == (True, True, 50_000)


def test_what_cannot_be_undone_is_accepted_but_counts_as_unresolved() -> None:
    assert judge(1_000_000, 1.0, LIMITS, can_undo=False) == (True, True, 200_000)


def test_without_an_estimate_the_largest_interval_is_used() -> None:
    assert judge(1_000, nan, LIMITS) == (True, False, LIMITS.maximum)


def test_halving_ends_at_the_smallest_interval() -> None:
    assert halve(1_000_000, LIMITS) == 500_000
    assert halve(60_000, LIMITS) == 50_000
    assert halve(50_000, LIMITS) is None


def test_the_last_intervals_add_up_to_the_stop_time_without_a_sliver() -> None:
    for remaining in (1, 49_999, 1_000_000, 1_000_001, 1_049_999, 2_010_000, 7_123_457):
        steps, left = 0, remaining
        while left:
            taken = fit_to_stop(1_000_000, left, LIMITS)
            assert 0 < taken <= LIMITS.maximum
            assert taken >= min(remaining, LIMITS.minimum)
            left -= taken
            steps += 1
        assert steps <= remaining / 1_000_000 + 2


def test_time_is_counted_so_a_million_steps_do_not_drift() -> None:
    assert 1_000_000 * in_ns(1e-3) == in_ns(1000.0)
