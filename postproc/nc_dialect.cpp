#include "postproc/nc_dialect.h"

#include <algorithm>
#include <charconv>
#include <optional>

#include "postproc/dialects/dialects.h"

namespace toothpath {

std::vector<std::string> dialect_names() {
  std::vector<std::string> names;
  for (const auto make : kDialects) names.push_back(make().name);
  return names;
}

std::vector<std::string> program_extensions() {
  std::vector<std::string> extensions;
  for (const auto make : kDialects)
    if (const std::string e = make().extension; std::find(extensions.begin(), extensions.end(), e) == extensions.end()) extensions.push_back(e);
  return extensions;
}

Result<NcDialect> find_dialect(std::string_view name) {
  std::string list;
  for (const auto make : kDialects) {
    NcDialect d = make();
    if (d.name == name) return d;
    list += (list.empty() ? "\"" : ", \"") + d.name + "\"";
  }
  return fail("dialect = \"{}\" is not one of {}", name, list);
}

namespace {

/// n of "Mn", one to three digits without a leading zero; -1: another text.
int m_number(std::string_view word) {
  int n = -1;
  if (word.size() < 2 || word.size() > 4 || word[0] != 'M' || (word[1] == '0' && word.size() > 2)) return -1;
  const auto [end, error] = std::from_chars(word.data() + 1, word.data() + word.size(), n);
  return error == std::errc() && end == word.data() + word.size() && n >= 0 ? n : -1;
}

/// What is wrong with a word of the builder; nothing: it can switch a coolant.
std::optional<std::string> word_fault(const std::string& word, const Machine& machine, const NcDialect& d) {
  const int n = m_number(word);
  if (n < 0) return fmt::format("\"{}\" is no M word such as M7", word);
  for (const auto& [first, last] : d.own_m)
    if (n >= first && n <= last) return fmt::format("{} means something else to dialect \"{}\"", word, d.name);
  for (const auto* codes : {&machine.post.tcp_on, &machine.post.tcp_off, &machine.post.smoothing_on, &machine.post.smoothing_off})
    if (std::find(codes->begin(), codes->end(), word) != codes->end()) return fmt::format("{} is a code of TCP or smoothing in this file", word);
  return std::nullopt;
}

/// The words of the builder for coolants.
Status take_coolants(const Machine& machine, NcDialect& d) {
  for (const auto& [coolant, words] : machine.post.coolant) {
    const std::string key = fmt::format("post.coolant_{}", to_string(coolant));
    const SourcePosition where = machine.where(key);
    if (!d.takes_coolant) return fail_at(where, "{}: dialect \"{}\" has words of its own and no others", key, d.name);
    for (const std::string& word : {words.on, words.off})
      if (const auto fault = word_fault(word, machine, d)) return fail_at(where, "{}: {}", key, *fault);
    d.coolant[coolant] = words;
  }
  for (const auto& [coolant, words] : machine.post.coolant)
    for (const auto& other : d.coolant)
      if (words.on == other.second.off)
        return fail_at(machine.where(fmt::format("post.coolant_{}", to_string(coolant))), "post.coolant_{}: {} switches {} off",
                       to_string(coolant), words.on, to_string(other.first));
  return Ok{};
}

}  // namespace

Result<CoolantWords> coolant_words(const NcDialect& dialect, Coolant coolant) {
  const auto found = dialect.coolant.find(coolant);
  if (found != dialect.coolant.end()) return found->second;
  std::string list;
  for (const auto& [other, words] : dialect.coolant) list += (list.empty() ? "" : ", ") + std::string(to_string(other));
  const std::string help = dialect.takes_coolant ? fmt::format("; post.coolant_{} = [\"M..\", \"M..\"] in the machine file gives those of the builder, on and off",
                                                               to_string(coolant))
                                                 : std::string();
  return fail("mode = \"{}\": dialect \"{}\" has words for {} alone{}", to_string(coolant), dialect.name, list, help);
}

Result<NcDialect> dialect_of(const Machine& machine) {
  auto d = find_dialect(machine.dialect);
  if (!d) return d;
  d->format.linear_decimals = machine.post.linear_decimals.value_or(d->format.linear_decimals);
  d->format.rotary_decimals = machine.post.rotary_decimals.value_or(d->format.rotary_decimals);
  for (const int digits : {d->format.linear_decimals, d->format.rotary_decimals})
    if (digits < 1 || digits > 7) return fail("{} decimals in a word of the machine: 1 to 7 are possible", digits);
  if (d->exact_path_mm > 0) d->exact_path_mm = machine.exact_corner_mm();
  if (!machine.post.tcp_on.empty()) d->tcp_on = machine.post.tcp_on;
  if (!machine.post.tcp_off.empty()) {
    d->tcp_off = machine.post.tcp_off;
    if (!d->tcp_starts_at_zero) d->safe_start.insert(d->safe_start.end(), d->tcp_off.begin(), d->tcp_off.end());
  }
  if (machine.tcp != TcpMode::none && (d->tcp_on.empty() || d->tcp_off.empty()))
    return fail("machine \"{}\": dialect \"{}\" has no TCP: tcp = \"none\" (joint output) is supported", machine.name, d->name);
  if (!machine.post.smoothing_on.empty()) {
    if (!d->takes_smoothing)
      return fail("machine \"{}\": post.smoothing_on: dialect \"{}\" has its own words for what may be left of corners", machine.name, d->name);
    if (machine.post.smoothing_off.empty() || !machine.post.smoothing_tolerance_mm)
      return fail("machine \"{}\": post.smoothing_on needs post.smoothing_off and post.smoothing_tolerance", machine.name);
    d->smoothing_on = machine.post.smoothing_on;
    d->smoothing_off = machine.post.smoothing_off;
    d->smoothing_mm = *machine.post.smoothing_tolerance_mm;
    d->smoothing_axis_rad = machine.post.smoothing_axis_tolerance_rad;
    d->blend = false;
    std::erase_if(d->start, [](const std::string& line) { return line.find("{blend}") != std::string::npos; });
  }
  if (auto taken = take_coolants(machine, *d); !taken) return taken.error();
  for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k)
    if (machine.chain.rotary(k).rollover && d->rollover.way == NcRollover::Way::none && d->write == nullptr)
      return fail("machine \"{}\": axes.{}.rollover: dialect \"{}\" has no words for an axis that rolls over", machine.name, machine.chain.rotary(k).letter,
                  d->name);
  if (machine.tcp == TcpMode::vectors && d->vector_words[0].empty())
    return fail("machine \"{}\": dialect \"{}\" has no tool vectors: tcp = \"none\" and \"angles\" are supported", machine.name, d->name);
  return d;
}

AxisOptions axis_options(const NcDialect& dialect, const Machine& machine) {
  AxisOptions options;
  options.format = dialect.format;
  options.max_inverse_time = dialect.max_inverse_time;
  options.loop_needs_constant_index = dialect.loop.form == NcLoop::Form::stretches || !dialect.loop.index_line.empty();
  options.expand_teeth = !machine.post.index_loop.value_or(true) || dialect.loop.form == NcLoop::Form::none;
  options.tcp_starts_at_zero = dialect.tcp_starts_at_zero;
  options.tcp_loop = !dialect.loop.frame_on.empty();
  return options;
}

}  // namespace toothpath
