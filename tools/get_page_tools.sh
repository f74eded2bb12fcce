#!/bin/sh
# Installs what the browser test of the report page needs: chromium, nodejs and puppeteer-core (into .deps/page).
# Safe to run again: what is there stays. Packages from the distribution need root; without it the command is printed.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
missing=""
command -v chromium >/dev/null 2>&1 || command -v chromium-browser >/dev/null 2>&1 || command -v google-chrome >/dev/null 2>&1 || missing="$missing chromium"
command -v node >/dev/null 2>&1 || missing="$missing nodejs"
command -v npm >/dev/null 2>&1 || missing="$missing npm"
if [ -n "$missing" ]; then
  if [ "$(id -u)" = 0 ]; then
    apt-get update -q
    # shellcheck disable=SC2086
    DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing fonts-dejavu-core
  else
    echo "missing:$missing; run as root: apt-get install --no-install-recommends$missing fonts-dejavu-core" >&2
    exit 1
  fi
fi
target="$root/.deps/page"
mkdir -p "$target"
if [ ! -d "$target/node_modules/puppeteer-core" ] || ! cmp -s "$root/tests/app/page/package.json" "$target/package.json"; then
  cp "$root/tests/app/page/package.json" "$target/package.json"
  (cd "$target" && npm install --no-audit --no-fund --ignore-scripts --loglevel=error) || { rm -f "$target/package.json"; exit 1; }
fi
echo "page tools are ready: $(node --version), puppeteer-core in .deps/page"
