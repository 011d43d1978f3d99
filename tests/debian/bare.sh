#!/usr/bin/env bash
# The README's commands on a bare machine: a Debian 13 with git, make, gcc and python3 alone, from nothing, in a folder
# made by debootstrap; nothing is installed outside it.
#
#   tests/debian/bare.sh [COMMAND ...]      default: `make report` and `make test`, as the README has them
#
# The system is made anew each time, under build/debian/bare; CACHE=1 keeps the downloaded packages for the next time.
# How this machine reaches its package registries (proxy, certificates, pip's and uv's settings) holds inside, too.
set -euo pipefail
cd "$(dirname "$0")/../.."
target=test-bare
. tests/debian/system.sh

root="$PWD/build/debian/bare" log="$PWD/build/debian/bare.log"
# A package's name, not its dependencies' recommendations: python3 without venv, gcc without the C library's headers.
packages="git,make,gcc,python3"
carried="^(https?_proxy|all_proxy|no_proxy|HTTPS?_PROXY|ALL_PROXY|NO_PROXY|(PIP|UV)_(DEFAULT_)?(EXTRA_)?INDEX(_URL)?\
|PIP_(DEFAULT_TIMEOUT|TRUSTED_HOST)|UV_HTTP_TIMEOUT)="

carry_settings() {
  local line certificates="${SSL_CERT_FILE:-${PIP_CERT:-${REQUESTS_CA_BUNDLE:-}}}"
  while IFS= read -r line; do settings+=("$line"); done < <(env | grep -E "$carried" | grep -v '^http_proxy=' || true)
  if [ -n "$certificates" ]; then
    cp --dereference "$certificates" "$root/etc/ssl/machine.crt"
    settings+=(SSL_CERT_FILE=/etc/ssl/machine.crt PIP_CERT=/etc/ssl/machine.crt)
  fi
  for file in /etc/resolv.conf /etc/hosts; do [ ! -e "$file" ] || cp --dereference "$file" "$root/etc/"; done
  for file in /etc/pip.conf /etc/uv/uv.toml; do [ ! -e "$file" ] || install -D "$file" "$root$file"; done
}

if [ $# = 0 ]; then
  mapfile -t commands < <(grep -oE '^make (report|test)\b' README.md)
  [ "${#commands[@]}" = 2 ] || fail "README.md no longer begins a line with make report and one with make test"
else
  commands=("$@")
fi

rm -rf "$root"; mkdir -p "$root" build/debian/cache
echo "== a bare Debian 13 with ${packages//,/, } in build/debian/bare"
debootstrap --variant=minbase --include="$packages" ${CACHE:+--cache-dir="$PWD/build/debian/cache"} \
  trixie "$root" "$mirror" > "$log" 2>&1 || fail "the system could not be made; see build/debian/bare.log"
mkdir -p "$root/etc/ssl"
carry_settings
git clone --quiet --no-hardlinks . "$root/srv/project"
[ -z "$(git status --porcelain)" ] || echo "changes that are not committed are not in the clone"
for command in "${commands[@]}"; do
  echo "== $command"
  status=0
  SECONDS=0
  inside "$root" "cd /srv/project && $command" || status=$?
  echo "== $command: exit status $status after $((SECONDS / 60)) min $((SECONDS % 60)) s"
  [ "$status" = 0 ] || exit 1
done
