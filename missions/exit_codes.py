"""What every verb of the command line tells by its exit code."""

DONE = 0
FAILED = 1  # the mission, or a check; ended at once, by a second SIGTERM
BAD_INPUT = 2
STOPPED = 130  # by Ctrl-C
UNREAD = 141  # nobody reads what it prints
