"""The campaigns of scenarios/campaigns: each can be begun, and Apollo 11's landings are what a run of their own gives."""

from pathlib import Path

import pytest

from orchestrator.campaign.campaign import Campaign
from orchestrator.campaign.landing import Base, blueprint, land
from orchestrator.campaign.outputs import chosen, flat
from orchestrator.results import write
from orchestrator.scenario.read import Tree
from orchestrator.simulation import Simulation

CAMPAIGNS = Path(__file__).parents[2] / "scenarios" / "campaigns"


@pytest.mark.parametrize("path", sorted(CAMPAIGNS.glob("*.toml")), ids=lambda path: path.stem)
def test_a_campaign_can_be_read_and_every_address_is_a_parameter(path: Path) -> None:
    plan = Campaign.read(path)
    assert plan.inputs.num_rows > 100
    assert len(plan.overrides(0)) >= len(plan.addresses)


def test_apollo_15s_base_landing_stands_on_its_slope() -> None:
    """Setup: the middle of the campaign's bounds, 1.4 m/s down onto 10.9 deg. It is to be flown and trusted, not to be right.

    Tolerance: pads sunk and struts stroked unequally lean the vehicle a few degrees beyond the slope, never by as much as the slope.
    """
    landing = land(Campaign.read(CAMPAIGNS / "apollo15.toml").base, ())
    assert (landing.outcome, landing.trusted) == ("stands", True)
    pitch = landing.outputs["final_attitude_deg.pitch"]
    assert isinstance(pitch, float)
    assert 10.9 < pitch < 2 * 10.9
    assert landing.outputs["final_attitude_deg.roll"] == pytest.approx(0.0, abs=1e-6)


def test_landings_of_apollo_11_by_kept_units_are_those_of_fresh_ones_to_the_last_bit(tmp_path: Path) -> None:
    plan = Campaign.read(CAMPAIGNS / "apollo11_scatter.toml")
    its = plan.overrides(3)
    kept = [land(plan.base, plan.overrides(index)) for index in (3, 4, 3)]
    simulation = Simulation(blueprint(plan.base, its))
    alone = flat(write(simulation.run(), tmp_path))
    simulation.close()
    assert kept[0].outcome == "stands"
    assert kept[0].outputs == kept[2].outputs
    assert chosen(list(kept[0].outputs), plan.table.outputs, "here")
    assert dict(kept[0].outputs) == alone


def test_ending_at_rest_leaves_only_the_soils_creep_out() -> None:
    """Setup: the twin to 4 s, and with the campaigns' [until], which ends it at 2.0 s.

    Tolerances: the soil law creeps by at most 0.05 mm/s (docs/physics.md), 0.1 mm in the 2 s left out. The struts relax meanwhile
    against their joints' damping, by 1.0 mm at most: 2 mm are allowed for strokes and skids, a third of what the photographs resolve
    (6.35 mm), and 0.05 deg of attitude. What peaks before rest is the same to the last bit.
    """
    plan = Campaign.read(CAMPAIGNS / "apollo11_sensitivity.toml")
    path = CAMPAIGNS.parent / "apollo11_zupp_twin.toml"
    without: Tree = {key: value for key, value in plan.table.changes.items() if key != "until"}
    ended, whole = land(plan.base, ()), land(Base.read(path, plan.table.set, without), ())
    assert ended.outcome == whole.outcome == "stands"
    assert whole.outputs["master.simulated_s"] == pytest.approx(4.0)
    assert ended.outputs["master.simulated_s"] == pytest.approx(2.0, abs=0.1)
    same = [name for name in whole.outputs if name.startswith(("peak_rates", "contact_times", "failure.tip_over.least"))]
    assert all(ended.outputs[name] == whole.outputs[name] for name in same)
    for start, allowed in {"penetration_m": 1e-4, "strokes_m": 2e-3, "skid_m": 2e-3, "final_attitude": 0.05}.items():
        names = [name for name in whole.outputs if name.startswith(start)]
        assert names
        for name in names:
            assert ended.outputs[name] == pytest.approx(whole.outputs[name], abs=allowed), name
