"""What a quasi-Newton carries from step to step can be taken out and put back: a run goes on with the same bits."""

from quarter_vehicle import quarter_vehicle

from orchestrator.checkpoint.memory import adopt, recall
from orchestrator.master.master import Master
from orchestrator.master.result import Attempt
from orchestrator.master.settings import MasterSettings

SETTINGS = MasterSettings(max_interval=1e-2, tolerance=1e-6)


def halfway(master: Master) -> None:
    def stop(time: float) -> None:
        master.stop_requested = time > 0.1

    master.run(stop)


def test_a_master_that_adopts_the_memory_ends_on_the_same_bits() -> None:
    whole, half, other = (quarter_vehicle(SETTINGS, sloped=False) for _ in range(3))
    whole.run()
    halfway(half)
    adopt(other, recall(half))
    other.log = [Attempt(*row) for row in other.log]
    for mine, theirs in zip(other.system.slaves, half.system.slaves, strict=True):
        theirs.save()
        mine._saved = theirs._saved
        mine.restore()
    other.run()
    assert other.plan.board.now.tobytes() == whole.plan.board.now.tobytes()
    assert [row.interval for row in other.log] == [row.interval for row in whole.log]
