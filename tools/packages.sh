# Debian packages that Toothpath needs, and how to get those that are missing. Sourced by ./run and ./check.

build_packages=(g++ cmake ninja-build libeigen3-dev libcgal-dev libassimp-dev libembree-dev libtbb-dev libfmt-dev
  nlohmann-json3-dev libcli11-dev libtomlplusplus-dev libboost-dev zlib1g-dev libssl-dev lib3mf-dev libtinygltf-dev libpugixml-dev libceres-dev)
test_packages=(libgtest-dev libbenchmark-dev calculix-ccx clang-format clang-tidy mold  # the browser: tools/get_page_tools.sh
  dpkg-dev file patchelf lintian mandoc zsh fish pybind11-dev python3-dev python3-numpy python3-matplotlib python3-jsonschema python3-tomli
  slurm-wlm parallel)
exchange_packages=(freecad-python3)  # opens the STEP files of tests/app/cad_files_test.cpp; with what it needs 1 GB
package_packages=(dpkg-dev file patchelf)  # the preset `package`
site_packages=(mkdocs mkdocs-material)  # tools/site.sh
fuzz_packages=(clang-14 clang libclang-rt-14-dev libfuzzer-14-dev)  # tools/fuzz.sh

# need_packages NAME...: installs those that are not there, in one call; upgrades nothing.
need_packages() {
  local missing=() name
  for name in "$@"; do
    dpkg-query -W -f='${db:Status-Status}' "$name" 2>/dev/null | grep -qx installed || missing+=("$name")
  done
  ((${#missing[@]})) || return 0
  echo "installing: ${missing[*]}" >&2
  local as_root=()
  [[ $(id -u) == 0 ]] || as_root=(sudo)
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -q >&2
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --no-install-recommends -y -q "${missing[@]}" >&2
}
