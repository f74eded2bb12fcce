#include "geometry/exchange/step_text.h"

#include <iterator>

namespace toothpath::exchange {
namespace {

/// A coordinate: 1e-7 mm is a tenth of a nanometre.
std::string length(double value) {
  std::string text = fmt::format("{:.7f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  return text == "-0." ? "0." : text;
}

}  // namespace

std::string real(double value) {
  std::string text = fmt::format("{:.15G}", value);
  if (text.find('.') != std::string::npos) return text;
  const std::size_t exponent = text.find('E');
  text.insert(exponent == std::string::npos ? text.size() : exponent, ".");
  return text;
}

std::string quoted(std::string_view text) {
  std::string out = "'";
  for (const char c : text) {
    if (c == '\'') out += "''";
    else if (c == '\\') out += "\\\\";
    else if (c >= ' ' && c <= '~') out += c;
    else out += fmt::format("\\X\\{:02X}", static_cast<unsigned char>(c));
  }
  return out + "'";
}

std::string references(std::span<const StepId> ids) {
  std::string out = "(";
  for (const StepId id : ids) {
    if (out.size() > 1) out += ',';
    out += '#';
    out += std::to_string(id);
  }
  return out + ")";
}

StepId StepText::point(const Vec3& p) {
  return add("CARTESIAN_POINT('',({},{},{}))", length(p.x()), length(p.y()), length(p.z()));
}

StepId StepText::direction(const Vec3& d) {
  return add("DIRECTION('',({},{},{}))", real(d.x()), real(d.y()), real(d.z()));
}

StepId StepText::placement(const Vec3& origin, const Vec3& axis, const Vec3& x) {
  const StepId at = point(origin), along = direction(axis), across = direction(x);
  return add("AXIS2_PLACEMENT_3D('',#{},#{},#{})", at, along, across);
}

std::string StepText::file(std::string_view name, std::string_view program) const {
  std::string out = "ISO-10303-21;\nHEADER;\n";
  out += fmt::format("FILE_DESCRIPTION(({}),'2;1');\n", quoted("one gear as a solid of exact teeth"));
  // No time: the same gear gives the same bytes.
  out += fmt::format("FILE_NAME({},'1970-01-01T00:00:00',(''),(''),{},{},'');\n", quoted(name), quoted(program),
                     quoted(program));
  out += "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n";
  out += body_;
  out += "ENDSEC;\nEND-ISO-10303-21;\n";
  return out;
}

}  // namespace toothpath::exchange
