#include "postproc/shaper/gearbox_reader.h"

#include <charconv>
#include <cmath>

#include <fmt/format.h>

namespace toothpath::shaper {
namespace {

constexpr std::int64_t kMostUnits = 9'999'999'999;  // mm, deg: sums and differences of millionths stay whole numbers
constexpr std::int64_t kMostWhole = 999'999'999'999;

std::string_view trimmed(std::string_view s) {
  while (!s.empty() && (s.front() == ' ' || s.front() == '\r')) s.remove_prefix(1);
  while (!s.empty() && (s.back() == ' ' || s.back() == '\r')) s.remove_suffix(1);
  return s;
}

}  // namespace

std::optional<std::int64_t> micro(std::string_view s) {
  const bool negative = s.starts_with('-');
  if (negative) s.remove_prefix(1);
  std::int64_t value = 0;
  int decimals = -1, digits = 0;
  for (const char c : s) {
    if (c == '.' && decimals < 0) {
      decimals = 0;
    } else if (c >= '0' && c <= '9' && digits < 15) {
      value = 10 * value + (c - '0');
      ++digits;
      if (decimals >= 0) ++decimals;
    } else {
      return {};
    }
  }
  if (digits == 0 || decimals > 6) return {};
  for (int k = std::max(decimals, 0); k < 6; ++k) {
    if (value > kMostUnits * 1'000'000) return {};
    value *= 10;
  }
  if (value >= (kMostUnits + 1) * 1'000'000) return {};
  return negative ? -value : value;
}

std::optional<std::int64_t> whole(std::string_view s) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), value);
  if (error != std::errc{} || end != s.data() + s.size() || value > kMostWhole || value < -kMostWhole) return {};
  return value;
}

std::vector<std::string_view> words_of_block(std::string_view block) {
  std::vector<std::string_view> words;
  for (std::string_view rest = block; !rest.empty();) {
    const auto space = rest.find(' ');
    if (space != 0) words.push_back(rest.substr(0, space));
    rest = space == std::string_view::npos ? std::string_view() : rest.substr(space + 1);
  }
  return words;
}

