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
  int others = 0;                   ///< deciding keys that have another word than their first one
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

/// Goes on with a document in all ways in which that many deciding keys have another word than their first one.
void collect(const Ask& ask, toml::TomlValue document, Leaf leaf, int most_others, std::vector<Leaf>& leaves,
             std::vector<toml::TomlValue>& documents) {
  const auto open = grow(ask, document, leaf);
  if (!open) {
    drop_unasked(document, leaf);
    leaves.push_back(std::move(leaf));
    documents.push_back(std::move(document));
    return;
  }
  const std::vector<std::string> words = choices_of(*open);
  for (const std::string& word : words) {
    if (word != words.front() && leaf.others == most_others) break;
    Leaf more = leaf;
    more.others += word != words.front() ? 1 : 0;
    more.words[dotted(open->table, open->key)] = word;
    collect(ask, document, std::move(more), most_others, leaves, documents);
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

bool below(const std::string& table, const std::string& key) {
  return key.starts_with(table.empty() ? "" : table + ".") &&
         key.find('.', table.empty() ? 0 : table.size() + 1) == std::string::npos;
}

/// The ways in which words were chosen, each once and in order, by numbers: there are many, and they are compared
/// often.
class Ways {
 public:
  explicit Ways(const std::vector<Leaf>& leaves) {
    std::set<Words> all;
    for (const Leaf& leaf : leaves) all.insert(leaf.words);
    std::set<std::string> keys;
    for (const Words& words : all)
      for (const auto& [key, word] : words) keys.insert(key);
    keys_.assign(keys.begin(), keys.end());
    words_.resize(keys_.size(), {""});
    for (const Words& words : all) {
      numbers_.emplace(words, numbers_.size());
      for (std::size_t k = 0; k < keys_.size(); ++k) {
        const auto found = words.find(keys_[k]);
        chosen_.push_back(found == words.end() ? 0 : number_of(words_[k], found->second));
      }
    }
  }

  [[nodiscard]] std::size_t number(const Words& words) const { return numbers_.at(words); }
  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }
  [[nodiscard]] const std::string& word(std::size_t key, int number) const {
    return words_[key][static_cast<std::size_t>(number)];
  }
  /// The number of the word of a deciding key; 0: it is not there.
  [[nodiscard]] int chosen(std::size_t way, std::size_t key) const { return chosen_[way * keys_.size() + key]; }
  /// The words of a deciding key in these ways, in the order in which they are met.
  [[nodiscard]] std::vector<int> chosen(const std::vector<std::size_t>& ways, std::size_t key) const {
    std::vector<int> found;
    for (const std::size_t way : ways)
      if (const int word = chosen(way, key); std::find(found.begin(), found.end(), word) == found.end())
        found.push_back(word);
    return found;
  }

 private:
  static int number_of(std::vector<std::string>& words, const std::string& word) {
    const auto number = std::size_t(std::find(words.begin() + 1, words.end(), word) - words.begin());
    if (number == words.size()) words.push_back(word);
    return static_cast<int>(number);
  }

  std::map<Words, std::size_t> numbers_;
  std::vector<std::string> keys_;
  std::vector<std::vector<std::string>> words_;  ///< of each key; the first is ""
  std::vector<int> chosen_;                      ///< of every way, of each key
};

bool has_none(const std::vector<int>& words) { return std::find(words.begin(), words.end(), 0) != words.end(); }

/// The conditions on other keys than `self` that choose `some` of `all`. Left out, where that changes nothing, are
/// those that only say whether a deciding key is there, and those on keys of other tables.
std::vector<Condition> conditions(const Ways& ways, const std::string& table, const std::string& self,
                                  const std::vector<std::size_t>& all, const std::vector<std::size_t>& some) {
  struct Chosen {
    std::size_t key;
    std::vector<int> words, of_all;
  };
  std::vector<Chosen> result;
  for (std::size_t key = 0; key < ways.keys().size(); ++key) {
    if (ways.keys()[key] == self) continue;
    Chosen chosen{key, ways.chosen(some, key), ways.chosen(all, key)};
    if (chosen.words.size() < chosen.of_all.size()) result.push_back(std::move(chosen));
  }
  const auto chooses = [&](const std::vector<Chosen>& tried) {
    return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [&](std::size_t way) {
      return std::all_of(tried.begin(), tried.end(), [&](const Chosen& c) {
        return std::find(c.words.begin(), c.words.end(), ways.chosen(way, c.key)) != c.words.end();
      });
    }));
  };
  const auto leave_out = [&](const auto& may_go) {
    for (std::size_t i = result.size(); i-- > 0;) {
      if (!may_go(result[i])) continue;
      auto without = result;
      without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
      if (chooses(without) == some.size()) result = std::move(without);
    }
  };
  leave_out([&](const Chosen& c) {
    return has_none(c.words) || (has_none(c.of_all) && c.words.size() + 1 == c.of_all.size());
  });
  leave_out([&](const Chosen& c) { return !below(table, ways.keys()[c.key]); });
  if (chooses(result) != some.size()) throw std::logic_error(fmt::format("what decides on {} is no single word", self));
  std::vector<Condition> named;
  for (const Chosen& c : result) {
    named.push_back({ways.keys()[c.key], {}});
    for (const int word : c.words) named.back().words.push_back(ways.word(c.key, word));
  }
  return named;
}

