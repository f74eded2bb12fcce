// What a reader asks of a file, noted: from it the reference of all keys is made (app/reference).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace toothpath::toml {

/// What a number may be. The unit stands in messages only: " mm", " deg", "" for counts.
struct Range {
  double low, high;
  const char* unit = "";
  bool open_low = false, open_high = false;  ///< the limit itself is refused

  /// Above 0, up to `high`.
  [[nodiscard]] static constexpr Range positive(double high, const char* unit) { return {0.0, high, unit, true}; }
};

/// How many entries a list has.
struct Count {
  std::size_t least = 0, most = SIZE_MAX;
};

enum class ValueKind {
  boolean,
  integer,
  number,
  text,
  integers,  ///< a list of them, as are the next four
  numbers,
  texts,
  rows,  ///< each a list of numbers, one a column
  tables,
  table,
};

/// What the value of a key may be.
struct ValueShape {
  ValueKind kind = ValueKind::text;
  std::vector<Range> ranges{};         ///< of a number, and of the numbers of a list; of rows one a column
  std::vector<std::string> words{};    ///< all that a text, or an entry of a list of texts, may be; empty: any
  std::vector<int> choices{};          ///< all that an integer may be; empty: any of its range
  std::vector<std::string> columns{};  ///< names of those of rows
  Count count{};                       ///< of a list
  std::string pattern{};               ///< a regular expression that the whole text fits; empty: any
  bool ascii = false;

  [[nodiscard]] static ValueShape of_words(ValueKind kind, std::vector<std::string> words) {
    ValueShape shape{kind};
    shape.words = std::move(words);
    return shape;
  }
  [[nodiscard]] static ValueShape of_range(ValueKind kind, const Range& range) {
    ValueShape shape{kind};
    shape.ranges = {range};
    return shape;
  }
};

enum class Presence {
  required,
  optional,
  misplaced,  ///< asked for only to refuse it with a word of help
};

/// A key as a reader asked for it.
struct KeyNote {
  std::string table;  ///< dotted name without indices: "gear.zone"; empty: the file itself
  std::string key;
  std::vector<ValueShape> shapes;  ///< its value is one of them
  Presence presence = Presence::required;
  std::string absent;    ///< what holds where the key is left out, as the file would say it; empty: nothing, or the
                         ///< sentence of the key says it
  bool decides = false;  ///< which other keys there are depends on its word, or on its shape where there are several
};

/// What keys of one table have to do with each other.
struct KeyRelation {
  enum class Kind {
    one_of,    ///< exactly one of them
    together,  ///< both or none
    needs,     ///< the first needs the second
    excludes,  ///< not both
    supplies,  ///< where the first is there, only the second of the required keys must stand here
  };
  std::string table;
  Kind kind;
  std::string first, second;

  bool operator<(const KeyRelation& other) const {
    return std::tie(table, kind, first, second) < std::tie(other.table, other.kind, other.first, other.second);
  }
};

struct KeyNotes {
  std::vector<KeyNote> keys;  ///< in the order of asking
  std::vector<KeyRelation> relations;
};

}  // namespace toothpath::toml
