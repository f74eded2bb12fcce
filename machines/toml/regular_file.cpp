#include "machines/toml/regular_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <mutex>

namespace toothpath::toml {

Status for_each_block(const std::string& path, const std::function<Status(std::string_view)>& take) {
  const auto cannot = [&](const char* what) {
    return Diagnostic{
        DiagnosticKind::file_access, {path, 0, 0}, fmt::format("cannot {}: {}", what, std::strerror(errno))};
  };
  // O_NONBLOCK: opening a pipe must not wait for its writer.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (descriptor < 0) return cannot("open");
  struct Closer {
    int descriptor;
    ~Closer() { ::close(descriptor); }
  } closer{descriptor};
  struct stat status {};
  if (::fstat(descriptor, &status) != 0) return cannot("look at");
  const SourcePosition position{path, 0, 0};
  if (S_ISDIR(status.st_mode))
    return Diagnostic{DiagnosticKind::file_access, position, "cannot read: it is a directory"};
  if (!S_ISREG(status.st_mode)) return fail_at(position, "is not a regular file");
  char block[1 << 16];
  while (true) {
    const ssize_t got = ::read(descriptor, block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return cannot("read");
    if (got == 0) return Ok{};
    if (auto s = take({block, static_cast<std::size_t>(got)}); !s) return s;
  }
}

Result<std::string> read_regular_file(const std::string& path, std::size_t max_bytes) {
  std::string text;
  const Status read = for_each_block(path, [&](std::string_view block) -> Status {
    text += block;
    if (text.size() > max_bytes) return fail_at({path, 0, 0}, "is longer than {} bytes", max_bytes);
    return Ok{};
  });
  if (!read) return read.error();
  return text;
}

namespace {

std::mutex inputs_mutex;
std::vector<std::string> inputs;

}  // namespace

Result<std::string> read_input_file(const std::string& path, std::size_t max_bytes) {
  {
    const std::lock_guard lock(inputs_mutex);
    if (std::find(inputs.begin(), inputs.end(), path) == inputs.end()) inputs.push_back(path);
  }
  return read_regular_file(path, max_bytes);
}

std::vector<std::string> inputs_read() {
  const std::lock_guard lock(inputs_mutex);
  return inputs;
}

void forget_inputs_read() {
  const std::lock_guard lock(inputs_mutex);
  inputs.clear();
}

}  // namespace toothpath::toml
