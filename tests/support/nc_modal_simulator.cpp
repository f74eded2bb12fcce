#include "tests/support/nc_modal_simulator.h"

#include <regex>
#include <sstream>
#include <stdexcept>

namespace toothpath::test {
namespace {

struct Sets {
  const char* word;  // a whole word, or for `lines` a regular expression of the whole line
  const char* group;
  const char* value;
};

/// How a control is read. A group "-" stands for words without a mode.
struct Language {
  std::vector<Sets> words, lines;
  char comment = '(';  // what a comment begins with; "(" ends at ")", the others at the end of the line
  std::string axis;    // regular expression of an axis or value word: letter, value
  bool numbered = false;
  ModalState safe, end;
  std::vector<std::regex> patterns = {};  // of `lines`
  std::regex value = {};                  // of `axis`
};

const std::vector<Sets> kIso = {{"G0", "motion", "rapid"},
                                {"G1", "motion", "feed"},
                                {"G17", "plane", "xy"},
                                {"G18", "plane", "zx"},
                                {"G19", "plane", "yz"},
                                {"G20", "units", "inch"},
                                {"G21", "units", "mm"},
                                {"G90", "distance", "absolute"},
                                {"G91", "distance", "increments"},
                                {"G93", "feed", "inverse time"},
                                {"G94", "feed", "per minute"},
                                {"G95", "feed", "per turn"},
                                {"G40", "radius", "off"},
                                {"G41", "radius", "on"},
                                {"G42", "radius", "on"},
                                {"G49", "length", "off"},
                                {"G43", "length", "on"},
                                {"G80", "cycle", "off"},
                                {"G53", "-", "machine"},
                                {"G54", "offset", "G54"},
                                {"M3", "spindle", "on"},
                                {"M4", "spindle", "on"},
                                {"M5", "spindle", "off"},
                                {"M7", "coolant", "on"},
                                {"M8", "coolant", "on"},
                                {"M9", "coolant", "off"},
                                {"M6", "-", "tool change"},
                                {"M0", "-", "pause"},
                                {"/M0", "-", "pause"},
                                {"M1", "-", "pause"}};

std::vector<Sets> iso_and(std::vector<Sets> more) {
  more.insert(more.end(), kIso.begin(), kIso.end());
  return more;
}

const char* const kPlainWord = R"(([XYZABCFSTHDPQ])(-?\d*\.?\d*|\[.*\]))";

Language linuxcnc() {
  Language l;
  l.words = iso_and({{"G92.1", "shift", "off"},
                     {"G61", "smoothing", "off"},
                     {"G61.1", "smoothing", "off"},
                     {"G64", "smoothing", "on"},
                     {"M428", "tcp", "on"},
                     {"M429", "tcp", "off"},
                     {"M2", "-", "end"}});
  l.lines = {{R"(G52 [ABC]\[.*\])", "shift", "on"},
             {R"(G10 L2 P9 X#5221 Y#5222 Z#5223 C#5226 A#5224 R\[.*\])", "written offset", "turned"},
             {R"(G10 L2 P9 R0)", "written offset", "straight"},
             {"G59\\.3", "offset", "G59.3"},
             {"G59\\.3", "frame", "turned"},
             {"G54", "offset", "G54"},
             {"G54", "frame", "zero"}};
  l.axis = kPlainWord;
  l.safe = {{"units", "mm"},   {"plane", "xy"},   {"distance", "absolute"}, {"feed", "per minute"},
            {"radius", "off"}, {"length", "off"}, {"cycle", "off"},         {"shift", "off"},
            {"offset", "G54"}, {"frame", "zero"}};  // smoothing: on or off
                                                    // by what the cuts turn
  l.end = l.safe;
  l.end["smoothing"] = l.end["spindle"] = "off";
  return l;
}

Language fanuc() {
  Language l;
  l.words = iso_and({{"G69", "rotation", "off"},
                     {"G68", "rotation", "on"},
                     {"G61", "smoothing", "off"},
                     {"G64", "smoothing", "on"},
                     {"G43.4", "length", "on"},
                     {"M30", "-", "end"},
                     {"M99", "-", "return"}});
  l.lines = {{R"(%|O\d+ ?)", "-", ""},
             {R"(.*\bG43\.4\b.*)", "tcp", "on"},
             {R"(.*\bG49\b.*)", "tcp", "off"},
             {R"(G52 X0\. Y0\. Z0\.( [ABC]0\.)*)", "shift", "off"},
             {R"(G52 [ABC]-?\d+\.\d*)", "shift", "on"},
             {R"(N\d+ ?)", "-", ""}};
  l.axis = kPlainWord;
  // G49 stands in the block of the first retract: it is that motion which is safe.
  l.safe = {{"units", "mm"},  {"plane", "xy"},     {"distance", "absolute"}, {"feed", "per minute"}, {"radius", "off"},
            {"cycle", "off"}, {"rotation", "off"}, {"offset", "G54"},        {"smoothing", "off"},   {"shift", "off"}};
  l.end = l.safe;
  l.end["length"] = l.end["tcp"] = l.end["spindle"] = "off";
  return l;
}

Language siemens() {
  Language l;
  l.words = iso_and({{"G710", "units", "mm"},
                     {"G700", "units", "inch"},
                     {"SUPA", "-", "machine"},
                     {"COMPOF", "compressor", "off"},
                     {"D0", "length", "off"},
                     {"D1", "length", "on"},
                     {"G641", "smoothing", "on"},
                     {"G60", "smoothing", "off"},
                     {"ORIWKS", "orientation", "work"},
                     {"ORIAXES", "interpolation", "axes"},
                     {"M30", "-", "end"}});
  // TRAORI and TRAFOOF may drop the frames: the offset counts as lost until it is named again.
  l.lines = {{"TRAORI", "tcp", "on"},
             {"TRAFOOF", "tcp", "off"},
             {"TRAORI|TRAFOOF", "offset", "dropped"},
             {"ROT|TRANS", "frame", "zero"},
             {"ROT|TRANS", "shift", "off"},
             {"TRANS [ABC]=R2", "shift", "on"},
             {"ROT Z=R3", "frame", "turned"},
             {R"(CYCLE832\([0-9.]+,_(ORI_)?FINISH,[0-9.]+\))", "smoothing", "on"},
             {R"(CYCLE832\(\))", "smoothing", "off"},
             {R"((R\d|TOOTH)=.*|DEF INT COUNT(,TOOTH)?)", "-", ""},
             {R"(FOR .*|ENDFOR)", "-", ""},
             {R"re(MSG\(("[^"]*")?\))re", "-", ""},
             {R"re(T="T\d+")re", "-", ""},
             {R"(FGROUP\([A-Z,]+\))", "path group", "named"},
             {R"(FGROUP\(\))", "path group", "machine"},
             {R"(FGREF\[[ABC]\]=\d+)", "-", ""}};
  l.comment = ';';
  l.axis = R"(([XYZ]|[ABC]=|[ABC]3=|F|S|ADIS=)(R2(?:[+-]\d*\.?\d*)?|-?\d*\.?\d*))";
  l.safe = {{"units", "mm"},   {"plane", "xy"},     {"distance", "absolute"}, {"feed", "per minute"},
            {"radius", "off"}, {"tcp", "off"},      {"frame", "zero"},        {"compressor", "off"},
            {"offset", "G54"}, {"smoothing", "on"}, {"shift", "off"}};
  l.end = l.safe;
  l.end["length"] = l.end["smoothing"] = l.end["spindle"] = "off";
  return l;
}

Language heidenhain() {
  Language l;
  l.words = {{"L", "-", ""},
             {"LN", "-", ""},
             {"R0", "radius", "off"},
             {"RL", "radius", "on"},
             {"RR", "radius", "on"},
             {"FMAX", "-", "rapid"},
             {"M91", "-", "machine"},
             {"M126", "travel", "shorter"},
             {"M127", "travel", "plain"},
             {"M3", "spindle", "on"},
             {"M5", "spindle", "off"},
             {"M8", "coolant", "on"},
             {"M9", "coolant", "off"},
             {"M0", "-", "pause"},
             {"/M0", "-", "pause"},
             {"M1", "-", "pause"},
             {"M30", "-", "end"}};
  l.lines = {{R"(BEGIN PGM \S+ MM)", "units", "mm"},
             {R"(BEGIN PGM \S+ INCH)", "units", "inch"},
             {R"(END PGM \S+ MM)", "-", ""},
             {"PLANE RESET STAY", "tilt", "off"},
             {"FUNCTION RESET TCPM", "tcp", "off"},
             {"FUNCTION TCPM F TCP AXIS POS PATHCTRL AXIS", "tcp", "on"},
             {"TRANS DATUM RESET", "shift", "off"},
             {R"(CYCL DEF 7\.0 DATUM SHIFT|CYCL DEF 10\.0 ROTATION|CYCL DEF 32\.0 TOLERANCE)", "-", ""},
             {R"(CYCL DEF 7\.1 [ABC]\+Q2)", "shift", "on"},
             {R"(CYCL DEF 10\.1 ROT\+0)", "frame", "zero"},
             {R"(CYCL DEF 10\.1 ROT\+Q3)", "frame", "turned"},
             {R"(CYCL DEF 247 DATUM SETTING Q339=\+1)", "offset", "G54"},
             {R"(CYCL DEF 32\.1 T[0-9.]+)", "smoothing", "on"},
             {R"(CYCL DEF 32\.1)", "smoothing", "off"},
             {R"(CYCL DEF 32\.2 HSC-MODE:0 TA[0-9.]+)", "axis smoothing", "on"},
             {R"(TOOL CALL \d+ Z S\d+)", "length", "on"},
             {R"(TOOL CALL \d+ Z S\d+)", "-", "tool change"},
             {R"(TOOL CALL S\d+|TOOL DEF \d+)", "-", ""},
             {R"(Q\d = .*)", "-", ""},
             {R"(LBL \d+)", "-", ""}};
  l.comment = ';';
  l.axis = R"(([XYZABCF]|T[XYZ])([+-]?\d*\.?\d*))";
  l.numbered = true;
  l.safe = {{"units", "mm"},   {"tilt", "off"},   {"tcp", "off"},        {"shift", "off"},
            {"frame", "zero"}, {"offset", "G54"}, {"travel", "shorter"}, {"smoothing", "on"}};
  l.end = l.safe;
  l.end["smoothing"] = l.end["spindle"] = "off";
  l.end["travel"] = "plain";
  l.end["radius"] = "off";
  return l;
}

Language apt() {
  Language l;
  l.lines = {{R"(PARTNO/.*)", "-", ""},
             {"UNITS/MM", "units", "mm"},
             {"UNITS/INCHES", "units", "inch"},
             {"MULTAX/ON", "axes", "all"},
             {R"(LOADTL/\d+,LENGTH,[0-9.]+)", "-", "tool change"},
             {R"(CUTTER/[0-9.,]+)", "-", ""},
             {R"(SPINDL/RPM,\d+,CLW)", "spindle", "on"},
             {"SPINDL/OFF", "spindle", "off"},
             {"COOLNT/ON|COOLNT/FLOOD|COOLNT/MIST", "coolant", "on"},
             {"COOLNT/OFF", "coolant", "off"},
             {"RAPID", "next", "rapid"},
             {R"(FEDRAT/[0-9.]+,MMPM)", "feed", "per minute"},
             {R"(GOTO/.*)", "-", ""},
             {"END", "-", "end"},
             {"FINI", "-", ""}};
  l.comment = '$';  // "$$"; one alone goes on in the next line
  l.axis = "";
  l.safe = {{"units", "mm"}, {"axes", "all"}};
  l.end = l.safe;
  l.end["spindle"] = "off";
  return l;
}

const Language& language(const std::string& dialect) {
  static const std::map<std::string, Language> all = [] {
    std::map<std::string, Language> m = {{"linuxcnc", linuxcnc()},
                                         {"fanuc", fanuc()},
                                         {"mitsubishi_m80", fanuc()},
                                         {"haas", fanuc()},
                                         {"siemens", siemens()},
                                         {"heidenhain", heidenhain()},
                                         {"apt", apt()}};
    for (auto& [name, l] : m) {
      for (const auto& s : l.lines) l.patterns.emplace_back(s.word);
      l.value = std::regex(l.axis);
    }
    return m;
  }();
  const auto found = all.find(dialect);
  if (found == all.end()) throw std::invalid_argument("no modal data for " + dialect);
  return found->second;
}

struct Line {
  int number = 0;
  std::string code, comment;
};

std::string trimmed(const std::string& s) {
  const auto b = s.find_first_not_of(' ');
  return b == std::string::npos ? std::string() : s.substr(b, s.find_last_not_of(' ') + 1 - b);
}

/// Lines without numbers and comments; an APT statement that goes on in the next line is one.
std::vector<Line> lines_of(const std::string& text, const Language& l) {
  std::vector<Line> out;
  std::istringstream in(text);
  int n = 0;
  std::string carried;
  for (std::string s; std::getline(in, s);) {
    ++n;
    if (l.numbered) s.erase(0, s.find(' ') + 1);
    Line line;
    line.number = n;
    const std::string open = l.comment == '$' ? "$$" : std::string(1, l.comment);
    if (const auto from = s.find(open); from != std::string::npos) {
      const auto to = l.comment == '(' ? s.find(')', from) : s.size();
      line.comment = trimmed(s.substr(from + open.size(), to - from - open.size()));
      s.erase(from, to == std::string::npos ? to : to + 1 - from);
    }
    line.code = carried + trimmed(s);
    carried.clear();
    if (!line.code.empty() && line.code.back() == '$') {
      carried = line.code.substr(0, line.code.size() - 1);
      continue;
    }
    out.push_back(line);
  }
  return out;
}

/// Order of execution: sub-programs at their calls, loops twice.
class Order {
 public:
  explicit Order(const std::vector<Line>& lines) : lines_(lines) {
    std::smatch m;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      if (lines[i].code.empty() || std::string("oON").find(lines[i].code[0]) == std::string::npos) continue;
      if (std::regex_match(lines[i].code, m, kSub) || std::regex_match(lines[i].code, m, kProgram)) subs_[m[1]] = i + 1;
    }
    run(0);
  }
  [[nodiscard]] const std::vector<std::size_t>& executed() const { return executed_; }

