#include "postproc/nc_dialect.h"

#include "postproc/dialects/dialects.h"

namespace toothpath {

std::vector<std::string> dialect_names() {
  std::vector<std::string> names;
  for (const auto make : kDialects) names.push_back(make().name);
  return names;
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
