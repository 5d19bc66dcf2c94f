#!/usr/bin/env bash
# usage: tsan.sh SOURCE_DIR [BUILD_DIR]
# Builds the solver under the thread sanitizer and has it make steps of a bed so large that four threads share it, by every
# scheme; a race that is seen is a failure.
set -euo pipefail
source_dir=$1 build_dir=${2:-$1/build/tsan}
mkdir -p "$build_dir"
cmake -S "$source_dir" --preset tsan -B "$build_dir" >"$build_dir/build.log"
cmake --build "$build_dir" --target crossdem-solver --parallel "$(nproc)" >>"$build_dir/build.log" 2>&1 ||
  { tail -n 30 "$build_dir/build.log" >&2 && exit 1; }
exec /usr/bin/python3 "$source_dir/tests/nightly/tsan_bed.py" "$build_dir/solver/crossdem-solver"
