"""Who is repeated and who is stepped once."""

from master_samples import HEAVY, links, mass, prepared, spring

from orchestrator.master.ports import ReducedPort
from orchestrator.master.roles import repeated_units, together
from orchestrator.master.settings import MasterSettings
from orchestrator.master.system import Link, System


def chain(*pairs: tuple[int, int]) -> list[Link]:
    return [Link(a, "x", b, "x") for a, b in pairs]


def test_units_in_a_loop_are_repeated_and_what_hangs_on_it_is_not() -> None:
    assert repeated_units(4, chain((0, 1), (1, 2), (2, 0), (2, 3)), [True] * 4) == [True, True, True, False]


def test_a_loop_through_a_unit_that_cannot_roll_back_is_no_loop() -> None:
    assert repeated_units(3, chain((0, 1), (1, 2), (2, 0)), [True, False, True]) == [False] * 3


def test_two_sides_of_a_reduced_interface_model_share_their_role() -> None:
    names = ("",) * 6
    ports = [ReducedPort("p", 0, 1, names, names, names), ReducedPort("q", 2, 3, names, names, names)]
    assert together([True, False, True, True], ports) == [False, False, True, True]


def test_a_rejection_is_not_overruled_by_what_is_judged_after_the_units_stepped_once() -> None:
    """A second oscillator, stepped explicitly beside the first, must not keep the first from rejecting."""
    first = [mass("a", 1.0, 0.0), mass("b", HEAVY, 1.2), spring()]
    blind = [mass("c", 1.0, 0.0), mass("d", HEAVY, 1.2), spring(rollback=False)]
    blind[2].name = "blind"
    moved = [Link(k.source_unit + 3, k.source, k.target_unit + 3, k.target) for k in links()]
    master = prepared(System([*first, *blind], [*links(), *moved]), MasterSettings(max_interval=0.1, min_interval=1e-5, tolerance=1e-6))
    assert master.repeated == [True, True, True, False, False, False]
    master.run()
    assert any(not row.accepted for row in master.log)
