// Edits that somebody could make by hand, planted in a program of every form of output: the table of
// docs/planted_edits.md says of each what `check` finds it by, or that it is harmless. Where it passes, a reader of the
// tests' own (nc_walk, plain_machine) measures that the tool still comes wherever the program cut.
// TOOTHPATH_WRITE_EDITS=1 writes what was found into the table; another value is a regular expression of the edits that
// are tried and written.
#include <array>
#include <cstdlib>
#include <map>
#include <unordered_map>

#include "tests/app/planted.h"

namespace toothpath::test {
namespace {

constexpr double kHarmless_um = 13;  // scallop, chord and the margin of left material
constexpr double kBlankTop = -18;    // mm, in the frame of the gear: above it nothing is cut
const std::string kTable = TOOTHPATH_SOURCE_DIR "/docs/planted_edits.md";

/// A form of output, or a machine that ships, in tilted planes.
struct EditedForm {
  OutputForm form;
  const char* planes = nullptr;  ///< the machine's name
  [[nodiscard]] std::string name() const { return planes ? std::string(form.control) + " planes" : form.name(); }
};

std::vector<EditedForm> edited_forms() {
  std::vector<EditedForm> out;
  for (const OutputForm& form : planted_forms()) out.push_back({form});
  out.push_back({{"fanuc", "none", false}, "fanuc_ac"});
  out.push_back({{"mitsubishi_m80", "none", false}, "m80_ac"});
  out.push_back({{"siemens", "none", true}, "siemens_ac"});
  out.push_back({{"heidenhain", "none", true}, "heidenhain_ac"});
  return out;
}

bool comment(const std::string& line) {
  const std::size_t at = line.find_first_not_of("0123456789 ");
  return at != std::string::npos && (line[at] == '(' || line[at] == ';' || line[at] == '$');
}

using Edited = std::optional<Lines>;

/// Where the first line from `from` on fits that is no comment.
std::optional<std::size_t> find(const Lines& lines, const std::string& pattern, std::size_t from = 0) {
  const std::regex look(pattern);
  for (std::size_t n = from; n < lines.size(); ++n)
    if (!comment(lines[n]) && std::regex_search(lines[n], look)) return n;
  return std::nullopt;
}
/// The first that fits gets another text; nothing where none does.
Edited replaced(const Lines& lines, const std::string& pattern, const std::string& by, std::size_t from = 0) {
  const auto at = find(lines, pattern, from);
  if (!at) return std::nullopt;
  Lines out = lines;
  out[*at] = std::regex_replace(lines[*at], std::regex(pattern), by, std::regex_constants::format_first_only);
  return out;
}
Edited dropped(const Lines& lines, const std::string& pattern, std::size_t from = 0, std::size_t count = 1) {
  const auto at = find(lines, pattern, from);
  if (!at) return std::nullopt;
  Lines out = lines;
  out.erase(out.begin() + std::ptrdiff_t(*at), out.begin() + std::ptrdiff_t(*at + count));
  return out;
}
std::string other_sign(const std::string& number) {
  if (number[0] == '-') return number.substr(1);
  return "-" + (number[0] == '+' ? number.substr(1) : number);
}
/// The number behind `head` with its other sign, in the first line where it is not 0; Heidenhain says both signs.
Edited signed_otherwise(const Lines& lines, const std::string& head, std::size_t from = 0) {
  const std::string pattern = "(" + head + ")([-+]?[0-9.]*[1-9][0-9.]*)";
  const auto at = find(lines, pattern, from);
  if (!at) return std::nullopt;
  Lines out = lines;
  std::smatch found;
  std::regex_search(lines[*at], found, std::regex(pattern));
  std::string number = other_sign(found[found.size() - 1]);
  const auto digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  if (number[0] != '-' && (digit(lines[*at][0]) || (found[1].length() > 0 && digit(*(found[1].second - 1)))))
    number = "+" + number;
  out[*at] = found.prefix().str() + found[1].str() + number + found.suffix().str();
  return out;
}

/// A program whose text is edited.
class Editable : public PlantedProgram {
 public:
  static Editable make(const EditedForm& form) {
    if (form.planes) {
      std::string machine = file_text(TOOTHPATH_SOURCE_DIR "/machines/data/" + std::string(form.planes) + ".toml");
      replace_once(machine, "max = 60.0", "max = 2.0");  // of A: one pair of angles is within the travel
      std::string job = leaning(kPlantedJob) + "[program]\ntilted_planes = true\n";
      replace_once(job, "[3.0, -2.0, 120.0]", "[0.0, 0.0, 30.0]");
      replace_once(job, "[3.0, -2.0, 0.0]", "[0.0, 0.0, 0.0]");
      return {form, machine, job, {0, 0, 0}};
    }
    Random random(77);
    const std::string machine = random_machine(form.form, random);
    const auto [job, origin] = planted_job(form.form, machine);
    return {form, machine, leaning(job), origin};
  }
  [[nodiscard]] bool made() const { return !lines_.empty(); }
  [[nodiscard]] std::string control() const { return form_.control; }
  [[nodiscard]] bool planes() const { return planes_; }