GearboxReading GearboxReader::run(std::string_view text) {
  while (!text.empty()) {
    const auto end = text.find('\n');
    ++line_;
    block(trimmed(text.substr(0, end)));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  if (!ended_) problem("the program has no M30");
  if (coupled_) problem("the gearbox is still coupled at the end");
  if (stroking_) problem("the ram still strokes at the end");
  if (relief_) problem("the relief is still on at the end");
  close();
  return std::move(out_);
}

void GearboxReader::problem(const std::string& what) {
  out_.problems.push_back(fmt::format("line {}: {}", line_, what));
}

void GearboxReader::block(std::string_view s) {
  if (s.empty() || s.front() == ';' || (s.front() == '(' && s.back() == ')') || frame(s)) return;
  if (ended_) return problem("text after M30");
  if (s == w_.relief_on) return set(relief_, true, "relief");
  if (s == w_.relief_off) {
    if (stroking_) problem("the relief goes off while the ram strokes");
    return set(relief_, false, "relief");
  }
  if (s == "M30") {
    ended_ = true;
    return;
  }
  if (s.starts_with("G17 ") || s.starts_with("G21 ")) return start(s);
  if (!own_block(s)) motion(s);
}

void GearboxReader::set(bool& flag, bool to, const char* what) {
  if (flag == to) problem(fmt::format("the {} is {} already", what, to ? "on" : "off"));
  flag = to;
}

void GearboxReader::start(std::string_view s) {
  for (const std::string_view word : safe_start())
    if ((" " + std::string(s) + " ").find(" " + std::string(word) + " ") == std::string::npos)
      problem(fmt::format("{} is missing in the safe start", word));
  started_ = true;
}

void GearboxReader::couple(std::int64_t work, std::int64_t cutter) {
  if (coupled_) problem("coupled twice");
  if (stroking_) problem("the gearbox is coupled while the ram strokes");
  if (cutter_ != 0) problem("the gearbox is coupled away from zero");
  coupled_ = true;
  out_.ratio = GearboxRatio{work, cutter};
  out_.clear_before_mm = x_;
}

void GearboxReader::uncouple() {
  if (!coupled_) problem("uncoupled, but not coupled");
  if (stroking_) problem("uncoupled while the ram strokes");
  coupled_ = false;
  out_.clear_after_mm = x_;
}

void GearboxReader::stroke(double from, double to, double speed) {
  if (!coupled_) problem("the ram strokes without gearbox");
  if (!relief_) problem("the ram strokes without relief");
  set(stroking_, true, "ram");
  out_.stroke_start_mm = from;
  out_.stroke_end_mm = to;
  out_.strokes_per_minute = from != to ? speed / (2 * std::abs(from - to)) : 0;
  out_.slide_mm = y_;
  if (std::abs(z_ - from) > kPlace) problem("the ram does not wait at its start");
}

/// What a motion block says; places that it does not name are where they were.
struct GearboxReader::Motion {
  bool rapid = false, direct = false, moved = false, work_said = false;
  double x = 0, y = 0, z = 0, feed = 0;
  std::int64_t cutter = 0;
};

GearboxReader::Motion GearboxReader::words_of_motion(std::string_view s) {
  Motion m{rapid_, false, false, false, x_, y_, z_, 0, cutter_};
  std::string said;
  for (const std::string_view word : words_of_block(s)) {
    if (word == "G0") m.rapid = true;
    else if (word == "G1") m.rapid = false;
    else if (word == "G93") inverse_ = true;
    else if (word == "G94") inverse_ = false;
    else if (word == "SUPA" || word == "G53") m.direct = true;
    else if (idle_word(word)) continue;
    else {
      const auto parts = split(word);
      const auto value = parts ? micro(parts->number) : std::nullopt;
      if (!value) {
        problem(fmt::format("\"{}\" is not understood", word));
        continue;
      }
      const std::string_view name = parts->name;
      const double v = double(*value) * 1e-6;
      if (said.find(name) != std::string::npos) problem(fmt::format("{} stands twice", name));
      said += std::string(name) + " ";
      if (name == w_.cutter_axis) m.cutter = *value, m.moved = true;
      else if (name == w_.work_axis) m.work_said = true;
      else if (name == "X") m.x = v, m.moved = true;
      else if (name == "Y") m.y = v, m.moved = true;
      else if (name == "Z") m.z = v, m.moved = true;
      else if (name == "F") m.feed = v;
      else problem(fmt::format("\"{}\" is not understood", word));
    }
  }
  return m;
}

void GearboxReader::check_order(const Motion& m) {
  if (!started_) problem("motion before the safe start");
  if (first_ && (!m.direct || m.x == x_)) problem("the first motion is not the infeed slide in machine coordinates");
  first_ = false;
  if (!m.moved && !m.work_said) problem("a block without words");
  if (!m.rapid && !(m.feed > 0)) problem("a feed move without F");
  if (m.rapid && (coupled_ || stroking_)) problem("a rapid while the gearbox runs");
  if (m.work_said && coupled_) problem("the work is moved by a word while it is coupled");
  if (stroking_ && (m.y != y_ || m.z != z_)) problem("offset slide or ram moved by a word while the ram strokes");
}

void GearboxReader::motion(std::string_view s) {
  const Motion m = words_of_motion(s);
  check_order(m);
  if (stroking_ && coupled_) {
    const double way =
        m.x != x_ && m.cutter == cutter_ ? std::abs(m.x - x_) : std::abs(double(m.cutter - cutter_)) * 1e-6;
    if (m.x != x_ && m.cutter != cutter_ && !inverse_) problem("infeed and cutter together need G93");
    const double minutes = m.feed > 0 ? (inverse_ ? 1 / m.feed : way / m.feed) : 0;
    out_.moves.push_back({line_, x_, m.x, cutter_, m.cutter, minutes});
  }
  rapid_ = m.rapid;
  x_ = m.x;
  y_ = m.y;
  z_ = m.z;
  cutter_ = m.cutter;
}

}  // namespace toothpath::shaper
