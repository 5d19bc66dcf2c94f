#!/usr/bin/env bash
# usage: build_against_installed.sh BUILD_DIR WORK_DIR
# Installs BUILD_DIR into a fresh WORK_DIR, builds the project beside this script with it, and runs that.
set -euo pipefail
build_dir=$1 work_dir=$2
rm -rf "$work_dir"
cmake --install "$build_dir" --prefix "$work_dir/installed" >/dev/null
cmake -S project -B "$work_dir/build" -DCMAKE_PREFIX_PATH="$work_dir/installed" -DCMAKE_BUILD_TYPE=Release
cmake --build "$work_dir/build"
"$work_dir/build/consumer"
"$work_dir/installed/bin/crossdem-solver" --version
