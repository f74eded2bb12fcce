#!/bin/sh
# Prints a page to PDF in headless Chromium and counts its sides: tools/page_prints_on_one_side.sh FILE.html [OUT.pdf]
# Exit code 0: one side; 1: more; 77: no Chromium here.
set -eu
[ $# -ge 1 ] || { echo "usage: tools/page_prints_on_one_side.sh FILE.html [OUT.pdf]" >&2; exit 2; }
for browser in chromium chromium-browser google-chrome; do
  command -v "$browser" >/dev/null 2>&1 && break
  browser=""
done
[ -n "$browser" ] || { echo "no Chromium: run tools/get_page_tools.sh" >&2; exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$work/profile" --no-pdf-header-footer \
  --print-to-pdf="$work/page.pdf" "file://$(realpath "$1")" >/dev/null 2>&1
[ $# -lt 2 ] || cp "$work/page.pdf" "$2"
sides=$(grep -a -o '/Count [0-9]*' "$work/page.pdf" | head -n 1 | cut -d ' ' -f 2)
echo "$sides side(s)"
[ "$sides" -eq 1 ]
