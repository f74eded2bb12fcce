// What --json carries beside the report: the data of the command.
#pragma once

#include <string>

#include "app/base/outcome.h"
#include "machines/toml/toml_tree.h"

namespace toothpath::app {

/// Puts a JSON text under a key of the outcome's JSON object. Nothing where there is none.
void add_data(CommandOutcome& outcome, const char* key, const std::string& json);

/// A TOML value as JSON text; dates are null.
[[nodiscard]] std::string json_of_toml(const toml::TomlValue& value);

}  // namespace toothpath::app
