// Reads one table of a TOML file key by key: type, range and presence are checked here and every finding is collected.
// What a finding says is the business of the format: `TableWords`.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "machines/toml/key_notes.h"
#include "machines/toml/toml_tree.h"

namespace toothpath::toml {

/// The messages of one format. `path` is the dotted name of a table, "" for the file itself: "gear", "gear.zone[0]".
/// `name` is what `name()` made, with an index in brackets for an element of an array.
class TableWords {
 public:
  using KnownKeys = std::set<std::string, std::less<>>;

  virtual ~TableWords() = default;
  /// What a key of a table is called in messages.
  [[nodiscard]] virtual std::string name(const std::string& path, std::string_view key) const = 0;
  [[nodiscard]] virtual std::string missing(const std::string& path, std::string_view key) const = 0;
  [[nodiscard]] virtual std::string unknown(const std::string& path, const std::string& key,
                                            const KnownKeys& known) const = 0;
  [[nodiscard]] virtual std::string wrong_type(const std::string& name, TomlType wanted, TomlType found) const = 0;
  /// `found` is no table, or, with `many`, no array of tables.
  [[nodiscard]] virtual std::string no_table(const std::string& path, std::string_view key, bool many,
                                             TomlType found) const = 0;
  /// `found` is no array of `count` numbers: another type, or another count.
  [[nodiscard]] virtual std::string not_numbers(const std::string& name, std::size_t count,
                                                const TomlValue& found) const = 0;
  [[nodiscard]] virtual std::string not_finite(const std::string& name, double number) const = 0;
  [[nodiscard]] virtual std::string outside(const std::string& name, double number, const Range& range) const = 0;
  [[nodiscard]] virtual std::string integer_outside(const std::string& name, std::int64_t number,
                                                    const Range& range) const = 0;
  /// What a text may not be in this format; nothing when it is right. `ascii`: it goes into NC text.
  [[nodiscard]] virtual std::optional<std::string> text_fault(const std::string& name, const std::string& text,
                                                              bool ascii) const = 0;
  [[nodiscard]] virtual std::string not_one_of(const std::string& name, const std::string& text,
                                               std::span<const std::string_view> words) const = 0;
};

/// What all tables of one file share.
struct ReaderFindings {
  explicit ReaderFindings(const TableWords& format) : words(format) {}

  const TableWords& words;
  std::vector<Diagnostic> errors;
  /// Of every table that was opened and of its keys: "gear", "gear.module", "gear.zone[0].inner_radius".
  std::map<std::string, SourcePosition, std::less<>> positions;
  KeyNotes* notes = nullptr;  ///< where there is one, every key that is asked for is noted
};

/// What a text is beside its being one: told to whoever describes the format; only `ascii` is checked here.
struct TextRules {
  bool ascii = false;
  const char* pattern = "";  ///< as in ValueShape
};

class TableReader {
 public:
  /// @param table  a value that is a table; it and `findings` outlive the reader
  /// @param path   dotted name of the table: "gear", "gear.zone[0]"; empty for the file itself
  TableReader(const TomlValue& table, std::string path, ReaderFindings& findings);

  /// Keys that this table lacks are looked up in another one, which outlives the reader; they keep their places there.
  void supply(const TomlTable& others) { others_ = &others; }

  [[nodiscard]] bool has(std::string_view key) const { return entry(key) != nullptr; }
  // A value without asking for the key: of this table alone; of the one that supplies it, too. Null: there is none.
  [[nodiscard]] const TomlValue* own(std::string_view key) const {
    const TomlEntry* found = table_.find(key);
    return found ? &found->value : nullptr;
  }
  [[nodiscard]] const TomlValue* looked_up(std::string_view key) const {
    const TomlEntry* found = entry(key);
    return found ? &found->value : nullptr;
  }
  /// Place of the value of a key, or of the table where the key is absent.
  [[nodiscard]] SourcePosition where(std::string_view key) const;
  /// Place of an entry of a list.
  [[nodiscard]] SourcePosition where(std::string_view key, std::size_t entry) const;
  /// What a key of this table is called in messages.
  [[nodiscard]] std::string name(std::string_view key) const { return words().name(path_, key); }
  [[nodiscard]] const std::string& path() const { return path_; }
  /// Refusals so far, in all tables of the file.
  [[nodiscard]] std::size_t errors() const { return findings_->errors.size(); }

  // Every getter marks its key as known and, where the findings ask for it, notes it. A mistyped or out-of-range value
  // is recorded and gives nothing; so does a missing one, unless the getter says otherwise.
  using Words = std::span<const std::string_view>;
  using WordList = std::initializer_list<std::string_view>;
  std::optional<double> number(std::string_view key, const Range& range);
  std::optional<int> integer(std::string_view key, const Range& range);
  std::optional<std::string> text(std::string_view key, const TextRules& rules = {});
  std::optional<std::string> word(std::string_view key, Words allowed);
  std::optional<std::string> word(std::string_view key, WordList allowed) {
    return word(key, {allowed.begin(), allowed.size()});
  }
  /// A word on which it depends which other keys there are.
  std::optional<std::string> variant(std::string_view key, Words allowed);
  std::optional<std::string> variant(std::string_view key, WordList allowed) {
    return variant(key, {allowed.begin(), allowed.size()});
  }
  /// Exactly `count` finite numbers.
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count, const Range& range);
  // Lists; their count is told to whoever describes the format, and not checked here.
  std::optional<std::vector<double>> number_list(std::string_view key, const Range& range, const Count& count = {});
  std::optional<std::vector<int>> integer_list(std::string_view key, const Range& range, const Count& count = {});
  /// A value whose structure the caller reads itself, by the first of `shapes` that it is; recorded when absent.
  const TomlValue* required(std::string_view key, std::vector<ValueShape> shapes);
  std::optional<TableReader> required_table(std::string_view key);

