"""The same study on a Dask cluster of two workers, and with the compiled engine."""

from __future__ import annotations

from pathlib import Path

import pytest

from missions.exit_codes import DONE
from missions.problems import InputError
from missions.study.command import StudyOptions, fly_study
from missions.study.fly import here, on_cluster
from missions.study.shards import blocks
from tests.missions.study.toy_runs import WITHOUT_FIGURES, fly


@pytest.fixture
def study(tmp_path: Path) -> str:
    path = tmp_path / "toy.yaml"
    path.write_text(WITHOUT_FIGURES, encoding="utf-8")
    return str(path)


def test_a_cluster_flies_the_same(study: str, tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    here_options, there_options = StudyOptions(out=tmp_path / "here"), StudyOptions(out=tmp_path / "there")
    assert fly_study(study, here_options, flyer=here(fly)) == DONE
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
    ) as cluster:
        assert fly_study(study, there_options, flyer=on_cluster(cluster.scheduler_address, fly)) == DONE
    for name in ("runs.csv", "points.csv", "over_time.csv"):
        assert (tmp_path / "there" / name).read_bytes() == (tmp_path / "here" / name).read_bytes()


def test_nothing_at_the_address_is_bad_input() -> None:
    pytest.importorskip("distributed")
    landed = on_cluster("tcp://127.0.0.1:9", fly, connect_s=0.2)(list(blocks((), ())))
    with pytest.raises(InputError, match=r'--dask: got "tcp://127\.0\.0\.1:9" .* allowed: the address of a Dask'):
        next(landed)


@pytest.mark.slow
def test_the_compiled_engine_flies_a_study(study: str, tmp_path: Path) -> None:
    assert fly_study(study, StudyOptions(out=tmp_path / "out", runs=3)) == DONE
    assert len((tmp_path / "out" / "runs.csv").read_text().splitlines()) == 1 + 8 * 3
