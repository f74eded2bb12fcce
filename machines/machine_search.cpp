// Where installed machine files and schemas live: beside the installed program, or in the tree it was built from.
#include <algorithm>
#include <filesystem>

#include "machines/machine_file.h"
#include "machines/toml/near_name.h"

namespace toothpath::machines {
namespace {

namespace fs = std::filesystem;

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

bool is_same(const fs::path& path, const std::string& other) {
  std::error_code error;
  return !other.empty() && fs::equivalent(path, other, error) && !error;
}

/// "; did you mean ...?" for a name that is like one of these, with its ending or without.
std::string hint_for(const std::string& name, const std::vector<std::string>& installed) {
  const std::string hint = toml::did_you_mean(name, installed);
  return hint.empty() ? toml::did_you_mean(name + ".toml", installed) : hint;
}

/// A folder of the data beside the installed program, then that of the tree it was built from.
std::vector<fs::path> data_places(const char* installed, [[maybe_unused]] const char* in_tree) {
  std::vector<fs::path> places;
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error) places.push_back(program.parent_path().parent_path() / "share" / "toothpath" / installed);
#ifdef TOOTHPATH_SOURCE_TREE
  places.push_back(fs::path(TOOTHPATH_SOURCE_TREE) / in_tree);
#endif
  return places;
}

}  // namespace

std::string schema_file(const std::string& name) {
  for (const fs::path& place : data_places("schema", "docs/schema"))
    if (is_there(place / name)) return (place / name).string();
  return {};
}

std::vector<std::string> machine_directories() {
  const std::vector<fs::path> places = data_places("machines", "machines/data");
  std::error_code error;
  std::vector<std::string> found;
  for (const fs::path& place : places)
    if (fs::is_directory(place, error)) found.push_back(place.string());
  return found;
}

std::vector<std::string> installed_machines() {
  std::vector<std::string> names;
  for (const std::string& directory : machine_directories()) {
    std::error_code error;
    for (fs::directory_iterator it(directory, error), end; !error && it != end; it.increment(error))
      if (it->path().extension() == ".toml") names.push_back(it->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

Result<std::string> find_machine_file(const std::string& name, const std::string& job_directory,
                                      const std::string& job_file) {
  if (name.empty() || name.find('\0') != std::string::npos)
    return fail_as(DiagnosticKind::file_access, "machine file has no name");
  const fs::path wanted(name);
  std::string folder;  // of this name, such as the results of a job named like its machine: taken last, its opening
                       // says what it is
  for (const char* ending : {"", ".toml"}) {
    const fs::path beside = fs::path(job_directory) / (name + ending);  // an absolute name replaces the directory
    if (!is_there(beside) || is_same(beside, job_file)) continue;
    std::error_code error;
    if (!fs::is_directory(beside, error)) return beside.string();
    folder = beside.string();
  }
  if (wanted.is_relative()) {
    const fs::path plain = wanted.parent_path() == "machines" ? wanted.filename() : wanted;
    if (!plain.has_parent_path())
      for (const std::string& directory : machine_directories())
        for (const char* ending : {"", ".toml"})
          if (const fs::path path = fs::path(directory) / (plain.string() + ending); is_there(path))
            return path.string();
  }
  if (!folder.empty()) return folder;
  const std::vector<std::string> installed = installed_machines();
  return fail_as(DiagnosticKind::file_access,
                 "machine file \"{}\" is neither beside the job nor installed{}; installed are: {}", name,
                 hint_for(name, installed), fmt::join(installed, ", "));
}

}  // namespace toothpath::machines
