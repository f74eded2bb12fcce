// The tools of a library file (LinuxCNC, Fusion, FreeCAD) as far as the file says them, and what somebody says beside
// it. What nobody says is named, never made up.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/job/library_tool.h"
#include "app/proposal/gear_limits.h"
#include "app/proposal/shelf.h"

namespace toothpath::proposal {

/// What a job says of its tools beside the name of their library.
struct LibraryWords {
  std::string file;                     ///< as the job names it; empty: tools are written out
  std::string unit;                     ///< its `library_unit`; empty: none is said
  std::map<int, toml::TomlTable> said;  ///< keys of a [[tool]] that stand in the job, by its number
};

class LibraryShelf {
 public:
  struct Tool {
    tool_library::LibraryTool known;
    toml::TomlTable said;
    job::LibraryToolReading reading;

    [[nodiscard]] int number() const { return known.number > 0 ? known.number : 1; }
    [[nodiscard]] bool whole() const { return reading.missing.empty() && reading.wrong.empty(); }
    /// "tool 4 (1 mm ball)".
    [[nodiscard]] std::string title() const;
  };

  /// @param unit  "mm" or "inch" for lengths of which the file states no unit; empty: nobody says it
  /// Refused: what the reader of the library refuses.
  [[nodiscard]] static Result<LibraryShelf> open(const std::string& file, const std::string& unit);

  /// Keys that hold beside what the library says of a tool, or instead of it. Refused (kind usage): no such tool, a
  /// key that a [[tool]] does not have, a wrong value; the tool then stays as it was.
  Status say(int number, const toml::TomlTable& keys);

  /// Tools that a gear may be cut with, as far as they are known: of a kind that the route takes, no wider than what
  /// reaches the root or what roughs first, with flutes or a neck that reach it. None where none may finish.
  [[nodiscard]] std::vector<const Tool*> candidates(Route route, const FaceFacts& facts) const;
  /// Why each of the others is none, by its title; of kinds that no job has, too.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> left_out(Route route, const FaceFacts& facts) const;
  /// Why a tool is no candidate, whatever the others are; empty: it is one.
  [[nodiscard]] static std::string why_not(const Tool& tool, Route route, const FaceFacts& facts);
  /// Of these the two that a job would take if all the rest of them were right: the largest that finishes, and the
  /// largest that roughs.
  [[nodiscard]] static std::vector<const Tool*> proposed(const std::vector<const Tool*>& candidates,
                                                         const FaceFacts& facts);
  /// What is missing, with what follows from a kind that is not said.
  [[nodiscard]] static std::vector<job::MissingKey> missing(const Tool& tool, Route route);

  [[nodiscard]] const Tool* find(int number) const;
  [[nodiscard]] const std::string& file() const { return file_; }
  /// All that are whole, with their numbers.
  [[nodiscard]] Shelf whole() const;
  /// @param file  as a job names the library
  [[nodiscard]] LibraryWords words(const std::string& file) const;

 private:
  std::string file_, unit_;
  std::vector<Tool> tools_;
  std::vector<tool_library::OtherTool> others_;
};

}  // namespace toothpath::proposal
