#include "app/reference/survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>

namespace toothpath::reference {
namespace {

using toml::ValueKind;
using toml::ValueShape;

/// Deciding keys by their dotted names, with their words.
using Words = std::map<std::string, std::string>;

/// What the reader asked of one document.
struct Leaf {
  Words words;
  toml::KeyNotes notes;             ///< while the document grew
  std::vector<toml::KeyNote> last;  ///< of the document with all keys
};

double number_in(const toml::Range& range) {
  const auto inside = [&range](double x) {
    return (range.open_low ? x > range.low : x >= range.low) && (range.open_high ? x < range.high : x <= range.high);
  };
  return inside(1) ? 1 : (range.low + range.high) / 2;
}

toml::TomlValue value_of(decltype(toml::TomlValue::data) data) { return {{}, std::move(data)}; }

toml::TomlArray numbers_of(const ValueShape& shape, std::size_t count) {
  toml::TomlArray list;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = number_in(shape.ranges[std::min(i, shape.ranges.size() - 1)]);
    if (shape.kind == ValueKind::integers) list.values.push_back(value_of(static_cast<std::int64_t>(std::ceil(x))));
    else list.values.push_back(value_of(x));
  }
  return list;
}

toml::TomlValue sample(const ValueShape& shape) {
  const std::size_t count = std::max<std::size_t>(shape.count.least, 1);
  toml::TomlArray list;
  switch (shape.kind) {
    case ValueKind::boolean: return value_of(false);
    case ValueKind::integer:
      if (!shape.choices.empty()) return value_of(static_cast<std::int64_t>(shape.choices.front()));
      return value_of(static_cast<std::int64_t>(std::ceil(number_in(shape.ranges.front()))));
    case ValueKind::number: return value_of(number_in(shape.ranges.front()));
    case ValueKind::text: return value_of(shape.words.empty() ? std::string("X") : shape.words.front());
    case ValueKind::integers:
    case ValueKind::numbers: return value_of(numbers_of(shape, count));
    case ValueKind::texts:
      for (const std::string& word : shape.words) list.values.push_back(value_of(word));
      while (shape.words.empty() && list.values.size() < count) list.values.push_back(value_of(std::string("X")));
      return value_of(std::move(list));
    case ValueKind::rows:
      for (std::size_t i = 0; i < count; ++i) list.values.push_back(value_of(numbers_of(shape, shape.ranges.size())));
      return value_of(std::move(list));
    case ValueKind::tables: list.values.push_back(value_of(toml::TomlTable{})); return value_of(std::move(list));
    case ValueKind::table: break;
  }
  return value_of(toml::TomlTable{});
}

/// All tables of a dotted name.
std::vector<toml::TomlTable*> tables_of(toml::TomlValue& document, const std::string& name) {
  std::vector<toml::TomlTable*> found = {&std::get<toml::TomlTable>(document.data)};
  for (std::size_t at = 0; at < name.size();) {
    const std::size_t end = std::min(name.find('.', at), name.size());
    const std::string part = name.substr(at, end - at);
    at = end + 1;
    std::vector<toml::TomlTable*> below;
    for (toml::TomlTable* table : found)
      for (toml::TomlEntry& entry : table->entries) {
        if (entry.key != part) continue;
        if (auto* one = std::get_if<toml::TomlTable>(&entry.value.data)) below.push_back(one);
        if (auto* many = std::get_if<toml::TomlArray>(&entry.value.data))
          for (toml::TomlValue& element : many->values)
            if (auto* one = std::get_if<toml::TomlTable>(&element.data)) below.push_back(one);
      }
    found = std::move(below);
  }
  return found;
}

std::vector<std::string> choices_of(const toml::KeyNote& note) {
  if (note.shapes.size() == 1) return note.shapes.front().words;
  std::vector<std::string> names;
  for (const ValueShape& shape : note.shapes) names.emplace_back(to_string(shape.kind));
  return names;
}

/// The value with which a document goes on; of a deciding key that of its word.
toml::TomlValue chosen(const toml::KeyNote& note, const Words& words) {
  const auto found = words.find(dotted(note.table, note.key));
  if (!note.decides || found == words.end()) return sample(note.shapes.front());
  if (note.shapes.size() == 1) return value_of(std::string(found->second));
  for (const ValueShape& shape : note.shapes)
    if (found->second == to_string(shape.kind)) return sample(shape);
  return sample(note.shapes.front());
}

/// Adds a key to the tables that lack it. Returns whether any did.
bool add_key(toml::TomlValue& document, const toml::KeyNote& note, const Words& words) {
  bool added = false;
  for (toml::TomlTable* table : tables_of(document, note.table))
    if (!table->find(note.key)) {
      table->entries.push_back({note.key, {}, chosen(note, words)});
      added = true;
    }
  return added;
}

/// Grows a document until the reader asks for nothing more. What it asks while a deciding key is missing counts for
/// nothing.
/// @returns a deciding key that has no word yet, where one is met
std::optional<toml::KeyNote> grow(const Ask& ask, toml::TomlValue& document, Leaf& leaf) {
  for (bool grown = true; grown;) {
    grown = false;
    toml::KeyNotes notes;
    (void)ask(document, notes);
    const auto chosen_before = [&leaf](const toml::KeyNote& note) {
      return leaf.words.contains(dotted(note.table, note.key));
    };
    for (const toml::KeyNote& note : notes.keys)
      if (note.decides && chosen_before(note)) grown = add_key(document, note, leaf.words) || grown;
    if (grown) continue;
    for (const toml::KeyNote& note : notes.keys)
      if (note.decides && !chosen_before(note)) return note;
    leaf.notes.keys.insert(leaf.notes.keys.end(), notes.keys.begin(), notes.keys.end());
    leaf.notes.relations.insert(leaf.notes.relations.end(), notes.relations.begin(), notes.relations.end());
    for (const toml::KeyNote& note : notes.keys)
      if (note.presence != toml::Presence::misplaced) grown = add_key(document, note, leaf.words) || grown;
    leaf.last = std::move(notes.keys);
  }
  return std::nullopt;
}

/// What a start brought along for other words.
void drop_unasked(toml::TomlValue& document, const Leaf& leaf) {
  std::set<std::pair<std::string, std::string>> asked;
  std::set<std::string> opened;
  for (const toml::KeyNote& note : leaf.last) {
    opened.insert(note.table);
    if (note.presence != toml::Presence::misplaced) asked.emplace(note.table, note.key);
  }
  for (const std::string& name : opened)
    for (toml::TomlTable* table : tables_of(document, name))
      std::erase_if(table->entries, [&](const toml::TomlEntry& entry) { return !asked.contains({name, entry.key}); });
}

void collect(const Ask& ask, const toml::TomlValue& start, const Words& words, std::vector<Leaf>& leaves,
             std::vector<toml::TomlValue>& documents) {
  Leaf leaf{words, {}, {}};
  toml::TomlValue document = start;
  const auto open = grow(ask, document, leaf);
  if (!open) {
    drop_unasked(document, leaf);
    leaves.push_back(std::move(leaf));
    documents.push_back(std::move(document));
    return;
  }
  for (const std::string& word : choices_of(*open)) {
    Words more = words;
    more[dotted(open->table, open->key)] = word;
    collect(ask, start, more, leaves, documents);
  }
}

/// What all leaves of the same words say of one key.
struct Found {
  std::vector<ValueShape> shapes;
  bool asked = false, required = true, decides = false;
  std::string absent;
};

void add_to(Found& found, const toml::KeyNote& note) {
  if (note.presence == toml::Presence::misplaced) return;
  found.asked = true;
  found.decides = found.decides || note.decides;
  if (found.absent.empty()) found.absent = note.absent;
  for (const ValueShape& shape : note.shapes)
    if (std::none_of(found.shapes.begin(), found.shapes.end(), [&](const ValueShape& s) { return same(s, shape); }))
      found.shapes.push_back(shape);
}

bool required_at_last(const Leaf& leaf, const std::string& table, const std::string& key) {
  bool required = false;
  for (const toml::KeyNote& note : leaf.last)
    if (note.table == table && note.key == key) {
      if (note.presence != toml::Presence::required) return false;
      required = true;
    }
  return required;
}

bool like(const Found& a, const Found& b) {
  return a.asked == b.asked && a.required == b.required && a.absent == b.absent &&
         std::equal(a.shapes.begin(), a.shapes.end(), b.shapes.begin(), b.shapes.end(), same);
}

bool holds(const Condition& condition, const Words& words) {
  const auto found = words.find(condition.key);
  return std::find(condition.words.begin(), condition.words.end(), found == words.end() ? "" : found->second) !=
         condition.words.end();
}

bool below(const std::string& table, const std::string& key) {
  return key.starts_with(table.empty() ? "" : table + ".") &&
         key.find('.', table.empty() ? 0 : table.size() + 1) == std::string::npos;
}

/// The words of a deciding key in these leaves; "" where they have it not.
std::vector<std::string> words_of(const std::vector<Words>& leaves, const std::string& key) {
  std::vector<std::string> found;
  for (const Words& words : leaves) {
    const auto at = words.find(key);
    const std::string word = at == words.end() ? "" : at->second;
    if (std::find(found.begin(), found.end(), word) == found.end()) found.push_back(word);
  }
  return found;
}

bool has_none(const std::vector<std::string>& words) {
  return std::find(words.begin(), words.end(), "") != words.end();
}

/// The conditions on other keys than `self` that choose `some` of `all`. Left out, where that changes nothing, are
/// those that only say whether a deciding key is there, and those on keys of other tables.
std::vector<Condition> conditions(const std::string& table, const std::string& self, const std::vector<Words>& all,
                                  const std::vector<Words>& some) {
  std::set<std::string> deciding;
  for (const Words& words : all)
    for (const auto& [key, word] : words)
      if (key != self) deciding.insert(key);
  std::vector<Condition> result;
  for (const std::string& key : deciding) {
    Condition condition{key, words_of(some, key)};
    if (condition.words.size() < words_of(all, key).size()) result.push_back(std::move(condition));
  }
  const auto chooses = [&](const std::vector<Condition>& tried) {
    return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [&](const Words& words) {
      return std::all_of(tried.begin(), tried.end(), [&](const Condition& c) { return holds(c, words); });
    }));
  };
  const auto leave_out = [&](const auto& may_go) {
    for (std::size_t i = result.size(); i-- > 0;) {
      auto without = result;
      without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
      if (may_go(result[i]) && chooses(without) == some.size()) result = std::move(without);
    }
  };
  leave_out([&](const Condition& c) {
    const auto words = words_of(all, c.key);
    return has_none(c.words) || (has_none(words) && c.words.size() + 1 == words.size());
  });
  leave_out([&](const Condition& c) { return !below(table, c.key); });
  if (chooses(result) != some.size()) throw std::logic_error(fmt::format("what decides on {} is no single word", self));
  return result;
}

