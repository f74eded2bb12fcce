// A file that appears under its name at once, and never over another one: jobs that commands write.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <string>

#include "geometry/base/result.h"

namespace toothpath::app {

/// The file before it has its name: beside where it will stand, so that what it names is found. Goes with this.
class UnnamedFile {
 public:
  explicit UnnamedFile(const std::string& file) : path_(fmt::format("{}.{}.part", file, ::getpid())) {}
  ~UnnamedFile() { ::unlink(path_.c_str()); }
  UnnamedFile(const UnnamedFile&) = delete;
  UnnamedFile& operator=(const UnnamedFile&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

  [[nodiscard]] bool write(const std::string& text) const {
    std::ofstream out(path_, std::ios::binary);
    out << text;
    out.close();
    return !out.fail();
  }

 private:
  std::string path_;
};

/// Errors (kind file_access): it exists, or cannot be written.
inline Status write_new_file(const std::string& file, const std::string& text) {
  const auto fails = [&](const char* why) { return Diagnostic{DiagnosticKind::file_access, {file, 0, 0}, why}; };
  const UnnamedFile unnamed(file);
  if (!unnamed.write(text)) return fails("cannot be written");
  if (::link(unnamed.path().c_str(), file.c_str()) != 0)
    return fails(errno == EEXIST ? "exists already, and is not replaced" : "cannot be written");
  return Ok{};
}

}  // namespace toothpath::app
