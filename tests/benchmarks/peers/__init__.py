"""`make bench-peers`: our compiled study beside VMAS (the vectorized multi-agent simulator on torch), in one run.

    make bench-peers
    .venv-peers/bin/python -m tests.benchmarks.peers.run [--runs N] [--batches 64 1024] [--study PYTHON]

VMAS is never a dependency: it has an environment of its own, .venv-peers, made from `requirements.txt` beside this
file; nothing here imports the stack, and nothing of the stack imports this. A figure is environment steps (one tick of
one mission with all its agents and targets) per second of processor time on one thread, the median over several runs
after a warm-up; the peers take turns. VMAS is made for GPUs too; none is measured here.

    cmommt             the paper's world and B-CMOMMT as batched torch operations
    cmommt_scenario    the same as a VMAS scenario
    run                the table: that scenario, the same operations without VMAS around them, VMAS's own `discovery`,
                       and then our study, as `python -m tests.benchmarks.study` prints it

Of the b-cmommt that the study and the missions fly, the torch version HAS: the disc arena, evasive targets (eq. 8, the
edge, the walk when nothing is near), sensing range, radio range and one tick of delay, velocities from successive
sightings, nearest-owns with claims compared in the same tick, the rule for helpers on their way, loss by eq. 10 with
a horizon, calls for all but the nearest, capture times by eq. 11, the greedy answer (closest unanswered, else those
I reach before whoever answers), commitment, take-over, the help margin, and the velocities of follow, help and explore.

It LACKS, each of which makes it cheaper: a table per agent (it shares one last position and velocity per target among
all who hear of it, mates keep away from where mates are and not from where they said, and nothing older than a tick
is known), so also the memory of lost targets and the calls for them; leases longer than a tick, radio loss and
latency; ids as tie-breakers and distances in whole millimeters; settled calls (a call ends only when the caller
yields); the other predictors, gates and capture rules; the stale-first search; events and help counts; chance by key,
so that a run can be repeated alone (torch's generator draws for the whole batch); and 64-bit arithmetic (torch's 32
bits here).

Its coverage is printed beside the speed, since a fast wrong thing is no peer; the study's nearest relative is
`b-cmommt` with `memory_s: 0`.
"""