/// The leaves by their words, with what they say of each table.
class Tables {
 public:
  explicit Tables(const std::vector<Leaf>& leaves) {
    for (const Leaf& leaf : leaves)
      for (const toml::KeyNote& note : leaf.notes.keys) {
        if (std::find(order_.begin(), order_.end(), note.table) == order_.end()) order_.push_back(note.table);
        opened_[note.table].insert(leaf.words);
        auto& keys = keys_[note.table];
        if (note.presence != toml::Presence::misplaced && std::find(keys.begin(), keys.end(), note.key) == keys.end())
          keys.push_back(note.key);
      }
    for (const Leaf& leaf : leaves) add(leaf);
  }

  [[nodiscard]] std::vector<Table> tables() const {
    std::vector<Table> result;
    for (const std::string& name : order_) {
      Table table{name, {}, {}};
      const auto& opened = opened_.at(name);
      const std::vector<Words> all(opened.begin(), opened.end());
      for (const std::string& key : keys_.at(name)) table.keys.push_back(key_of(name, key, all));
      for (const auto& [relation, some] : relations_)
        if (relation.table == name)
          table.relations.push_back({relation, conditions(name, "", all, {some.begin(), some.end()})});
      result.push_back(std::move(table));
    }
    return result;
  }

 private:
  void add(const Leaf& leaf) {
    for (const toml::KeyNote& note : leaf.notes.keys) add_to(found_[{note.table, note.key}][leaf.words], note);
    std::set<std::string> here;
    for (const toml::KeyNote& note : leaf.notes.keys) here.insert(note.table);
    for (auto& [place, by_words] : found_)
      if (const auto at = by_words.find(leaf.words); at != by_words.end() && here.contains(place.first))
        at->second.required = at->second.required && required_at_last(leaf, place.first, place.second);
    for (const toml::KeyRelation& relation : leaf.notes.relations) relations_[relation].insert(leaf.words);
  }

