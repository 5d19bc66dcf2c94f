"""How the processes of a workflow end: on a signal, and when the process that started them is no more."""

import ctypes
import os
import signal

PR_SET_PDEATHSIG = 1  # linux/prctl.h
ENDING = (signal.SIGINT, signal.SIGTERM)


def end_on_signals() -> None:
    """SIGINT and SIGTERM raise KeyboardInterrupt, whatever this process was started with: shells hand on an ignored SIGINT.

    Once: a second one would break off the cleaning up.
    """
    for number in ENDING:
        signal.signal(number, _end)


def end_with_parent(number: signal.Signals = signal.SIGTERM) -> None:
    """Have the system send `number` when the parent ends, and send it at once where that has happened already.

    It may come more than once, as each thread of the parent ends.
    """
    parent = os.getppid()
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, number, 0, 0, 0)
    if os.getppid() != parent:
        os.kill(os.getpid(), number)


def _end(*_) -> None:
    for number in ENDING:
        signal.signal(number, signal.SIG_IGN)
    raise KeyboardInterrupt
