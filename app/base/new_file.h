// A file that appears under its name at once, and never over another one: jobs that commands write.
#pragma once

#include <string>

#include "geometry/base/result.h"

namespace toothpath::app {

/// Nothing stands under this name, and its folder can be looked into. Refused: something stands there, were it a link
/// into nowhere (kind usage, with `option`); the folder does not exist or cannot be looked into (kind file_access).
[[nodiscard]] Status check_new_file(const std::string& file, const char* option);

/// The file before it has its name: beside where it will stand, so that what it names is found. Goes with this, and
/// with a signal.
class UnnamedFile {
 public:
  explicit UnnamedFile(const std::string& file);
  ~UnnamedFile();
  UnnamedFile(const UnnamedFile&) = delete;
  UnnamedFile& operator=(const UnnamedFile&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

  /// What it holds from now on. Errors (kind file_access), with the place of the file that it will be.
  [[nodiscard]] Status write(const std::string& text) const;

 private:
  std::string file_, path_;
};

/// Errors (kind file_access): it exists, or cannot be written.
[[nodiscard]] Status write_new_file(const std::string& file, const std::string& text);

}  // namespace toothpath::app
