// Sets of result files change their place as a whole: what stands in a directory gives way to what is new, or moves
// into a folder below it.
//
// A set is moved file by file, so every step leaves a mark on the disk (a hidden folder or file, ".toothpath-..."). A
// process that is killed between two steps loses nothing: recover(), called by the next one, undoes a step that was not
// complete and finishes one that was. Marks that no run of ours can have left there are refused, and nothing is
// touched: a directory may have come out of somebody's archive.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "app/files/folder.h"
#include "geometry/base/result.h"

namespace toothpath::app {

/// Names of the files that a command writes.
class OutputNames {
 public:
  /// A name that ends in "." stands for every extension of NC programs ("program."): such files are the programs of the
  /// command. One that ends in "#." stands for all with a whole number of 1 to 3 digits there, too ("program_#.").
  explicit OutputNames(const std::vector<std::string>& names);
  [[nodiscard]] bool is_program(std::string_view name) const;
  [[nodiscard]] bool contains(std::string_view name) const;
  /// Those that stand in the directory, whatever they are (a link, a folder), programs first.
  [[nodiscard]] std::vector<std::string> standing_in(const files::Folder& folder) const;

 private:
  std::vector<std::string> programs_, others_, numbered_;  ///< the last: what stands ahead of the number
};

class OutputExchange {
 public:
  /// `previous`: name of the folder below `folder` into which set_aside() moves; empty: there is none.
  OutputExchange(files::Folder folder, OutputNames names, std::string previous);

  /// Undoes or finishes what a killed process left. Errors (`file_access`): a mark, or `previous`, that is a link or of
  /// another kind than those of ours; a journal that names anything but outputs of this command; a file of ours can be
  /// moved neither forth nor back.
  [[nodiscard]] Status recover() const;
  /// Errors (`file_access`): a folder in the place of an output; a `previous` that cannot be written.
  [[nodiscard]] Status check() const;

  /// Moves what stands in the directory under the names into `previous`, whose files of these names go; files of other
  /// names stay where they are. At no moment is there a mix of two sets in `previous`. Failed: everything is where it
  /// was.
  [[nodiscard]] Status set_aside() const;

  struct NewFile {
    std::string temporary, name;  ///< both in the folder
  };
  /// What stands in the directory under the names gives way to `files`, which get their names in this order; then
  /// `verify` looks at them. When anything fails, what stood there stands there again, and of `files` those that had
  /// got their name are gone.
  [[nodiscard]] Status replace(const std::vector<NewFile>& files, const std::function<Status()>& verify) const;

 private:
  [[nodiscard]] Status check_marks() const;
  [[nodiscard]] Status take_out(const std::vector<std::string>& names) const;
  [[nodiscard]] Status put_back() const;
  [[nodiscard]] Status write_journal(const std::vector<NewFile>& files) const;
  [[nodiscard]] Result<std::vector<std::string>> read_journal() const;
  [[nodiscard]] Status undo_replace() const;
  [[nodiscard]] Status end_replace() const;
  [[nodiscard]] Status aside_to_previous() const;
  [[nodiscard]] Status recover_previous() const;
  [[nodiscard]] Status end_previous() const;

  files::Folder folder_;
  OutputNames names_;
  std::string previous_, kept_, older_;
};

}  // namespace toothpath::app
