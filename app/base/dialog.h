// Questions on a terminal, or what the options said instead: every answer belongs to an option, and without a terminal
// a missing one is refused with its name.
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

class Dialog {
 public:
  template <typename Value>
  using Answer = Expected<Value, std::vector<Diagnostic>>;
  /// Why an answer is not taken; nothing: it is.
  using Judge = std::function<std::optional<std::string>(const std::string& answer)>;

  /// Asks where the input is a terminal.
  explicit Dialog(bool quiet);
  [[nodiscard]] bool asks() const { return asks_; }

  /// Lines of a name and a value, on a terminal only.
  void tell(const std::vector<std::pair<std::string, std::string>>& lines) const;

  // Refused (kind usage): a wrong value or a missing one without a terminal, answers that end. On a terminal a wrong
  // answer is asked for again.
  /// One of these words; an empty answer takes the first.
  [[nodiscard]] Answer<std::string> word(const char* option, const char* text, std::string given,
                                         std::span<const std::string_view> words) const;
  /// An empty answer takes `proposed`.
  [[nodiscard]] Answer<double> number(const NumberQuestion& question, std::optional<double> given,
                                      std::optional<double> proposed) const;
  /// Anything that the judge takes; an empty answer is `proposed`, where there is one. Asks; precondition: asks().
  [[nodiscard]] Answer<std::string> text(const std::string& option, const std::string& text,
                                         const std::optional<std::string>& proposed, const Judge& judge) const;

 private:
  bool asks_;
};

}  // namespace toothpath::app
