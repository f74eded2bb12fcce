// The output directory: all files of a run appear together at its end, or none does.
//
// Every file is written to a hidden temporary name beside its final one, flushed to the disk, and renamed by commit(). A
// run that ends in any other way, by an error or a signal, takes its temporary files with it. Files that an earlier
// run of the same command left are removed at the start: whatever is there at the end belongs to this run.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "geometry/base/result.h"

namespace toothpath {

class OutputDir {
 public:
  /// Makes `path` (and its parents) where it does not exist, checks that files can be made in it, and removes from it the
  /// files called `own_names`; a name that ends in "." stands for every extension of output ("program.").
  /// Errors, all `file_access`: not a directory, not writable, a directory in the place of an output.
  [[nodiscard]] static Result<OutputDir> open(const std::string& path, const std::vector<std::string>& own_names);

  OutputDir(OutputDir&& other) noexcept;
  OutputDir& operator=(OutputDir&&) = delete;
  OutputDir(const OutputDir&) = delete;
  /// Discards what was not committed; a directory that open() made and that is still empty goes too.
  ~OutputDir();

  /// Writes a file under its temporary name. `name` has no slash. Errors: `file_access` (disk full, ...).
  Status write(std::string_view name, std::string_view content);
  /// The bytes on disk of a file written before.
  [[nodiscard]] Result<std::string> read_back(std::string_view name) const;
  /// Path that the file will have; for messages.
  [[nodiscard]] std::string final_path(std::string_view name) const;
  /// Drops a file written before (an NC program that turned out not to be safe).
  void discard(std::string_view name);
  /// Gives every file its final name, in the order in which they were written. When one cannot be renamed, those already
  /// renamed are removed again. Then every file is read under its final name; where one differs from what was written, all are
  /// removed. Nothing can be written afterwards.
  Status commit();

 private:
  OutputDir() = default;
  struct File {
    std::string name, temporary_path;
    std::string sha256;  ///< of what was written
  };
  void discard_all();
  [[nodiscard]] const File* find(std::string_view name) const;

  std::string path_;
  std::vector<std::string> made_;  ///< directories made by open(), outermost first
  std::vector<File> files_;
  bool active_ = false;
};

}  // namespace toothpath
