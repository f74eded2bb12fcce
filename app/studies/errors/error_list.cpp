#include "app/studies/errors/error_list.h"

#include <algorithm>
#include <cmath>

#include "app/base/option_number.h"

namespace toothpath::errors {
namespace {

constexpr double kMostSize = 10000;
constexpr double kParallel = 1e-12;  // 1 - |cosine|
constexpr const char* kAssumed = "assumed";
// Draws: 0 is the tooth; of error kind k and rotary r those from kFirst + (2 k + r) * kStride.
constexpr std::uint64_t kFirst = 64, kStride = 4096;

bool is_ball(const tool::ToolAssembly& tool) { return tool.type == tool::CutterType::ball_end_mill; }

void add_rotary(std::vector<Error>& out, const machines::KinematicChain& chain, std::size_t k, const job::Job& job) {
  const std::string axis(1, chain.rotary(k).letter);
  const auto add = [&](Kind kind, const char* name, const char* unit, double size, const char* source,
                       const std::string& meaning) {
    out.push_back({kind, k, axis + "." + name, unit, size, source, meaning});
  };
  const auto stated = job.setup->pivot_error_mm;
  add(Kind::pivot, "pivot", "um", stated ? *stated * 1000 : 5, stated ? "setup.pivot_error" : kAssumed,
      "axis " + axis + " runs beside its place, across it");
  add(Kind::tilt, "tilt", "urad", 20, kAssumed, "direction of axis " + axis);
  if (index_rotary(chain, *job.setup) != k) {
    add(Kind::zero, "zero", "urad", 20, kAssumed, "zero of axis " + axis);
    add(Kind::scale, "scale", "urad/rad", 10, kAssumed, "axis " + axis + " turns by this more a radian");
  }
  add(Kind::wave, "wave", "urad", 15, kAssumed, "axis " + axis + " errs once a turn");
}

Vec3 any_across(const Vec3& d) {
  const Vec3 least = std::abs(d.x()) < 0.5 ? Vec3::UnitX() : Vec3::UnitY();
  return d.cross(least).normalized();
}

/// Two normal numbers across a direction.
Vec3 across(const Vec3& direction, double size, const samples::Numbers& numbers, std::uint64_t from) {
  const Vec3 one = any_across(direction), other = direction.cross(one);
  return size * (numbers.normal(from) * one + numbers.normal(from + 1) * other);
}

/// Of every tool by itself; the largest size.
double draw_tools(std::map<int, double>& out, const job::Job& job, double size, bool balls,
                  const samples::Numbers& numbers, std::uint64_t from) {
  double most = 0;
  for (const auto& tool : job.tools) {
    const double value = size * numbers.normal(from++);
    if (balls && !is_ball(tool)) continue;
    out[tool.number] = value / 1000;
    most = std::max(most, std::abs(value));
  }
  return most;
}

double draw_one(const Error& error, const machines::KinematicChain& chain, const job::Job& job,
                const samples::Numbers& numbers, Drawn& out) {
  // Draws stand in pairs behind a normal number: half the place of the first.
  const std::uint64_t from = (kFirst + (2 * std::uint64_t(error.kind) + error.rotary) * kStride) / 2;
  machines::RotaryErrors& rotary = out.machine.rotary[error.rotary];
  const auto scalar = [&](double& value) {
    const double drawn = error.size * numbers.normal(from);
    value = drawn * 1e-6;
    return std::abs(drawn);
  };
  const auto vector = [&](Vec3& value, const Vec3& direction, double unit) {
    const Vec3 drawn = across(direction, error.size, numbers, from);
    value = drawn * unit;
    return drawn.norm();
  };
  switch (error.kind) {
    case Kind::pivot: return vector(rotary.point_mm, chain.rotary(error.rotary).direction, 1e-3);
    case Kind::tilt: return vector(rotary.tilt_rad, chain.rotary(error.rotary).direction, 1e-6);
    case Kind::zero: return scalar(rotary.zero_rad);
    case Kind::scale: return scalar(rotary.scale);
    case Kind::wave: rotary.wave_phase_rad = 2 * kPi * numbers.share(2 * from + 2); return scalar(rotary.wave_rad);
    case Kind::square_xy: return scalar(out.machine.square_xy_rad);
    case Kind::square_xz: return scalar(out.machine.square_xz_rad);
    case Kind::square_yz: return scalar(out.machine.square_yz_rad);
    case Kind::spindle_tilt: return vector(out.machine.spindle_tilt_rad, Vec3::UnitZ(), 1e-6);
    case Kind::tool_length: return draw_tools(out.longer_mm, job, error.size, false, numbers, from);
    case Kind::tool_radius: return draw_tools(out.radius_mm, job, error.size, true, numbers, from);
  }
  return 0;
}

}  // namespace

std::optional<std::size_t> index_rotary(const machines::KinematicChain& chain, const joints::Setup& setup) {
  if (chain.table.empty()) return std::nullopt;
  const double cosine = chain.table[0].direction.dot(setup.rotation().col(2));
  return 1 - std::abs(cosine) < kParallel ? std::optional<std::size_t>(0) : std::nullopt;
}

std::vector<Error> errors_of(const machines::Machine& machine, const job::Job& job) {
  std::vector<Error> out;
  for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k) add_rotary(out, machine.chain, k, job);
  out.push_back({Kind::square_xy, 0, "square.XY", "urad", 15, kAssumed, "X and Y are not square"});
  out.push_back({Kind::square_xz, 0, "square.XZ", "urad", 15, kAssumed, "X and Z are not square"});
  out.push_back({Kind::square_yz, 0, "square.YZ", "urad", 15, kAssumed, "Y and Z are not square"});
  out.push_back({Kind::spindle_tilt, 0, "spindle.tilt", "urad", 15, kAssumed, "direction of the spindle"});
  out.push_back(
      {Kind::tool_length, 0, "tool.length", "um", 5, kAssumed, "length of every tool since it was touched off"});
  double form_mm = 0;
  for (const auto& tool : job.tools)
    if (is_ball(tool)) form_mm = std::max(form_mm, tool.form_error_mm.value_or(0));
  if (std::any_of(job.tools.begin(), job.tools.end(), is_ball))
    out.push_back({Kind::tool_radius, 0, "tool.radius", "um", form_mm > 0 ? form_mm * 1000 : 3,
                   form_mm > 0 ? "tool.form_error" : kAssumed, "radius of every ball"});
  return out;
}

