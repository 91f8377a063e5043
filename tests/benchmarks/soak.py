"""`make soak`: daemons fly as fast as they can for an hour, and nothing may grow.

    python -m tests.benchmarks.soak [--minutes 60] [--agents 10] [--every 10] [--out out/soak]

Quickstart with two targets an agent, recorded, in processes of its own: memory, threads, open files and processor time
a tick of each. Leaves `soak.csv`, `soak.png` and a verdict: exit code 1 if anything grew by more than BOUNDS allow. The
recording stays, too.
"""

from __future__ import annotations

import argparse
import csv
import os
import signal
import sys
from collections.abc import Iterator, Sequence
from dataclasses import astuple, dataclass, fields
from pathlib import Path
from statistics import median
from time import monotonic, process_time, sleep

from rich.console import Console
from rich.table import Table

from comms.session import Network, open_client
from missions.daemons.fleet import FleetOptions, ask
from missions.daemons.orders import Report, Verb
from tests.missions.daemons.swarm import Swarm, children, free_endpoint, resident_mb, swarm

TICK_S = 0.1  # of quickstart
CONNECT_S = 10.0
STOPPED = 130
FOREVER_S = 10_000_000.0  # of mission: this ends by Ctrl-C
TRICKLE_A = 0.001  # nobody comes home for its battery


@dataclass(frozen=True, slots=True)
class Sample:
    """One process at one moment, and since the last sample: its processor time and the wall's, per tick.

    What may explain the time comes with it: how long this computer takes for REFERENCE rounds of nothing, as its clock
    and its other guests change that, and what there is to do, targets followed and mates heard by all agents together.
    """

    at_s: float
    process: str
    resident_mb: float
    threads: int
    files: int
    busy_ms: float
    tick_ms: float
    reference_ms: float
    tags: int
    mates: int

    @property
    def work(self) -> float:
        """Its processor time a tick, in references: what is left where the computer itself is slower for a while."""
        return self.busy_ms / self.reference_ms


@dataclass(frozen=True, slots=True)
class Bound:
    """By how much the median of the last quarter may exceed that of the second one: in all, and as a share."""

    amount: float
    share: float

    def allows(self, early: float, late: float) -> bool:
        """Whether something that was `early` may be `late` now."""
        return late - early <= max(self.amount, self.share * early)


# Memory: what an allocator keeps of its peaks, and four bytes a tick of which the world makes `coverage_late`.
# Time: the processor's. How long a tick takes on the wall says more of what else the computer does.
BOUNDS = {
    "resident_mb": Bound(10.0, 0.1),
    "threads": Bound(0.0, 0.0),
    "files": Bound(0.0, 0.0),
    "work": Bound(0.05, 0.25),
}
ONE_FILE_MB = 250.0
PLOTTED = (*BOUNDS, "busy_ms", "tick_ms", "reference_ms", "tags", "mates")
REFERENCE = 200_000


def processes(run: Swarm) -> dict[int, str]:
    """The daemons of a launch: `world`, `record` and `agent 3` by process id."""
    found = {}
    for pid, command in children(run.process.pid).items():
        words = command.split()
        verb = words[3]
        found[pid] = f"{verb} {words[words.index('--id') + 1]}" if "--id" in words else verb
    return found


def threads(pid: int) -> int:
    """How many it has."""
    return len(os.listdir(f"/proc/{pid}/task"))


def files(pid: int) -> int:
    """How many file descriptors it holds."""
    return len(os.listdir(f"/proc/{pid}/fd"))


def busy_s(pid: int) -> float:
    """The processor time it has taken."""
    user, system = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[11:13]
    return (int(user) + int(system)) / os.sysconf("SC_CLK_TCK")


def reports(bus: Network) -> list[Report]:
    """How every agent is that answers."""
    answers = ask(bus, Verb.STATUS, FleetOptions())
    return [answer.report for answer in answers.values() if answer is not None and answer.report is not None]


def ticks(swarm_now: Sequence[Report]) -> float:
    """How far the swarm is: ticks since power-on, of whoever is farthest."""
    return max((report.time_s for report in swarm_now), default=0.0) / TICK_S


def reference_ms() -> float:
    """The processor time of always the same work."""
    began_s = process_time()
    for _ in range(REFERENCE):
        pass
    return 1e3 * (process_time() - began_s)


