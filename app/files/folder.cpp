#include "app/files/folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "machines/toml/regular_file.h"

namespace toothpath::files {
namespace {

constexpr int kFolder = O_DIRECTORY | O_CLOEXEC;
constexpr mode_t kFileMode = 0666, kFolderMode = 0777;

/// `path` without its last step, and that step; "a/b//" is "a" and "b".
std::pair<std::string, std::string> parent_and_name(std::string path) {
  while (path.size() > 1 && path.back() == '/') path.pop_back();
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return {".", path};
  return {slash == 0 ? "/" : path.substr(0, slash), path.substr(slash + 1)};
}

}  // namespace

bool is_plain_name(std::string_view name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string_view::npos &&
         name.find('\0') == std::string_view::npos;
}

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

Folder::Folder(int handle, std::string path)
    : handle_(new int(handle),
              [](const int* h) {
                ::close(*h);
                delete h;
              }),
      path_(std::move(path)) {}

Result<Folder> Folder::open(const std::string& path) {
  const int handle = ::open(path.c_str(), O_PATH | kFolder);
  if (handle < 0) return cannot("write into", path, errno);
  return Folder(handle, path);
}

Result<Folder> Folder::open_or_make(const std::string& path, std::vector<Made>& made) {
  struct stat status {};
  if (path.empty() || ::stat(path.c_str(), &status) == 0 || errno != ENOENT) return open(path);
  const auto [before, name] = parent_and_name(path);
  auto parent = open_or_make(before, made);
  if (!parent) return parent;
  if (!is_plain_name(name)) return open(path);
  if (::mkdirat(parent->handle(), name.c_str(), kFolderMode) == 0) made.push_back({*parent, name});
  else if (errno != EEXIST) return cannot("make the directory", path, errno);
  return open(path);  // where it exists now, another run made it meanwhile
}

Result<Folder> Folder::below(const std::string& name) const {
  if (!is_plain_name(name)) return cannot("write into", at(name), EINVAL);
  const int handle = ::openat(*handle_, name.c_str(), O_PATH | O_NOFOLLOW | kFolder);
  if (handle >= 0) return Folder(handle, at(name));
  const int error = errno;
  if (error != ENOTDIR && error != ELOOP) return cannot("write into", at(name), error);
  return Diagnostic{DiagnosticKind::file_access,
                    {at(name), 0, 0},
                    "cannot write into: it is no folder (a link, a file, a pipe); take it away, or give another "
                    "directory"};
}

Result<Folder> Folder::below_or_made(const std::string& name, std::vector<Made>& made) const {
  if (!has(name)) {
    if (auto s = make_folder(name); !s) return s.error();
    made.push_back({*this, name});
  }
  return below(name);
}

bool Folder::look(const std::string& name, struct stat& status) const {
  return is_plain_name(name) && ::fstatat(*handle_, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0;
}

Kind Folder::kind(const std::string& name) const {
  struct stat status {};
  if (!look(name, status)) return Kind::nothing;
  if (S_ISREG(status.st_mode)) return Kind::file;
  return S_ISDIR(status.st_mode) ? Kind::folder : Kind::other;
}

std::vector<std::string> Folder::names() const {
  std::vector<std::string> names;
  const int handle = ::openat(*handle_, ".", O_RDONLY | kFolder);
  DIR* entries = handle < 0 ? nullptr : ::fdopendir(handle);
  if (!entries) {
    if (handle >= 0) ::close(handle);
    return names;
  }
  while (const dirent* entry = ::readdir(entries))
    if (is_plain_name(entry->d_name)) names.emplace_back(entry->d_name);
  ::closedir(entries);
  return names;
}

bool Folder::may_write() const { return ::faccessat(*handle_, ".", W_OK | X_OK, 0) == 0; }

Result<int> Folder::open_file(const std::string& name, int flags) const {
  const char* what = (flags & O_ACCMODE) == O_RDONLY ? "read" : "write";
  const auto not_regular = [&] {
    return Diagnostic{DiagnosticKind::file_access,
                      {at(name), 0, 0},
                      fmt::format("cannot {}: it is no regular file (a link, a folder, a pipe); take it away, or give "
                                  "another directory",
                                  what)};
  };
  if (!is_plain_name(name)) return cannot(what, at(name), EINVAL);
  const Kind stands = kind(name);  // a device must not even be opened
  if (stands != Kind::file && stands != Kind::nothing) return not_regular();
  const int file = ::openat(*handle_, name.c_str(), flags | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK | O_NOCTTY, kFileMode);
  if (file < 0) return cannot(what, at(name), errno);
  struct stat status {};
  if (::fstat(file, &status) == 0 && S_ISREG(status.st_mode)) return file;
  ::close(file);
  return not_regular();
}

Status Folder::write_new(const std::string& name, std::string_view content) const {
  const auto file = open_file(name, O_WRONLY | O_CREAT | O_EXCL);
  if (!file) return file.error();
  int error = write_all(*file, content);
  if (::close(*file) != 0 && error == 0) error = errno;
  if (error == 0) return Ok{};
  ::unlinkat(*handle_, name.c_str(), 0);
  return cannot("write", at(name), error);
}

Result<std::string> Folder::read(const std::string& name, std::size_t max_bytes) const {
  const auto file = open_file(name, O_RDONLY);
  if (!file) return file.error();
  auto text = toml::read_regular_file(*file, at(name), max_bytes);
  ::close(*file);
  return text;
}

Status Folder::for_each_block(const std::string& name, const std::function<Status(std::string_view)>& take) const {
  const auto file = open_file(name, O_RDONLY);
  if (!file) return file.error();
  auto read = toml::for_each_block(*file, at(name), take);
  ::close(*file);
  return read;
}

Status Folder::make_folder(const std::string& name) const {
  if (!is_plain_name(name)) return cannot("make the directory", at(name), EINVAL);
  if (::mkdirat(*handle_, name.c_str(), kFolderMode) == 0) return Ok{};
  return cannot("make the directory", at(name), errno);
}

Status Folder::remove(const std::string& name) const {
  if (!is_plain_name(name)) return cannot("remove", at(name), EINVAL);
  if (::unlinkat(*handle_, name.c_str(), 0) == 0 || errno == ENOENT) return Ok{};
  return cannot("remove", at(name), errno);
}

Status Folder::remove_folder(const std::string& name) const {
  if (!is_plain_name(name)) return cannot("remove", at(name), EINVAL);
  if (::unlinkat(*handle_, name.c_str(), AT_REMOVEDIR) == 0 || errno == ENOENT) return Ok{};
  return cannot("remove", at(name), errno);
}

Status Folder::move(const std::string& name, const Folder& to, const std::string& new_name) const {
  if (!is_plain_name(name) || !is_plain_name(new_name)) return cannot("move", at(name), EINVAL);
  if (::renameat(*handle_, name.c_str(), *to.handle_, new_name.c_str()) == 0) return Ok{};
  return cannot("move", at(name), errno);
}

void Folder::flush() const {
  const int handle = ::openat(*handle_, ".", O_RDONLY | kFolder);
  if (handle < 0) return;
  ::fsync(handle);
  ::close(handle);
}

}  // namespace toothpath::files