Status set_sizes(std::vector<Error>& errors, const std::vector<std::string>& given, bool only) {
  if (only)
    for (Error& error : errors) error.size = 0;
  for (const std::string& text : given) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const auto found = std::find_if(errors.begin(), errors.end(), [&](const Error& e) { return e.name == name; });
    if (equals == std::string::npos || found == errors.end()) {
      std::string names;
      for (const Error& error : errors) names += (names.empty() ? "" : ", ") + error.name;
      return fail_as(DiagnosticKind::usage, "--error {}: not NAME=SIZE of an error of this machine: {}", text, names);
    }
    const auto size =
        app::read_number("--error", std::string_view(text).substr(equals + 1), {0, kMostSize, found->unit.c_str()});
    if (!size) return size.error();
    found->size = *size;
    found->source = "--error";
  }
  std::erase_if(errors, [](const Error& error) { return error.size == 0; });
  if (errors.empty()) return fail_as(DiagnosticKind::usage, "no error is left: name one with --error NAME=SIZE");
  return Ok{};
}

Drawn draw(const std::vector<Error>& errors, std::optional<std::size_t> which, const machines::KinematicChain& chain,
           const job::Job& job, const samples::Numbers& numbers) {
  Drawn out;
  for (std::size_t k = 0; k < errors.size(); ++k)
    if (!which || *which == k) out.magnitude = draw_one(errors[k], chain, job, numbers, out);
  if (!which) out.magnitude = 0;
  return out;
}

}  // namespace toothpath::errors
