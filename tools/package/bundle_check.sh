# Is every library that a bundle needs in it? Sourced by tarball.sh and tests/install/package_test.sh.

# is_of_glibc LIBRARY: those that come with the loader of a system and cannot be taken along.
is_of_glibc() {
  [[ $1 =~ ^(ld-linux.*|libc|libm|libdl|librt|libpthread|libresolv|libutil|libmvec|libanl)\.so(\.[0-9]+)*$ ]]
}

# check_bundle TREE: reads the dynamic section of every program and library below it. Where all is there, the least glibc and the number of
# files are printed; else each library that is missing or would be looked for elsewhere is told with the file that needs it, and 1 returned.
check_bundle() {
  local tree file section library faults=0 glibc=0 versions count=0 rpath folder
  tree=$(realpath "$1")
  while IFS= read -r file; do
    section=$(readelf -dV "$file" 2>/dev/null) || continue
    [[ $section == *"Dynamic section"* ]] || continue
    count=$((count + 1))
    rpath=$(sed -n 's/.*(RPATH).*\[\(.*\)\]/\1/p' <<<"$section")
    folder=$(realpath -m "${rpath/\$ORIGIN/$(dirname "$file")}")
    if [[ $rpath != "\$ORIGIN"* || $folder/ != "$tree"/* || $section == *"(RUNPATH)"* ]]; then
      echo "bundle: ${file#"$tree"/} looks for libraries in \"$rpath\", which is not a place in the bundle" >&2
      faults=1
    fi
    while read -r library; do
      is_of_glibc "$library" || [[ -s $folder/$library ]] || { echo "bundle: $library is missing, ${file#"$tree"/} needs it" >&2; faults=1; }
    done < <(sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' <<<"$section")
    versions=$(grep -oE 'GLIBC_2\.[0-9]+' <<<"$section" | sed 's/GLIBC_2\.//' | sort -n | tail -n 1)
    ((${versions:-0} <= glibc)) || glibc=$versions
  done < <(find "$tree" -type f \( -path '*/bin/*' -o -name '*.so*' \) | sort)
  ((count > 1)) || { echo "bundle: no programs in $tree" >&2; faults=1; }
  ((faults == 0)) || return 1
  echo "glibc 2.$glibc or newer; $count programs and libraries"
}