  /// Greatest distance from the way of the program's cuts to those of this text, um; nothing where no reader of the
  /// tests' own is there.
  [[nodiscard]] std::optional<double> missed_um(const Lines& lines) const {
    if (planes_) return std::nullopt;
    const JudgedPath edited = walk(lines);
    if (!edited.faults().empty()) return INFINITY;
    if (!made_) made_ = std::make_unique<JudgedPath>(walk(lines_));
    const JudgedPath& made = *made_;
    constexpr double kCell = 1;
    const auto cell = [](const Vec3& p) {
      const auto at = [&](int k) { return std::int64_t(std::floor(p[k] / kCell)) + 4096; };
      return at(0) << 40 | at(1) << 20 | at(2);
    };
    std::vector<std::pair<Vec3, Vec3>> ways;
    std::unordered_map<std::int64_t, std::vector<std::size_t>> cells;
    for (const MachineMove& m : edited.moves()) {
      if (m.rapid) continue;
      const Vec3 a = edited.at(m, 0).tip, b = edited.at(m, 1).tip;
      const int n = std::max(1, int(std::ceil(2 * (b - a).norm() / kCell)));
      for (int k = 0; k <= n; ++k) cells[cell(a + (b - a) * k / n)].push_back(ways.size());
      ways.emplace_back(a, b);
    }
    double most = 0;
    for (const MachineMove& m : made.moves()) {
      if (m.rapid) continue;
      for (const double t : {0.5, 1.0}) {
        const Vec3 p = made.at(m, t).tip;
        if (p.z() > kBlankTop) continue;
        double least = INFINITY;
        for (int n = 0; n < 27 && least > most; ++n) {  // from the middle outwards
          const int k = 13 + (n % 2 ? n / 2 + 1 : -n / 2);
          const auto near = cells.find(cell(p + kCell * Vec3(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1)));
          if (near == cells.end()) continue;
          for (const std::size_t way : near->second) {
            least = std::min(least, distance_to_segment(p, ways[way].first, ways[way].second));
            if (least <= most) break;
          }
        }
        most = std::max(most, least);
      }
    }
    return 1e3 * most;
  }

  /// Index of a block in the middle of a pass: five behind each other with X and Y and no G.
  [[nodiscard]] std::size_t cut() const {
    const std::regex block(form_.control == std::string("apt") ? "^GOTO/.*" : "^(\\d+ L )?X\\S+ Y\\S+ Z[^GRD]*$");
    std::size_t run = 0;
    for (std::size_t n = 0; n < lines_.size(); ++n) {
      if (form_.control == std::string("apt") && (lines_[n].starts_with("FEDRAT") || lines_[n].starts_with("0.")))
        continue;
      run = std::regex_match(lines_[n], block) ? run + 1 : 0;
      if (run == 4) return n;
    }
    ADD_FAILURE() << name_ << ": no pass";
    return 0;
  }
  /// Index of the line that names a tooth; nothing where teeth are not written out or called one by one.
  [[nodiscard]] std::optional<std::size_t> tooth(int number) const {
    const std::regex look(fmt::format("^(\\d+ )?[(;$ ]+(AT )?TOOTH {}\\)?$", number));
    for (std::size_t n = 0; n < lines_.size(); ++n)
      if (std::regex_match(lines_[n], look)) return n;
    return std::nullopt;
  }

