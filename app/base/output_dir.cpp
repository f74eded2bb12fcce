#include "app/base/output_dir.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <optional>
#include <utility>

#include "app/base/interruption.h"
#include "app/base/out_of_memory.h"
#include "app/base/standing_results.h"
#include "geometry/base/hash.h"
#include "machines/toml/regular_file.h"

namespace toothpath::app {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTemporaryPrefix = ".toothpath-";
constexpr const char* kLock = ".toothpath-lock";

/// What is said at the end: by a signal, and by the command line.
std::string note;

void say(const std::string& interrupted, const std::string& ended) {
  set_state(interrupted);
  note = ended;
}

/// Makes the directory and its parents; returns those that were made, outermost first.
Result<std::vector<std::string>> make_directories(const std::string& path) {
  std::vector<std::string> missing, made;
  for (fs::path p = fs::path(path).lexically_normal(); !p.empty(); p = p.parent_path()) {
    std::error_code error;
    if (fs::exists(fs::symlink_status(p, error)) || p == p.parent_path()) break;
    if (p.has_filename()) missing.push_back(p.string());
  }
  for (auto it = missing.rbegin(); it != missing.rend(); ++it) {
    if (::mkdir(it->c_str(), 0777) == 0) {
      made.push_back(*it);
      if (!register_temporary(*it, true)) return cannot("use", *it, ENAMETOOLONG);
      continue;
    }
    if (errno == EEXIST) continue;  // another run made it meanwhile, and will take it away
    const int error = errno;
    for (auto old = made.rbegin(); old != made.rend(); ++old) {
      ::rmdir(old->c_str());
      forget_temporary(*old);
    }
    return cannot("make the directory", *it, error);
  }
  return made;
}

/// Process that wrote a temporary file, from its name ".toothpath-<pid>-<name>".
std::optional<pid_t> writer_of(std::string_view name) {
  if (!name.starts_with(kTemporaryPrefix)) return std::nullopt;
  name.remove_prefix(kTemporaryPrefix.size());
  pid_t pid = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), pid);
  if (error != std::errc{} || end == name.data() + name.size() || *end != '-' || pid <= 0) return std::nullopt;
  return pid;
}

/// What a run that was killed outright could not take with it.
void remove_leftovers(const std::string& directory) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    const auto writer = writer_of(entry.path().filename().string());
    if (writer && ::kill(*writer, 0) != 0 && errno == ESRCH) ::unlink(entry.path().c_str());
  }
}

bool same_file(const struct stat& a, const struct stat& b) { return a.st_dev == b.st_dev && a.st_ino == b.st_ino; }

/// Is `place` the file that `path` names, or the link that `path` is?
bool stands_at(const std::string& path, const struct stat& place) {
  struct stat input {};
  return (::stat(path.c_str(), &input) == 0 && same_file(input, place)) ||
         (::lstat(path.c_str(), &input) == 0 && same_file(input, place));
}

Diagnostic refused_input(const std::string& path, std::string why) {
  return {DiagnosticKind::usage, {path, 0, 0}, std::move(why)};
}

}  // namespace

OutputDir::OutputDir(std::string path, const std::vector<std::string>& own_names, const std::string& previous)
    : path_(std::move(path)), names_(own_names), previous_(previous), exchange_(path_, names_, previous_) {}

Result<OutputDir> OutputDir::open(const std::string& path, const std::vector<std::string>& own_names,
                                  const std::vector<std::string>& inputs, const std::string& previous) {
  OutputDir result(path, own_names, previous);
  say("nothing was written", {});
  auto made = make_directories(path);
  if (!made) return made.error();
  result.made_ = std::move(made.value());
  result.active_ = true;
  std::error_code error;
  if (!fs::is_directory(path, error)) return cannot("write into", path, ENOTDIR);
  if (::access(path.c_str(), W_OK | X_OK) != 0) return cannot("write into", path, errno);
  if (auto s = result.lock(); !s) return s.error();
  if (auto s = result.refuse_leftovers(inputs); !s) return s.error();
  {
    require_memory();
    const SignalsBlocked blocked;
    remove_leftovers(path);
    if (auto s = result.exchange_.recover(); !s) return s.error();
  }
  if (auto s = result.exchange_.check(); !s) return s.error();
  result.note_standing();
  if (auto s = result.refuse_replaced_inputs(inputs); !s) return s.error();
  return result;
}

