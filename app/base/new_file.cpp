#include "app/base/new_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "app/base/interruption.h"
#include "app/files/folder.h"

namespace toothpath::app {

Status check_new_file(const std::string& file, const char* option) {
  struct stat status {};
  if (::lstat(file.c_str(), &status) == 0)
    return fail_as(DiagnosticKind::usage, "{}: {} exists already, and is not replaced", option, file);
  if (errno != ENOENT) return files::cannot("write", file, errno);
  const std::string folder = std::filesystem::path(file).parent_path().string();
  if (::stat(folder.empty() ? "." : folder.c_str(), &status) != 0) return files::cannot("write", file, errno);
  return Ok{};
}

UnnamedFile::UnnamedFile(const std::string& file) : file_(file), path_(fmt::format("{}.{}.part", file, ::getpid())) {
  (void)register_temporary(AT_FDCWD, path_, false);  // a path that is too long cannot be written either
}

UnnamedFile::~UnnamedFile() {
  ::unlink(path_.c_str());
  forget_temporary(AT_FDCWD, path_);
}

Status UnnamedFile::write(const std::string& text) const {
  ::unlink(path_.c_str());
  const int file = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file < 0) return files::cannot("write", file_, errno);
  int error = files::write_all(file, text);
  if (::close(file) != 0 && error == 0) error = errno;
  return error == 0 ? Status(Ok{}) : files::cannot("write", file_, error);
}

Status write_new_file(const std::string& file, const std::string& text) {
  const UnnamedFile unnamed(file);
  if (auto written = unnamed.write(text); !written) return written;
  if (::link(unnamed.path().c_str(), file.c_str()) == 0) return Ok{};
  if (errno == EEXIST)
    return Diagnostic{DiagnosticKind::file_access, {file, 0, 0}, "exists already, and is not replaced"};
  return files::cannot("write", file, errno);
}

}  // namespace toothpath::app