 private:
  Editable(const EditedForm& form, const std::string& machine, const std::string& job, const Vec3& origin)
      : PlantedProgram(form.form, machine, job, origin), planes_(form.planes != nullptr), name_(form.name()) {}
  static std::string leaning(std::string job) {
    replace_once(job, "chord_tolerance = 0.002\n", "chord_tolerance = 0.002\ntool_axis = [[62.75, 6.0, 0.0]]\n");
    return job;
  }
  bool planes_;
  std::string name_;
  mutable std::unique_ptr<JudgedPath> made_;  ///< the program as it was made
};

/// Blocks that carry numbers count up again, as the control's editor has them.
Lines renumbered(Lines lines, const std::string& control) {
  for (std::size_t n = 0; n < lines.size() && control == "heidenhain"; ++n)
    lines[n] = std::to_string(n) + lines[n].substr(lines[n].find(' '));
  return lines;
}

/// Rows of the table, in their order.
using Rows = std::vector<std::pair<std::string, Edited>>;

void edit_cuts(const Editable& p, Rows& out) {
  const Lines& all = p.lines();
  const std::size_t cut = p.cut();
  const bool apt = p.control() == "apt";
  const auto next = find(all, apt ? "^GOTO/" : "X", cut + 1);
  Lines swapped = all, one = all, ten = all;
  std::swap(swapped[cut], swapped[*next]);
  for (bool more = true; more;) {  // with the lines that it goes on in
    more = one[cut].ends_with("$");
    one.erase(one.begin() + std::ptrdiff_t(cut));
  }
  const std::ptrdiff_t behind = apt ? 30 : 10;
  ten.erase(ten.begin() + std::ptrdiff_t(cut), ten.begin() + std::ptrdiff_t(cut) + behind);
  out.emplace_back("a block of a cut left out", one);
  out.emplace_back("two blocks of a cut swapped", swapped);
  out.emplace_back("ten lines from a cut on left out", ten);
  out.emplace_back("decimal point of a cut lost",
                   replaced(all, apt ? "(GOTO/-?[0-9]+)\\." : "(X[-+]?[0-9]+)\\.", "$1", cut));
}

void edit_links(const Editable& p, Rows& out) {
  const Lines& all = p.lines();
  const std::string control = p.control();
  const bool apt = control == "apt", heidenhain = control == "heidenhain", siemens = control == "siemens";
  out.emplace_back("a rise in machine coordinates left out", dropped(all, heidenhain ? "M91"
                                                                          : siemens  ? "SUPA"
                                                                                     : "G53 |G53$"));
  const std::size_t cut = p.cut();
  // The link behind that cut: up, across, down.
  const std::string rapid = apt ? "^RAPID$" : heidenhain ? "^\\d+ L .*FMAX$" : "^G0 ";
  const auto up = find(all, rapid, cut);
  const std::size_t step = apt ? 2 : 1;
  Lines across = all, down = all, swapped = all;
  if (up) {
    const auto at = std::ptrdiff_t(*up);
    across.erase(across.begin() + at + std::ptrdiff_t(step), across.begin() + at + std::ptrdiff_t(2 * step));
    down.erase(down.begin() + at + std::ptrdiff_t(2 * step), down.begin() + at + std::ptrdiff_t(3 * step));
    std::swap_ranges(swapped.begin() + at + std::ptrdiff_t(step), swapped.begin() + at + std::ptrdiff_t(2 * step),
                     swapped.begin() + at + std::ptrdiff_t(2 * step));
    out.emplace_back("the way across of a link left out", across);
    out.emplace_back("the way down of a link left out", down);
    out.emplace_back("across and down of a link swapped", swapped);
  }
  const std::string c =
      siemens ? "C=(?:R2)?|CYCLE800\\(0,\"\",0,39,0,0,[0-9]+,R2" : "[ #]C|FN 1: Q5 = \\+Q2 \\+ |G68.2 .* I|SPC";
  out.emplace_back("sign of C in a link",
                   apt ? std::nullopt
                       : signed_otherwise(all, heidenhain ? "^\\d+ L C|FN 1: Q5 = \\+Q2 \\+ "
                                               : siemens  ? "^G0 C=(?:R2)?|CYCLE800\\(0,\"\",0,39,0,0,[0-9]+,R2"
                                                          : "^G0 C|^G68.2 .* I"));
  out.emplace_back("sign of C in a cut", apt ? std::nullopt
                                             : signed_otherwise(all, heidenhain ? "^\\d+ L X.* C"
                                                                     : siemens  ? "^G1 X.* C=(?:R2)?"
                                                                                : "^G1 X.* C"));
  out.emplace_back("sign of A in a link",
                   apt ? std::nullopt
                       : signed_otherwise(all, heidenhain ? "^\\d+ L C.* A|SPA"
                                               : siemens  ? "^G0 C=.* A=|CYCLE800\\(0,\"\",0,39,0,0,[0-9]+,R2[-0-9.]+,"
                                                          : "^G0 C.* A|^G68.2 .* J"));
  out.emplace_back("sign of A in a cut, or of a tool vector", signed_otherwise(all,
                                                                               apt ? "^GOTO/[^,]*,[^,]*,[^,]*,|^"
                                                                               : heidenhain ? "^\\d+ LN? X.* (?:A|TX)"
                                                                               : siemens    ? "^G1 X.* (?:A=|A3=)"
                                                                                            : "^G1 X.* A",
                                                                               cut - 3));
  out.emplace_back("sign of the index", heidenhain ? replaced(all, "(Q2 = )(0-)?Q1", "$1(3-Q1)") : Edited());
  if (heidenhain) {
    auto minus = replaced(all, "Q2 = 0-Q1", "Q2 = Q1");
    out.back().second = minus ? minus : replaced(all, "Q2 = Q1", "Q2 = 0-Q1");
  } else if (siemens) {
    auto minus = replaced(all, "R2=0-COUNT", "R2=COUNT");
    out.back().second = minus ? minus : replaced(all, "R2=COUNT", "R2=0-COUNT");
  } else if (control == "linuxcnc") {
    auto minus = replaced(all, "(G52 C\\[)0-#1", "$1#1");
    out.back().second = minus ? minus : replaced(all, "(G52 C\\[)#1", "$010-#1");
  } else {
    out.back().second = signed_otherwise(all, "^G52 C", find(all, "^M98").value_or(all.size()));
  }
}

/// Where the words of LinuxCNC's loops count from, and those of Siemens with TRAORI. (The zeros of other controls:
/// IndexZero in tests/postproc.)
void edit_zeros(const Editable& p, Rows& out) {
  const Lines& all = p.lines();
  const bool loop = p.control() == "linuxcnc" && find(all, "^G52 C\\[");
  const auto turned = loop ? find(all, "^G59\\.3$") : std::nullopt;
  out.emplace_back("G52 of the index left out", loop ? dropped(all, "^G52 C\\[") : std::nullopt);
  out.emplace_back("G92.1 behind the teeth left out",
                   loop ? dropped(all, "^G92\\.1$", *find(all, "^o1\\d+ endwhile$")) : std::nullopt);
  out.emplace_back("G59.3 left out", turned ? dropped(all, "^G59\\.3$") : std::nullopt);
  out.emplace_back("G54 behind G59.3 left out", turned ? dropped(all, "^G54$", *turned) : std::nullopt);
  out.emplace_back("the look at the work offset left out",
                   p.control() == "linuxcnc" ? dropped(all, "^o99 while", 0, 3) : std::nullopt);
  const std::string angle = "(^G10 L2 P9 .*R\\[)";
  auto sign = replaced(all, angle + "0-", "$1");
  if (!sign) sign = replaced(all, angle, "$010-");
  out.emplace_back("sign of R in G10", turned ? sign : std::nullopt);
  // TRANS ahead of TRAORI, behind it, behind TRAFOOF, and behind the teeth; all of the text: there is none.
  const std::size_t none = all.size();
  const bool takes = p.control() == "siemens" && find(all, "^TRANS C=R2$") && find(all, "^TRAORI$");
  const std::size_t traori = takes ? find(all, "^TRAORI$").value_or(none) : none;
  const std::size_t trafoof = find(all, "^TRAFOOF$", traori).value_or(none);
  const std::size_t ahead = takes ? 0 : none;
  out.emplace_back("TRANS ahead of TRAORI left out", dropped(all, "^TRANS C=R2$", ahead));
  out.emplace_back("TRANS behind TRAORI left out", dropped(all, "^TRANS C=R2$", traori));
  out.emplace_back("TRANS behind TRAFOOF left out", dropped(all, "^TRANS C=R2$", trafoof));
  out.emplace_back("TRANS behind the teeth left out", dropped(all, "^TRANS$", trafoof));
  out.emplace_back("another angle behind TRAORI", replaced(all, "^TRANS C=R2$", "TRANS C=R2+0.1", traori));
  out.emplace_back("another angle ahead of TRAORI and behind it", replaced(all, "^(R2=.*)$", "$1+0.1", ahead));
  out.emplace_back("ROT beside TRANS", replaced(all, "^TRANS C=R2$", "ROT Z=R2", traori));
}

void edit_conditions(const Editable& p, Rows& out) {
  const Lines& all = p.lines();
  const std::string control = p.control();
  const bool apt = control == "apt", heidenhain = control == "heidenhain", siemens = control == "siemens";
  out.emplace_back("another work offset", apt          ? std::nullopt
                                          : heidenhain ? replaced(all, "Q339=\\+1", "Q339=+2", *find(all, "TOOL CALL"))
                                                       : replaced(all, "\\bG54\\b", "G55", *find(all, "T=?\"?T?1")));
  out.emplace_back("length of another tool", apt          ? replaced(all, "LENGTH,80", "LENGTH,81")
                                             : heidenhain ? replaced(all, "TOOL CALL 1 Z", "TOOL CALL 2 Z")
                                             : siemens    ? replaced(all, "^D1$", "D2")
                                                          : replaced(all, "\\bH1\\b", "H2"));
  out.emplace_back("length not switched on", apt || heidenhain ? std::nullopt
                                             : siemens         ? dropped(all, "^D1$")
                                                               : replaced(all, "G43(\\.4)? H1 ?", ""));
  out.emplace_back("a longer tool by hand",
                   heidenhain ? replaced(all, "TOOL CALL 1 Z S20000", "TOOL CALL 1 Z S20000 DL+1") : Edited());
  out.emplace_back("another tool", apt          ? replaced(all, "LOADTL/1,", "LOADTL/7,")
                                   : heidenhain ? replaced(all, "TOOL CALL 1 Z", "TOOL CALL 7 Z")
                                   : siemens    ? replaced(all, "T=\"T1\"", "T=\"T7\"")
                                                : replaced(all, "\\bT1\\b", "T7"));
  const std::string s = apt ? "RPM,20000" : "S20000";
  const std::string head = s.substr(0, s.find('2'));
  out.emplace_back("S ten times as large", replaced(all, s, head + "200000"));
  out.emplace_back("S twice as large", replaced(all, s, head + "40000"));
  out.emplace_back("S a tenth", replaced(all, s, head + "2000"));
  out.emplace_back("S larger by a twentieth", replaced(all, s, head + "21000"));
  const std::regex word("(F|FEDRAT/)([0-9.]+)");
  for (const auto& [name, factor] : {std::pair{"F of a cut ten times as large", 10.0},
                                     {"F of a cut a hundred times as large", 100.0},
                                     {"F of a cut a tenth", 0.1}}) {
    Edited edited;
    for (std::size_t n = p.cut() + 1; n-- > 0;) {
      std::smatch f;
      if (comment(all[n]) || !std::regex_search(all[n], f, word)) continue;
      edited = all;
      (*edited)[n] = f.prefix().str() + f[1].str() + fmt::format("{:.3f}", factor * std::stod(f[2])) + f.suffix().str();
      break;
    }
    out.emplace_back(name, edited);
  }
  out.emplace_back("spindle the other way", apt ? replaced(all, "CLW", "CCLW") : replaced(all, "\\bM3\\b", "M4"));
  out.emplace_back("spindle stopped instead",
                   apt ? replaced(all, "SPINDL/RPM.*", "SPINDL/OFF") : replaced(all, "\\bM3\\b", "M5"));
  out.emplace_back("spindle not switched on",
                   apt ? dropped(all, "SPINDL/RPM") : replaced(all, " ?\\bM3\\b", heidenhain ? " M9" : ""));
  out.emplace_back("spindle not switched off", dropped(all, apt ? "SPINDL/OFF" : "\\bM5\\b"));
  out.emplace_back("coolant not switched on", dropped(all, apt ? "COOLNT/FLOOD" : "\\bM8\\b"));
  out.emplace_back("coolant not switched off", dropped(all, apt ? "COOLNT/OFF" : "\\bM9\\b"));
  out.emplace_back("end of the program left out", dropped(all, apt                     ? "^END$"
                                                               : control == "linuxcnc" ? "\\bM2\\b"
                                                                                       : "\\bM30\\b"));
}

void edit_teeth(const Editable& p, Rows& out) {
  const Lines& all = p.lines();
  const auto at = [&](int k) { return p.tooth(k); };
  const auto without = [&](std::size_t first, std::size_t last) {
    Lines lines = all;
    lines.erase(lines.begin() + std::ptrdiff_t(first), lines.begin() + std::ptrdiff_t(last));
    return lines;
  };
  Edited loop = replaced(all, "LT 60\\]|LT \\+60 |COUNT=0 TO 59", "");
  if (loop) {
    loop = replaced(all, "LT 60\\]", "LT 59]");
    if (!loop) loop = replaced(all, "LT \\+60 ", "LT +59 ");
    if (!loop) loop = replaced(all, "COUNT=0 TO 59", "COUNT=0 TO 58");
    out.emplace_back("a tooth left out", loop);
  } else {
    out.emplace_back("a tooth left out", at(30) ? Edited(without(*at(30), *at(31))) : Edited());
  }
  Edited swapped;
  if (at(30)) {
    swapped = all;
    std::rotate(swapped->begin() + std::ptrdiff_t(*at(30)), swapped->begin() + std::ptrdiff_t(*at(31)),
                swapped->begin() + std::ptrdiff_t(*at(32)));
  }
  out.emplace_back("two teeth swapped", swapped);
  // Where the cuts stand in the text once a tooth.
  const bool written = at(30) && *at(31) - *at(30) > 20;
  Edited pass, cut;
  if (written) {
    const std::size_t begin = *at(30);
    if (p.control() == "apt") {
      const auto first = find(all, "^FEDRAT", *find(all, "^FEDRAT/6000", begin));
      const auto down = find(all, "^FEDRAT", *first + 1);
      pass = without(*down, *find(all, "^FEDRAT/6000", *down));
    } else {
      const auto first = find(all, "G1 ", *find(all, "G1 ", begin) + 20);
      const auto last = find(all, "^G0 |^M429", *first);  // behind the lift
      pass = without(*first + 1, *last - 1);
      cut = without(*first + 3, *first + 4);
    }
  }
  out.emplace_back("a pass of tooth 30 left out", pass);
  out.emplace_back("a block of tooth 30 left out", cut);
  Edited elsewhere;
  if (written && p.control() != "apt") {
    const std::size_t begin = *at(30), end = *at(31);
    elsewhere = all;
    int links = 0;
    for (std::size_t n = begin; n < end; ++n)
      if (all[n].starts_with("G1 ") && all[n].find(" C") != std::string::npos && ++links == 4) {
        const Edited one = signed_otherwise(all, "^G1 X.* C", n);
        if (one) elsewhere = one;
      }
  }
  out.emplace_back("sign of C in a pass of tooth 30", elsewhere);
}

Rows edits_of(const Editable& p) {
  Rows out;
  edit_cuts(p, out);
  edit_links(p, out);
  edit_zeros(p, out);
  edit_conditions(p, out);
  edit_teeth(p, out);
  return out;
}

/// The table: edit -> form -> words.
struct Table {
  std::vector<std::string> forms, edits;
  std::map<std::string, std::map<std::string, std::string>> cells;
};
constexpr const char* kHead = "| edit |";

Table table_of(const std::string& page) {
  Table out;
  std::istringstream in(page);
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(kHead)) inside = true;
    else if (inside && !line.starts_with("|")) break;
    if (!inside || line.starts_with("|--")) continue;
    std::vector<std::string> cells;
    std::istringstream row(line.substr(2));
    for (std::string cell; std::getline(row, cell, '|');) {
      cell.erase(0, std::min(cell.size(), cell.find_first_not_of(' ')));
      cell.erase(cell.find_last_not_of(' ') + 1);
      cells.push_back(cell);
    }
    if (out.forms.empty()) {
      out.forms.assign(cells.begin() + 1, cells.end());
      continue;
    }
    out.edits.push_back(cells[0]);
    for (std::size_t k = 1; k < cells.size() && k <= out.forms.size(); ++k)
      out.cells[cells[0]][out.forms[k - 1]] = cells[k];
  }
  return out;
}

