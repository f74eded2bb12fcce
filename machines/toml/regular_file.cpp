#include "machines/toml/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace toothpath::toml {
namespace {

Diagnostic cannot(const char* what, const std::string& path) {
  return {DiagnosticKind::file_access, {path, 0, 0}, fmt::format("cannot {}: {}", what, std::strerror(errno))};
}

/// Blocks as they come, put together.
class Joined {
 public:
  Joined(const std::string& path, std::size_t most) : path_(path), most_(most) {}

  Status operator()(std::string_view block) {
    text += block;
    if (text.size() > most_) return fail_at({path_, 0, 0}, "is longer than {} bytes", most_);
    return Ok{};
  }

  std::string text;

 private:
  const std::string& path_;
  std::size_t most_;
};

}  // namespace

Status for_each_block(int descriptor, const std::string& path, const std::function<Status(std::string_view)>& take) {
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return cannot("look at", path);
  const SourcePosition position{path, 0, 0};
  if (S_ISDIR(status.st_mode))
    return Diagnostic{DiagnosticKind::file_access, position, "cannot read: it is a directory"};
  if (!S_ISREG(status.st_mode)) return fail_at(position, "is not a regular file");
  char block[1 << 16];
  while (true) {
    const ssize_t got = ::read(descriptor, block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return cannot("read", path);
    if (got == 0) return Ok{};
    if (auto s = take({block, static_cast<std::size_t>(got)}); !s) return s;
  }
}

Status for_each_block(const std::string& path, const std::function<Status(std::string_view)>& take) {
  // O_NONBLOCK: opening a pipe must not wait for its writer.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) return cannot("open", path);
  const Status read = for_each_block(descriptor, path, take);
  ::close(descriptor);
  return read;
}

Result<std::string> read_regular_file(int descriptor, const std::string& path, std::size_t max_bytes) {
  Joined joined(path, max_bytes);
  if (auto read = for_each_block(descriptor, path, std::ref(joined)); !read) return read.error();
  return std::move(joined.text);
}

Result<std::string> read_regular_file(const std::string& path, std::size_t max_bytes) {
  Joined joined(path, max_bytes);
  if (auto read = for_each_block(path, std::ref(joined)); !read) return read.error();
  return std::move(joined.text);
}

Result<std::string> read_input_file(const std::string& path, std::size_t max_bytes) {
  note_input(path);
  return read_regular_file(path, max_bytes);
}

}  // namespace toothpath::toml
