// The flow of control of an ISO program: lines, o-words, loops, sub-programs, parameters. What a block does is the
// business of whoever runs it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "postproc/readback/iso/block.h"
#include "postproc/readback/reader.h"
#include "postproc/readback/turns.h"

namespace toothpath::iso {

class NcFlow {
 public:
  /// What a block of words does: a located error, or nothing.
  using Words = std::function<std::optional<Diagnostic>(const NcBlock&)>;

  /// @param o_words LinuxCNC: o-words and text without %; else M98 and a program between % and %
  NcFlow(std::string_view text, const std::string& file, bool o_words, const readback::NcControl& control);

  /// Executes to the end of the program. `words` sees every block that is no o-word and no assignment, empty ones too.
  [[nodiscard]] Status run(const Words& words);

  /// A diagnostic in the line that is being executed.
  [[nodiscard]] Diagnostic here(int column, std::string message) const {
    return at(line_ + 1, column, std::move(message));
  }
  /// A problem in that line; nothing: there is none.
  [[nodiscard]] std::optional<Diagnostic> placed(int column, std::optional<std::string> problem) const {
    return problem ? std::optional(here(column, std::move(*problem))) : std::nullopt;
  }
  [[nodiscard]] std::string_view text() const { return lines_[line_]; }  ///< of the line that is being executed
  [[nodiscard]] std::int32_t line() const { return static_cast<std::int32_t>(line_) + 1; }
  [[nodiscard]] Result<double> value(const NcBlock& b, const NcValue& v, int column) const;
  /// What a parameter of the control itself holds: programs may read it.
  void tell(std::size_t parameter, double value) { set_parameter(parameter, value, true); }

  /// A loop that is not entered has shown that this parameter is 0: its condition is a sum of squares above 0, and in
  /// it stands (ABORT, ..).
  [[nodiscard]] bool seen_zero(std::size_t parameter) const { return zeros_.count(parameter) != 0; }
  [[nodiscard]] std::size_t seen_zeros() const { return zeros_.size(); }

  /// M98, M97, M99, M2.
  [[nodiscard]] bool has_program(std::int64_t number) const { return labels_.count(number) != 0; }
  [[nodiscard]] std::optional<Diagnostic> call_program(std::int64_t number);
  [[nodiscard]] bool has_lines(double number) const;  ///< one line begins with this N word
  [[nodiscard]] std::optional<Diagnostic> call_lines(double number);
  [[nodiscard]] std::optional<Diagnostic> return_from_program(int column);
  [[nodiscard]] bool inside_call() const { return !frames_.empty(); }
  void end() { ended_ = true; }
  void moved() { idle_ = 0; }  ///< the block made a move

  /// Lines behind the one that is being executed, `most` of them or up to the end of the text.
  [[nodiscard]] std::span<const std::string_view> ahead(std::size_t most) const {
    return std::span(lines_).subspan(pc_, std::min(most, lines_.size() - pc_));
  }
  /// They are left out; a diagnostic in one of them (1: the first).
  void leave_out(std::size_t count) { pc_ += count; }
  [[nodiscard]] Diagnostic there(std::size_t behind, int column, std::string message) const {
    return at(line_ + 1 + behind, column, std::move(message));
  }

 private:
  struct Frame {  // of a call or a loop
    OWord kind = OWord::none;
    std::int64_t number = 0;
    std::size_t begin = 0;  // line of the loop's head, or where to go on after a call
    double repeats = 0;
    std::array<double, 30> saved{};
    std::array<bool, 30> saved_set{};
    std::vector<std::pair<std::size_t, double>> locals;  // named ones of the caller
    std::size_t turns = 0;                               // of a while loop
    std::vector<double> marked;                          // parameters at turn 1, 2, 4, 8 ..
    std::vector<bool> marked_set;
    std::uint64_t marked_print = 0;  // of them
  };

  void split(std::string_view text);
  [[nodiscard]] Diagnostic at(std::size_t line, int column, std::string message) const;
  void find_names(NcBlock& block);
  std::pair<const NcBlock*, Diagnostic> fetch(std::size_t line);
  std::optional<Diagnostic> find_labels();
  void note_number(std::size_t line, std::string_view text);
  [[nodiscard]] std::optional<Diagnostic> enter(std::size_t line);
  [[nodiscard]] std::optional<Diagnostic> check_percents() const;
  Status after_end();
  [[nodiscard]] const double* parameter(int n) const;
  [[nodiscard]] std::string name_of(std::size_t parameter) const;
  std::optional<Diagnostic> assign(const NcBlock& b);
  std::optional<Diagnostic> o_word(const NcBlock& b);
  std::optional<Diagnostic> call(const NcBlock& b);
  std::optional<Diagnostic> end_call();
  std::optional<Diagnostic> loop_head(const NcBlock& b);
  void set_parameter(std::size_t n, double value, bool set);
  [[nodiscard]] bool comes_round(Frame& loop) const;
  void note_zeros(const NcBlock& head);

  const std::string& file_;
  bool o_words_;
  std::size_t check_lines_;  // behind the comment of a check of the tool: no business of the flow
  std::size_t max_steps_, max_idle_, idle_ = 0;
  std::vector<std::string_view> lines_;
  std::vector<std::size_t> percents_;
  std::unordered_map<std::size_t, std::size_t> ends_;      // head line -> end line
  std::unordered_map<std::int64_t, std::size_t> labels_;   // sub-program -> line
  std::unordered_map<std::int64_t, std::size_t> numbers_;  // N word -> line; past all of them where it occurs twice
  std::unordered_map<std::size_t, NcBlock> cache_;
  NcBlock once_;
  std::vector<Frame> frames_;
  readback::LoopTurns turns_;
  std::size_t pc_ = 0, line_ = 0;
  bool ended_ = false, started_ = false;
  std::uint64_t print_ = 0;  // of the parameters that are set: two states with other prints differ
  std::unordered_map<std::string, std::size_t> names_;  // #<name> -> place in parameters_
  std::unordered_set<std::size_t> own_;                 // of them those of the control
  std::vector<std::size_t> locals_;                     // of them those that belong to a sub-program
  std::vector<double> parameters_;
  std::vector<bool> parameter_set_;
  std::set<std::size_t> zeros_;
};

}  // namespace toothpath::iso
