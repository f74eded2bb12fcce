#include "app/base/output_exchange.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <sstream>

#include "machines/toml/regular_file.h"
#include "postproc/controls/registry.h"

namespace toothpath::app {
namespace {

namespace fs = std::filesystem;

// Marks on the disk, in the order in which a move makes them.
constexpr const char* kAside = ".toothpath-aside";  ///< folder: files on their way out of the directory
constexpr const char* kJournal =
    ".toothpath-journal";                         ///< kAside is complete; what stands under the names in here is new
constexpr const char* kDone = ".toothpath-done";  ///< kAside, renamed: the new files stay, those in here go
// "-" and the name of `previous` follow:
constexpr const char* kKept = ".toothpath-kept-";    ///< kAside, renamed: complete, becomes `previous`
constexpr const char* kOlder = ".toothpath-older-";  ///< `previous`, renamed: gives way to kKept
constexpr std::size_t kMostJournalBytes = 1 << 16;
constexpr std::size_t kMostDigits = 3;  // of a numbered program

bool exists(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0;
}

bool is_folder(const std::string& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode);
}

std::vector<std::string> entries_of(const std::string& directory) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(directory, error), end; !error && it != end; it.increment(error))
    names.push_back(it->path().filename().string());
  return names;
}

bool is_nc_program(const std::string& name) {
  const auto extensions = controls::program_extensions();
  return std::any_of(extensions.begin(), extensions.end(), [&](const std::string& e) { return name.ends_with(e); });
}

Status moved(const std::string& from, const std::string& to) {
  if (::rename(from.c_str(), to.c_str()) == 0) return Ok{};
  return cannot("move", from, errno);
}

Status removed(const std::string& path) {
  if (::unlink(path.c_str()) == 0 || errno == ENOENT) return Ok{};
  return cannot("remove", path, errno);
}

/// A folder with nothing but files of ours.
Status removed_with_files(const std::string& folder) {
  for (const auto& name : entries_of(folder))
    if (auto s = removed(folder + "/" + name); !s) return s;
  if (::rmdir(folder.c_str()) == 0 || errno == ENOENT) return Ok{};
  return cannot("remove", folder, errno);
}

}  // namespace

Diagnostic cannot(const char* what, const std::string& path, int error) {
  return {DiagnosticKind::file_access, {path, 0, 0}, fmt::format("cannot {}: {}", what, std::strerror(error))};
}

int write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return ::fsync(descriptor) == 0 || errno == EINVAL ? 0 : errno;
}

void flush_directory(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
}

OutputNames::OutputNames(const std::vector<std::string>& names) {
  for (const auto& name : names)
    if (name.back() != '.') others_.push_back(name);
    else if (name.ends_with("#.")) numbered_.push_back(name.substr(0, name.size() - 2));
    else
      for (const auto& extension : controls::program_extensions()) programs_.push_back(name + extension.substr(1));
}

bool OutputNames::is_program(std::string_view name) const {
  if (std::find(programs_.begin(), programs_.end(), name) != programs_.end()) return true;
  const std::size_t point = name.find('.');
  if (numbered_.empty() || point == std::string_view::npos) return false;
  const auto extensions = controls::program_extensions();
  if (std::find(extensions.begin(), extensions.end(), name.substr(point)) == extensions.end()) return false;
  return std::any_of(numbered_.begin(), numbered_.end(), [&](const std::string& head) {
    if (!name.starts_with(head) || head.size() > point) return false;
    const std::string_view digits = name.substr(head.size(), point - head.size());
    return !digits.empty() && digits.size() <= kMostDigits &&
           std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
  });
}

bool OutputNames::contains(std::string_view name) const {
  return is_program(name) || std::find(others_.begin(), others_.end(), name) != others_.end();
}

std::vector<std::string> OutputNames::standing_in(const std::string& directory) const {
  std::vector<std::string> standing;
  const auto add = [&](const std::vector<std::string>& names) {
    std::copy_if(names.begin(), names.end(), std::back_inserter(standing),
                 [&](const std::string& name) { return exists(directory + "/" + name); });
  };
  add(programs_);
  if (!numbered_.empty()) {
    const std::size_t before = standing.size();
    for (std::string& name : entries_of(directory))
      if (is_program(name) && std::find(programs_.begin(), programs_.end(), name) == programs_.end())
        standing.push_back(std::move(name));
    std::sort(standing.begin() + static_cast<std::ptrdiff_t>(before), standing.end());
  }
  add(others_);
  return standing;
}

OutputExchange::OutputExchange(std::string directory, OutputNames names, std::string previous)
    : directory_(std::move(directory)), names_(std::move(names)), previous_(std::move(previous)) {
  if (previous_.empty()) return;
  kept_ = kKept + previous_;
  older_ = kOlder + previous_;
}

Status OutputExchange::check() const {
  const auto no_folders = [&](const std::string& directory) -> Status {
    for (const auto& name : names_.standing_in(directory))
      if (is_folder(directory + "/" + name)) return cannot("replace", directory + "/" + name, EISDIR);
    return Ok{};
  };
  if (auto s = no_folders(directory_); !s) return s;
  const std::string folder = at(previous_);
  if (previous_.empty() || !exists(folder)) return Ok{};
  if (!is_folder(folder)) return cannot("keep earlier results in", folder, ENOTDIR);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) return cannot("keep earlier results in", folder, errno);
  return no_folders(folder);
}

/// Files of the names to kAside, programs first.
Status OutputExchange::take_out(const std::vector<std::string>& names) const {
  if (::mkdir(at(kAside).c_str(), 0777) != 0) return cannot("make the directory", at(kAside), errno);
  for (const auto& name : names) {
    if (is_folder(at(name))) continue;  // made since check(): what would replace it fails with its name
    if (auto s = moved(at(name), at(kAside) + "/" + name); !s) {
      (void)put_back();  // what cannot move now is moved by the next recover()
      return s;
    }
  }
  return Ok{};
}

