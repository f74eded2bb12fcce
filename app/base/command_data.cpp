#include "app/base/command_data.h"

#include <nlohmann/json.hpp>

#include "app/report/svg/html_text.h"
#include "geometry/base/json_text.h"

namespace toothpath::app {
namespace {

using Json = nlohmann::ordered_json;

Json json_value(const toml::TomlValue& value) {
  if (const auto* flag = std::get_if<bool>(&value.data)) return *flag;
  if (const auto* whole = std::get_if<std::int64_t>(&value.data)) return *whole;
  if (const auto* real = std::get_if<double>(&value.data)) return *real;
  if (const std::string* text = value.text()) return svg::valid_utf8(*text);
  if (const toml::TomlArray* array = value.array()) {
    Json list = Json::array();
    for (const toml::TomlValue& entry : array->values) list.push_back(json_value(entry));
    return list;
  }
  if (const toml::TomlTable* table = value.table()) {
    Json object = Json::object();
    for (const toml::TomlEntry& entry : table->entries) object[svg::valid_utf8(entry.key)] = json_value(entry.value);
    return object;
  }
  return nullptr;
}

}  // namespace

void add_data(CommandOutcome& outcome, const char* key, const std::string& json) {
  if (outcome.report_json.empty()) return;
  Json report = Json::parse(outcome.report_json);
  report[key] = Json::parse(json);
  outcome.report_json = json_text(report, 2) + "\n";
}

std::string json_of_toml(const toml::TomlValue& value) { return json_text(json_value(value), 2); }

}  // namespace toothpath::app
