"""Recordings reviewed: `swarm review F.rrd` tells what happened in a mission, and why, from its recording alone.

    review = read(Path("out/quickstart.rrd"))
    review.report["coverage"]        # every metric of the mission's own report, counted anew
    review.losses[0].chances         # who could have prevented the first loss
    print(*review.lines, sep="\\n")   # the timeline

`reading` puts it together; `calls`, `losses`, `timeline` and `highlights` find what happened; `summary`, `moment`,
`lines`, `comparison`, `figures` and `page` show it; `checks` judges it; `command` is the shell.
"""
