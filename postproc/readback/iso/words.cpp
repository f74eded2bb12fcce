#include "postproc/readback/iso/words.h"

#include <cmath>

namespace toothpath::iso {

std::string g_word(int tenths) {
  return tenths % 10 == 0 ? fmt::format("G{}", tenths / 10) : fmt::format("G{}.{}", tenths / 10, tenths % 10);
}

bool has_g(const IsoLanguage& language, int tenths) {
  return std::find(language.g_tenths.begin(), language.g_tenths.end(), tenths) != language.g_tenths.end();
}

std::optional<Diagnostic> WordSorter::sort(const NcBlock& b, Request& r) const {
  for (const auto& w : b.words) {
    if (w.letter == '#') return here(w.column, "an assignment in a line of words");
    const auto v = flow_.value(b, w.value, w.column);
    if (!v) return v.error();
    if (auto bad = take(r, w, *v)) return bad;
  }
  r.words = b.words.size() - (b.words.front().letter == 'N' ? 1 : 0);
  return std::nullopt;
}

std::optional<Diagnostic> WordSorter::skippable(const NcBlock& b) const {
  for (const auto& w : b.words) {
    const bool waits = (w.letter == 'G' && w.value.number == 4) || w.letter == 'P' || w.letter == 'N' ||
                       (w.letter == 'M' && w.value.count == 0 && (w.value.number == 0 || w.value.number == 1));
    if (!waits || w.value.count != 0)
      return here(w.column,
                  "a block that may be skipped is read with M0, M1 and G4 P alone: with others there would be two "
                  "programs to prove");
  }
  return std::nullopt;
}

/// Codes of the machine file that switch TCP.
bool WordSorter::site_code(Request& r, const std::string& code) const {
  const auto is = [&](const std::vector<std::string>& list) {
    return std::find(list.begin(), list.end(), code) != list.end();
  };
  if (!is(control_.tcp_on) && !is(control_.tcp_off)) return false;
  r.switch_tcp = is(control_.tcp_on) ? 1 : 0;
  return true;
}

std::optional<Diagnostic> WordSorter::once(std::optional<double>& slot, const NcWord& w, double v) const {
  if (slot) return here(w.column, fmt::format("two {} words in a block", w.letter));
  slot = v;
  return std::nullopt;
}

bool WordSorter::has_m(int m) const {
  static constexpr std::array<int, 7> common = {0, 1, 2, 3, 5, 6, 30};
  const bool call = m == 98 || m == 99 || (m == 97 && language_.local_calls);
  return std::find(common.begin(), common.end(), m) != common.end() || (call && !language_.o_words) ||
         std::find(language_.coolant_m.begin(), language_.coolant_m.end(), m) != language_.coolant_m.end();
}

/// The machine file names outputs that clamp: M64 P, M65 P.
bool WordSorter::has_outputs() const {
  return std::any_of(control_.clamps.begin(), control_.clamps.end(),
                     [](const auto& clamp) { return clamp && clamp->on.find(' ') != std::string::npos; });
}

std::optional<Diagnostic> WordSorter::take(Request& r, const NcWord& w, double v) const {
  switch (w.letter) {
    case 'G': return take_g(r, w, v);
    case 'M': {
      const int m = static_cast<int>(std::lround(v));
      if (v == m && language_.codes_of_site && site_code(r, fmt::format("M{}", m))) return std::nullopt;
      const std::string word = fmt::format("M{}", m);
      if (v == m && (m == 64 || m == 65) && has_outputs()) r.output = true;
      else if (v != m || !(has_m(m) || control_.switches_coolant(word) || control_.clamped_by(word)))
        return here(w.column, fmt::format("M{} is not in the subset", v));
      return take_m(r, m, w.column);
    }
    case 'N': return std::nullopt;
    case 'F': return once(r.f, w, v);
    case 'S': return once(r.s, w, v);
    case 'H': return once(r.h, w, v);
    case 'T': return once(r.t, w, v);
    case 'P':
      r.p_column = w.column;
      r.p_point = w.point;
      return once(r.p, w, v);
    case 'Q': return once(r.q, w, v);
    case 'L': return once(r.l, w, v);
    case 'R':
      if (!has_g(language_, 100)) break;
      if (!r.writes) r.column = w.column;
      return once(r.turn, w, v);
    case 'I':
    case 'J':
    case 'K':
      if (!has_g(language_, 682)) break;
      if (language_.point_needed && !w.point)
        return here(w.column, fmt::format("{} without a decimal point", w.letter));
      return once(r.euler[static_cast<std::size_t>(w.letter - 'I')], w, v);
    default: break;
  }
  return take_axis(r, w, v);
}

std::optional<Diagnostic> WordSorter::take_axis(Request& r, const NcWord& w, double v) const {
  for (std::size_t a = 0; a < 5; ++a) {
    if (control_.letters[a] != w.letter) continue;
    if (r.move.has[a]) return here(w.column, fmt::format("two {} words in a block", w.letter));
    if (language_.point_needed && !w.point) return here(w.column, fmt::format("{} without a decimal point", w.letter));
    r.move.has[a] = true;
    r.move.axis[a] = v;
    r.column = w.column;
    return std::nullopt;
  }
  return here(w.column, fmt::format("word {} is not in the subset or no axis of the machine", w.letter));
}

std::optional<Diagnostic> WordSorter::take_m(Request& r, int m, int column) const {
  if (r.m.size() >= language_.most_m)
    return language_.most_m == 1 ? here(column, "two M words in a block: the control takes one")
                                 : here(column, fmt::format("more than {} M words in a block", language_.most_m));
  for (const int other : r.m)
    if (clash_of_m(control_, other, m))
      return here(column, fmt::format("M{} and M{} of one group in a block", other, m));
  r.m.push_back(m);
  return std::nullopt;
}

/// Takes a G code of the family and gives its modal group; 0: it is none.
unsigned WordSorter::group_of(Request& r, int tenths) const {
  switch (tenths) {
    case 0:
    case 10: r.motion = tenths / 10; return 1;
    case 170: return 2;
    case 900: r.absolute = true; return 3;
    case 910: r.incremental = true; return 3;
    case 40: r.dwell = true; return 14;
    case 280: r.to_reference = 0; return 14;
    case 300: r.to_reference = 1; return 14;
    case 930:
    case 940: r.feed_mode = tenths / 10; return 4;
    case 210: r.millimetres = true; return 5;
    case 400: return 6;
    case 430: r.g43 = true; return 7;
    case 434: r.g43 = r.tcp = true; return 7;
    case 490: r.g49 = true; return 7;
    case 800: return 8;
    case 100: r.writes = true; return 14;
    case 520: r.zeros = language_.moves_zeros; return r.zeros ? 14 : 0;
    case 530: r.g53 = true; return 9;
    case 610:
    case 611:
    case 640:
      r.g64 = tenths == 640;
      r.g61 = !r.g64;
      r.stops = tenths == 611;
      return 10;
    case 921: r.clears = true; return 11;
    case 690: r.no_plane = true; return 13;
    case 682: r.plane = true; return 13;
    case 531: r.to_plane = true; return 14;
    case 540:
    case 550:
    case 560:
    case 570:
    case 580:
    case 590:
    case 591:
    case 592:
    case 593: r.offset = g_word(tenths); return kOffsets;
    default: return 0;
  }
}

std::optional<Diagnostic> WordSorter::take_g(Request& r, const NcWord& w, double v) const {
  const int tenths = static_cast<int>(std::lround(v * 10));
  const bool extended = tenths > 0 && tenths == language_.extended.tenths;
  const unsigned group = extended ? kOffsets : group_of(r, tenths);
  r.extended = r.extended || extended;
  if (tenths == 100) r.write_column = w.column;
  if (group == 0 || std::abs(v * 10 - tenths) > 1e-6) return here(w.column, fmt::format("G{} is not in the subset", v));
  const bool special = tenths == 100 || tenths == 434 || tenths == 682 || tenths == 531 || tenths == 690 ||
                       tenths == 921 || tenths == 610 || tenths == 611 || tenths == 640 ||
                       (tenths > 590 && tenths < 600);
  if (special && !has_g(language_, tenths)) return here(w.column, fmt::format("G{} is not in the dialect", v));
  if ((r.groups & (1U << group)) != 0) return here(w.column, "two G words of one modal group in a block");
  r.groups |= 1U << group;
  if (r.column == 1) r.column = w.column;
  return std::nullopt;
}

}  // namespace toothpath::iso