 private:
  std::size_t skip_to(std::size_t from, const std::string& code) const {
    while (from < lines_.size() && lines_[from].code != code) ++from;
    return from;
  }
  void run(std::size_t i) {
    std::smatch m;
    std::map<std::size_t, int> repeated;
    for (; i < lines_.size(); ++i) {
      const std::string& c = lines_[i].code;
      if (c.empty() || std::string("oMECF").find(c[0]) == std::string::npos) {
        executed_.push_back(i);
      } else if (std::regex_match(c, m, kSub)) {
        i = skip_to(i, "o" + m[1].str() + " endsub");
      } else if (std::regex_match(c, m, kEndSub)) {
        return;
      } else if (std::regex_match(c, m, kCall)) {
        run(subs_.at(m[1]));
      } else if (std::regex_match(c, m, kEnd) || std::regex_match(c, m, kRepeat)) {
        if (repeated[i]++ == 0) i = start_of(i, m);
      } else if (!std::regex_match(c, kWhile)) {
        executed_.push_back(i);
        if (c == "M99" || c == "M30" || c == "M2" || c == "FINI") return;
      }
    }
  }
  /// Line behind which the loop that ends at `i` begins.
  std::size_t start_of(std::size_t i, const std::smatch& m) const {
    const std::string& code = lines_[i].code;
    const std::string number = m.size() > 2 && m[2].matched ? m[2].str() : m[1].str();
    const std::string begin = code == "ENDFOR"                        ? "FOR "
                              : code.find("LBL") != std::string::npos ? "LBL " + number
                                                                      : "o" + number + " while";
    while (i > 0 && lines_[i].code.rfind(begin, 0) != 0) --i;
    return i;
  }