OutputDir::OutputDir(OutputDir&& other) noexcept
    : path_(std::move(other.path_)),
      names_(std::move(other.names_)),
      previous_(std::move(other.previous_)),
      exchange_(std::move(other.exchange_)),
      made_(std::move(other.made_)),
      files_(std::move(other.files_)),
      aside_(std::move(other.aside_)),
      lock_(std::exchange(other.lock_, -1)),
      active_(std::exchange(other.active_, false)) {}

OutputDir::~OutputDir() {
  if (active_) discard_all();
}

/// A hidden file, locked as long as this run lives: who dies leaves a file without a lock. The file goes with its run,
/// so a lock counts only while its file stands there.
Status OutputDir::lock() {
  const std::string path = path_ + "/" + kLock;
  for (;;) {
    lock_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (lock_ < 0) return cannot("write", path, errno);
    int locked = 0;
    do locked = ::flock(lock_, LOCK_EX | LOCK_NB);
    while (locked != 0 && errno == EINTR);
    const int error = errno;
    struct stat ours {
    }, there{};
    const bool counts =
        locked == 0 && ::fstat(lock_, &ours) == 0 && ::lstat(path.c_str(), &there) == 0 && same_file(ours, there);
    if (counts) break;
    ::close(std::exchange(lock_, -1));
    if (locked == 0) continue;
    if (error == EWOULDBLOCK) {
      Diagnostic busy = fail_as(DiagnosticKind::file_access,
                                "another run is writing into this directory: wait for its end, or give another --out");
      busy.position.file = path_;
      return busy;
    }
    return cannot("lock", path, error);
  }
  if (register_temporary(path, false)) return Ok{};
  unlock();
  return cannot("write", path, ENAMETOOLONG);
}

void OutputDir::unlock() {
  if (lock_ < 0) return;
  const std::string path = path_ + "/" + kLock;
  ::unlink(path.c_str());
  forget_temporary(path);
  ::close(std::exchange(lock_, -1));
}

Status OutputDir::refuse_replaced_inputs(const std::vector<std::string>& inputs) const {
  const auto refuse_in = [&](const std::string& directory) -> Status {
    for (const auto& name : names_.standing_in(directory)) {
      struct stat replaced {};
      if (::lstat((directory + "/" + name).c_str(), &replaced) != 0) continue;
      for (const auto& input : inputs)
        if (stands_at(input, replaced))
          return refused_input(
              input,
              fmt::format(
                  "this input lies where the command writes its own {}: copy it elsewhere, or give another --out",
                  name));
    }
    return Ok{};
  };
  if (auto s = refuse_in(path_); !s) return s;
  return previous_.empty() ? Status(Ok{}) : refuse_in(path_ + "/" + previous_);
}

/// open() clears hidden files of ours away.
Status OutputDir::refuse_leftovers(const std::vector<std::string>& inputs) const {
  std::error_code error;
  const fs::path here = fs::canonical(path_, error);
  for (const auto& input : inputs)
    for (fs::path at = fs::absolute(input, error); at.has_relative_path(); at = at.parent_path())
      if (at.filename().string().starts_with(kTemporaryPrefix) && fs::canonical(at.parent_path(), error) == here)
        return refused_input(input, fmt::format("names that begin with \"{}\" are the program's own in {}: copy this "
                                                "input elsewhere",
                                                kTemporaryPrefix, path_));
  return Ok{};
}

Status OutputDir::keeps_inputs() const { return refuse_replaced_inputs(toml::inputs_read()); }

void OutputDir::note_standing() const {
  const std::string standing = describe_results(path_, names_.standing_in(path_));
  if (standing.empty()) return say(path_ + " holds no results of this command", {});
  const std::string text = fmt::format("{} stays as it was: {}", path_, standing);
  say(text, text);
}

