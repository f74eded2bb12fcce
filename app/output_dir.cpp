#include "app/output_dir.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>

#include "app/interruption.h"
#include "geometry/base/hash.h"
#include "machines/toml/regular_file.h"

namespace toothpath {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kExtensions[] = {"ngc", "nc", "mpf", "h", "apt"};
constexpr std::string_view kTemporaryPrefix = ".toothpath-";

Diagnostic cannot(const char* what, const std::string& path, int error) {
  return {DiagnosticKind::file_access, {path, 0, 0}, fmt::format("cannot {}: {}", what, std::strerror(error))};
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
    if (::mkdir(it->c_str(), 0777) != 0 && errno != EEXIST) {
      const int error = errno;
      for (auto old = made.rbegin(); old != made.rend(); ++old) {
        ::rmdir(old->c_str());
        forget_temporary(*old);
      }
      return cannot("make the directory", *it, error);
    }
    made.push_back(*it);
    if (!register_temporary(*it, true)) return cannot("use", *it, ENAMETOOLONG);
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

Status remove_output(const std::string& path) {
  if (::unlink(path.c_str()) == 0 || errno == ENOENT) return Ok{};
  return cannot("replace", path, errno);
}

Status remove_old_outputs(const std::string& directory, const std::vector<std::string>& names) {
  for (const auto& name : names) {
    if (name.back() != '.') {
      if (const auto removed = remove_output(directory + "/" + name); !removed) return removed;
      continue;
    }
    for (const auto extension : kExtensions)
      if (const auto removed = remove_output(directory + "/" + name + std::string(extension)); !removed) return removed;
  }
  // What a run that was killed outright could not take with it.
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error)) {
    const auto writer = writer_of(entry.path().filename().string());
    if (writer && ::kill(*writer, 0) != 0 && errno == ESRCH) ::unlink(entry.path().c_str());
  }
  return Ok{};
}

/// Name of the directory itself on disk: a rename is safe only when the directory is flushed too.
void flush_directory(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0) return;
  ::fsync(descriptor);
  ::close(descriptor);
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

}  // namespace

Result<OutputDir> OutputDir::open(const std::string& path, const std::vector<std::string>& own_names) {
  OutputDir result;
  result.path_ = path;
  auto made = make_directories(path);
  if (!made) return made.error();
  result.made_ = std::move(made.value());
  result.active_ = true;
  std::error_code error;
  if (!fs::is_directory(path, error)) return cannot("write into", path, ENOTDIR);
  if (::access(path.c_str(), W_OK | X_OK) != 0) return cannot("write into", path, errno);
  if (const auto removed = remove_old_outputs(path, own_names); !removed) return removed.error();
  return result;
}

OutputDir::OutputDir(OutputDir&& other) noexcept
    : path_(std::move(other.path_)), made_(std::move(other.made_)), files_(std::move(other.files_)),
      active_(std::exchange(other.active_, false)) {}

OutputDir::~OutputDir() {
  if (active_) discard_all();
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
  return read_regular_file(file->temporary_path, std::string().max_size());
}

void OutputDir::discard(std::string_view name) {
  const auto found = std::find_if(files_.begin(), files_.end(), [&](const File& f) { return f.name == name; });
  if (found == files_.end()) return;
  ::unlink(found->temporary_path.c_str());
  forget_temporary(found->temporary_path);
  files_.erase(found);
}

void OutputDir::discard_all() {
  while (!files_.empty()) discard(std::string(files_.back().name));
  for (auto it = made_.rbegin(); it != made_.rend(); ++it) {
    ::rmdir(it->c_str());  // fails where something is in it, as it should
    forget_temporary(*it);
  }
  made_.clear();
  active_ = false;
}

Status OutputDir::commit() {
  const SignalsBlocked blocked;
  for (std::size_t i = 0; i < files_.size(); ++i) {
    const std::string target = final_path(files_[i].name);
    if (::rename(files_[i].temporary_path.c_str(), target.c_str()) == 0) continue;
    const int error = errno;
    for (std::size_t k = 0; k < i; ++k) ::unlink(final_path(files_[k].name).c_str());
    discard_all();
    return cannot("write", target, error);
  }
  flush_directory(path_);
  for (const File& file : files_) {
    const std::string target = final_path(file.name);
    const auto bytes = read_regular_file(target, std::string().max_size());
    if (bytes && sha256_hex(*bytes) == file.sha256) continue;
    for (const File& other : files_) ::unlink(final_path(other.name).c_str());
    discard_all();
    if (!bytes) return bytes.error();
    Diagnostic differs = fail_as(DiagnosticKind::file_access, "the file on the disk differs from what was written; all files of this run are removed");
    differs.position.file = target;
    return differs;
  }
  for (const File& file : files_) forget_temporary(file.temporary_path);
  for (const auto& directory : made_) forget_temporary(directory);
  files_.clear();
  made_.clear();
  active_ = false;
  return Ok{};
}

}  // namespace toothpath