  inline static const std::regex kSub{R"(o(\d+) sub)"}, kEndSub{R"(o(\d+) endsub)"},
      kCall{R"((?:o|M9[78] P)(\d+)(?: call.*)?)"}, kWhile{R"(o(\d+) while .*)"}, kEnd{R"((?:o(\d+) endwhile|ENDFOR))"},
      kRepeat{R"((?:CALL LBL (\d+) REP\d+|FN 12: IF \+Q\d LT \+\d+ GOTO LBL (\d+)))"}, kProgram{R"([ON](\d+))"};
  const std::vector<Line>& lines_;
  std::map<std::string, std::size_t> subs_;
  std::vector<std::size_t> executed_;
};

/// What a line says, whatever stands around it.
struct Meaning {
  std::vector<const Sets*> sets;
  std::map<std::string, std::string> words;
  bool vector = false, known = true;
};

Meaning read_line(const Language& l, const std::string& code) {
  Meaning out;
  bool line_known = false;
  for (std::size_t i = 0; i < l.lines.size(); ++i)
    if (std::regex_match(code, l.patterns[i])) {
      out.sets.push_back(&l.lines[i]);
      line_known = true;
    }
  if (l.comment == '$') {
    if (code.rfind("GOTO/", 0) == 0) {
      static const std::vector<std::string> names = {"X", "Y", "Z", "I", "J", "K"};
      std::istringstream in(code.substr(5));
      std::size_t n = 0;
      for (std::string v; n < names.size() && std::getline(in, v, ',');) out.words[names[n++]] = v;
      out.vector = true;
    }
    if (code.rfind("FEDRAT/", 0) == 0) out.words["F"] = code.substr(7);
    if (code.rfind("SPINDL/RPM", 0) == 0) out.words["S"] = code.substr(11);
    out.known = line_known;
    return out;
  }
  // Statements whose words are no axis words, and assignments.
  static const std::regex statement(
      R"(ROT .*|G52 .*|G10 .*|CYCL .*|TOOL .*|FUNCTION .*|PLANE .*|TRANS.*|BEGIN .*|END .*|Q\d .*|FN .*|R\d=.*|FOR .*|LBL .*)"),
      assignment(R"(#\d=.*)");
  if (line_known && (code.find(' ') == std::string::npos || std::regex_match(code, statement))) return out;
  if (std::regex_match(code, assignment)) return out;
  std::istringstream in(code);
  for (std::string w; in >> w;) {
    bool found = line_known;
    for (const auto& s : l.words)
      if (w == s.word) {
        out.sets.push_back(&s);
        found = true;
      }
    std::smatch m;
    if (std::regex_match(w, m, l.value) && m[2].length() > 0) {
      std::string name = m[1];
      if (name.size() == 2 && name[1] == '=') name.pop_back();
      out.vector = out.vector || (name.size() >= 2 && (name[0] == 'T' || name.find('3') != std::string::npos));
      out.words[name] = m[2];
      found = true;
    }
    out.known = out.known && found;
  }
  return out;
}

