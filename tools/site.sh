#!/usr/bin/env bash
# The documentation as a site in build/site, with a gallery made by running every sample: tools/site.sh [options of tools/site/make.py]
# Program and Python module are those of the preset `package`, built where they are missing, or what --program and --module say.
# Look at it with: python3 -m http.server -d build/site    (as files every page opens, too; the search needs a server)
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
source "$root/tools/packages.sh"
need_packages "${build_packages[@]}" "${site_packages[@]}" pybind11-dev python3-dev python3-numpy
"$root/tools/get_page_tools.sh" >&2
if [[ " $*" != *" --program"* ]]; then
  (cd "$root" && cmake --preset package >/dev/null && cmake --build "$root/build/package" --target toothpath toothpath_least_squares toothpath_python)
  set -- --program "$root/build/package/toothpath" --module "$root/build/package/python" "$@"
fi
exec /usr/bin/python3 "$root/tools/site/make.py" "$@"
