// The output directory: all files of a run appear together at its end, or none does; what stood there before is not
// lost.
//
// Every file is written to a hidden temporary name beside its final one, flushed to the disk, and renamed by commit().
// All of it goes through a handle of the directory: no link that stands there is followed, nothing outside is touched.
// A run that ends in any other way, by an error or a signal, takes its temporary files with it. What an earlier run of
// the same command left stays as it is until commit() replaces it, or until set_aside() moves it into a folder below:
// from then on no old program can be taken for a new one.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "app/base/output_exchange.h"
#include "app/files/folder.h"
#include "geometry/base/result.h"

namespace toothpath::app {

/// Folder in which `run` and `correct` keep the results before the last ones.
inline constexpr const char* kPrevious = "previous";

class OutputDir {
 public:
  /// Makes `path` (and its parents) where it does not exist, checks that files can be made in it and locks it for this
  /// process. Of the files in it none is changed; what a run that was killed left half-done is put in order first.
  /// @param own_names  files of the command; a name that ends in "." stands for every extension of NC programs
  /// ("program.")
  /// @param inputs     files that the command reads: those that it would replace are refused (kind `usage`)
  /// @param previous   folder for set_aside(); empty: the command does not call it
  /// Other errors, all `file_access`: not a directory, not writable, another run is writing into it, a directory in the
  /// place of an output, something else than a writable directory in the place of `previous`, marks of a killed run
  /// that none of ours can have left (OutputExchange::recover()).
  [[nodiscard]] static Result<OutputDir> open(const std::string& path, const std::vector<std::string>& own_names,
                                              const std::vector<std::string>& inputs = {},
                                              const std::string& previous = {});
  /// The same of a folder of the program's own, `name` below `path`: a link in its place is refused.
  [[nodiscard]] static Result<OutputDir> open_below(const std::string& path, const std::string& name,
                                                    const std::vector<std::string>& own_names,
                                                    const std::vector<std::string>& inputs = {});

  OutputDir(OutputDir&& other) noexcept;
  OutputDir& operator=(OutputDir&&) = delete;
  OutputDir(const OutputDir&) = delete;
  /// Discards what was not committed; a directory that open() made and that is still empty goes too.
  ~OutputDir();

  /// Refused (kind `usage`): a file that has been read as an input until now (inputs_read()) and that this
  /// command would replace. open() asks for those of its list, set_aside() and commit() for all; a command that works
  /// long between the two asks by itself.
  [[nodiscard]] Status keeps_inputs() const;

  /// The inputs are accepted, and the work begins: earlier results with a program move into `previous`, whose results
  /// go. Results without one stay until commit(). Errors: `file_access`, and those of keeps_inputs(); then everything
  /// is where it was.
  Status set_aside();

  /// Writes a file under its temporary name. `name` has no slash; what is not among the command's names is discarded
  /// before commit(). Errors: `file_access` (disk full, ...).
  Status write(std::string_view name, std::string_view content);
  /// The bytes on disk of a file written before.
  [[nodiscard]] Result<std::string> read_back(std::string_view name) const;
  /// Path that the file will have; for messages.
  [[nodiscard]] std::string final_path(std::string_view name) const;
  [[nodiscard]] const std::string& path() const { return folder_.path(); }  ///< as the user wrote it
  /// Drops a file written before (an NC program that turned out not to be safe).
  void discard(std::string_view name);
  /// All of them whose name `is_one`.
  void discard_if(const std::function<bool(std::string_view name)>& is_one);
  /// Gives every file its final name, programs last: where one stands, all the rest is there. What stood under the
  /// command's names goes. Then every file is read under its final name and compared with what was written. When
  /// anything fails none of the files is there, and what stood there stands there again. Nothing can be written
  /// afterwards.
  Status commit();

  /// What became of earlier results, for the end of the process, one line; empty where there is nothing to say. That of
  /// the last directory that was opened; a signal prints the like.
  [[nodiscard]] static std::string closing_note();

 private:
  OutputDir(files::Folder folder, std::vector<files::Folder::Made> made, const std::vector<std::string>& own_names,
            const std::string& previous);
  struct File {
    std::string name, temporary;
    std::string sha256;  ///< of what was written
  };
  using MakeFolder = std::function<Result<files::Folder>(std::vector<files::Folder::Made>& made)>;
  [[nodiscard]] static Result<OutputDir> opened(const MakeFolder& make, const std::vector<std::string>& own_names,
                                                const std::vector<std::string>& inputs, const std::string& previous);
  [[nodiscard]] Status prepare(const std::vector<std::string>& inputs);
  [[nodiscard]] Status lock();
  void unlock();
  [[nodiscard]] Status refuse_replaced_inputs(const std::vector<std::string>& inputs) const;
  [[nodiscard]] Status refuse_leftovers(const std::vector<std::string>& inputs) const;
  [[nodiscard]] Status verify() const;
  void note_standing() const;
  void discard_all();
  [[nodiscard]] const File* find(std::string_view name) const;

  files::Folder folder_;
  OutputNames names_;
  std::string previous_;
  OutputExchange exchange_;
  std::vector<files::Folder::Made> made_;  ///< directories made by open(), outermost first
  std::vector<File> files_;
  std::string aside_;  ///< what set_aside() moved, in words
  int lock_ = -1;
  bool active_ = false;
};

}  // namespace toothpath::app
