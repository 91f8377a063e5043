"""Two computers and a cable, on this one: network namespaces, which need no rights where users may have them.

    with two_machines() as machines, machines.swarm(GROUND, "world", ...), machines.swarm(DRONE, "agent", ...) as agent:
        with machines.cut(Cut.SILENT):
            agent.wait_for("holds still")

They are on two networks with a router between them. The cable is unplugged, which both may notice, or the router passes
nothing on any more, which nobody is told.
"""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from enum import Enum
from functools import cache

from tests.missions.daemons.swarm import ROOT, Swarm, swarm

GROUND, DRONE, ROUTER = "ground", "drone", "router"
GROUND_ADDRESS, DRONE_ADDRESS = "10.77.1.2", "10.77.2.2"
# Named namespaces are kept in /run, which is ours alone there.
_PLACE = (
    "unshare",
    "--map-root-user",
    "--net",
    "--mount",
    "sh",
    "-c",
    "mount -t tmpfs tmpfs /run && echo ready && cat",
)
_LAY = f"""set -e
for name in {GROUND} {ROUTER} {DRONE}; do ip netns add $name; ip -n $name link set lo up; done
ip link add to-{GROUND} netns {ROUTER} type veth peer name eth0 netns {GROUND}
ip link add to-{DRONE} netns {ROUTER} type veth peer name eth0 netns {DRONE}
ip -n {GROUND} addr add {GROUND_ADDRESS}/24 dev eth0
ip -n {ROUTER} addr add 10.77.1.1/24 dev to-{GROUND}
ip -n {DRONE} addr add {DRONE_ADDRESS}/24 dev eth0
ip -n {ROUTER} addr add 10.77.2.1/24 dev to-{DRONE}
ip -n {GROUND} link set eth0 up; ip -n {DRONE} link set eth0 up
ip -n {ROUTER} link set to-{GROUND} up; ip -n {ROUTER} link set to-{DRONE} up
ip -n {GROUND} route add default via 10.77.1.1; ip -n {DRONE} route add default via 10.77.2.1
ip netns exec {ROUTER} sh -c 'echo 1 > /proc/sys/net/ipv4/ip_forward'
"""


class Cut(Enum):
    """How a cable fails: what cuts it, and what mends it again."""

    UNPLUGGED = (f"ip -n {ROUTER} link set to-{DRONE} down", f"ip -n {ROUTER} link set to-{DRONE} up")
    SILENT = (
        f"ip netns exec {ROUTER} sh -c 'echo 0 > /proc/sys/net/ipv4/ip_forward'",
        f"ip netns exec {ROUTER} sh -c 'echo 1 > /proc/sys/net/ipv4/ip_forward'",
    )


class Machines:
    """Both computers, in the namespaces that process `pid` keeps open."""

    def __init__(self, pid: int) -> None:
        self._enter = ("nsenter", "--preserve-credentials", "--user", "--net", "--mount", f"--target={pid}")

    @contextmanager
    def swarm(self, machine: str, *words: str) -> Iterator[Swarm]:
        """A `swarm` command that runs on one of them, and does not outlive the block."""
        with swarm(*words, within=(*self._enter, "ip", "netns", "exec", machine, "env", f"--chdir={ROOT}")) as running:
            yield running

    @contextmanager
    def cut(self, cut: Cut) -> Iterator[None]:
        """The cable is cut while the block lasts."""
        break_it, mend_it = cut.value
        self.run(break_it)
        try:
            yield
        finally:
            self.run(mend_it)

    def run(self, script: str) -> None:
        """A script that sees both computers and the cable."""
        subprocess.run((*self._enter, "sh", "-c", script), check=True, capture_output=True, timeout=30.0)


@contextmanager
def two_machines() -> Iterator[Machines]:
    """Two computers that reach each other."""
    with _place() as pid:
        machines = Machines(pid)
        machines.run(_LAY)
        yield machines


@cache
def why_not() -> str:
    """Why this computer cannot play two; empty if it can."""
    try:
        with two_machines():
            return ""
    except FileNotFoundError as error:
        return f"needs {error.filename}: Debian's util-linux and iproute2"
    except (subprocess.SubprocessError, PermissionError) as error:
        said = getattr(error, "stderr", b"") or b""
        return f"users may not have network namespaces here: {said.decode(errors='replace').strip() or error}"


@contextmanager
def _place() -> Iterator[int]:
    """Namespaces of our own; the process that keeps them open ends with its standard input."""
    with subprocess.Popen(_PLACE, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdin is not None
        assert process.stdout is not None
        assert process.stderr is not None
        if process.stdout.readline() != b"ready\n":
            raise PermissionError(process.stderr.read().decode(errors="replace").strip())
        yield process.pid
        process.stdin.close()
