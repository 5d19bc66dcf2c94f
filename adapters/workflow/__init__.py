"""Ensembles as a Snakemake workflow: what is left to run goes into tasks, on this machine's cores or on a cluster.

Every call has a folder of its own, WORKSPACE/workflow/CALL, and Snakemake works in that: what was cut short needs no
unlocking, as the next call starts afresh with the runs that are not there yet.
"""
