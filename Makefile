# `make run` flies the quickstart mission; `make test` is what CI runs.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
PEERS := .venv-peers
CLIENTS := .venv-clients

.PHONY: run test test-slow test-network test-clients search fuzz check format bench bench-processes bench-kills \
	bench-scale bench-vehicles bench-recording soak pictures bench-peers clean

run: $(VENV)/ground.done
	@mkdir -p out
	$(BIN)/swarm launch quickstart --record out/quickstart.rrd --report out/quickstart.json
	@echo "Look at it: $(BIN)/rerun out/quickstart.rrd"

test: check
	$(BIN)/python -m pytest -n 2 --dist loadgroup -m "not slow" tests

# All tests, and laws on twenty times as many examples, new ones each time.
test-slow: $(VENV)/all.done
	$(BIN)/python -m pytest -n 2 --dist loadgroup --hypothesis-profile search tests

# Two computers in network namespaces, and a cable between them that is cut: five minutes.
test-network: $(VENV)/all.done
	$(BIN)/python -m pytest -rs tests/missions/daemons/test_machines.py

# MAVSDK, MAVProxy and mavutil fly simulated vehicles: some minutes. CLIENT="--only mavsdk" for some of them.
test-clients: $(VENV)/all.done $(CLIENTS)/clients.done
	$(CLIENTS)/bin/python -m tests.clients --swarm $(BIN)/python $(CLIENT)

# The laws alone, on new examples: some minutes. A failure prints the example.
search: $(VENV)/all.done
	$(BIN)/python -m pytest -n 2 --dist loadgroup --hypothesis-profile search -m "hypothesis and not slow" tests

# A million hostile frames: two to four minutes. FUZZ="--seed 7 --jobs 4"; a failure names the seed and episode to repeat.
fuzz: $(VENV)/all.done
	$(BIN)/python -m tests.fuzz $(FUZZ)

check: $(VENV)/all.done
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy

format: $(VENV)/all.done
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

bench: $(VENV)/all.done
	$(BIN)/python -m tests.benchmarks
	$(BIN)/python -m tests.benchmarks.study

# Ticks a second of daemons in lockstep beside one process, and what a daemon weighs: two minutes.
bench-processes: $(VENV)/all.done
	$(BIN)/python -m tests.benchmarks.processes

# What an agent costs among ten, and among a thousand: four minutes.
bench-scale: $(VENV)/all.done
	$(BIN)/python -m tests.benchmarks.scale $(SCALE)

# What a process costs that is killed or frozen, each kind in turn: five minutes. KILLS="--only recorder" for some.
bench-kills: $(VENV)/all.done
	$(BIN)/python -m tests.benchmarks.kills $(KILLS)

# Ten daemons fly for an hour, and nothing may grow; leaves out/soak. SOAK="--minutes 3" for less.
soak: $(VENV)/all.done
	$(BIN)/python -m tests.benchmarks.soak $(SOAK)

bench-vehicles: $(VENV)/all.done
	$(BIN)/python -m tests.benchmarks.vehicles

bench-recording: $(VENV)/all.done
	$(BIN)/python -m tests.benchmarks.recording

# What docs/ shows of recordings; needs Debian's mesa-vulkan-drivers and libvulkan1. PICTURES="faults map" for some.
pictures: $(VENV)/all.done
	$(BIN)/python -m tests.pictures $(PICTURES)

bench-peers: $(VENV)/all.done $(PEERS)/peers.done
	$(PEERS)/bin/python -m tests.benchmarks.peers.run --study $(BIN)/python

clean:
	rm -rf $(VENV) $(PEERS) $(CLIENTS) out build dist *.egg-info

$(BIN)/python:
	$(PYTHON) -m venv $(VENV)

$(VENV)/ground.done: pyproject.toml | $(BIN)/python
	$(BIN)/pip install --quiet --editable '.[ground]'
	@touch $@

$(VENV)/all.done: pyproject.toml | $(BIN)/python
	$(BIN)/pip install --quiet --editable '.[ground,study,dask,dev]'
	@touch $@ $(VENV)/ground.done

$(PEERS)/peers.done: tests/benchmarks/peers/requirements.txt
	$(PYTHON) -m venv $(PEERS)
	$(PEERS)/bin/pip install --quiet --requirement $<
	@touch $@

$(CLIENTS)/clients.done: tests/clients/requirements.txt
	$(PYTHON) -m venv $(CLIENTS)
	$(CLIENTS)/bin/pip install --quiet --requirement $<
	@touch $@
