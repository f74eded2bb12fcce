// Lines of NC text in the format of a dialect: numbers, comments, templates, length check, block numbers.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "postproc/text/dialect.h"

namespace toothpath::text {

class NcLines {
 public:
  using Values = std::map<std::string, std::string, std::less<>>;

  explicit NcLines(const NcDialect& dialect) : dialect_(dialect) {}

  /// A whole line; one that begins as a comment is no block.
  void line(std::string_view text);
  void comment(std::string_view text);
  /// The block that follows has this number, as an N word.
  void number_next(int n) { next_number_ = n; }
  /// Templates of the dialect, each a line. A name that `values` lacks is an error.
  void fill(const NcLinesOfText& templates, const Values& values);

  /// The line that is being put together: appended to, then ended.
  [[nodiscard]] std::string& text() { return text_; }
  [[nodiscard]] std::size_t size() const { return text_.size(); }
  void end_line(std::size_t begin, bool block);
  void number(std::int64_t scaled, int decimals);
  [[nodiscard]] std::string value(std::int64_t scaled, int decimals) const;

  [[nodiscard]] std::size_t blocks() const { return blocks_; }
  [[nodiscard]] std::optional<Diagnostic>& error() { return error_; }

  /// `text` with a number ahead of every line, from 0.
  [[nodiscard]] static std::string numbered(std::string_view text);

 private:
  const NcDialect& dialect_;
  std::string text_;
  std::size_t blocks_ = 0;
  int next_number_ = -1;
  std::optional<Diagnostic> error_;
};

/// A template with its names replaced; empty: it names a value that `values` lacks.
[[nodiscard]] std::optional<std::string> expanded(std::string_view pattern, const NcLines::Values& values);

struct CornerWords;
/// {blend}, {blend_axis}, {finish}, {roughs} 1 and {cut} ROUGH where a later operation takes what the corners leave.
void set_corner_values(NcLines::Values& values, const CornerWords& corners, const joints::AxisProgram& program,
                       const NcDialect& dialect);

/// Values of the templates that are the same throughout a program.
[[nodiscard]] NcLines::Values program_values(const joints::AxisProgram& program, const NcDialect& dialect,
                                             const NcHeader& header);

/// Comments at the top of a program. @param hash the line that stands at the end too
[[nodiscard]] std::vector<std::string> header_comments(const joints::AxisProgram& program, const NcDialect& dialect,
                                                       const NcHeader& header, std::string_view hash);
/// Those that name what is assumed, as many as the longest header leaves behind `ahead` lines; several groups of keys
/// share a line where they are more, and what does not fit is counted.
[[nodiscard]] std::vector<std::string> assumed_comments(const std::vector<std::string>& assumed,
                                                        const NcDialect& dialect, std::size_t ahead);
/// Those that tell the order of the teeth and where the program begins, if not as usual.
[[nodiscard]] std::vector<std::string> order_comments(const joints::AxisProgram& program);
/// Names the line behind it: where the operator may set another first tooth.
[[nodiscard]] std::string first_tooth_comment(const joints::AxisProgram& program,
                                              const joints::AxisOperation& operation);
/// "TEETH 12 TO 23", in the spread order "PLACES 12 TO 23", "TOOTH 5", "ALL TEETH".
[[nodiscard]] std::string teeth_text(const joints::AxisProgram& program, int first_place, int end_place);

}  // namespace toothpath::text
