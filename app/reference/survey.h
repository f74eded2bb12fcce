// All keys of a file format, found by asking its reader: it reads documents that grow by every key that it asks for,
// one document for every way in which the words of its deciding keys (`type`, ..) can be chosen, most of them the first
// ones.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "machines/toml/key_notes.h"
#include "machines/toml/toml_tree.h"

namespace toothpath::reference {

/// A key belongs there when a deciding key, by its dotted name ("gear.type"), has one of these words. Of a deciding key
/// that takes values of several shapes the words are the names of the shapes.
struct Condition {
  std::string key;
  std::vector<std::string> words;
};

/// What a key may be under some conditions, all of which hold.
struct KeyForm {
  std::vector<toml::ValueShape> shapes;
  bool required = false;
  std::string absent;  ///< what holds where the key is left out, as in toml::KeyNote
  std::vector<Condition> when;
};

struct Key {
  std::string name;
  bool decides = false;
  std::vector<KeyForm> forms;  ///< at least one
};

struct Relation {
  toml::KeyRelation relation;
  std::vector<Condition> when;
};

struct Table {
  std::string name;  ///< dotted, without indices; empty: the file itself
  std::vector<Key> keys;
  std::vector<Relation> relations;

  [[nodiscard]] const Key* find(std::string_view key) const;
};

struct Reference {
  std::vector<Table> tables;               ///< the file first, then in the order in which the reader opened them
  std::vector<toml::TomlValue> documents;  ///< each with all keys that it may have

  [[nodiscard]] const Table* find(std::string_view table) const;
};

/// The keys that a reader asks of a document. Returns what is wrong with the document.
using Ask = std::function<std::vector<Diagnostic>(const toml::TomlValue& document, toml::KeyNotes& notes)>;

/// So many deciding keys at once have another word than their first one: all choices of all keys would be tens of
/// thousands of documents. A test tries one more.
inline constexpr int kMostOthers = 2;

/// @param starts  tables from which documents grow: what a reader's answer depends on besides deciding keys. A key is
///                required when it is so from every start.
/// Throws std::logic_error where the presence of a key depends on anything else.
[[nodiscard]] Reference survey(const Ask& ask, const std::vector<toml::TomlValue>& starts,
                               int most_others = kMostOthers);

/// "gear.type" of a table and a key.
[[nodiscard]] std::string dotted(const std::string& table, const std::string& key);
/// Words of a value of several shapes: "number", "table".
[[nodiscard]] const char* to_string(toml::ValueKind kind);
[[nodiscard]] bool same(const toml::ValueShape& a, const toml::ValueShape& b);

}  // namespace toothpath::reference
