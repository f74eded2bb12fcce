// The questions of `toothpath new`, one after the other: kind of gear, way to cut, machine, numbers, tools.
#pragma once

#include <string>
#include <vector>

#include "app/base/dialog.h"
#include "app/proposal/library_shelf.h"
#include "app/proposal/propose.h"
#include "app/questions/given.h"

namespace toothpath::questions {

/// What a job is made from.
struct Choice {
  proposal::Wishes wishes;
  proposal::Told notes;  ///< of a gear that stands in a file
  proposal::ChosenMachine machine;
  proposal::ChosenGear gear;
  proposal::Shelf shelf;           ///< empty: standard sizes
  proposal::LibraryWords library;  ///< of the tools, where they stand in one
};

/// Goes through the questions until they are answered, back and forth: on a terminal a gear that cannot be made is
/// asked for again from the number that is in the way. Refused: what is missing or wrong, by its option.
[[nodiscard]] Expected<Choice, std::vector<Diagnostic>> choose(const Given& given, app::Dialog& dialog);

/// What nobody says and nobody can propose, all of it at once, where nothing is asked for.
[[nodiscard]] std::vector<Diagnostic> missing_in(const Given& request, app::Dialog& dialog);

/// A job is UTF-8 and its texts are visible; names of files may be any bytes.
[[nodiscard]] Status can_be_named(const char* option, const std::string& text);

}  // namespace toothpath::questions
