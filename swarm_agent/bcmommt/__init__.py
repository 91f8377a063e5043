"""B-CMOMMT, the algorithm of the paper and nothing else, as plain scalar rules over one agent's table.

Read beside Kolling & Carpin, "Cooperative Observation of Multiple Moving Targets": one file per idea, in the order of
Algorithm 1.

    params      the constants of section 3 and 6, by name and unit
    belief      what one agent knows: the table, and how seeing and hearing fill it
    profiles    how things draw an agent (figure 1), and the bound on the following distance (eq. 12)
    prediction  predictive tracking: targets out of sight that still count (section 4.1)
    tags        "read the tag, compare the distance": who owns a target (section 4.1, definition 3)
    loss        when a tag will be lost (section 4.2.1, eq. 10)
    net         the same, learned: the net for two tags and the one for three
    reach       how long a helper needs (eq. 11, eq. 13)
    help        calls issued, and which call to answer (section 4.2.2)
    modes       follow, help, explore (figure 3)
    behaviors   where to fly in each mode
    step        Algorithm 1, one pass of its loop

Eq. 2, the rules of section 4.1, and what the paper compares with are in `swarm_agent.policies`.

The rules are inside what numba compiles, without its decorator: loops and `if`s, + - * / and sqrt, columns that are
lists here and arrays in a study. Where they depart from the text a comment begins with `PAPER:` and says why.

Symbols of the paper and their names here:

    S      arena                       r_s   sensing_range_m        r_c   the radio's range (not known to the rules)
    v_i    agent, me, mate             s_v   agent_speed_m_s        s_o   target_speed_m_s
    o_j    target, j                   t_l   loss_in_s, loss_at_s   T_r   capture_s (Algorithm 1: t_c)
    TT     table.tagged                h_m   help_margin_s          delta turn_time_s (of eq. 13)
    UH, AH the two halves of help.choose                            d_o1  standoff_m
"""
