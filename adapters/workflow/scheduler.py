"""Snakemake's own command, ended together with the crossdem that started it. Leads a process group: its tasks are in it."""

import os
import signal
import sys

from .signals import end_on_signals, end_with_parent


def _cancel(*_) -> None:
    signal.signal(signal.SIGUSR1, signal.SIG_IGN)
    os.killpg(0, signal.SIGINT)  # on which Snakemake cancels, also on a cluster, and tasks end


def main(arguments: list[str]) -> None:
    end_on_signals()
    signal.signal(signal.SIGUSR1, _cancel)
    end_with_parent(signal.SIGUSR1)
    from snakemake import main as snakemake  # here: it takes a second

    snakemake(arguments)


if __name__ == "__main__":
    main(sys.argv[1:])
