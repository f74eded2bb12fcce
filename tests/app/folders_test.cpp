// The rules of the folders: every file stands in the table of its folder's README, every file named there exists, and no folder includes
// one that lies above it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "program.h"

namespace toothpath::test {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = TOOTHPATH_SOURCE_DIR;

bool is_source(const fs::path& path) {
  return path.extension() == ".h" || path.extension() == ".cpp" || path.extension() == ".inl";
}

/// Sources of a folder and of those below it that have no README of their own, relative to it.
std::vector<fs::path> sources_of(const fs::path& folder) {
  std::vector<fs::path> out;
  for (auto it = fs::recursive_directory_iterator(folder); it != fs::recursive_directory_iterator(); ++it) {
    if (it->is_directory() && fs::exists(it->path() / "README.md")) it.disable_recursion_pending();
    else if (is_source(it->path()) || (folder.filename() == "samples" && it->path().extension() == ".toml"))
      out.push_back(fs::relative(it->path(), folder));
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// What stands in backquotes in the first column of the table that begins with "| file |".
std::set<std::string> listed_in(const fs::path& readme) {
  std::set<std::string> out;
  std::istringstream in(file_text(readme.string()));
  bool inside = false;
  const std::regex quoted("`([^`]+)`");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("| file |")) inside = true;
    else if (!line.starts_with("|")) inside = false;
    if (!inside) continue;
    const std::string first = line.substr(0, line.find('|', 1));
    for (auto it = std::sregex_iterator(first.begin(), first.end(), quoted); it != std::sregex_iterator(); ++it) out.insert((*it)[1]);
  }
  return out;
}

/// `name` as the table may write it: a whole file name, a stem, a stem that ends in *, a folder that ends in /.
bool stands_for(const std::string& entry, const fs::path& file) {
  const std::string whole = file.generic_string(), stem = (file.parent_path() / file.stem()).generic_string();
  if (entry.ends_with('/')) return whole.starts_with(entry);
  if (entry.ends_with('*')) return stem.starts_with(entry.substr(0, entry.size() - 1));
  return entry == whole || entry == stem;
}

TEST(Folders, TablesListEveryFileAndNoOther) {
  for (const char* folder :
       {"geometry", "cam", "cam/tool", "cam/line", "machines", "machines/toml", "postproc", "postproc/controls", "app", "samples"}) {
    const auto entries = listed_in(kRoot / folder / "README.md");
    EXPECT_FALSE(entries.empty()) << folder;
    const auto files = sources_of(kRoot / folder);
    EXPECT_FALSE(files.empty()) << folder;
    for (const auto& file : files)
      EXPECT_TRUE(std::any_of(entries.begin(), entries.end(), [&](const std::string& e) { return stands_for(e, file); }))
          << folder << "/README.md lacks " << file;
    for (const auto& entry : entries)
      EXPECT_TRUE(fs::exists(kRoot / folder / entry) || std::any_of(files.begin(), files.end(), [&](const fs::path& f) { return stands_for(entry, f); }))
          << folder << "/README.md names " << entry << ", which is not there";
  }
}

TEST(Folders, IncludeOnlyWhatLiesBelow) {
  const std::map<std::string, std::vector<std::string>> allowed = {{"geometry", {"geometry/"}},
                                                                   {"cam", {"cam/", "geometry/"}},
                                                                   {"machines", {"machines/", "geometry/base/"}},
                                                                   {"postproc", {"postproc/", "cam/", "machines/", "geometry/"}},
                                                                   {"app", {"app/", "postproc/", "cam/", "machines/", "geometry/"}}};
  const std::regex include("#include \"([^\"]+)\"");
  for (const auto& [folder, below] : allowed) {
    int seen = 0;
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
      if (!is_source(entry.path())) continue;
      std::istringstream in(file_text(entry.path().string()));
      std::smatch match;
      for (std::string line; std::getline(in, line);) {
        if (!std::regex_match(line, match, include)) continue;
        ++seen;
        const std::string included = match[1];
        EXPECT_TRUE(std::any_of(below.begin(), below.end(), [&](const std::string& b) { return included.starts_with(b); }))
            << entry.path() << " includes " << included;
      }
    }
    EXPECT_GT(seen, 10) << folder;
  }
}

}  // namespace
}  // namespace toothpath::test
