#include "app/reference/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "app/reference/formats.h"
#include "geometry/base/json_text.h"

namespace toothpath::reference {
namespace {

using Json = nlohmann::ordered_json;
using toml::ValueKind;
using toml::ValueShape;

void add_range(Json& json, const toml::Range& range, bool whole) {
  const auto number = [whole](double x) { return whole ? Json(static_cast<std::int64_t>(x)) : Json(x); };
  json[range.open_low ? "exclusiveMinimum" : "minimum"] = number(range.low);
  json[range.open_high ? "exclusiveMaximum" : "maximum"] = number(range.high);
}

Json number_schema(const toml::Range& range, bool whole) {
  Json json = {{"type", whole ? "integer" : "number"}};
  add_range(json, range, whole);
  return json;
}

/// No control characters.
constexpr const char* kPrintable = "^[^\\u0000-\\u001f\\u007f]*$";

Json text_schema(const ValueShape& shape) {
  if (!shape.words.empty()) return {{"enum", shape.words}};
  Json json = {{"type", "string"}, {"minLength", 1}};
  json["pattern"] = shape.pattern.empty() ? kPrintable : "^(" + shape.pattern + ")$";
  return json;
}

Json list_schema(Json items, const toml::Count& count) {
  Json json = {{"type", "array"}, {"items", std::move(items)}};
  if (count.least > 0) json["minItems"] = count.least;
  if (count.most != SIZE_MAX) json["maxItems"] = count.most;
  return json;
}

Json texts_schema(const ValueShape& shape) {
  Json json = list_schema(text_schema({ValueKind::text, {}, shape.words}), shape.count);
  if (!shape.words.empty()) json["uniqueItems"] = true;
  return json;
}

Json rows_schema(const ValueShape& shape) {
  Json columns = Json::array();
  for (std::size_t i = 0; i < shape.ranges.size(); ++i) {
    columns.push_back(number_schema(shape.ranges[i], false));
    columns.back()["title"] = shape.columns[i];
  }
  const std::size_t count = shape.ranges.size();
  Json row = {{"type", "array"}, {"items", std::move(columns)}, {"minItems", count}, {"maxItems", count}};
  return list_schema(std::move(row), shape.count);
}

/// `text` as the file would say it; TOML and JSON agree on what stands there.
Json literal(const std::string& text) { return Json::parse(text); }

using Conditions = std::vector<Condition>;

bool admits(const KeyForm& form, const std::string& key, const std::string& word) {
  return std::all_of(form.when.begin(), form.when.end(), [&](const Condition& c) {
    return c.key != key || std::find(c.words.begin(), c.words.end(), word) != c.words.end();
  });
}

/// Does a key belong to this table itself, and not to another?
bool belongs(const Table& table, const std::string& key) {
  const auto dot = key.rfind('.');
  return (dot == std::string::npos ? "" : key.substr(0, dot)) == table.name;
}

class Schema {
 public:
  explicit Schema(const Format& format) : format_(format) {}

  [[nodiscard]] Json file() {
    Json json = table_schema(format_.reference.tables.front());
    add_foreign(json);
    return json;
  }

 private:
  [[nodiscard]] Json shape_schema(const std::string& key, const ValueShape& shape) const {
    switch (shape.kind) {
      case ValueKind::boolean: return {{"type", "boolean"}};
      case ValueKind::integer:
        if (!shape.choices.empty()) return {{"enum", shape.choices}};
        return number_schema(shape.ranges.front(), true);
      case ValueKind::number: return number_schema(shape.ranges.front(), false);
      case ValueKind::text: return text_schema(shape);
      case ValueKind::integers: return list_schema(number_schema(shape.ranges.front(), true), shape.count);
      case ValueKind::numbers: return list_schema(number_schema(shape.ranges.front(), false), shape.count);
      case ValueKind::texts: return texts_schema(shape);
      case ValueKind::rows: return rows_schema(shape);
      case ValueKind::tables: return list_schema(below(key), shape.count);
      case ValueKind::table: return below(key);
    }
    return {};
  }

  [[nodiscard]] Json below(const std::string& key) const {
    const Table* table = format_.reference.find(key);
    return table ? table_schema(*table) : Json{{"type", "object"}};
  }

  /// What the value is in any of these forms.
  [[nodiscard]] Json value_schema(const std::string& key, const std::vector<const KeyForm*>& forms) const {
    std::vector<ValueShape> shapes;
    for (const KeyForm* form : forms)
      for (const ValueShape& shape : form->shapes) {
        const bool words = shape.kind == ValueKind::text && !shape.words.empty() && !shapes.empty() &&
                           shapes.front().kind == ValueKind::text && !shapes.front().words.empty();
        if (words) {
          for (const std::string& word : shape.words)
            if (std::find(shapes.front().words.begin(), shapes.front().words.end(), word) == shapes.front().words.end())
              shapes.front().words.push_back(word);
        } else if (std::none_of(shapes.begin(), shapes.end(), [&](const ValueShape& s) { return same(s, shape); })) {
          shapes.push_back(shape);
        }
      }
    if (shapes.size() == 1) return shape_schema(key, shapes.front());
    Json any = Json::array();
    for (const ValueShape& shape : shapes) any.push_back(shape_schema(key, shape));
    return {{"anyOf", std::move(any)}};
  }

