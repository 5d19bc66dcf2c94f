#!/usr/bin/env bash
# Makes a Debian machine ready: installs what scripts/packages.txt lists and is missing, then builds.
# usage: scripts/setup.sh "SECTION..." PRESET[:TARGET]...
# Sections of packages.txt, besides [engines]; CMake presets, each with the one target to build (default: all).
# With [checks] the browser tests get the one package from npm that they need.
# A second time it neither installs nor rebuilds. Output of apt and the compiler goes to build/setup.log.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export PATH="${PATH:-/usr/bin}:/usr/sbin:/usr/bin:/sbin:/bin" DEBIAN_FRONTEND=noninteractive
mkdir -p build
log=build/setup.log
: >"$log"

say() { printf 'setup: %s\n' "$*"; }

# packages_in SECTION...: the names under these headings of packages.txt
packages_in() {
  awk -v wanted=" $* " '/^# \[/ { gsub(/^# \[|\].*/, ""); on = index(wanted, " " $0 " "); next }
                        on && !/^#/ && NF { print $1 }' scripts/packages.txt
}

# missing PACKAGE...: those of them that are neither installed nor provided by one that is, as npm is by some nodejs
missing() {
  printf '%s\n' "$@" | grep -vxF -f <(dpkg-query -W -f '${db:Status-Status} ${Package}, ${Provides}\n' |
    sed -n 's/^installed //p' | tr ',' '\n' | sed 's/^ *//; s/ .*//; /^$/d') || true
}

# may_install: sets apt, the way to run apt-get here; fails where there is none
may_install() {
  command -v apt-get >/dev/null || return 1
  apt=(apt-get -y -o DPkg::Lock::Timeout=600)
  [ "$(id -u)" = 0 ] && return
  command -v sudo >/dev/null || return 1
  sudo -n true 2>/dev/null || { [ -t 0 ] && sudo -v; } || return 1
  apt=(sudo env DEBIAN_FRONTEND=noninteractive "${apt[@]}")
}

# logged TEXT COMMAND...: runs the command, its output in the log; shows the log's end when it fails
logged() {
  local text=$1
  shift
  say "$text"
  "$@" >>"$log" 2>&1 </dev/null || {
    tail -n 30 "$log" >&2
    say "failed; the whole output is in $PWD/$log" >&2
    return 1
  }
}

install_missing() {
  local -a needed engines
  mapfile -t needed < <(missing $(packages_in "$@"))
  mapfile -t engines < <(missing $(packages_in engines))
  [ $((${#needed[@]} + ${#engines[@]})) -gt 0 ] || return 0
  if ! may_install; then
    say "missing packages, and no right to install them here. As root, run:" >&2
    echo "  apt-get install --no-install-recommends ${needed[*]} ${engines[*]}" >&2
    [ ${#needed[@]} -eq 0 ] # engines alone may be missing: the others run
    return
  fi
  logged "reading the package lists" "${apt[@]}" update || say "going on with the old lists"
  if [ ${#needed[@]} -gt 0 ]; then
    logged "installing ${needed[*]}" "${apt[@]}" install --no-install-recommends "${needed[@]}"
  fi
  local engine
  for engine in "${engines[@]}"; do # one by one: each may be had or not
    logged "installing $engine" "${apt[@]}" install --no-install-recommends "$engine" ||
      say "going on without $engine; its runs will be reported as missing" >&2
  done
}

if command -v dpkg-query >/dev/null; then
  install_missing $1
else
  say "not a Debian system: install the like of what scripts/packages.txt lists by hand" >&2
fi
browser=tests/browser
if [[ " $1 " == *" checks "* && ! $browser/node_modules/.package-lock.json -nt $browser/package-lock.json ]]; then
  logged "installing what drives the browser ($browser)" npm ci --prefix "$browser" --ignore-scripts --no-audit --no-fund
fi
shift
for wanted in "$@"; do
  IFS=: read -r preset target <<<"$wanted:all"
  target=${target%%:*}
  logged "configuring build/$preset" cmake --preset "$preset"
  logged "building build/$preset (a minute or two the first time)" \
    cmake --build "build/$preset" --parallel "$(nproc)" --target "$target"
done
