#!/usr/bin/env bash
# Installs what docker/packages.txt names and a Node.js new enough for the web build. Run by ./run and by the Dockerfile.
# Does nothing, quickly, when everything is there.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
mapfile -t packages < <(grep -vE '^\s*(#|$)' "$here/packages.txt")

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; elif command -v sudo >/dev/null; then sudo "$@"; else
    echo "smokemap: '$*' needs root; run ./run as root once, or install sudo" >&2
    exit 1
  fi
}

missing=()
for package in "${packages[@]}"; do
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
done
node_is_new_enough() {
  command -v "$1" >/dev/null && "$1" -e 'const [a, b] = process.versions.node.split(".").map(Number); process.exit(a > 20 || (a === 20 && b >= 19) ? 0 : 1)'
}
node_home=/opt/smokemap-node
if ! node_is_new_enough node && ! node_is_new_enough "$node_home/node_modules/.bin/node"; then
  command -v npm >/dev/null || missing+=(nodejs npm)
fi
if [ ${#missing[@]} -gt 0 ]; then
  echo "smokemap: installing ${#missing[@]} Debian packages (some minutes on a new machine)"
  as_root apt-get update -qq
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
fi
# Debian 12 has Node 18, Vite needs 20.19: the same programs as npm packages, beside the system's.
if ! node_is_new_enough node && ! node_is_new_enough "$node_home/node_modules/.bin/node"; then
  case "$(uname -m)" in aarch64) node_arch=arm64 ;; *) node_arch=x64 ;; esac
  echo "smokemap: installing Node.js 20 from npm into $node_home"
  as_root mkdir -p "$node_home"
  as_root npm install --loglevel=error --no-fund --no-audit --prefix "$node_home" "node-linux-$node_arch@20.19.5" npm@11.6.2 || {
    echo "smokemap: Node.js 20 could not be installed from npm (see above); any Node.js from 20.19 on the PATH does as well" >&2
    exit 1
  }
fi