  // The same, but an absent key is no error.
  std::optional<double> optional_number(std::string_view key, const Range& range);
  std::optional<int> optional_integer(std::string_view key, const Range& range);
  std::optional<bool> optional_boolean(std::string_view key);
  std::optional<std::string> optional_text(std::string_view key, const TextRules& rules = {});
  std::optional<std::string> optional_word(std::string_view key, WordList allowed);
  std::optional<std::vector<double>> optional_numbers(std::string_view key, std::size_t count, const Range& range);
  std::optional<std::vector<double>> optional_number_list(std::string_view key, const Range& range,
                                                          const Count& count = {});
  std::optional<std::vector<int>> optional_integer_list(std::string_view key, const Range& range,
                                                        const Count& count = {});
  std::optional<std::vector<std::string>> optional_ascii_list(std::string_view key, const Count& count = {},
                                                              std::vector<std::string> words = {});
  /// A value whose structure the caller reads itself; nothing when absent.
  const TomlValue* value(std::string_view key, std::vector<ValueShape> shapes, Presence noted = Presence::optional);
  /// A table; recorded when it is something else. Nothing when absent: where `noted` says that it is required, the
  /// caller refuses that.
  std::optional<TableReader> table(std::string_view key, Presence noted = Presence::optional);
  /// An array of tables ([[key]]); recorded when it is something else. Empty when absent, as above.
  std::vector<TableReader> tables(std::string_view key, const Count& count = {}, Presence noted = Presence::optional);

  // The same, with what holds where the key is absent or wrong.
  double number_or(std::string_view key, const Range& range, double absent);
  int integer_or(std::string_view key, const Range& range, int absent);
  bool boolean_or(std::string_view key, bool absent);
  std::string word_or(std::string_view key, WordList allowed, std::string_view absent);

  /// The numbers of an array inside a value, one a range; recorded under `name` where they are something else.
  std::optional<std::vector<double>> numbers_of(const TomlValue& value, const std::string& name,
                                                std::initializer_list<Range> ranges);
  /// A key that is looked for only to refuse it with a word of help: is it there?
  bool misplaced(std::string_view key);
  /// Records it where a key that is optional elsewhere is absent.
  void demand(std::string_view key) { (void)look(key, true); }
  /// Tells whoever describes the format; what contradicts it the caller refuses.
  void relate(KeyRelation::Kind kind, std::string_view first, std::string_view second);
  /// Every entry of this table; marks all as known.
  const std::vector<TomlEntry>& entries();

  /// Records a refusal of `key`.
  template <typename... Args>
  void refuse(std::string_view key, fmt::format_string<Args...> text, Args&&... args) {
    record(where(key), fmt::format(text, std::forward<Args>(args)...));
  }
  /// The same at another place.
  template <typename... Args>
  void refuse_at(const SourcePosition& position, fmt::format_string<Args...> text, Args&&... args) {
    record(position, fmt::format(text, std::forward<Args>(args)...));
  }
  /// Forgets all refusals behind the first `kept`: they follow from another one.
  void forget_errors(std::size_t kept) { findings_->errors.resize(std::min(kept, errors())); }
  /// Records every key that was never asked for.
  void finish();
  /// Of a table that cannot be read further because `key` is absent: records the key that was probably meant to be it.
  void name_misspelt(std::string_view key);

 private:
  [[nodiscard]] const TableWords& words() const { return findings_->words; }
  [[nodiscard]] std::string join(std::string_view key) const;
  [[nodiscard]] const TomlEntry* entry(std::string_view key) const;
  void record(SourcePosition position, std::string message);
  /// Marks a key as known, and notes it.
  void ask(std::string_view key, const ValueShape& shape, Presence presence, std::string absent = {});
  const TomlValue* look(std::string_view key, bool must);
  std::optional<double> to_number(const TomlValue& value, const std::string& name, const Range& range);
  std::optional<int> to_integer(const TomlValue& value, const std::string& name, const Range& range);
  std::optional<std::string> to_text(const TomlValue& value, const std::string& name, bool ascii);
  std::optional<std::string> one_word(std::string_view key, Words allowed, bool must);
  std::optional<bool> to_boolean(std::string_view key, const TomlValue& value);
  std::optional<std::vector<double>> numbers_listed(std::string_view key, const Range& range, const Count& count,
                                                    Presence presence);
  std::optional<std::vector<int>> integers_listed(std::string_view key, const Range& range, const Count& count,
                                                  Presence presence);
  std::optional<std::vector<double>> counted(std::string_view key, const TomlValue& value, std::size_t count,
                                             const Range& range);
  template <typename T, typename Read>
  std::optional<std::vector<T>> list(std::string_view key, const TomlValue& found, Read read);

  const TomlTable& table_;
  const TomlTable* others_ = nullptr;
  SourcePosition position_;
  std::string path_;
  ReaderFindings* findings_;
  TableWords::KnownKeys known_;
};

/// Into the order of the file.
void sort_by_position(std::vector<Diagnostic>& errors);

}  // namespace toothpath::toml