Status OutputDir::set_aside() {
  if (auto s = keeps_inputs(); !s) return s;
  const auto standing = names_.standing_in(path_);
  if (standing.empty() || !names_.is_program(standing.front())) return Ok{};
  std::string text =
      fmt::format("what stood in {} is in {}/{}: {}", path_, path_, previous_, describe_results(path_, standing));
  require_memory();
  const SignalsBlocked blocked;
  if (auto s = exchange_.set_aside(); !s) return s;
  aside_ = std::move(text);
  say(aside_, aside_);
  return Ok{};
}

const OutputDir::File* OutputDir::find(std::string_view name) const {
  const auto found = std::find_if(files_.begin(), files_.end(), [&](const File& f) { return f.name == name; });
  return found == files_.end() ? nullptr : &*found;
}

std::string OutputDir::final_path(std::string_view name) const { return path_ + "/" + std::string(name); }

Status OutputDir::write(std::string_view name, std::string_view content) {
  discard(name);
  const std::string temporary = fmt::format("{}/{}{}-{}", path_, kTemporaryPrefix, ::getpid(), name);
  if (!register_temporary(temporary, false)) return cannot("write", final_path(name), ENAMETOOLONG);
  ::unlink(temporary.c_str());
  const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666);
  if (descriptor < 0) {
    const int error = errno;
    forget_temporary(temporary);
    return cannot("write", final_path(name), error);
  }
  files_.push_back({std::string(name), temporary, sha256_hex(content)});
  int error = write_all(descriptor, content);
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error == 0) return Ok{};
  discard(name);
  return cannot("write", final_path(name), error);
}

Result<std::string> OutputDir::read_back(std::string_view name) const {
  const File* file = find(name);
  if (!file) return cannot("read", final_path(name), ENOENT);
  return toml::read_regular_file(file->temporary_path, std::string().max_size());
}

void OutputDir::discard(std::string_view name) {
  const auto found = std::find_if(files_.begin(), files_.end(), [&](const File& f) { return f.name == name; });
  if (found == files_.end()) return;
  ::unlink(found->temporary_path.c_str());
  forget_temporary(found->temporary_path);
  files_.erase(found);
}

void OutputDir::discard_if(const std::function<bool(std::string_view)>& is_one) {
  for (std::size_t n = files_.size(); n-- > 0;)
    if (is_one(files_[n].name)) discard(std::string(files_[n].name));
}

void OutputDir::discard_all() {
  while (!files_.empty()) discard(std::string(files_.back().name));
  unlock();
  for (auto it = made_.rbegin(); it != made_.rend(); ++it) {
    ::rmdir(it->c_str());  // fails where something is in it, as it should
    forget_temporary(*it);
  }
  made_.clear();
  active_ = false;
}

/// What lies under the final names is what was written.
Status OutputDir::verify() const {
  for (const File& file : files_) {
    Sha256 hash;
    const Status read = toml::for_each_block(final_path(file.name), [&](std::string_view block) -> Status {
      hash.add(block);
      return Ok{};
    });
    if (!read) return read;
    if (hash.hex() == file.sha256) continue;
    Diagnostic differs =
        fail_as(DiagnosticKind::file_access,
                "the file on the disk differs from what was written; all files of this run are removed");
    differs.position.file = final_path(file.name);
    return differs;
  }
  return Ok{};
}

Status OutputDir::commit() {
  require_memory();
  const SignalsBlocked blocked;
  if (auto s = keeps_inputs(); !s) {
    discard_all();
    return s;
  }
  std::stable_partition(files_.begin(), files_.end(), [&](const File& file) { return !names_.is_program(file.name); });
  std::vector<OutputExchange::NewFile> renamed;
  for (const File& file : files_) renamed.push_back({file.temporary_path, file.name});
  if (auto s = exchange_.replace(renamed, [&] { return verify(); }); !s) {
    discard_all();
    return s;
  }
  for (const File& file : files_) forget_temporary(file.temporary_path);
  for (const auto& directory : made_) forget_temporary(directory);
  files_.clear();
  made_.clear();
  unlock();
  active_ = false;
  note_results_written();
  say(path_ + " holds the results of this run" + (aside_.empty() ? "" : "; " + aside_), aside_);
  return Ok{};
}

std::string OutputDir::closing_note() { return note; }

}  // namespace toothpath::app
