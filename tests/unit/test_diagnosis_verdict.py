"""The rules of a verdict, on hypotheses whose fits are made up."""

from dataclasses import replace

import numpy as np
import pytest

from orchestrator.diagnosis.hypothesis import NULL
from orchestrator.diagnosis.verdict import OUTSIDE, TOGETHER, Judged, contenders, informed, judge, probabilities

LIBRARY = 40
FINE, POOR = 0.4, 1e-6


def null(adequacy: float) -> Judged:
    return Judged(NULL.name, 0.0, adequacy)


def named(*hypotheses: Judged) -> tuple[str, tuple[str, ...]]:
    found = judge(hypotheses, LIBRARY)
    return found.verdict, found.names


def test_nothing_is_missing_where_no_effect_gains_enough() -> None:
    assert named(null(FINE)) == ("nothing_missing", ())
    assert named(null(FINE), Judged("a", 4.9, FINE), Judged("b", -3.0, FINE)) == ("nothing_missing", ())


def test_an_effect_must_outweigh_the_whole_library_not_only_gain_five() -> None:
    assert named(null(FINE), Judged("a", 5.5, FINE)) == ("nothing_missing", ())
    assert named(null(FINE), Judged("a", 7.0, FINE)) == ("effect", ("a",))


def test_a_name_holds_nine_tenths_of_everything_not_of_the_effects_alone() -> None:
    """Of the effects a has 0.91; with nothing missing's 0.07 beside them 0.85."""
    hypotheses = [null(FINE), Judged("a", 6.3, FINE), Judged("b", 4.0, FINE)]
    found = probabilities(hypotheses, LIBRARY)
    assert found["a"] < 0.9 < found["a"] / (found["a"] + found["b"])
    assert named(*hypotheses) == ("nothing_missing", ())
    assert named(null(FINE), Judged("a", 6.9, FINE), Judged("b", 4.0, FINE)) == ("effect", ("a",))


def test_one_effect_far_ahead_of_its_rivals_is_named() -> None:
    assert named(null(POOR), Judged("a", 60.0, FINE), Judged("b", 50.0, FINE)) == ("effect", ("a",))


def test_effects_that_fit_alike_are_not_told_apart() -> None:
    verdict, names = named(null(POOR), Judged("a", 60.0, FINE), Judged("b", 59.0, FINE), Judged("c", 40.0, FINE))
    assert (verdict, names) == ("cannot_tell", ("a", "b"))


def test_the_set_of_those_that_cannot_be_told_apart_holds_nine_tenths() -> None:
    _, names = named(null(POOR), *(Judged(n, 60.0 - 0.1 * i, FINE) for i, n in enumerate("abcde")))
    found = probabilities([null(POOR), *(Judged(n, 60.0 - 0.1 * i, FINE) for i, n in enumerate("abcde"))], LIBRARY)
    assert sum(found[n] for n in names) >= 0.9
    assert sum(found[n] for n in names[:-1]) < 0.9


def test_a_residual_that_nothing_explains_is_none_of_the_effects() -> None:
    assert named(null(POOR), Judged("a", 3.0, POOR)) == ("none_of_my_effects", ())
    assert named(null(POOR), Judged("a", 60.0, POOR)) == ("none_of_my_effects", ())


@pytest.mark.parametrize(("gain", "adequacy", "named_all_the_same"), [(5.0, FINE, True), (-0.5, FINE, False), (5.0, 1e-4, False)])
def test_a_name_must_gain_on_the_held_out_landing_and_leave_noise_there(gain: float, adequacy: float, named_all_the_same: bool) -> None:
    verdict, names = named(null(POOR), Judged("a", 60.0, FINE, gain, adequacy))
    assert (verdict, names) == (("effect", ("a",)) if named_all_the_same else ("none_of_my_effects", ()))


def test_where_nothing_missing_is_adequate_an_effect_that_fails_on_the_held_out_landing_is_nothing_missing() -> None:
    found = judge([null(FINE), Judged("a", 9.0, FINE, -1.0, FINE)], LIBRARY)
    assert found.verdict == "nothing_missing"
    assert "held-out" in found.why


def test_what_noise_does_not_lend_an_effect_is_missing_all_the_same() -> None:
    """A law outside the library: adhesion led by 33.7 in ln evidence, failed on the held-out landing, and nothing missing had p = 0.049."""
    found = judge([null(FINE), Judged("a", 33.7, FINE, 1.9, 1e-4)], LIBRARY)
    assert found.verdict == "none_of_my_effects"
    assert "held-out" in found.why


