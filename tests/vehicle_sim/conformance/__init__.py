"""Our vehicle against a recorded one: ArduCopter V4.5.5 SITL (official commit 142aece2, quad, default parameters).

`recordings` holds excerpts of what the real one did (`excerpt` cut them); the tests do the same to ours and compare.
docs/conformance.md says what is the same, within which band, and what differs and why.
"""