  [[nodiscard]] Json key_schema(const Table& table, const Key& key) const {
    const std::string name = dotted(table.name, key.name);
    std::vector<const KeyForm*> forms;
    for (const KeyForm& form : key.forms) forms.push_back(&form);
    Json json = value_schema(name, forms);
    json["description"] = format_.meaning(name);
    const std::string& absent = key.forms.front().absent;
    if (!absent.empty() &&
        std::all_of(key.forms.begin(), key.forms.end(), [&](const KeyForm& form) { return form.absent == absent; }))
      json["default"] = literal(absent);
    return json;
  }

  [[nodiscard]] Json table_schema(const Table& table) const {
    Json properties = Json::object(), required = Json::array(), all = Json::array();
    for (const Key& key : table.keys) {
      properties[key.name] = key_schema(table, key);
      if (std::all_of(key.forms.begin(), key.forms.end(), [](const KeyForm& f) { return f.required; }) &&
          std::any_of(key.forms.begin(), key.forms.end(), [](const KeyForm& f) { return f.when.empty(); }))
        required.push_back(key.name);
    }
    for (const Key& key : table.keys)
      if (key.decides) add_variants(table, key, all);
    for (const Relation& relation : table.relations) all.push_back(relation_schema(table, relation));
    Json json = {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
    if (!all.empty()) json["allOf"] = std::move(all);
    demand(table, std::move(required), json);
    return json;
  }

  /// What each word of a deciding key changes in its own table.
  void add_variants(const Table& table, const Key& key, Json& all) const {
    const std::string name = dotted(table.name, key.name);
    std::set<std::string> told;
    for (const KeyForm& form : key.forms)
      for (const ValueShape& shape : form.shapes)
        for (const std::string& word : shape.words) {
          if (!told.insert(word).second) continue;
          Json then = changes(table, name, word, true);
          if (!then.empty())
            all.push_back({{"if", {{"properties", {{key.name, {{"const", word}}}}}, {"required", {key.name}}}},
                           {"then", std::move(then)}});
        }
  }

  /// What the keys of a table are where a deciding key has a word.
  /// @param own  the deciding key is one of this table: then all that depends on it is said
  [[nodiscard]] Json changes(const Table& table, const std::string& decides, const std::string& word, bool own) const {
    Json properties = Json::object(), required = Json::array();
    for (const Key& key : table.keys) {
      std::vector<const KeyForm*> left, all;
      bool depends = false;
      for (const KeyForm& form : key.forms) {
        all.push_back(&form);
        depends = depends ||
                  std::any_of(form.when.begin(), form.when.end(), [&](const Condition& c) { return c.key == decides; });
        if (admits(form, decides, word)) left.push_back(&form);
      }
      if (!depends) continue;
      const std::string name = dotted(table.name, key.name);
      if (left.empty()) {
        properties[key.name] = false;
        continue;
      }
      if (Json narrow = value_schema(name, left); narrow != value_schema(name, all))
        properties[key.name] = std::move(narrow);
      const bool needed = std::all_of(left.begin(), left.end(), [&](const KeyForm* form) {
        return form->required && std::all_of(form->when.begin(), form->when.end(), [&](const Condition& c) {
                 return c.key == decides || (own && implied(table, c, decides, word));
               });
      });
      if (needed) required.push_back(key.name);
    }
    Json json = Json::object();
    if (!properties.empty()) json["properties"] = std::move(properties);
    demand(table, std::move(required), json);
    return json;
  }

  /// Required keys; of a table that another file may complete only where it does not.
  static void demand(const Table& table, Json required, Json& json) {
    if (required.empty()) return;
    const auto supplied = std::find_if(table.relations.begin(), table.relations.end(), [](const Relation& r) {
      return r.relation.kind == toml::KeyRelation::Kind::supplies;
    });
    if (supplied == table.relations.end()) {
      json["required"] = std::move(required);
      return;
    }
    json["allOf"].push_back(
        {{"if", {{"not", {{"required", {supplied->relation.first}}}}}}, {"then", {{"required", std::move(required)}}}});
  }

  /// Does a word of one deciding key of a table exist only where another condition holds anyway?
  [[nodiscard]] bool implied(const Table& table, const Condition& condition, const std::string& decides,
                             const std::string& word) const {
    const Key* key = table.find(decides.substr(table.name.empty() ? 0 : table.name.size() + 1));
    if (!key) return false;
    return std::all_of(key->forms.begin(), key->forms.end(), [&](const KeyForm& form) {
      const bool has = std::any_of(form.shapes.begin(), form.shapes.end(), [&](const ValueShape& shape) {
        return std::find(shape.words.begin(), shape.words.end(), word) != shape.words.end();
      });
      return !has || std::any_of(form.when.begin(), form.when.end(), [&](const Condition& c) {
        return c.key == condition.key && std::all_of(c.words.begin(), c.words.end(), [&](const std::string& w) {
                 return std::find(condition.words.begin(), condition.words.end(), w) != condition.words.end();
               });
      });
    });
  }

  [[nodiscard]] Json relation_schema(const Table& table, const Relation& relation) const {
    const std::string &a = relation.relation.first, &b = relation.relation.second;
    const auto has = [](const std::string& key) { return Json{{"required", {key}}}; };
    Json json;
    switch (relation.relation.kind) {
      case toml::KeyRelation::Kind::one_of: json["oneOf"] = Json::array({has(a), has(b)}); break;
      case toml::KeyRelation::Kind::together:
        json["dependencies"] = {{a, Json::array({b})}, {b, Json::array({a})}};
        break;
      case toml::KeyRelation::Kind::needs: json["dependencies"] = {{a, Json::array({b})}}; break;
      case toml::KeyRelation::Kind::excludes: json["not"] = {{"required", {a, b}}}; break;
      case toml::KeyRelation::Kind::supplies: json["dependencies"] = {{a, Json::array({b})}}; break;
    }
    if (relation.when.empty()) return json;
    Json properties = Json::object(), required = Json::array();
    for (const Condition& c : relation.when) {
      if (!belongs(table, c.key)) throw std::logic_error(fmt::format("{} and {} depend on {}", a, b, c.key));
      const std::string key = c.key.substr(table.name.empty() ? 0 : table.name.size() + 1);
      properties[key] = {{"enum", c.words}};
      required.push_back(key);
    }
    return {{"if", {{"properties", std::move(properties)}, {"required", std::move(required)}}},
            {"then", std::move(json)}};
  }

  /// A schema of a table at its place in the file.
  [[nodiscard]] Json nested(const std::string& table, Json json) const {
    if (table.empty()) return json;
    const auto dot = table.rfind('.');
    const std::string above = dot == std::string::npos ? "" : table.substr(0, dot);
    const std::string name = dot == std::string::npos ? table : table.substr(dot + 1);
    const Key* key = format_.reference.find(above)->find(name);
    if (key->forms.front().shapes.front().kind == ValueKind::tables) json = {{"items", std::move(json)}};
    return nested(above, {{"properties", {{name, std::move(json)}}}});
  }

  /// What depends on a deciding key of another table is said at the file.
  void add_foreign(Json& file) const {
    std::set<std::string> deciding;
    for (const Table& table : format_.reference.tables)
      for (const Key& key : table.keys)
        for (const KeyForm& form : key.forms)
          for (const Condition& c : form.when)
            if (!belongs(table, c.key)) deciding.insert(c.key);
    for (const std::string& name : deciding) {
      const auto dot = name.rfind('.');
      const std::string owner = dot == std::string::npos ? "" : name.substr(0, dot);
      const std::string leaf = dot == std::string::npos ? name : name.substr(dot + 1);
      for (const KeyForm& form : format_.reference.find(owner)->find(leaf)->forms)
        for (const std::string& word : form.shapes.front().words) {
          Json then = Json::array();
          for (const Table& table : format_.reference.tables)
            if (!belongs(table, name))
              if (Json json = changes(table, name, word, false); !json.empty())
                then.push_back(nested(table.name, std::move(json)));
          Json condition = {{"properties", {{leaf, {{"const", word}}}}}, {"required", {leaf}}};
          Json at_file = nested(owner, std::move(condition));
          if (!owner.empty()) at_file["required"] = {owner};
          file["allOf"].push_back({{"if", std::move(at_file)}, {"then", {{"allOf", std::move(then)}}}});
        }
    }
  }

  const Format& format_;
};

/// Without an `$id`: Taplo takes absolute ones only, and where a schema lies nobody knows.
Json head(const char* title) { return {{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}}; }

}  // namespace

std::string job_schema() {
  const Format format = job_format();
  Json json = head("A job of Toothpath");
  json.update(Schema(format).file());
  return json_text(json, 1) + "\n";
}

std::string machine_schema() {
  const Format milling = milling_machine_format(), shaper = gear_shaper_format();
  Json json = head("A machine file of Toothpath");
  json["type"] = "object";
  json["required"] = {"kind"};
  json["properties"]["kind"] = {{"enum", {"five_axis", "gear_shaper"}}, {"description", milling.meaning("kind")}};
  json["if"] = {{"properties", {{"kind", {{"const", "gear_shaper"}}}}}};
  json["then"] = Schema(shaper).file();
  json["else"] = Schema(milling).file();
  return json_text(json, 1) + "\n";
}

}  // namespace toothpath::reference
