#!/usr/bin/env bash
# usage: fuzz.sh BUILD_DIR NAME FOUND [OPTION...]
# Has the fuzzer NAME of BUILD_DIR go through its seeds and the inputs in the folder FOUND, then make others of them, as the
# OPTIONs of libFuzzer say, in 1 GB and at most 10 s per input. Inputs that reach new code go into FOUND. One that breaks a
# reader, hangs or takes too much memory goes into FOUND-broken and is a failure.
set -euo pipefail
build_dir=$1 name=$2 found=$3
seeds=$(dirname "${BASH_SOURCE[0]}")/seeds/$name
mkdir -p "$found" "$found-broken"
"$build_dir/${name}_fuzz" -rss_limit_mb=1024 -timeout=10 -max_len=8192 -print_final_stats=1 -dict="$build_dir/$name.dict" \
  -artifact_prefix="$found-broken/" "${@:4}" "$found" "$seeds" 2> >(tee "$found.log" >&2) || {
  echo "fuzz: $name is broken by the input in $found-broken: once it is mended, the input goes into tests/fuzz/seeds/$name" >&2
  exit 1
}