/// The leaves by their words, with what they say of each table.
class Tables {
 public:
  explicit Tables(const std::vector<Leaf>& leaves) : ways_(leaves) {
    for (const Leaf& leaf : leaves) {
      const std::size_t way = ways_.number(leaf.words);
      for (const toml::KeyNote& note : leaf.notes.keys) {
        if (std::find(order_.begin(), order_.end(), note.table) == order_.end()) order_.push_back(note.table);
        opened_[note.table].insert(way);
        auto& keys = keys_[note.table];
        if (note.presence != toml::Presence::misplaced && std::find(keys.begin(), keys.end(), note.key) == keys.end())
          keys.push_back(note.key);
      }
    }
    for (const Leaf& leaf : leaves) add(leaf, ways_.number(leaf.words));
  }

  [[nodiscard]] std::vector<Table> tables() const {
    std::vector<Table> result;
    for (const std::string& name : order_) {
      Table table{name, {}, {}};
      const auto& opened = opened_.at(name);
      const std::vector<std::size_t> all(opened.begin(), opened.end());
      for (const std::string& key : keys_.at(name)) table.keys.push_back(key_of(name, key, all));
      for (const auto& [relation, some] : relations_)
        if (relation.table == name)
          table.relations.push_back({relation, conditions(ways_, name, "", all, {some.begin(), some.end()})});
      result.push_back(std::move(table));
    }
    return result;
  }

 private:
  void add(const Leaf& leaf, std::size_t way) {
    for (const toml::KeyNote& note : leaf.notes.keys) add_to(found_[{note.table, note.key}][way], note);
    std::set<std::string> here;
    for (const toml::KeyNote& note : leaf.notes.keys) here.insert(note.table);
    for (auto& [place, by_way] : found_)
      if (const auto at = by_way.find(way); at != by_way.end() && here.contains(place.first))
        at->second.required = at->second.required && required_at_last(leaf, place.first, place.second);
    for (const toml::KeyRelation& relation : leaf.notes.relations) relations_[relation].insert(way);
  }

  [[nodiscard]] Key key_of(const std::string& table, const std::string& name,
                           const std::vector<std::size_t>& all) const {
    Key key{name, false, {}};
    std::vector<std::pair<Found, std::vector<std::size_t>>> classes;
    for (const auto& [way, found] : found_.at({table, name})) {
      if (!found.asked) continue;
      key.decides = key.decides || found.decides;
      const Found& one = found;
      const auto at = std::find_if(classes.begin(), classes.end(), [&](const auto& c) { return like(c.first, one); });
      if (at == classes.end()) classes.push_back({found, {way}});
      else at->second.push_back(way);
    }
    for (const auto& [found, some] : classes)
      key.forms.push_back(
          {found.shapes, found.required, found.absent, conditions(ways_, table, dotted(table, name), all, some)});
    return key;
  }

  Ways ways_;
  std::vector<std::string> order_;
  std::map<std::string, std::set<std::size_t>> opened_;
  std::map<std::string, std::vector<std::string>> keys_;
  std::map<std::pair<std::string, std::string>, std::map<std::size_t, Found>> found_;
  std::map<toml::KeyRelation, std::set<std::size_t>> relations_;
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

Reference survey(const Ask& ask, const std::vector<toml::TomlValue>& starts, int most_others) {
  Reference reference;
  std::vector<Leaf> leaves;
  for (const toml::TomlValue& start : starts) collect(ask, start, {}, most_others, leaves, reference.documents);
  reference.tables = Tables(leaves).tables();
  return reference;
}

}  // namespace toothpath::reference
