"""One mission, compiled: `loop.fly` and its parts, made of the same rules that fly in the air (`rules`).

state       the arrays that a mission consists of
loop        the tick: link, perceive, act, move
motion      how targets move
counting    coverage, events and help
foresight   the perfect predictor: what will happen if nobody helps
referee     the optimal answering of calls, by `bottleneck`
"""
