#include "app/fit/least_squares.h"

#include <dlfcn.h>

#include <filesystem>
#include <vector>

namespace toothpath::fit {
namespace {

namespace fs = std::filesystem;
using Minimise = void (*)(LeastSquares*);

constexpr const char* kLibrary = "toothpath_least_squares.so";

/// Beside the installed program, then where this was built.
std::vector<fs::path> library_places() {
  std::vector<fs::path> places;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) places.push_back(program.parent_path().parent_path() / "lib" / "toothpath" / "modules" / kLibrary);
#ifdef TOOTHPATH_LIBRARY_IN_TREE
  places.emplace_back(fs::path(TOOTHPATH_LIBRARY_IN_TREE) / kLibrary);
#endif
  return places;
}

struct Library {
  Minimise minimise = nullptr;
};

/// Stays open as long as the process lives.
Result<Library> open_library() {
  for (const fs::path& place : library_places()) {
    std::error_code error;
    if (!fs::exists(place, error)) continue;
    void* library = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* found = library != nullptr ? ::dlsym(library, "toothpath_minimise") : nullptr;
    if (found != nullptr) return Library{reinterpret_cast<Minimise>(found)};
    const char* why = ::dlerror();
    return Diagnostic{
        DiagnosticKind::file_access,
        {place.string(), 0, 0},
        fmt::format("cannot be opened: {}; Debian has what it needs in libceres3", why ? why : "unknown")};
  }
  return Diagnostic{DiagnosticKind::file_access,
                    {library_places().front().string(), 0, 0},
                    "is missing: it belongs to the program, install that again"};
}

}  // namespace

Status minimise(LeastSquares& problem) {
  static const Result<Library> library = open_library();
  if (!library) return library.error();
  library->minimise(&problem);
  return Ok{};
}

}  // namespace toothpath::fit
