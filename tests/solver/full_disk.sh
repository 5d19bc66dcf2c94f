#!/usr/bin/env bash
# usage: full_disk.sh SOLVER WORK_DIR
# A run whose files cannot grow any further ends with status 1 and a message, not with a crash. A limit on the size of
# files stands for the full disk.
set -euo pipefail
solver=$1 work_dir=$2
small_bed=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/small_bed.json
export LSAN_OPTIONS=detect_leaks=0 # HDF5 1.10 loses a block of its own when it cannot write
rm -rf "$work_dir"
mkdir -p "$work_dir"
"$solver" pack "$small_bed" --output "$work_dir/packing"
for kilobytes in 16 40 80; do # motion.h5 fails at its first, a middle and its last frame
  status=0
  (
    trap '' XFSZ
    ulimit -f "$kilobytes"
    exec "$solver" run "$small_bed" --packing "$work_dir/packing/packing.csv" --output "$work_dir/run_$kilobytes"
  ) 2>"$work_dir/message" || status=$?
  cat "$work_dir/message"
  [ "$status" = 1 ] || { echo "status $status at $kilobytes kB" >&2 && exit 1; }
  grep -q "is the disk full?" "$work_dir/message"
  [ "$(wc -l <"$work_dir/message")" = 1 ] # nothing after it: under the sanitizers a crash has status 1 too
  [ ! -e "$work_dir/run_$kilobytes/run.json" ] # which would say that all is done
done
