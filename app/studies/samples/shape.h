// A value of JSON against a model of it: a file that somebody damaged or edited is refused before it is taken apart.
#pragma once

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

namespace toothpath::samples {

/// The first place where `json` lacks what the model has, in words; empty: nowhere. An object may have further keys. A
/// list of one object stands for a list of any length, its entries like that one; other lists have the length of the
/// model. A whole number of the model is one that fits an int.
template <typename Json>
[[nodiscard]] std::string shape_fault(const Json& model, const Json& json, const std::string& where) {
  const auto is_no = [&](const char* needed) {
    return fmt::format("\"{}\" is {}; {} is needed", where, json.type_name(), needed);
  };
  if (model.is_object()) {
    if (!json.is_object()) return where.empty() ? "this is no JSON object" : is_no("an object");
    for (const auto& [key, value] : model.items()) {
      const std::string place = where.empty() ? key : where + "." + key;
      if (!json.contains(key)) return fmt::format("\"{}\" is missing", place);
      if (std::string fault = shape_fault(value, json[key], place); !fault.empty()) return fault;
    }
  } else if (model.is_array()) {
    if (!json.is_array()) return is_no("a list");
    const bool any_length = model.size() == 1 && model[0].is_object();
    if (!any_length && json.size() != model.size())
      return fmt::format("\"{}\" has {} entries, not {}", where, json.size(), model.size());
    for (std::size_t k = 0; k < json.size(); ++k)
      if (std::string fault = shape_fault(model[any_length ? 0 : k], json[k], fmt::format("{}[{}]", where, k));
          !fault.empty())
        return fault;
  } else if (model.is_string()) {
    if (!json.is_string()) return is_no("a text");
  } else if (model.is_boolean()) {
    if (!json.is_boolean()) return is_no("true or false");
  } else if (model.is_number_unsigned()) {
    if (!json.is_number_unsigned()) return is_no("a whole number from 0");
  } else if (model.is_number_integer()) {
    if (!json.is_number_integer() || json.template get<double>() > std::numeric_limits<int>::max() ||
        json.template get<double>() < std::numeric_limits<int>::min())
      return is_no("a whole number that fits 32 bits");
  } else if (!json.is_number()) {
    return is_no("a number");
  }
  return {};
}

}  // namespace toothpath::samples