def test_two_effects_at_once_are_named_where_no_single_one_does() -> None:
    pair = Judged("a + b", 90.0, FINE)
    assert named(null(POOR), Judged("a", 60.0, POOR), Judged("b", 20.0, POOR), pair) == ("effects", ("a", "b"))


def test_pairs_that_cannot_be_told_apart_are_the_answers_their_effects_the_names() -> None:
    found = judge([null(POOR), Judged("a + b", 90.0, FINE), Judged("a + c", 89.9, FINE), Judged("a", 50.0, POOR)], LIBRARY)
    assert (found.verdict, found.names) == ("cannot_tell", ("a", "b", "c"))
    assert found.answers == ("a + b", "a + c")


def test_a_pair_must_explain_more_than_a_single_effect_by_enough() -> None:
    """There are 20 times as many pairs as effects, and a twentieth of the prior is for them all: 6 in ln evidence."""
    assert named(null(POOR), Judged("a", 60.0, FINE), Judged("a + b", 61.0, FINE)) == ("effect", ("a",))
    assert named(null(POOR), Judged("a", 60.0, FINE), Judged("a + b", 66.0, FINE)) == ("cannot_tell", ("a", "b"))
    assert named(null(POOR), Judged("a", 60.0, FINE), Judged("a + b", 70.0, FINE)) == ("effects", ("a", "b"))


def test_half_of_the_prior_is_nothing_missing_and_the_library_shares_the_rest() -> None:
    found = probabilities([Judged(NULL.name, 0.0, 1.0), *(Judged(f"e{i}", 0.0, 1.0) for i in range(LIBRARY))], LIBRARY)
    assert found[NULL.name] == pytest.approx(0.5, abs=0.02)
    assert found["e0"] == pytest.approx(0.5 / LIBRARY, rel=0.06)
    assert sum(found.values()) == pytest.approx(1.0)


def shares(*hypotheses: Judged) -> tuple[float, ...]:
    found = probabilities([null(POOR), *hypotheses], 47)
    return tuple(found[h.name] for h in hypotheses)


def test_a_law_outside_the_library_must_lead_a_single_by_what_its_prior_asks_and_may_trail_a_pair() -> None:
    single, pair = Judged("damping", 40.0, FINE), Judged("damping + slope", 40.0, FINE)
    asked = np.log((1.0 - TOGETHER) / 47 * 100 / OUTSIDE)
    assert asked == pytest.approx(3.70, abs=0.01)
    assert shares(single, Judged("law", 40.0 + asked, FINE, laws=100)) == pytest.approx((0.5, 0.5))
    behind = np.log(47 * 46 / 2 / 100)  # 1081 pairs and 100 laws share as much
    assert shares(pair, Judged("law", 40.0 - behind, FINE, laws=100)) == pytest.approx((0.5, 0.5))
    assert shares(pair, Judged("law", 40.0 - behind - np.log(9.0), FINE, laws=100)) == pytest.approx((0.9, 0.1))


def with_law(*hypotheses: Judged) -> tuple[str, tuple[str, ...], tuple[str, ...]]:
    found = judge([null(POOR), *hypotheses], 47)
    return found.verdict, found.names, found.answers


def test_a_law_outside_the_library_has_its_place_among_the_answers() -> None:
    pair, law = Judged("a + b", 119.7, FINE), Judged("law", 115.8, FINE, laws=100)  # a torque that two frictions imitate: 4.6 to 1
    assert with_law(pair, law) == ("cannot_tell", ("a", "b", "law"), ("a + b", "law"))
    assert with_law(pair, replace(law, log_evidence=113.0)) == ("effects", ("a", "b"), ())
    assert with_law(pair, replace(law, log_evidence=123.0)) == ("none_of_my_effects", (), ("law",))
    assert with_law(pair, replace(law, adequacy=1e-3)) == ("effects", ("a", "b"), ())
    assert with_law(replace(pair, holdout_gain=5.0, holdout_adequacy=FINE), replace(law, holdout_gain=-1.0, holdout_adequacy=FINE)) == (
        "effects",
        ("a", "b"),
        (),
    )


