#!/usr/bin/env bash
# usage: fuzz.sh SOURCE_DIR [SECONDS]
# Ten minutes, or SECONDS, of the readers' fuzzers one after the other, on one core. What they find is kept in
# build/fuzz/found and is where the next night goes on from; an input that breaks a reader lies in build/fuzz/found/NAME-broken.
set -euo pipefail
cd "$1"
all_s=${2:-600}
fuzzers=(tests/fuzz/*_fuzz.cpp)
cmake --preset fuzz >build/fuzz.log
cmake --build build/fuzz --parallel "$(nproc)" >>build/fuzz.log 2>&1 || { tail -n 30 build/fuzz.log >&2 && exit 1; }
for source in "${fuzzers[@]}"; do
  name=$(basename "$source" _fuzz.cpp)
  bash tests/fuzz/fuzz.sh build/fuzz/tests/fuzz "$name" "build/fuzz/found/$name" -max_total_time=$((all_s / ${#fuzzers[@]}))
done
