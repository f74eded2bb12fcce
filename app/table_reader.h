// Reads one table of a job file key by key: type, range and presence are checked here and every finding is collected.
#pragma once

#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "app/job.h"
#include "app/toml_document.h"

namespace toothpath {

/// What a number may be. The unit stands in messages only: " mm", " deg", "" for counts.
struct Range {
  double low, high;
  const char* unit = "";
  bool open_low = false, open_high = false;  ///< the limit itself is refused
};

/// What all tables of one file share.
struct ReaderFindings {
  std::vector<Diagnostic> errors;
  KeyPositions positions;

  void add(Diagnostic diagnostic) { errors.push_back(std::move(diagnostic)); }
};

class TableReader {
 public:
  /// @param path  key path of the table: "gear", "gear.zone[0]"; empty for the file itself
  TableReader(const DocumentTable& table, SourcePosition position, std::string path, ReaderFindings& findings);

  [[nodiscard]] bool has(std::string_view key) const { return table_.find(key) != nullptr; }
  /// Place of the key, or of the table where the key is absent.
  [[nodiscard]] SourcePosition where(std::string_view key) const;

  // Required keys: a missing, mistyped or out-of-range one is recorded and gives nothing.
  std::optional<double> number(std::string_view key, const Range& range);
  std::optional<int> integer(std::string_view key, const Range& range);
  std::optional<std::string> text(std::string_view key);
  std::optional<std::string> word(std::string_view key, std::initializer_list<std::string_view> words);
  std::optional<bool> boolean(std::string_view key);
  /// Exactly `count` finite numbers.
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count, const Range& range);

  /// The same, but an absent key is no error.
  template <typename Reader>
  auto if_present(std::string_view key, Reader read) -> decltype(read()) {
    known_.emplace(key);
    if (!has(key)) return std::nullopt;
    return read();
  }

  /// A raw value whose structure the caller reads itself; nothing when absent.
  const DocumentValue* value(std::string_view key);
  /// A table; recorded when it is something else. Nothing when absent.
  std::optional<TableReader> table(std::string_view key);
  /// An array of tables ([[key]]); recorded when it is something else. Empty when absent.
  std::vector<TableReader> tables(std::string_view key);

  /// Records a refusal of `key`.
  template <typename... Args>
  void refuse(std::string_view key, fmt::format_string<Args...> text, Args&&... args) {
    findings_->add(fail_at(where(key), "{}", fmt::format(text, std::forward<Args>(args)...)));
  }
  /// Records every key that was never asked for.
  void finish();

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  const DocumentMember* require(std::string_view key);
  std::optional<double> to_number(const DocumentValue& value, const std::string& name, const Range& range);
  [[nodiscard]] std::string join(std::string_view key) const;
  [[nodiscard]] std::string title() const;  ///< "[gear]" or "the job"

  const DocumentTable& table_;
  SourcePosition position_;
  std::string path_;
  ReaderFindings* findings_;
  std::set<std::string, std::less<>> known_;
};

}  // namespace toothpath