/// The same, remembered: programs repeat their lines.
const Meaning& meaning_of(const std::string& dialect, const std::string& code) {
  static std::map<std::pair<std::string, std::string>, Meaning> all;
  const auto found = all.find({dialect, code});
  return found != all.end() ? found->second
                            : all.emplace(std::pair{dialect, code}, read_line(language(dialect), code)).first->second;
}

/// Returns false where a word is not in the data.
bool apply(const std::string& dialect, ModalBlock& b) {
  const Meaning& meaning = meaning_of(dialect, b.code);
  b.words = meaning.words;
  b.vector = meaning.vector;
  for (const Sets* s : meaning.sets) {
    const std::string group = s->group, value = s->value;
    if (group != "-") b.after[group] = value;
    b.machine = b.machine || value == "machine";
    b.tool_change = b.tool_change || value == "tool change";
    b.end = b.end || value == "end";
    b.rapid = b.rapid || (group == "-" && value == "rapid");
  }
  for (const char* a : {"X", "Y", "Z", "A", "B", "C"}) b.moves = b.moves || b.has(a);
  if (!b.moves) {
    b.rapid = false;
  } else if (dialect == "apt") {
    b.rapid = b.before.count("next") != 0;
    b.after.erase("next");
  } else if (dialect != "heidenhain") {
    b.rapid = b.after.count("motion") != 0 && b.after.at("motion") == "rapid";
  }
  return meaning.known;
}

}  // namespace

const std::string& ModalBlock::mode(const std::string& group) const {
  static const std::string none = "never set";
  const auto found = after.find(group);
  return found == after.end() ? none : found->second;
}

ModalRun simulate_modes(const std::string& text, const std::string& dialect) {
  const Language& l = language(dialect);
  const auto lines = lines_of(text, l);
  ModalRun run;
  ModalState state;
  const Order order(lines);
  for (const std::size_t i : order.executed()) {
    ModalBlock b;
    b.line = lines[i].number;
    b.code = lines[i].code;
    b.comment = lines[i].comment;
    b.before = b.after = state;
    if (!b.code.empty() && !apply(dialect, b)) run.unknown.push_back(std::to_string(b.line) + ": " + b.code);
    if (b.moves) b.after["place"] = b.machine ? "machine top" : "at work";
    state = b.after;
    run.ended = run.ended || b.end;
    run.blocks.push_back(std::move(b));
  }
  return run;
}

const ModalState& safe_modes(const std::string& dialect) { return language(dialect).safe; }
const ModalState& end_modes(const std::string& dialect) { return language(dialect).end; }

}  // namespace toothpath::test
