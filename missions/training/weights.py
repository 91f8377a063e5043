"""The weights file: two small nets as JSON, written by `swarm train` and read by missions without torch."""

from __future__ import annotations

from functools import lru_cache
from itertools import chain
from math import isfinite
from pathlib import Path

import msgspec

from missions.problems import InputError
from swarm_agent.bcmommt.net import Net

BUNDLED = Path(__file__).parent / "weights.json"
_PAIR_INPUTS, _TRIPLE_INPUTS = 3, 6


class NetFile(msgspec.Struct, forbid_unknown_fields=True):
    """One net: a row per hidden neuron (a weight per input, its bias, its weight in the output); the output's bias."""

    hidden: tuple[tuple[float, ...], ...]
    bias: float

    @property
    def net(self) -> Net:
        """The net as the rules read it."""
        return Net(self.hidden, self.bias)


class Weights(msgspec.Struct, forbid_unknown_fields=True):
    """What `swarm train` writes.

    Attributes:
        about: what the nets were fitted to, for people. pair, triple: the nets for two and for three tags.
    """

    about: str
    pair: NetFile
    triple: NetFile


def read_weights(path: Path) -> Weights:
    """The weights in a file. The runs of a study read it once.

    Raises:
        InputError: it cannot be read, or is no weights file.
    """
    try:
        state = path.stat()
        return _read(path, (state.st_mtime_ns, state.st_size))
    except (OSError, ValueError, msgspec.MsgspecError) as error:
        raise InputError(f"{path}: got no weights ({error}); allowed: a file written by swarm train") from error


def write_weights(path: Path, weights: Weights) -> None:
    """Write the file, the same bytes for the same weights."""
    path.write_bytes(msgspec.json.format(msgspec.json.encode(weights), indent=1) + b"\n")


@lru_cache(maxsize=4)
def _read(path: Path, stamp: tuple[int, int]) -> Weights:
    weights = msgspec.json.decode(path.read_bytes(), type=Weights)
    _check(weights.pair, "pair", _PAIR_INPUTS)
    _check(weights.triple, "triple", _TRIPLE_INPUTS)
    return weights


def _check(net: NetFile, name: str, n_inputs: int) -> None:
    if not net.hidden or any(len(row) != n_inputs + 2 for row in net.hidden):
        raise ValueError(f"{name}: hidden neurons have {n_inputs + 2} numbers each, and there is at least one")
    if not all(isfinite(number) for number in chain([net.bias], *net.hidden)):
        raise ValueError(f"{name}: numbers are finite")
