#!/bin/sh
# properties = {properties}
# The mark outlives Slurm's memory of the job, and the loss of its node once the work is done.
({exec_job}) && touch "slurm/$SLURM_JOB_NAME.done"