  [[nodiscard]] Key key_of(const std::string& table, const std::string& name, const std::vector<Words>& all) const {
    Key key{name, false, {}};
    std::vector<std::pair<Found, std::vector<Words>>> classes;
    for (const auto& by_words : found_.at({table, name})) {
      const Words& words = by_words.first;
      const Found& found = by_words.second;
      if (!found.asked) continue;
      key.decides = key.decides || found.decides;
      const auto at = std::find_if(classes.begin(), classes.end(), [&](const auto& c) { return like(c.first, found); });
      if (at == classes.end()) classes.push_back({found, {words}});
      else at->second.push_back(words);
    }
    for (const auto& [found, some] : classes)
      key.forms.push_back(
          {found.shapes, found.required, found.absent, conditions(table, dotted(table, name), all, some)});
    return key;
  }

  std::vector<std::string> order_;
  std::map<std::string, std::set<Words>> opened_;
  std::map<std::string, std::vector<std::string>> keys_;
  std::map<std::pair<std::string, std::string>, std::map<Words, Found>> found_;
  std::map<toml::KeyRelation, std::set<Words>> relations_;
};

}  // namespace

const Key* Table::find(std::string_view key) const {
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.name == key; });
  return found == keys.end() ? nullptr : &*found;
}

const Table* Reference::find(std::string_view table) const {
  const auto found = std::find_if(tables.begin(), tables.end(), [&](const Table& t) { return t.name == table; });
  return found == tables.end() ? nullptr : &*found;
}

