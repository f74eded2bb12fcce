#include "app/rexs/quantities.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "geometry/base/printable.h"

namespace toothpath::rexs {
namespace {

const char* word_of(Unit unit) { return unit == Unit::mm ? "mm" : unit == Unit::deg ? "deg" : "none"; }

bool is_unit(const Attribute& attribute, Unit unit) {
  if (!attribute.states_unit) return true;  // that of the schema
  const std::string& word = attribute.unit;
  switch (unit) {
    case Unit::mm: return word == "mm";
    case Unit::deg: return word == "deg" || word == "\xC2\xB0";
    case Unit::none: return word.empty() || word == "none";
  }
  return false;
}

}  // namespace

std::optional<double> Quantities::number_of(const Attribute& attribute, const std::string& text) const {
  double value = 0;
  std::string_view digits = text;
  if (digits.starts_with('+')) digits.remove_prefix(1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc{} && end == digits.data() + digits.size() && std::isfinite(value)) return value;
  refused_.add(attribute.at, "{} of {} is \"{}\", no finite number", attribute.id, component_.title(),
               printable(text.substr(0, 60)));
  return {};
}

std::optional<double> Quantities::optional(const char* id, Unit unit, const toml::Range& range) const {
  const Attribute* found = component_.find(id);
  if (!found) return {};
  if (!is_unit(*found, unit)) {
    refused_.add(found->at, "{} of {} is in \"{}\"; its unit in REXS is {}", id, component_.title(),
                 printable(found->unit), word_of(unit));
    return {};
  }
  const auto value = number_of(*found, found->text);
  if (!value) return {};
  const bool inside = (range.open_low ? *value > range.low : *value >= range.low) &&
                      (range.open_high ? *value < range.high : *value <= range.high);
  if (inside) return value;
  refused_.add(found->at, "{} = {:.10g} of {} is outside {:g} to {:g}{}", id, *value, component_.title(), range.low,
               range.high, range.unit);
  return {};
}

double Quantities::number(const char* id, Unit unit, const toml::Range& range) const {
  if (!component_.find(id)) missing(id);
  return optional(id, unit, range).value_or(range.high);
}

int Quantities::whole(const char* id, const toml::Range& range) const {
  const double value = number(id, Unit::none, range);
  if (value != std::floor(value))
    refused_.add(at_of(component_, id), "{} = {:.10g} of {} is no whole number", id, value, component_.title());
  return static_cast<int>(value);
}

std::optional<std::string> Quantities::word(const char* id) const {
  const Attribute* found = component_.find(id);
  return found ? std::optional(found->text) : std::nullopt;
}

std::vector<double> Quantities::list(const char* id) const {
  std::vector<double> out;
  const Attribute* found = component_.find(id);
  if (!found) return out;
  if (found->coded) {
    refused_.add(found->at, "{} of {} is coded; an array of plain numbers <c>..</c> is needed", id, component_.title());
    return out;
  }
  for (const std::string& cell : found->cells)
    if (const auto value = number_of(*found, cell)) out.push_back(*value);
  if (found->cells.empty() && !found->text.empty())
    if (const auto value = number_of(*found, found->text)) out.push_back(*value);
  return out;
}

void Quantities::must_be_zero(const char* id, const char* why) const {
  const std::vector<double> values = list(id);
  const auto other = std::find_if(values.begin(), values.end(), [](double v) { return v != 0; });
  if (other != values.end())
    refused_.add(at_of(component_, id), "{} = {:.10g} of {} must be 0: {}", id, *other, component_.title(), why);
}

void Quantities::missing(const char* id, const char* what) const {
  refused_.add(component_.at, "{} lacks {}{}{}", component_.title(), id, *what ? ": " : "", what);
}

}  // namespace toothpath::rexs
