#!/usr/bin/env bash
# usage: same_bits.sh SOLVER SOURCE_DIR WORK_DIR
# Compiles the solver with g++ -O0 and with clang++ -O2, settles a small bed and runs it by every scheme with each and with
# SOLVER (g++ -O3 in a release build), and compares what they wrote, bit for bit.
set -euo pipefail
own_solver=$1 source_dir=$2 work_dir=$3
source "$(dirname "${BASH_SOURCE[0]}")/write_and_hash.sh"
rm -rf "$work_dir"
mkdir -p "$work_dir"

# compile_and_hash NAME COMPILER FLAGS
compile_and_hash() {
  local build=$work_dir/build_$1
  cmake -S "$source_dir" -B "$build" -DBUILD_TESTING=OFF -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER="$2" \
    -DCMAKE_CXX_FLAGS="$3" >"$build.log"
  cmake --build "$build" --target crossdem-solver >>"$build.log" 2>&1 || { cat "$build.log" >&2 && return 1; }
  hash_results "$work_dir/$1" "$build/solver/crossdem-solver"
}

compile_and_hash g++_-O0 g++ -O0 &
compile_and_hash clang++_-O2 clang++ -O2
wait $!
hash_results "$work_dir/this_build" "$own_solver"
"$own_solver" --version
for name in g++_-O0 clang++_-O2; do
  diff "$work_dir/this_build.sha256" "$work_dir/$name.sha256" || { echo "this build and $name differ" >&2 && exit 1; }
done
echo "the same bits from this build, g++ -O0 and clang++ -O2"