std::string dotted(const std::string& table, const std::string& key) { return table.empty() ? key : table + "." + key; }

const char* to_string(ValueKind kind) {
  switch (kind) {
    case ValueKind::boolean: return "true or false";
    case ValueKind::integer: return "whole number";
    case ValueKind::number: return "number";
    case ValueKind::text: return "text";
    case ValueKind::integers: return "list of whole numbers";
    case ValueKind::numbers: return "list of numbers";
    case ValueKind::texts: return "list of texts";
    case ValueKind::rows: return "list of rows";
    case ValueKind::tables: return "list of tables";
    case ValueKind::table: return "table";
  }
  return "";
}

bool same(const ValueShape& a, const ValueShape& b) {
  const auto same_range = [](const toml::Range& p, const toml::Range& q) {
    return p.low == q.low && p.high == q.high && std::string_view(p.unit) == q.unit && p.open_low == q.open_low &&
           p.open_high == q.open_high;
  };
  return a.kind == b.kind && a.words == b.words && a.choices == b.choices && a.columns == b.columns &&
         a.count.least == b.count.least && a.count.most == b.count.most && a.pattern == b.pattern &&
         a.ascii == b.ascii &&
         std::equal(a.ranges.begin(), a.ranges.end(), b.ranges.begin(), b.ranges.end(), same_range);
}

Reference survey(const Ask& ask, const std::vector<toml::TomlValue>& starts) {
  Reference reference;
  std::vector<Leaf> leaves;
  for (const toml::TomlValue& start : starts) collect(ask, start, {}, leaves, reference.documents);
  reference.tables = Tables(leaves).tables();
  return reference;
}

}  // namespace toothpath::reference
