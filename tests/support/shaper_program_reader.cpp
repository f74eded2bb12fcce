#include "tests/support/shaper_program_reader.h"

#include <cmath>
#include <cstdlib>
#include <sstream>

namespace toothpath::test {
namespace {

constexpr double kWordMm = 1.1e-5;     // a word has at least 5 decimals
constexpr double kWordDeg = 0.501e-5;  // half of the fifth decimal

std::string without_comments(const std::string& line) {
  std::string out;
  bool inside = false;
  for (const char c : line) {
    if (c == '(') inside = true;
    else if (c == ')') inside = false;
    else if (c == ';' && !inside) break;
    else if (!inside && c != ' ' && c != '\t') out += c;
  }
  return out;
}

int axis_of(char letter) {
  switch (letter) {
    case 'X': return kX;
    case 'Y': return kY;
    case 'Z': return kZ;
    case 'A': return kA;
    case 'C': return kC;
    default: return -1;
  }
}

struct Faults {
  std::vector<std::string> list;
  template <typename... Parts>
  void add(int line, const Parts&... parts) {
    if (list.size() >= 20) return;
    std::ostringstream text;
    text.precision(10);
    text << "line " << line << ": ";
    (text << ... << parts);
    list.push_back(text.str());
  }
};

/// The reference angle after stroke j by long division in whole degrees and a remainder: no accumulation.
double whole_number_angle(long long numerator, long long denominator) {
  return static_cast<double>(static_cast<long double>(numerator / denominator) +
                             static_cast<long double>(numerator % denominator) / static_cast<long double>(denominator));
}

}  // namespace

ShaperProgramText read_shaper_program(const std::string& text) {
  ShaperProgramText program;
  std::istringstream in(text);
  std::string raw;
  std::array<double, 5> at{};
  bool rapid = false, motion_known = false, inverse = false;
  int number = 0;
  while (std::getline(in, raw)) {
    ++number;
    if (number == 1) program.first_line = raw;
    const std::string line = without_comments(raw);
    if (line.empty()) continue;
    const auto problem = [&](const std::string& what) {
      program.problems.push_back("line " + std::to_string(number) + ": " + what);
    };
    if (program.ended) problem("text after M2");
    if (raw.size() > 252) problem("longer than 252 characters");
    ShaperMove move;
    move.line = number;
    move.from = move.to = at;
    bool has_axis = false;
    for (std::size_t k = 0; k < line.size();) {
      const char letter = line[k++];
      std::size_t stop = k;
      while (stop < line.size() &&
             (line[stop] == '.' || line[stop] == '-' || line[stop] == '+' || (line[stop] >= '0' && line[stop] <= '9')))
        ++stop;
      if (stop == k) {
        problem(std::string("no number after ") + letter);
        break;
      }
      const std::string digits = line.substr(k, stop - k);
      const double value = std::strtod(digits.c_str(), nullptr);
      k = stop;
      if (const int axis = axis_of(letter); axis >= 0) {
        move.said[std::size_t(axis)] = has_axis = true;
        move.to[std::size_t(axis)] = value;
      } else if (letter == 'F') {
        move.feed = value;
        if (!(value > 0)) problem("F is not above 0");
      } else if (letter == 'M' && value == 2) {
        program.ended = true;
      } else if (letter == 'G') {
        const int code = static_cast<int>(std::lround(value));
        if (code == 0 || code == 1) rapid = code == 0, motion_known = true;
        else if (code == 93) inverse = true;
        else if (code == 94) inverse = false;
        else if (code == 53) move.machine_coordinates = true;
        else if (code != 21 && code != 17 && code != 90 && code != 40 && code != 49 && code != 80)
          problem("unexpected G" + digits);
      } else {
        problem(std::string("unexpected word ") + letter + digits);
      }
    }
    if (!has_axis) continue;
    if (!motion_known) problem("axis words before G0 or G1");
    move.rapid = rapid;
    move.inverse_time = inverse;
    program.moves.push_back(move);
    at = move.to;
  }
  return program;
}

std::vector<ReadStroke> cutting_strokes(const ShaperProgramText& program, const ShaperFacts& facts) {
  std::vector<ReadStroke> strokes;
  for (const auto& m : program.moves)
    if (!m.rapid && m.from[kZ] != m.to[kZ] && std::abs(m.to[kZ] - facts.end) < kWordMm)
      strokes.push_back({m.line, m.to[kX], m.from[kZ], m.to[kZ], m.from[kA], m.to[kA], m.from[kC], m.to[kC]});
  return strokes;
}

std::vector<std::string> shaper_program_faults(const ShaperProgramText& program, const ShaperFacts& f) {
  Faults faults;
  for (const auto& p : program.problems) faults.add(0, p);
  if (program.first_line != "G21 G17 G90 G94 G40 G49 G80") faults.add(1, "safe start missing");
  if (!program.ended) faults.add(0, "M2 missing");
  const auto& moves = program.moves;
  if (moves.empty()) {
    faults.add(0, "no motion");
    return faults.list;
  }
  // The first move knows nothing of where the machine stands: the infeed slide alone, away from the work.
  if (!moves[0].said[kX] || moves[0].said[kY] || moves[0].said[kZ] || moves[0].said[kA] || moves[0].said[kC])
    faults.add(moves[0].line, "the first motion is not the infeed slide alone");
  std::size_t first = 0;
  while (first < moves.size() && !(moves[first].inverse_time)) ++first;
  bool offset_set = false;
  for (std::size_t k = 0; k < moves.size(); ++k) {
    const auto& m = moves[k];
    const bool low = m.to[kX] < f.depth || (k > 0 && m.from[kX] < f.depth);
    if (m.rapid && low) faults.add(m.line, "rapid below X = depth");
    if (m.said[kY] && (offset_set || k >= first)) faults.add(m.line, "offset slide moved after it was set");
    if (m.said[kY]) {
      offset_set = true;
      if (std::abs(m.to[kY] - f.slide) > kWordMm) faults.add(m.line, "offset slide at ", m.to[kY], ", not ", f.slide);
    }
    if (m.from[kX] > m.to[kX] && std::abs(m.from[kZ] - f.start) > kWordMm && k > 1)
      faults.add(m.line, "infeed away from the start of the stroke");
    const bool cutting = !m.rapid && m.from[kZ] != m.to[kZ] && std::abs(m.to[kZ] - f.end) < kWordMm;
    if (!cutting && k >= first && (m.from[kA] != m.to[kA] || m.from[kC] != m.to[kC]))
      faults.add(m.line, "cutter or work turns outside of the cutting block");
  }
  if (!offset_set) faults.add(0, "offset slide never set");

  const int total = f.strokes_infeed + f.strokes_turn;
  std::size_t k = first;
  int j = 0;
  for (; k + 3 < moves.size() && moves[k].inverse_time; k += 4) {
    ++j;
    const auto &cut = moves[k], &lift = moves[k + 1], &back = moves[k + 2], &approach = moves[k + 3];
    const double x = j >= f.strokes_infeed ? 0 : f.depth * (1 - double(j) / f.strokes_infeed);
    const double x_next = j + 1 >= f.strokes_infeed ? 0 : f.depth * (1 - double(j + 1) / f.strokes_infeed);
    if (std::abs(cut.to[kX] - x) > kWordMm) faults.add(cut.line, "stroke ", j, " cuts at X ", cut.to[kX], ", not ", x);
    if (std::abs(cut.from[kZ] - f.start) > kWordMm || std::abs(cut.to[kZ] - f.end) > kWordMm)
      faults.add(cut.line, "stroke ", j, " from Z ", cut.from[kZ], " to ", cut.to[kZ]);
    const double c = f.sense * whole_number_angle(360LL * j, f.strokes_turn);
    const double a =
        whole_number_angle(360LL * j * f.work_teeth, static_cast<long long>(f.cutter_teeth) * f.strokes_turn);
    if (std::abs(cut.to[kC] - c) > kWordDeg)
      faults.add(cut.line, "work at ", cut.to[kC], " after stroke ", j, ", not ", c);
    if (std::abs(cut.to[kA] - a) > kWordDeg)
      faults.add(cut.line, "cutter at ", cut.to[kA], " after stroke ", j, ", not ", a);
    if (std::abs(lift.to[kX] - (x + f.relief)) > kWordMm || lift.to[kZ] != cut.to[kZ])
      faults.add(lift.line, "no lift by the relief before the return");
    if (std::abs(back.to[kZ] - f.start) > kWordMm || back.to[kX] != lift.to[kX])
      faults.add(back.line, "return is not straight");
    if (std::abs(approach.to[kX] - x_next) > kWordMm || approach.to[kZ] != back.to[kZ])
      faults.add(approach.line, "stroke ", j + 1, " would start at X ", approach.to[kX], ", not ", x_next);
    double minutes = 0;
    for (const auto* m : {&cut, &lift, &back, &approach}) {
      if (!m->inverse_time || m->rapid || !(m->feed > 0)) faults.add(m->line, "not a G1 block with F in G93");
      else minutes += 1 / m->feed;
    }
    if (std::abs(minutes * f.strokes_per_minute - 1) > 1e-7)
      faults.add(cut.line, "double stroke takes ", minutes, " min, not ", 1 / f.strokes_per_minute);
  }
  if (j != total) faults.add(0, j, " double strokes, not ", total);
  if (k >= moves.size()) {
    faults.add(0, "the cutter stays in the work");
  } else {
    const auto& m = moves[k];
    const bool only_x = m.said[kX] && !m.said[kY] && !m.said[kZ] && !m.said[kA] && !m.said[kC];
    if (!only_x || m.rapid || m.to[kX] < f.depth + f.relief - 1e-9)
      faults.add(m.line, "after the last stroke the infeed slide does not clear the work first");
  }
  return faults.list;
}

}  // namespace toothpath::test
