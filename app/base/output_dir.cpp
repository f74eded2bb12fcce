#include "app/base/output_dir.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <charconv>
#include <filesystem>
#include <optional>
#include <utility>

#include "app/base/interruption.h"
#include "app/base/out_of_memory.h"
#include "app/base/standing_results.h"
#include "geometry/base/hash.h"
#include "geometry/base/inputs_read.h"

namespace toothpath::app {
namespace {

namespace fs = std::filesystem;
using files::cannot;
using files::Folder;

constexpr std::string_view kTemporaryPrefix = ".toothpath-";
constexpr const char* kLock = ".toothpath-lock";

/// What is said at the end: by a signal, and by the command line.
std::string note;

void say(const std::string& interrupted, const std::string& ended) {
  set_state(interrupted);
  note = ended;
}

/// Directories that this run made go again, as far as nothing is in them.
void remove_made(std::vector<Folder::Made>& made) {
  for (auto it = made.rbegin(); it != made.rend(); ++it) {
    (void)it->parent.remove_folder(it->name);
    forget_temporary(it->parent.handle(), it->name);
  }
  made.clear();
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
void remove_leftovers(const Folder& folder) {
  for (const auto& name : folder.names()) {
    const auto writer = writer_of(name);
    if (writer && ::kill(*writer, 0) != 0 && errno == ESRCH) (void)folder.remove(name);
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

OutputDir::OutputDir(Folder folder, std::vector<Folder::Made> made, const std::vector<std::string>& own_names,
                     const std::string& previous)
    : folder_(std::move(folder)),
      names_(own_names),
      previous_(previous),
      exchange_(folder_, names_, previous_),
      made_(std::move(made)),
      active_(true) {}

Result<OutputDir> OutputDir::open(const std::string& path, const std::vector<std::string>& own_names,
                                  const std::vector<std::string>& inputs, const std::string& previous) {
  return opened([&](auto& made) { return Folder::open_or_make(path, made); }, own_names, inputs, previous);
}

Result<OutputDir> OutputDir::open_below(const std::string& path, const std::string& name,
                                        const std::vector<std::string>& own_names,
                                        const std::vector<std::string>& inputs) {
  const auto below = [&](auto& made) {
    auto folder = Folder::open_or_make(path, made);
    return folder ? folder->below_or_made(name, made) : folder;
  };
  return opened(below, own_names, inputs, {});
}

Result<OutputDir> OutputDir::opened(const MakeFolder& make, const std::vector<std::string>& own_names,
                                    const std::vector<std::string>& inputs, const std::string& previous) {
  say("nothing was written", {});
  std::vector<Folder::Made> made;
  bool registered = true;
  auto folder = [&] {
    const SignalsBlocked blocked;  // until a signal can take away what was made
    auto result = make(made);
    for (const auto& one : made) registered = register_temporary(one.parent.handle(), one.name, true) && registered;
    return result;
  }();
  if (folder && !registered) folder = cannot("use", folder->path(), ENAMETOOLONG);
  if (!folder) {
    remove_made(made);
    return folder.error();
  }
  OutputDir result(std::move(folder).value(), std::move(made), own_names, previous);
  if (auto s = result.prepare(inputs); !s) return s.error();
  return result;
}

Status OutputDir::prepare(const std::vector<std::string>& inputs) {
  if (!folder_.may_write()) return cannot("write into", path(), errno);
  if (auto s = lock(); !s) return s;
  if (auto s = refuse_leftovers(inputs); !s) return s;
  {
    require_memory();
    const SignalsBlocked blocked;
    remove_leftovers(folder_);
    if (auto s = exchange_.recover(); !s) return s;
  }
  if (auto s = exchange_.check(); !s) return s;
  note_standing();
  return refuse_replaced_inputs(inputs);
}

OutputDir::OutputDir(OutputDir&& other) noexcept
    // A copy: what it registered stands by its handle. NOLINTNEXTLINE(performance-move-constructor-init)
    : folder_(other.folder_),
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
  const SignalsBlocked blocked;  // until a signal can take the file away
  for (;;) {
    const auto file = folder_.open_file(kLock, O_RDWR | O_CREAT);
    if (!file) return file.error();
    int locked = 0;
    do locked = ::flock(*file, LOCK_EX | LOCK_NB);
    while (locked != 0 && errno == EINTR);
    const int error = errno;
    struct stat ours {
    }, there{};
    if (locked == 0 && ::fstat(*file, &ours) == 0 && folder_.look(kLock, there) && same_file(ours, there)) {
      lock_ = *file;
      break;
    }
    ::close(*file);
    if (locked == 0) continue;
    if (error == EWOULDBLOCK) {
      Diagnostic busy = fail_as(DiagnosticKind::file_access,
                                "another run is writing into this directory: wait for its end, or give another --out");
      busy.position.file = path();
      return busy;
    }
    return cannot("lock", folder_.at(kLock), error);
  }
  if (register_temporary(folder_.handle(), kLock, false)) return Ok{};
  unlock();
  return cannot("write", folder_.at(kLock), ENAMETOOLONG);
}

void OutputDir::unlock() {
  if (lock_ < 0) return;
  (void)folder_.remove(kLock);
  forget_temporary(folder_.handle(), kLock);
  ::close(std::exchange(lock_, -1));
}

Status OutputDir::refuse_replaced_inputs(const std::vector<std::string>& inputs) const {
  const auto refuse_in = [&](const Folder& folder) -> Status {
    for (const auto& name : names_.standing_in(folder)) {
      struct stat replaced {};
      if (!folder.look(name, replaced)) continue;
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
  if (auto s = refuse_in(folder_); !s) return s;
  if (previous_.empty() || folder_.kind(previous_) != files::Kind::folder) return Ok{};
  const auto previous = folder_.below(previous_);
  return previous ? refuse_in(*previous) : Status(Ok{});
}

/// open() clears hidden files of ours away.
Status OutputDir::refuse_leftovers(const std::vector<std::string>& inputs) const {
  std::error_code error;
  const fs::path here = fs::canonical(path(), error);
  for (const auto& input : inputs)
    for (fs::path at = fs::absolute(input, error); at.has_relative_path(); at = at.parent_path())
      if (at.filename().string().starts_with(kTemporaryPrefix) && fs::canonical(at.parent_path(), error) == here)
        return refused_input(input, fmt::format("names that begin with \"{}\" are the program's own in {}: copy this "
                                                "input elsewhere",
                                                kTemporaryPrefix, path()));
  return Ok{};
}

Status OutputDir::keeps_inputs() const { return refuse_replaced_inputs(inputs_read()); }

void OutputDir::note_standing() const {
  const std::string standing = describe_results(folder_, names_.standing_in(folder_));
  if (standing.empty()) return say(path() + " holds no results of this command", {});
  const std::string text = fmt::format("{} stays as it was: {}", path(), standing);
  say(text, text);
}

Status OutputDir::set_aside() {
  if (auto s = keeps_inputs(); !s) return s;
  const auto standing = names_.standing_in(folder_);
  if (standing.empty() || !names_.is_program(standing.front())) return Ok{};
  std::string text =
      fmt::format("what stood in {} is in {}: {}", path(), folder_.at(previous_), describe_results(folder_, standing));
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

std::string OutputDir::final_path(std::string_view name) const { return folder_.at(name); }

Status OutputDir::write(std::string_view name, std::string_view content) {
  discard(name);
  const std::string temporary = fmt::format("{}{}-{}", kTemporaryPrefix, ::getpid(), name);
  if (!register_temporary(folder_.handle(), temporary, false)) return cannot("write", final_path(name), ENAMETOOLONG);
  auto written = folder_.remove(temporary);
  if (written) written = folder_.write_new(temporary, content);
  if (written) {
    files_.push_back({std::string(name), temporary, sha256_hex(content)});
    return Ok{};
  }
  forget_temporary(folder_.handle(), temporary);
  written.error().position.file = final_path(name);
  return written;
}

Result<std::string> OutputDir::read_back(std::string_view name) const {
  const File* file = find(name);
  if (!file) return cannot("read", final_path(name), ENOENT);
  return folder_.read(file->temporary, std::string().max_size());
}

void OutputDir::discard(std::string_view name) {
  const auto found = std::find_if(files_.begin(), files_.end(), [&](const File& f) { return f.name == name; });
  if (found == files_.end()) return;
  (void)folder_.remove(found->temporary);
  forget_temporary(folder_.handle(), found->temporary);
  files_.erase(found);
}

void OutputDir::discard_if(const std::function<bool(std::string_view)>& is_one) {
  for (std::size_t n = files_.size(); n-- > 0;)
    if (is_one(files_[n].name)) discard(std::string(files_[n].name));
}

void OutputDir::discard_all() {
  while (!files_.empty()) discard(std::string(files_.back().name));
  unlock();
  remove_made(made_);
  active_ = false;
}

/// What lies under the final names is what was written.
Status OutputDir::verify() const {
  for (const File& file : files_) {
    Sha256 hash;
    const Status read = folder_.for_each_block(file.name, [&](std::string_view block) -> Status {
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
  for (const File& file : files_) {
    assert(names_.contains(file.name));
    renamed.push_back({file.temporary, file.name});
  }
  if (auto s = exchange_.replace(renamed, [&] { return verify(); }); !s) {
    discard_all();
    return s;
  }
  for (const File& file : files_) forget_temporary(folder_.handle(), file.temporary);
  for (const auto& made : made_) forget_temporary(made.parent.handle(), made.name);
  files_.clear();
  made_.clear();
  unlock();
  active_ = false;
  note_results_written();
  say(path() + " holds the results of this run" + (aside_.empty() ? "" : "; " + aside_), aside_);
  return Ok{};
}

std::string OutputDir::closing_note() { return note; }

}  // namespace toothpath::app
