"""Other ways to decide, beside the paper's own algorithm (`bcmommt.step`): same table, same parameters, same signature.

    a_cmommt   Parker's A-CMOMMT: the force sum of eq. 2
    basic      B-CMOMMT as first published, the rules of section 4.1
    regions    Jung & Sukhatme: agents spread over regions as targets do
    choice     the dispatch by `Params.policy`

A policy is one function `decide(t, p, mind, me, x, y, now, seed, tick)`, inside what numba compiles as all rules are.
"""