@pytest.mark.parametrize(
    ("gains", "verdict", "names"),
    [
        ((30.0, 31.0), "cannot_tell", ("a", "b")),
        ((30.0, 36.0), "effect", ("b",)),
        ((30.0, 20.0), "effect", ("a",)),
        ((30.0, None), "cannot_tell", ("a", "b")),  # not asked: it may be the better one
        ((30.0, -np.inf), "effect", ("a",)),  # cannot be flown
        ((-1.0, -2.0), "none_of_my_effects", ()),
    ],
)
def test_held_out_landings_decide_between_what_the_fitted_ones_cannot_tell(
    gains: tuple[float, float | None], verdict: str, names: tuple[str, ...]
) -> None:
    both = [Judged(n, e, FINE, gain, None if gain is None else FINE) for n, e, gain in zip("ab", (60.0, 59.0), gains, strict=True)]
    assert named(null(POOR), *both) == (verdict, names)


def test_held_out_landings_overrule_only_what_the_fitted_ones_leave_close() -> None:
    def a_before_b(b: float, gain: float) -> tuple[str, tuple[str, ...]]:
        return named(null(POOR), Judged("a", 60.0, FINE, 20.0, FINE), Judged("b", b, FINE, gain, FINE))

    assert a_before_b(55.5, 20.0) == ("effect", ("a",))
    assert a_before_b(55.5, 24.0) == ("cannot_tell", ("a", "b"))
    assert a_before_b(55.5, 30.0) == ("effect", ("b",))
    assert a_before_b(54.5, 30.0) == ("effect", ("a",))


@pytest.mark.parametrize(
    ("evidence", "gain", "verdict"),
    [
        (5.5, None, "nothing_missing"),
        (5.5, 4.0, "effect"),  # what one landing hints at and the other confirms
        (5.5, 0.1, "nothing_missing"),
        (5.5, -4.0, "nothing_missing"),
        (0.9, 20.0, "nothing_missing"),  # not HEARD: nobody would have asked
        (9.0, -8.0, "nothing_missing"),
        (12.0, -10.0, "none_of_my_effects"),  # more than noise lends
    ],
)
def test_a_weak_effect_is_named_where_both_landings_together_ask_for_it(evidence: float, gain: float | None, verdict: str) -> None:
    assert named(null(FINE), Judged("a", evidence, FINE, gain, None if gain is None else FINE))[0] == verdict


def test_evidence_of_two_landings_multiplies_and_leaves_those_who_were_not_asked_where_they_were() -> None:
    asked = [Judged("a", 9.0, FINE, 10.0, FINE), Judged("b", 8.0, FINE, 12.0, FINE)]
    rest = [null(FINE), Judged("c", 3.0, FINE), Judged("d", -2.0, FINE)]
    found = {h.name: h.log_evidence for h in informed([*asked, *rest], LIBRARY)}
    common = np.log((np.exp(19.0) + np.exp(20.0)) / (np.exp(9.0) + np.exp(8.0)))
    assert found == pytest.approx({"a": 19.0, "b": 20.0, NULL.name: 0.0, "c": 3.0 + common, "d": -2.0})


def test_the_held_out_landings_are_asked_of_the_credible_and_of_who_comes_close() -> None:
    some = [null(POOR), Judged("a", 60.0, FINE), Judged("b", 55.5, FINE), Judged("c", 54.5, FINE), Judged("a + b", 61.5, FINE)]
    assert contenders(some, LIBRARY) == ("a", "a + b", "b")
    assert contenders([null(FINE), Judged("a", 2.5, FINE), Judged("b", 0.9, FINE)], LIBRARY) == ("a",)
    assert contenders([null(FINE), Judged("a", 0.9, FINE)], LIBRARY) == ()


def test_effects_that_both_landings_together_do_not_ask_for_are_no_answers() -> None:
    """On the fitted landing alone a and b hold nine tenths; a loses on the held-out one, and nothing missing keeps 0.17 of both."""
    hypotheses = [null(FINE), Judged("a", 6.6, FINE, -3.0, FINE), Judged("b", 5.2, FINE, 0.1, FINE)]
    assert set(contenders(hypotheses, LIBRARY)) == {"a", "b"}
    assert named(*hypotheses) == ("nothing_missing", ())
    assert named(null(POOR), *hypotheses[1:]) == ("none_of_my_effects", ())
