// Questions on a terminal, or what the options said instead: every answer belongs to an option, and without a terminal
// a missing one is refused with its name.
//
// On a terminal an answer can be "?" (what is asked for) and "<" (back to the question before). What was answered is
// kept in order, so that the questions can be gone through again without being asked twice: after "<", after a gear
// that cannot be made, and in another run.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "geometry/base/result.h"
#include "machines/toml/table_reader.h"

namespace toothpath::app {

struct NumberQuestion {
  const char* option;  ///< "--teeth"
  const char* text;    ///< "teeth of the gear"
  toml::Range range;
  bool whole;
};

/// What was said on a terminal, as it was typed.
struct SaidAnswer {
  std::string option, answer;
};

class Dialog {
 public:
  template <typename Value>
  using Answer = Expected<Value, std::vector<Diagnostic>>;
  /// Why an answer is not taken; nothing: it is.
  using Judge = std::function<std::optional<std::string>(const std::string& answer)>;
  /// What "?" shows of an option; empty: nothing more than the question.
  using Explain = std::function<std::string_view(std::string_view option)>;
  /// Sees all answers whenever one has come or gone.
  using Keep = std::function<void(std::span<const SaidAnswer>)>;

  /// Asks where the input is a terminal.
  explicit Dialog(bool quiet, Explain explain = {}, Keep keep = {});
  [[nodiscard]] bool asks() const { return asks_; }

  /// Lines of a name and a value, on a terminal only; not while answers are given again.
  void tell(const std::vector<std::pair<std::string, std::string>>& lines) const;

  // Refused (kind usage): a wrong value or a missing one without a terminal; answers that end; "<", which the caller
  // takes up with `went_back`. On a terminal a wrong answer is asked for again.
  /// One of these words; an empty answer takes the first.
  [[nodiscard]] Answer<std::string> word(const char* option, const char* text, const std::string& given,
                                         std::span<const std::string_view> words);
  /// An empty answer takes `proposed`. The unit of the range may stand behind the number.
  [[nodiscard]] Answer<double> number(const NumberQuestion& question, std::optional<double> given,
                                      std::optional<double> proposed);
  /// Anything that the judge takes; an empty answer is `proposed`, where there is one. Asks; precondition: asks().
  [[nodiscard]] Answer<std::string> text(const std::string& option, const std::string& text,
                                         const std::optional<std::string>& proposed, const Judge& judge);

  /// The last answer was "<": the one before it is forgotten, and the questions may be gone through again from their
  /// beginning. True once.
  [[nodiscard]] bool went_back();
  /// The questions begin again: what was answered is not asked. @param said  answers of an earlier run come first
  void begin_again(std::vector<SaidAnswer> said = {});
  /// Forgets the answer to an option and all behind it. False: that was not asked.
  bool forget(std::string_view option);

 private:
  [[nodiscard]] Answer<std::string> ask(const std::string& option, const std::string& line,
                                        const std::optional<std::string>& proposed, const Judge& judge);
  void changed() const;

  bool asks_, back_ = false;
  Explain explain_;
  Keep keep_;
  std::vector<SaidAnswer> said_;
  std::size_t next_ = 0;  ///< answers before it have been given
};

}  // namespace toothpath::app