/// Files from kAside to their places, programs last (of whatever command they are); nobody else's file is overwritten.
Status OutputExchange::put_back() const {
  const std::string aside = at(kAside);
  if (!exists(aside)) return Ok{};
  auto names = entries_of(aside);
  std::stable_partition(names.begin(), names.end(), [](const std::string& name) { return !is_nc_program(name); });
  for (const auto& name : names) {
    if (exists(at(name))) return cannot("put back what a run that was killed left", aside + "/" + name, EEXIST);
    if (auto s = moved(aside + "/" + name, at(name)); !s) return s;
  }
  if (::rmdir(aside.c_str()) != 0) return cannot("remove", aside, errno);
  return Ok{};
}

Status OutputExchange::recover() const {
  if (exists(at(kDone))) {
    end_replace();
    if (exists(at(kDone))) return cannot("remove", at(kDone), EACCES);
  } else if (exists(at(kJournal))) {
    if (auto s = undo_replace(); !s) return s;
  }
  if (auto s = put_back(); !s) return s;
  return previous_.empty() ? Status(Ok{}) : recover_previous();
}

Status OutputExchange::set_aside() const {
  if (auto s = take_out(names_.standing_in(directory_)); !s) return s;
  flush_directory(directory_);
  if (auto s = aside_to_previous(); !s) {
    (void)put_back();
    return s;
  }
  flush_directory(directory_);
  (void)end_previous();  // what stays of the older set is hidden, and goes with the next recover()
  return Ok{};
}

/// Three renames of whole folders; failed: kAside is complete again and `previous` as it was.
Status OutputExchange::aside_to_previous() const {
  const std::string aside = at(kAside), kept = at(kept_), older = at(older_), previous = at(previous_);
  if (auto s = moved(aside, kept); !s) return s;
  const bool replaces = exists(previous);
  if (auto s = replaces ? moved(previous, older) : Status(Ok{}); !s) {
    (void)moved(kept, aside);
    return s;
  }
  if (auto s = moved(kept, previous); !s) {
    if (replaces) (void)moved(older, previous);
    (void)moved(kept, aside);
    return s;
  }
  return Ok{};
}

Status OutputExchange::recover_previous() const {
  const std::string kept = at(kept_), older = at(older_), previous = at(previous_);
  if (exists(kept)) {  // complete: it becomes `previous`
    if (exists(previous) && !exists(older))
      if (auto s = moved(previous, older); !s) return s;
    if (auto s = moved(kept, previous); !s) return s;
  } else if (exists(older) && !exists(previous)) {
    return moved(older, previous);
  }
  return end_previous();
}

/// Of the set before the last one our files go; what somebody else put there stays in `previous`.
Status OutputExchange::end_previous() const {
  const std::string older = at(older_);
  if (!exists(older)) return Ok{};
  for (const auto& name : entries_of(older)) {
    const std::string path = older + "/" + name;
    if (auto s = names_.contains(name) && !is_folder(path) ? removed(path) : moved(path, at(previous_) + "/" + name);
        !s)
      return s;
  }
  if (::rmdir(older.c_str()) != 0) return cannot("remove", older, errno);
  return Ok{};
}

Status OutputExchange::write_journal(const std::vector<NewFile>& files) const {
  const std::string temporary = fmt::format("{}/.toothpath-{}-journal", directory_, ::getpid());
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor < 0) return cannot("write", temporary, errno);
  std::string text;
  for (const auto& file : files) text += file.name + "\n";
  int error = write_all(descriptor, text);
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error == 0 && ::rename(temporary.c_str(), at(kJournal).c_str()) != 0) error = errno;
  if (error == 0) return Ok{};
  ::unlink(temporary.c_str());
  return cannot("write", temporary, error);
}

/// New files go, then the journal, then what they replaced comes back: in this order none of the old ones is taken for
/// a new one.
Status OutputExchange::undo_replace() const {
  const auto journal = toml::read_regular_file(at(kJournal), kMostJournalBytes);
  if (!journal) return journal.error();
  std::vector<std::string> names;
  std::istringstream lines(*journal);
  for (std::string name; std::getline(lines, name);) names.push_back(name);
  for (auto it = names.rbegin(); it != names.rend(); ++it)  // programs were named last
    if (!is_folder(at(*it)))
      if (auto s = removed(at(*it)); !s) return s;
  if (auto s = removed(at(kJournal)); !s) return s;
  return put_back();
}

/// The journal first: while it stands, kDone says that the new files stay.
void OutputExchange::end_replace() const {
  if (removed(at(kJournal))) (void)removed_with_files(at(kDone));
}

Status OutputExchange::replace(const std::vector<NewFile>& files, const std::function<Status()>& verify) const {
  std::vector<std::string> in_the_way = names_.standing_in(directory_);
  for (const auto& file : files)
    if (!names_.contains(file.name) && exists(at(file.name))) in_the_way.push_back(file.name);
  if (auto s = take_out(in_the_way); !s) return s;
  flush_directory(directory_);
  if (auto s = write_journal(files); !s) {
    (void)put_back();
    return s;
  }
  const auto named = [&]() -> Status {
    for (const auto& file : files)
      if (::rename(file.temporary_path.c_str(), at(file.name).c_str()) != 0)
        return cannot("write", at(file.name), errno);
    flush_directory(directory_);
    if (auto s = verify(); !s) return s;
    return moved(at(kAside), at(kDone));
  }();
  if (!named) {
    (void)undo_replace();  // what cannot be undone now is undone by the next recover()
    return named;
  }
  end_replace();
  return Ok{};
}

}  // namespace toothpath::app
