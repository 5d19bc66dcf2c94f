#!/usr/bin/env bash
# usage: arm64.sh SOLVER SOURCE_DIR WORK_DIR
# Compiles the solver for arm64, against Debian's libraries for it, which lie in a folder of their own; has qemu settle and run a
# small bed by every scheme, with Neon, and compares what SOLVER writes of it, bit for bit.
set -euo pipefail
own_solver=$1 source_dir=$2 work_dir=$3
source "$source_dir/tests/solver/write_and_hash.sh"
for program in aarch64-linux-gnu-g++ qemu-aarch64-static; do
  command -v "$program" >/dev/null || {
    echo "arm64: $program is missing: apt install g++-aarch64-linux-gnu qemu-user-static" >&2
    exit 1
  }
done
root=$work_dir/root apt=$work_dir/apt
libraries=/usr/lib/aarch64-linux-gnu
mkdir -p "$root" "$apt"/{lists/partial,archives/partial}
touch "$apt/status"

# An apt of its own, which knows nothing of what is installed here: every library that is needed comes down.
apt_arm64() {
  apt-get -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State="$apt" -o Dir::State::status="$apt/status" \
    -o Dir::State::lists="$apt/lists" -o Dir::Cache="$apt" -o Dir::Cache::archives="$apt/archives" \
    -o APT::Sandbox::User="$(id -un)" -o APT::Install-Recommends=false "$@"
}
apt_arm64 -qq update
apt_arm64 -qq -y --download-only install $(awk '/^# \[/ { on = /\[build\]/; next } on && /-dev$/ { print $1 }' \
  "$source_dir/scripts/packages.txt") >"$work_dir/apt.log" 2>&1 || { tail "$work_dir/apt.log" >&2 && exit 1; }
for package in "$apt"/archives/*.deb; do dpkg-deb -x "$package" "$root"; done

cmake -S "$source_dir" -B "$work_dir/build" -DBUILD_TESTING=OFF -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DCMAKE_LIBRARY_ARCHITECTURE=aarch64-linux-gnu \
  -DCMAKE_C_COMPILER=aarch64-linux-gnu-gcc -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ \
  -DCMAKE_SYSROOT="$root" -DCMAKE_FIND_ROOT_PATH="$root" -DCMAKE_PREFIX_PATH=/usr \
  -DCMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER -DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY \
  -DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY \
  -DCMAKE_EXE_LINKER_FLAGS="-L$root$libraries/hdf5/serial" >"$work_dir/build.log"
cmake --build "$work_dir/build" --target crossdem-solver --parallel "$(nproc)" >>"$work_dir/build.log" 2>&1 ||
  { tail -n 30 "$work_dir/build.log" >&2 && exit 1; }

emulated=(qemu-aarch64-static -L "$root" -E "LD_LIBRARY_PATH=$libraries:$libraries/hdf5/serial"
  "$work_dir/build/solver/crossdem-solver")
"${emulated[@]}" --version
hash_results "$work_dir/arm64" "${emulated[@]}"
hash_results "$work_dir/here" "$own_solver"
diff "$work_dir/here.sha256" "$work_dir/arm64.sha256"
echo "the same bits from $("$own_solver" --version) and on arm64"
