"""The energy account on numbers a reader can add up."""

import numpy as np
import pytest
from results_samples import TABLE, landing

from orchestrator.results import cost
from orchestrator.results.channels import Channels
from orchestrator.results.energy import account, account_of
from orchestrator.results.schema import ResultsTable


def columns(*values):
    return np.array(values, dtype=float)


def test_energy_that_went_where_the_units_say_leaves_no_residual():
    # 100 J kinetic and 50 J of height; the engine takes 20 J out; struts 70 J, soil 60 J: 150 - 20 - 70 - 60 = 0
    books = account(columns(100, 0), columns(1050, 1000), columns(0, 70), columns(0, -20), columns(0, -60))
    assert books.summary() == {
        "initial_J": 150.0,
        "final_J": 0.0,
        "supplied_J": -20.0,
        "dissipated_J": 130.0,
        "dissipated_in_units_J": 70.0,
        "absorbed_by_soil_J": 60.0,
        "residual_J": 0.0,
        "residual_fraction": 0.0,
    }


def test_energy_nobody_accounts_for_is_positive_and_energy_from_nowhere_negative():
    lost = account(columns(100, 10), columns(0, 0), columns(0, 60), columns(0, 0), columns(0, 0)).summary()
    made = account(columns(100, 50), columns(0, 0), columns(0, 60), columns(0, 0), columns(0, 0)).summary()
    assert (lost["residual_J"], lost["residual_fraction"]) == (30.0, 0.3)
    assert (made["residual_J"], made["residual_fraction"]) == (-10.0, -0.1)


def test_a_thrusting_engine_supplies_energy_that_must_be_found_again():
    books = account(columns(0, 25), columns(0, 0), columns(0, 0), columns(0, 25), columns(0, 0))
    assert books.residual[-1] == 0.0


def test_works_count_from_the_first_row_of_the_history():
    books = account(columns(10, 0), columns(0, 0), columns(500, 506), columns(3, 3), columns(-40, -44))
    assert books.residual.tolist() == [0.0, 0.0]


def test_the_account_sums_every_unit_and_takes_the_soil_from_the_legs():
    result = landing()
    channels = Channels(result.times, result.columns)
    books = account_of(channels, ResultsTable.model_validate(TABLE))
    assert books is not None
    last = {name: column[-1] - column[0] for name, column in result.columns.items()}
    assert books.absorbed[-1] == pytest.approx(-sum(last[f"leg{leg}.pad.work"] for leg in TABLE["legs"]))
    assert books.dissipated[-1] == pytest.approx(sum(last[f"leg{leg}.energy.dissipated"] for leg in TABLE["legs"]))
    assert books.supplied[-1] == pytest.approx(last["body.engine.work"])


def test_a_scenario_can_name_the_works_that_come_from_outside():
    columns_ = {"cart.energy.kinetic": columns(0, 8), "cart.tow.work": columns(0, 8)}
    table = ResultsTable(work=["cart.tow.work"])
    books = account_of(Channels(columns(0, 1), columns_), table)
    assert books is not None
    assert books.residual[-1] == 0.0


def test_without_legs_what_is_done_on_units_without_energies_was_absorbed():
    columns_ = {"mass.energy.kinetic": columns(12, 0), "mass.pad.work": columns(0, -12), "soil.pad.work": columns(0, 12)}
    books = account_of(Channels(columns(0, 1), columns_), ResultsTable())
    assert books is not None
    assert (books.absorbed[-1], books.residual[-1]) == (12.0, 0.0)


def test_no_account_is_drawn_up_when_nothing_says_where_energy_may_leave():
    columns_ = {"lander.energy.kinetic": columns(12, 0), "lander.leg1.pad.work": columns(0, -12)}
    assert account_of(Channels(columns(0, 1), columns_), ResultsTable()) is None
    assert account_of(Channels(columns(0, 1), columns_), ResultsTable(work=[])) is not None


def test_units_without_energies_have_no_account():
    assert account_of(Channels(columns(0, 1), {"mass.position": columns(0, 1)}), ResultsTable()) is None


def test_a_connection_passes_on_what_it_leaks_of_what_it_carries():
    first, second = cost.ledger(landing().ledger, 3400.0)
    assert (first["leak_J"], first["passed"]) == (0.5, True)
    assert (second["leak_J"], second["passed"]) == (20.0, False)
