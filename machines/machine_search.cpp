// Where installed machine files live: beside the installed program, or in the tree it was built from.
#include <algorithm>
#include <filesystem>

#include "machines/machine_file.h"

namespace toothpath {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// Names of the .toml files of the directories, sorted, each once.
std::vector<std::string> installed_names(const std::vector<std::string>& directories) {
  std::vector<std::string> names;
  for (const std::string& directory : directories) {
    std::error_code error;
    for (fs::directory_iterator it(directory, error), end; !error && it != end; it.increment(error))
      if (it->path().extension() == ".toml") names.push_back(it->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

}  // namespace

std::vector<std::string> machine_directories() {
  std::vector<fs::path> places;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) places.push_back(program.parent_path().parent_path() / "share" / "toothpath" / "machines");
#ifdef TOOTHPATH_MACHINE_DATA
  places.emplace_back(TOOTHPATH_MACHINE_DATA);
#endif
  std::vector<std::string> found;
  for (const fs::path& place : places)
    if (fs::is_directory(place, error)) found.push_back(place.string());
  return found;
}

Result<std::string> find_machine_file(const std::string& name, const std::string& job_directory) {
  if (name.empty() || name.find('\0') != std::string::npos)
    return fail_as(DiagnosticKind::file_access, "machine file has no name");
  const fs::path wanted(name);
  const fs::path beside = fs::path(job_directory) / wanted;  // an absolute name replaces the directory
  if (is_there(beside)) return beside.string();
  const std::vector<std::string> directories = machine_directories();
  if (wanted.is_relative()) {
    const fs::path plain = wanted.parent_path() == "machines" ? wanted.filename() : wanted;
    if (!plain.has_parent_path())
      for (const std::string& directory : directories)
        if (const fs::path path = fs::path(directory) / plain; is_there(path)) return path.string();
  }
  return fail_as(DiagnosticKind::file_access,
                 "machine file \"{}\" is neither beside the job nor installed; installed are: {}", name,
                 fmt::join(installed_names(directories), ", "));
}

}  // namespace toothpath
