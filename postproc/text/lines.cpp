#include "postproc/text/lines.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "machines/assumed.h"
#include "postproc/joints/tooth_order.h"
#include "postproc/numbers/comment.h"
#include "postproc/numbers/fixed_point.h"
#include "postproc/text/corners.h"
#include "postproc/text/writer.h"

namespace toothpath::text {
namespace {

constexpr std::size_t kLongestName = 24, kNameLength = 32;  // as a name of a program; behind its number
constexpr std::size_t kLongestHeader = 20;                  // lines
constexpr double kFreeFeed = 1000;                          // F that goes with G94 where nothing is cut, mm/min

std::string unsigned_text(double value, int decimals, const NcDialect& dialect) {
  std::string text;
  numbers::append_fixed(text, numbers::to_fixed(value, decimals), decimals, dialect.point_always);
  return text;
}

/// Characters of a comment in one line.
std::size_t comment_width(const NcDialect& dialect) {
  return dialect.max_line - dialect.comment_open.size() - dialect.comment_close.size();
}

/// With TCP the zero of a rotary moves, and the frame with it.
bool zero_turns_frame(const joints::AxisProgram& program, const NcDialect& dialect) {
  const auto asks = [](const joints::AxisOperation& op) {
    return std::any_of(op.teeth.begin(), op.teeth.end(), [](const auto& tooth) { return tooth.zero_deg.has_value(); });
  };
  return dialect.loop.zero_turns_frame && program.tcp != machines::TcpMode::none &&
         (program.loop || std::any_of(program.operations.begin(), program.operations.end(), asks));
}

}  // namespace

void set_corner_values(NcLines::Values& values, const CornerWords& corners, const joints::AxisProgram& program,
                       const NcDialect& dialect) {
  values["blend"] = unsigned_text(corners.blend_mm, 6, dialect);
  values["blend_axis"] = unsigned_text(corners.axis_deg, 4, dialect);
  values["roughs"] = corners.wide ? "1" : "0";
  values["cut"] = corners.wide ? "ROUGH" : "FINISH";
  const bool tcp = program.tcp != machines::TcpMode::none;
  values["finish"] = expanded(dialect.contour_finish[tcp ? 1 : 0], values).value_or("");
}

NcLines::Values program_values(const joints::AxisProgram& program, const NcDialect& dialect, const NcHeader& header) {
  const auto unsigned_value = [&](double v, int decimals) { return unsigned_text(v, decimals, dialect); };
  NcLines::Values values;
  values["number"] = std::to_string(header.program_number);
  values["name"] = numbers::first_words(numbers::comment_text(header.job_name), kNameLength);
  values["id"] = program_id(header.job_name, header.name_end);
  values["offset"] = program.work_offset;
  if (dialect.datum != nullptr) values["datum"] = std::to_string(dialect.datum(program.work_offset));
  const CornerWords corners = corner_words(program, dialect, header);
  set_corner_values(values, corners, program, dialect);
  values["radius"] = unsigned_value(corners.radius_mm, 0);
  for (const char letter : program.letters)
    if (letter != 0) values["axes"] += (values["axes"].empty() ? "" : ",") + std::string(1, letter);
  if (program.index_axis >= 0)
    values["index_axis"] = std::string(1, program.letters[static_cast<std::size_t>(program.index_axis)]);
  for (const char letter : program.letters)
    if (letter != 0)
      values["zeros"] += fmt::format("{}{}{}", values["zeros"].empty() ? "" : " ", letter, unsigned_value(0, 0));
  if (!dialect.loop.index_offset.empty()) {
    values["index_offset"] = dialect.loop.index_offset;
    values["index_datum"] = std::to_string(dialect.offset_number(dialect.loop.index_offset));
    const int origin = dialect.origin_parameter(dialect.offset_number(program.work_offset));
    for (const char letter : program.letters)
      if (letter != 0)
        values["origins"] += fmt::format("{}{}#{}", values["origins"].empty() ? "" : " ", letter,
                                         origin + static_cast<int>(std::string_view("XYZABC").find(letter)));
  }
  values["free"] = unsigned_value(kFreeFeed, 0);
  values["teeth"] = std::to_string(program.teeth);
  values["stride"] = std::to_string(program.tooth_stride);
  values["counters"] =
      program.tooth_stride == 1 ? dialect.loop.place : fmt::format("{},{}", dialect.loop.place, dialect.loop.tooth);
  values["tooth"] = program.tooth_stride == 1 ? dialect.loop.place : dialect.loop.tooth;
  values["sign"] = program.index_sign < 0 ? "0-" : "";
  const bool rolls_back = program.index_axis >= 0 && program.rollover[static_cast<std::size_t>(program.index_axis)] &&
                          program.index_sign < 0;
  if (!rolls_back) values["turns"] = values["sign"] + values["tooth"];
  else if (const auto turns = expanded(dialect.rollover.backwards, values); turns && !turns->empty())
    values["turns"] = *turns;
  values["frame_sign"] = program.frame_sign < 0 ? "0-" : "";
  return values;
}

std::vector<std::string> header_comments(const joints::AxisProgram& program, const NcDialect& dialect,
                                         const NcHeader& header, std::string_view hash) {
  std::vector<std::string> out = {numbers::comment_text("JOB " + header.job_name)};
  if (!header.job_hash.empty()) out.push_back(numbers::comment_text("JOB FILE " + header.job_hash));
  out.push_back(numbers::comment_text("MACHINE " + header.machine_name));
  out.emplace_back(hash);
  out.emplace_back("TOOL LENGTHS RUN FROM THE GAUGE LINE TO THE TIP");
  const auto at = [&](int i) {
    const std::int64_t scaled = numbers::to_fixed(program.work_offset_at_mm[i], 4);
    std::string s = dialect.sign_always && scaled >= 0 ? "+" : "";
    numbers::append_fixed(s, scaled, 4, dialect.point_always);
    return s;
  };
  out.push_back(fmt::format("WORK OFFSET {} AT X{} Y{} Z{} MM MACHINE", program.work_offset, at(0), at(1), at(2)));
  if (!dialect.blend && dialect.exact_path_mm > 0) {
    const std::int64_t corner = numbers::to_fixed(dialect.exact_path_mm, 6);
    std::string within, product;
    numbers::append_fixed(within, corner, 6, false);
    numbers::append_fixed(product, 4 * corner, 6, false);
    out.push_back(fmt::format("CORNERS WITHIN {} MM: TOOL ACCELERATION X SERVO PERIOD SQUARED IS AT MOST {} MM", within,
                              product));
  }
  if (header.contour_granted) {
    const CornerWords corners = corner_words(program, dialect, header);
    std::string within;
    numbers::append_fixed(within, numbers::to_fixed(corners.granted_mm, 6), 6, false);
    out.push_back(fmt::format("CONTOUR TOLERANCE {} MM, A SHARE OF WHAT THE PROOF LEAVES", within));
  }
  if (dialect.corner_mm > 0) {
    std::string within;
    numbers::append_fixed(within, numbers::to_fixed(dialect.corner_mm, 6), 6, false);
    out.push_back(
        fmt::format("{} LEAVES CORNERS BY AT MOST {} MM: STATED IN THE MACHINE FILE", dialect.corner_flow, within));
  }
  if (program.loop && program.tcp != machines::TcpMode::none && !dialect.loop.index_offset.empty())
    out.push_back(
        fmt::format("{} IS OVERWRITTEN AND TURNED TO THE TEETH; LINEAR_UNITS MUST BE MM", dialect.loop.index_offset));
  if (program.tcp != machines::TcpMode::none)
    for (const std::string& note : dialect.tcp_notes) out.push_back(numbers::comment_text(note));
  if (zero_turns_frame(program, dialect)) out.push_back(numbers::comment_text(dialect.loop.zero_note));
  for (std::size_t a = 3; a < 5; ++a)
    if (program.rollover[a]) {
      const auto note = expanded(dialect.rollover.note, {{"axis", std::string(1, program.letters[a])}});
      out.push_back(
          numbers::comment_text(note.value_or(dialect.rollover.note)));  // a name that does not exist stays visible
    }
  if (!dialect.blank.empty() && !header.blank && !header.no_blank.empty())
    out.push_back(numbers::comment_text(header.no_blank));
  for (auto& line : order_comments(program)) out.push_back(std::move(line));
  for (auto& line : assumed_comments(header.assumed, dialect, dialect.frame_begin.size() + out.size()))
    out.push_back(std::move(line));
  return out;
}

std::vector<std::string> assumed_comments(const std::vector<std::string>& assumed, const NcDialect& dialect,
                                          std::size_t ahead) {
  if (assumed.empty()) return {};
  std::vector<std::string> out = {"WARNING, ASSUMED AND NOT MEASURED:"};
  const std::size_t room = ahead + 2 < kLongestHeader ? kLongestHeader - ahead - 1 : 1;
  const std::vector<std::string> groups = machines::grouped_keys(assumed);
  const std::size_t width = comment_width(dialect);
  std::vector<std::string> lines;
  for (const auto& g : groups)
    for (auto& line : numbers::lines_of_words(numbers::comment_text("ASSUMED " + g), width))
      lines.push_back(std::move(line));
  if (lines.size() <= room) {
    out.insert(out.end(), lines.begin(), lines.end());
    return out;
  }
  std::vector<std::string> packed;
  std::vector<std::size_t> held;  // groups of a line
  for (const auto& g : groups) {
    const std::string text = numbers::comment_text(g);
    if (!packed.empty() && packed.back().size() + 2 + text.size() <= width) {
      packed.back() += "; " + text;
      ++held.back();
    } else {
      for (auto& line : numbers::lines_of_words("ASSUMED " + text, width)) packed.push_back(std::move(line));
      held.resize(packed.size(), 0);
      ++held.back();
    }
  }
  if (packed.size() > room) {
    std::size_t left = 0;
    for (std::size_t i = room - 1; i < held.size(); ++i) left += held[i];
    packed.resize(room - 1);
    packed.push_back(fmt::format("AND {} LINES MORE: THE SET-UP SHEET HAS THEM ALL", left));
  }
  out.insert(out.end(), packed.begin(), packed.end());
  return out;
}

namespace {

/// Tools that do not last, and who goes on.
std::vector<std::string> life_comments(const joints::AxisProgram& program) {
  constexpr std::size_t kMostNamed = 8;  // a line of some controls has 64 characters
  std::vector<std::string> out;
  for (const joints::ToolUse& use : program.tool_uses) {
    if (use.sister_of != 0) continue;
    std::vector<std::string> sisters;
    for (const joints::ToolUse& other : program.tool_uses)
      if (other.sister_of == use.tool) sisters.push_back(fmt::format("T{}", other.tool));
    std::string then = sisters.empty() ? "" : fmt::format(", THEN {}", fmt::join(sisters, ", "));
    if (sisters.size() > kMostNamed) then = fmt::format(", THEN ITS {} SISTERS", sisters.size());
    out.push_back(fmt::format("T{} CUTS FOR {:g} MIN{}", use.tool, use.life_min, then));
  }
  return out;
}

}  // namespace

std::vector<std::string> order_comments(const joints::AxisProgram& program) {
  std::vector<std::string> out;
  if (program.tooth_stride != 1)
    out.push_back(
        fmt::format("TOOTH ORDER SPREAD: PLACE N CUTS TOOTH N * {} MOD {}", program.tooth_stride, program.teeth));
  if (program.restart) {
    out.push_back(fmt::format("RESTART AT OPERATION {} TOOTH {}", program.restart->operation, program.restart->tooth));
    out.emplace_back("WHAT THE WHOLE PROGRAM CUTS BEFORE THAT IS TAKEN AS DONE");
  }
  if (const auto& part = program.part) {
    out.push_back(fmt::format("PART {} OF {}: OPERATION {}, {}", part->number, part->count, part->operation,
                              teeth_text(program, part->first_place, part->end_place)));
    if (part->number > 1) out.emplace_back("WHAT THE PARTS BEFORE CUT IS TAKEN AS DONE");
  }
  for (auto& line : life_comments(program)) out.push_back(std::move(line));
  if (program.restart || program.part) {
    const bool timed = program.has_acceleration;
    out.push_back(fmt::format("RUN TIME {:.2f} MIN, {:.2f} MIN OF IT CUTTING{}",
                              (timed ? program.accelerated.feed + program.accelerated.rapid : program.minutes) +
                                  program.clamp_minutes + program.check_minutes,
                              timed ? program.accelerated.feed : program.feed_minutes,
                              timed ? "" : ", WITHOUT ACCELERATIONS"));
  }
  return out;
}

std::string teeth_text(const joints::AxisProgram& program, int first_place, int end_place) {
  const char* what = program.tooth_stride == 1 ? "TEETH" : "PLACES";
  if (end_place - first_place == program.teeth) return "ALL TEETH";
  if (end_place - first_place == 1)
    return fmt::format("TOOTH {}", joints::tooth_of_place(first_place, program.tooth_stride, program.teeth));
  return fmt::format("{} {} TO {}", what, first_place, end_place - 1);
}

std::string first_tooth_comment(const joints::AxisProgram& program, const joints::AxisOperation& operation) {
  const int first = operation.end_place < 0 && !program.part ? 0 : operation.first_place;
  const int last = operation.end_of(program.teeth) - 1;
  if (program.tooth_stride == 1) return fmt::format("FIRST TOOTH, {} TO {}", first, last);
  return fmt::format("FIRST TOOTH BY ITS PLACE, {} TO {}: TOOTH = PLACE * {} MOD {}", first, last, program.tooth_stride,
                     program.teeth);
}

void NcLines::line(std::string_view text) {
  text_ += text;
  end_line(text_.size() - text.size(), !text.starts_with(dialect_.comment_open));
}

void NcLines::comment(std::string_view text) {
  const std::size_t begin = text_.size();
  text_ += dialect_.comment_open;
  text_ += numbers::first_words(text, comment_width(dialect_));
  text_ += dialect_.comment_close;
  end_line(begin, false);
}

std::optional<std::string> expanded(std::string_view pattern, const NcLines::Values& values) {
  std::string text;
  for (std::size_t i = 0; i < pattern.size();) {
    const std::size_t open = pattern.find('{', i);
    if (open == std::string_view::npos) return text.append(pattern.substr(i));
    text.append(pattern.substr(i, open - i));
    const std::size_t close = pattern.find('}', open);
    const auto found =
        close == std::string_view::npos ? values.end() : values.find(pattern.substr(open + 1, close - open - 1));
    if (found == values.end()) return std::nullopt;
    text += found->second;
    i = close + 1;
  }
  return text;
}

void NcLines::fill(const NcLinesOfText& templates, const Values& values) {
  for (const std::string& pattern : templates) {
    const auto text = expanded(pattern, values);
    if (text) line(*text);
    else if (!error_)
      error_ = fail("dialect {}: \"{}\" names a value that does not exist here", dialect_.name, pattern);
  }
}

void NcLines::end_line(std::size_t begin, bool block) {
  if (block && next_number_ >= 0) {
    text_.insert(begin, fmt::format("N{} ", next_number_));
    next_number_ = -1;
  }
  if (text_.size() - begin > dialect_.max_line && !error_)
    error_ = fail("block of {} characters exceeds {}, the longest line of {}", text_.size() - begin, dialect_.max_line,
                  dialect_.name);
  text_ += '\n';
  if (block) ++blocks_;
}

void NcLines::number(std::int64_t scaled, int decimals) {
  if (dialect_.sign_always && scaled >= 0) text_ += '+';
  numbers::append_fixed(text_, scaled, decimals, dialect_.point_always);
}

std::string NcLines::value(std::int64_t scaled, int decimals) const {
  std::string s;
  if (dialect_.sign_always && scaled >= 0) s += '+';
  numbers::append_fixed(s, scaled, decimals, dialect_.point_always);
  return s;
}

std::string NcLines::numbered(std::string_view text) {
  std::string out;
  out.reserve(text.size() + text.size() / 4);
  std::int64_t n = 0;
  for (std::size_t begin = 0; begin < text.size(); ++n) {
    std::size_t end = text.find('\n', begin);
    if (end == std::string_view::npos) end = text.size() - 1;
    numbers::append_integer(out, n);
    out += ' ';
    out += text.substr(begin, end + 1 - begin);
    begin = end + 1;
  }
  return out;
}

std::string name_on_control(const NcDialect& dialect, const NcHeader& header) {
  if (has_program_number(dialect)) return fmt::format("O{}", header.program_number);
  std::string name = program_id(header.job_name, header.name_end);
  if (dialect.name_begins_with_two_letters && name.size() > 1 && std::isdigit(static_cast<unsigned char>(name[1])))
    name.insert(1, "_");
  name = name.substr(0, kLongestName) + dialect.extension;
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return char(std::toupper(c)); });
  return name;
}

std::string program_id(std::string_view text, std::string_view end) {
  std::string out;
  for (const char c : numbers::comment_text(text).substr(0, kLongestName)) {
    const bool letter = c >= 'A' && c <= 'Z', digit = c >= '0' && c <= '9';
    out += letter || digit ? c : '_';
  }
  if (out.empty() || out[0] < 'A' || out[0] > 'Z') out.insert(0, "P");
  return out.substr(0, kLongestName - std::min(end.size(), kLongestName)) + std::string(end);
}

}  // namespace toothpath::text
