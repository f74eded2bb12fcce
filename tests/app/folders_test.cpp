// The rules of the folders: every file stands in the table of its folder's README, every file named there exists, and
// no folder includes one that lies above it.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "tests/app/program.h"

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
    for (auto it = std::sregex_iterator(first.begin(), first.end(), quoted); it != std::sregex_iterator(); ++it)
      out.insert((*it)[1]);
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

/// Folders whose README has a table of files.
std::vector<std::string> folders_with_tables() {
  std::vector<std::string> out = {"samples"};
  for (const char* top : {"geometry", "cam", "machines", "postproc", "app"}) {
    out.push_back(top);
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / top))
      if (entry.is_directory() && fs::exists(entry.path() / "README.md"))
        out.push_back(fs::relative(entry.path(), kRoot).generic_string());
  }
  return out;
}

TEST(Folders, TablesListEveryFileAndNoOther) {
  for (const std::string& folder : folders_with_tables()) {
    const auto entries = listed_in(kRoot / folder / "README.md");
    EXPECT_FALSE(entries.empty()) << folder;
    const auto files = sources_of(kRoot / folder);
    for (const auto& file : files)
      EXPECT_TRUE(
          std::any_of(entries.begin(), entries.end(), [&](const std::string& e) { return stands_for(e, file); }))
          << folder << "/README.md lacks " << file;
    for (const auto& entry : entries)
      EXPECT_TRUE(fs::exists(kRoot / folder / entry) ||
                  std::any_of(files.begin(), files.end(), [&](const fs::path& f) { return stands_for(entry, f); }))
          << folder << "/README.md names " << entry << ", which is not there";
  }
}

/// The room of a file: its folder; every control stands in the room of the controls, of mills or of shapers.
std::string room_of(const fs::path& file) {
  const std::string folder = file.parent_path().generic_string();
  for (const char* room : {"postproc/controls", "postproc/shaper"})
    if (folder.starts_with(room)) return room;
  return folder;
}

/// docs/rooms.md: room -> rooms that it may include.
std::map<std::string, std::set<std::string>> edges_of_the_plan() {
  std::map<std::string, std::set<std::string>> out;
  std::istringstream in(file_text((kRoot / "docs/rooms.md").string()));
  const std::regex quoted("`([^`]+)`");
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("| `")) continue;
    std::vector<std::string> names;
    for (auto it = std::sregex_iterator(line.begin(), line.end(), quoted); it != std::sregex_iterator(); ++it)
      names.push_back((*it)[1]);
    out[names.front()] = {names.begin() + 1, names.end()};
  }
  return out;
}

TEST(Folders, RoomsIncludeOnlyWhatThePlanSays) {
  const auto plan = edges_of_the_plan();
  ASSERT_GT(plan.size(), 25u);
  std::map<std::string, std::set<std::string>> used;
  const std::regex include("#include \"([^\"]+)\"");
  for (const char* top : {"geometry", "cam", "machines", "postproc", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / top)) {
      if (!is_source(entry.path())) continue;
      const std::string room = room_of(fs::relative(entry.path(), kRoot));
      ASSERT_TRUE(plan.contains(room)) << "docs/rooms.md lacks " << room;
      used[room];
      std::istringstream in(file_text(entry.path().string()));
      std::smatch match;
      for (std::string line; std::getline(in, line);) {
        if (!std::regex_match(line, match, include)) continue;
        const std::string other = room_of(fs::path(match[1].str()));
        if (other == room) continue;
        used[room].insert(other);
        EXPECT_TRUE(plan.at(room).contains(other)) << entry.path() << " includes " << match[1];
      }
    }
  EXPECT_EQ(used, plan) << "docs/rooms.md names rooms or edges that are not there";
}

TEST(Folders, NoRoomIsInACircleAndNoneBelowAppReachesIt) {
  const auto plan = edges_of_the_plan();
  for (const auto& [room, first] : plan) {
    std::set<std::string> reached;
    std::vector<std::string> open(first.begin(), first.end());
    while (!open.empty()) {
      const std::string next = open.back();
      open.pop_back();
      EXPECT_TRUE(room.starts_with("app") || !next.starts_with("app")) << room << " reaches " << next;
      if (!reached.insert(next).second) continue;
      const auto& more = plan.at(next);
      open.insert(open.end(), more.begin(), more.end());
    }
    EXPECT_FALSE(reached.contains(room)) << room;
  }
}

TEST(Folders, ARoomIsANamespace) {
  for (const char* top : {"geometry", "cam", "machines", "postproc", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / top)) {
      if (!is_source(entry.path())) continue;
      const std::string room = room_of(fs::relative(entry.path(), kRoot)), name = fs::path(room).filename().string(),
                        text = file_text(entry.path().string());
      if (text.find("namespace toothpath") == std::string::npos || room == "app" || room == "app/base") continue;
      const std::string wanted = room == "geometry/base" ? "namespace toothpath {" : "namespace toothpath::" + name;
      EXPECT_NE(text.find(wanted), std::string::npos) << entry.path() << " is not in " << wanted;
    }
}

}  // namespace
}  // namespace toothpath::test