def watch(run: Swarm, bus: Network, *, minutes: float, every_s: float) -> Iterator[list[Sample]]:
    """Samples of every process, for so long.

    Raises:
        SystemExit: one of the processes has ended.
    """
    pids = processes(run)
    began_s = was_s = monotonic()
    was_ticks, were_busy_s = ticks(reports(bus)), {pid: busy_s(pid) for pid in pids}
    while monotonic() - began_s < 60.0 * minutes:
        sleep(every_s)
        now_s, agents = monotonic(), reports(bus)
        now_ticks, speed_ms = ticks(agents), reference_ms()
        tags, mates = sum(len(agent.tags) for agent in agents), sum(agent.mates for agent in agents)
        if processes(run) != pids:
            raise SystemExit(f"other processes than at first run now:\n{run.output}")
        per_tick = 1e3 / max(1.0, now_ticks - was_ticks)
        are_busy_s = {pid: busy_s(pid) for pid in pids}
        yield [
            Sample(
                at_s=now_s - began_s,
                process=name,
                resident_mb=resident_mb(pid),
                threads=threads(pid),
                files=files(pid),
                busy_ms=(are_busy_s[pid] - were_busy_s[pid]) * per_tick,
                tick_ms=(now_s - was_s) * per_tick,
                reference_ms=speed_ms,
                tags=tags,
                mates=mates,
            )
            for pid, name in pids.items()
        ]
        was_s, was_ticks, were_busy_s = now_s, now_ticks, are_busy_s


def growth(samples: Sequence[Sample], name: str) -> tuple[float, float]:
    """The medians of something in the second quarter of the time, and in the last."""
    values = [float(getattr(sample, name)) for sample in samples]
    quarter = max(1, len(values) // 4)
    return median(values[quarter : 2 * quarter] or values), median(values[-quarter:])


def bound(name: str, process: str) -> Bound:
    """What a process is allowed."""
    # The recorder remembers where everything lies in the file that it writes, and begins another after 15 minutes of
    # the mission.
    return Bound(ONE_FILE_MB, 0.0) if (process, name) == ("record", "resident_mb") else BOUNDS[name]


def verdict(samples: Sequence[Sample]) -> tuple[Table, bool]:
    """What became of each process, and whether all of it is within bounds."""
    table = Table("process", *BOUNDS, box=None)
    steady = True
    for process in dict.fromkeys(sample.process for sample in samples):
        own = [sample for sample in samples if sample.process == process]
        cells = []
        for name in BOUNDS:
            early, late = growth(own, name)
            fine = bound(name, process).allows(early, late)
            steady = steady and fine
            cells.append(f"{early:.3g} to {late:.3g}" + ("" if fine else " GROWS"))
        table.add_row(process, *cells)
    return table, steady


def plot(samples: Sequence[Sample], file: Path) -> None:
    """Everything over time, a line for each process."""
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    figure, panels = pyplot.subplots(len(PLOTTED), 1, sharex=True, figsize=(8, 16), layout="constrained")
    for panel, name in zip(panels, PLOTTED, strict=True):
        for process in dict.fromkeys(sample.process for sample in samples):
            own = [sample for sample in samples if sample.process == process]
            panel.plot([each.at_s / 60.0 for each in own], [getattr(each, name) for each in own], label=process)
        panel.set(ylabel=name)
        panel.set_ylim(bottom=0.0)
        panel.grid(alpha=0.3)
    panels[-1].set(xlabel="minutes")
    panels[0].legend(fontsize="x-small", ncols=4)
    figure.savefig(file, dpi=120)


def soak(*, minutes: float, agents: int, every_s: float, folder: Path) -> list[Sample]:
    """Fly, and look on; the samples are in `soak.csv` as they come."""
    endpoint, samples = free_endpoint(), []
    counts = (f"agents.count={agents}", f"targets.count={2 * agents}")  # one each, and the swarm comes to rest
    changes = (*counts, f"duration_s={FOREVER_S:g}", f"vehicle.battery.hover_current_a={TRICKLE_A:g}")
    words = [word for change in changes for word in ("--set", change)]
    record = ("--record", str(folder / "soak.rrd"))
    with (
        swarm(
            "launch", "quickstart", *words, "--processes", "--listen", endpoint, *record, "--log-level", "info"
        ) as run,
        (folder / "soak.csv").open("w", newline="") as file,
    ):
        run.wait_for("the mission begins")
        writer = csv.writer(file)
        writer.writerow([column.name for column in fields(Sample)])
        with open_client(endpoint, lossless=True, patience_s=CONNECT_S) as bus:
            for now in watch(run, bus, minutes=minutes, every_s=every_s):
                samples += now
                writer.writerows(astuple(sample) for sample in now)
                file.flush()
        run.process.send_signal(signal.SIGINT)
        if run.wait() != STOPPED:
            raise SystemExit(f"it did not come home:\n{run.output}")
    return samples


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description="Fly for long, and see that nothing grows.")
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--agents", type=int, default=10)
    parser.add_argument("--every", type=float, default=10.0, metavar="SECONDS")
    parser.add_argument("--out", type=Path, default=Path("out/soak"), metavar="DIR")
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    for old in options.out.glob("soak*"):
        old.unlink()
    samples = soak(minutes=options.minutes, agents=options.agents, every_s=options.every, folder=options.out)
    table, steady = verdict(samples)
    plot(samples, options.out / "soak.png")
    console = Console()
    console.print(f"{options.minutes:g} minutes, medians of the second and the last quarter of them")
    console.print(table)
    console.print("nothing grows" if steady else "something grows")
    return 0 if steady else 1


if __name__ == "__main__":
    sys.exit(main())
