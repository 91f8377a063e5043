"""A storm of frames against both ends of the link: `python -m tests.fuzz --frames 1000000`, or `make fuzz`.

An episode is a value: what arrives, tick by tick (`episode`). It mixes sensible sessions (`sessions`: take off, fly,
upload a mission, land), so that the storm meets a vehicle in every state, with hostile frames (`hostile`: every message
type of the dialect, laid out by `layouts`) and damaged ones. `subjects` are the two ends, `laws` what must stay true
after every tick, `shrink` makes a failure small. The same seed makes the same episodes; a failure names its seed and
episode, and `--seed S --episode N` plays it again.
"""
