// A directory by a handle. What is done in it takes plain names and follows no link, so that nothing outside of it is
// written, moved or removed, whatever stands there: it may have come out of somebody's archive.
#pragma once

#include <sys/types.h>

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/result.h"

struct stat;

namespace toothpath::files {

/// What stands under a name. A link is `other`, wherever it leads; so are pipes and devices.
enum class Kind { nothing, file, folder, other };

/// Of one step: neither empty, nor "." or "..", without a slash.
[[nodiscard]] bool is_plain_name(std::string_view name);

/// What cannot be done with a file, and why: kind `file_access`, `error` as in errno.
[[nodiscard]] Diagnostic cannot(const char* what, const std::string& path, int error);

/// Writes all of it and flushes it to the disk; returns 0 or errno.
[[nodiscard]] int write_all(int descriptor, std::string_view content);

/// Names are plain ones: others are EINVAL. Errors are `file_access`, with the path as the user knows it. Copies share
/// the handle.
class Folder {
 public:
  struct Made;

  /// The directory that `path` leads to, through whatever links: the user named it.
  [[nodiscard]] static Result<Folder> open(const std::string& path);
  /// The same; where it does not exist it is made, and its parents. Those that were made go to the end of `made`,
  /// outermost first, also when a later one fails.
  [[nodiscard]] static Result<Folder> open_or_make(const std::string& path, std::vector<Made>& made);

  /// A folder below this one; a link is refused.
  [[nodiscard]] Result<Folder> below(const std::string& name) const;
  /// The same; where it does not exist it is made, and joins `made`.
  [[nodiscard]] Result<Folder> below_or_made(const std::string& name, std::vector<Made>& made) const;

  [[nodiscard]] const std::string& path() const { return path_; }  ///< as the user wrote it
  [[nodiscard]] std::string at(std::string_view name) const { return path_ + "/" + std::string(name); }
  [[nodiscard]] int handle() const { return *handle_; }  ///< for openat(2) and its like; lives as long as this

  [[nodiscard]] Kind kind(const std::string& name) const;
  [[nodiscard]] bool has(const std::string& name) const { return kind(name) != Kind::nothing; }
  /// As of lstat(2); false: it is not there.
  [[nodiscard]] bool look(const std::string& name, struct stat& status) const;
  [[nodiscard]] std::vector<std::string> names() const;
  [[nodiscard]] bool may_write() const;

  /// open(2) with O_NOFOLLOW and O_CLOEXEC; the caller closes it. Nothing but a regular file is opened.
  [[nodiscard]] Result<int> open_file(const std::string& name, int flags) const;
  /// A new file: what stands there fails.
  [[nodiscard]] Status write_new(const std::string& name, std::string_view content) const;
  [[nodiscard]] Result<std::string> read(const std::string& name, std::size_t max_bytes) const;
  [[nodiscard]] Status for_each_block(const std::string& name,
                                      const std::function<Status(std::string_view)>& take) const;

  [[nodiscard]] Status make_folder(const std::string& name) const;
  /// A file, a link, a pipe; what is not there is removed already.
  [[nodiscard]] Status remove(const std::string& name) const;
  /// An empty folder; what is not there is removed already.
  [[nodiscard]] Status remove_folder(const std::string& name) const;
  /// A file, a link or a whole folder; a file that stands there gives way.
  [[nodiscard]] Status move(const std::string& name, const Folder& to, const std::string& new_name) const;
  /// Flushes the names in it: a move is safe only then.
  void flush() const;

 private:
  Folder(int handle, std::string path);

  std::shared_ptr<const int> handle_;
  std::string path_;
};

/// A folder that was made, by its parent.
struct Folder::Made {
  Folder parent;
  std::string name;
};

}  // namespace toothpath::files
