"""The net of section 4.2.1, fitted to rows with torch: one hidden layer, sigmoids, least squares."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import torch
from torch import Tensor, nn

from missions.training.rows import Floats
from swarm_agent.bcmommt.net import Net

# More steps than these lower the error in its fourth digit.
STEPS = 400


def fit(inputs: Floats, teacher: Floats, *, n_hidden: int, seed: int, steps: int = STEPS) -> Net:
    """A net fitted to the rows by L-BFGS on all of them at once. The same seed gives the same net.

    Args:
        inputs: (N, I). teacher: (N), from 0 to 1. n_hidden: neurons in the hidden layer.
    """
    module = _module(inputs.shape[1], n_hidden, seed)
    x, y = torch.from_numpy(inputs), torch.from_numpy(teacher)
    optimizer = torch.optim.LBFGS(
        module.parameters(),
        max_iter=steps,
        history_size=20,
        line_search_fn="strong_wolfe",
        tolerance_grad=1e-9,
        tolerance_change=1e-12,
    )

    def loss() -> Tensor:
        optimizer.zero_grad()
        error = nn.functional.mse_loss(module(x)[:, 0], y)
        error.backward()  # type: ignore[no-untyped-call]
        return error

    with _one_thread():
        optimizer.step(loss)  # type: ignore[no-untyped-call]
    return _net(module)


def as_module(net: Net) -> nn.Sequential:
    """The net as a torch module: (N, I) to (N, 1)."""
    n_inputs = len(net.hidden[0]) - 2
    module = _module(n_inputs, len(net.hidden), seed=0)
    rows, bias = (torch.tensor(numbers, dtype=torch.float64) for numbers in (net.hidden, [net.bias]))
    values = (rows[:, :n_inputs], rows[:, n_inputs], rows[None, :, n_inputs + 1], bias)
    with torch.no_grad():
        for parameter, value in zip(module.parameters(), values, strict=True):
            parameter.copy_(value)
    return module


def predict(net: Net, inputs: Floats) -> Floats:
    """The net's output for every row: (N)."""
    with torch.no_grad():
        shares: Floats = as_module(net)(torch.from_numpy(inputs))[:, 0].numpy()
    return shares


@contextmanager
def _one_thread() -> Iterator[None]:
    """So small a net loses time to threads; and one adds up in one order, so that a fit repeats exactly."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)


def _module(n_inputs: int, n_hidden: int, seed: int) -> nn.Sequential:
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        return nn.Sequential(
            nn.Linear(n_inputs, n_hidden, dtype=torch.float64),
            nn.Sigmoid(),
            nn.Linear(n_hidden, 1, dtype=torch.float64),
            nn.Sigmoid(),
        )


def _net(module: nn.Sequential) -> Net:
    inner, bias, out, out_bias = (parameter.detach().tolist() for parameter in module.parameters())
    rows = zip(inner, bias, out[0], strict=True)
    return Net(tuple((*weights, neuron_bias, weight) for weights, neuron_bias, weight in rows), out_bias[0])