std::string page_with(const std::string& page, const Table& table) {
  std::string text = kHead;
  for (const std::string& form : table.forms) text += " " + form + " |";
  text += "\n|---|";
  for (std::size_t k = 0; k < table.forms.size(); ++k) text += "---|";
  text += "\n";
  for (const std::string& edit : table.edits) {
    text += "| " + edit + " |";
    for (const std::string& form : table.forms) {
      const auto& row = table.cells.at(edit);
      const auto cell = row.find(form);
      text += " " + (cell == row.end() ? "" : cell->second) + " |";
    }
    text += "\n";
  }
  const std::size_t from = page.find(kHead);
  if (from == std::string::npos) return page + "\n" + text;
  std::size_t to = from;
  while (to < page.size() && page[to] == '|') to = page.find('\n', to) + 1;
  return page.substr(0, from) + text + page.substr(to);
}

class EditsTable : public testing::TestWithParam<EditedForm> {};
INSTANTIATE_TEST_SUITE_P(Forms, EditsTable, testing::ValuesIn(edited_forms()), [](const auto& form) {
  std::string name = form.param.name();
  std::replace(name.begin(), name.end(), ' ', '_');
  return name;
});

TEST_P(EditsTable, SaysWhatCheckSays) {
  const std::string form = GetParam().name();
  const Editable p = Editable::make(GetParam());
  ASSERT_TRUE(p.made());
  const auto as_made = p.check_alone(p.lines());
  ASSERT_EQ(as_made.kind, "harmless") << as_made.text;
  const char* const rows = std::getenv("TOOTHPATH_WRITE_EDITS");
  const bool write = rows != nullptr;
  const std::regex wanted(write && rows != std::string("1") ? rows : "");
  std::string page = file_text(kTable);
  Table table = table_of(page);
  if (write && std::find(table.forms.begin(), table.forms.end(), form) == table.forms.end())
    table.forms.push_back(form);
  for (const auto& [name, lines] : edits_of(p)) {
    if (!std::regex_search(name, wanted)) continue;
    std::string said = "-";
    if (lines && *lines != p.lines()) {
      const Lines edited = renumbered(*lines, p.control());
      const auto found = p.check(edited);
      said = found.kind;
      std::optional<double> missed;
      if (said == "harmless" || said == "warning") {
        missed = p.missed_um(edited);
        // What passes leaves the tool where it must come; else nobody has looked.
        EXPECT_LE(missed.value_or(0), kHarmless_um) << form << ": " << name << " passes: " << found.text;
        EXPECT_LE(found.gouge_um, kTolerance_um);
      }
      std::printf("%-20s %-42s %-16s %s%s\n", form.c_str(), name.c_str(), said.c_str(),
                  missed ? fmt::format("{:.1f} um; ", *missed).c_str() : "", found.text.substr(0, 170).c_str());
    }
    if (write) {
      if (std::find(table.edits.begin(), table.edits.end(), name) == table.edits.end()) table.edits.push_back(name);
      table.cells[name][form] = said;
    } else {
      EXPECT_EQ(table.cells[name][form], said) << form << ": " << name;
    }
  }
  // None of them has left anything with the checker.
  EXPECT_EQ(p.check(p.lines()), as_made);
  if (write) write_file(kTable, page_with(page, table));
}

}  // namespace
}  // namespace toothpath::test
