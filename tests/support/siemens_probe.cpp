#include "tests/support/siemens_probe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <sstream>

namespace toothpath::test {
namespace {

/// Sums of products of numbers, R parameters and brackets.
class Sum {
 public:
  Sum(const std::string& text, const std::map<std::string, double>& values) : text_(text), values_(values) {}
  double whole() {
    const double v = sum();
    EXPECT_EQ(at_, text_.size()) << text_;
    return v;
  }

 private:
  bool take(char c) { return at_ < text_.size() && text_[at_] == c ? (++at_, true) : false; }
  double sum() {
    double v = product();
    while (true) {
      if (take('+')) v += product();
      else if (take('-')) v -= product();
      else return v;
    }
  }
  double product() {
    double v = factor();
    while (take('*')) v *= factor();
    return v;
  }
  double factor() {
    if (take('-')) return -factor();
    if (take('(')) {
      const double v = sum();
      EXPECT_TRUE(take(')')) << text_;
      return v;
    }
    std::smatch m;
    const std::string rest = text_.substr(at_);
    if (std::regex_search(rest, m, std::regex(R"(^[0-9]+\.?[0-9]*)"))) {
      at_ += std::size_t(m.length());
      return std::stod(m.str());
    }
    if (std::regex_search(rest, m, std::regex(R"(^(R[0-9]+|_OVR\[[0-9]+\]|\$AA_MW\[[XYZ]\]))"))) {
      at_ += std::size_t(m.length());
      const auto found = values_.find(m.str());
      if (found != values_.end()) return found->second;
    }
    ADD_FAILURE() << text_ << " at " << at_;
    return NAN;
  }

  const std::string& text_;
  const std::map<std::string, double>& values_;
  std::size_t at_ = 0;
};

class Control {
 public:
  Control(const std::string& text, const SiemensProbe& probe) : in_(text), probe_(probe) {}

  SiemensProbing run() && {
    for (std::string line; out_.alarm.empty() && !ended_ && std::getline(in_, line);) {
      SCOPED_TRACE(line);
      execute(line);
    }
    EXPECT_TRUE(ended_ || !out_.alarm.empty()) << "no M30";
    return std::move(out_);
  }

 private:
  void execute(const std::string& line) {
    std::smatch m;
    if (std::regex_search(line, m, std::regex("^; TOUCH ([0-9]+) "))) number_ = std::stoi(m[1]);
    if (line[0] == ';' || line == "TRAFOOF" || line == "COMPOF" || line == "D1" || line == "M6" || line == "STOPRE" ||
        line.rfind("DEF INT ", 0) == 0 || line.rfind("G54", 0) == 0 || line.rfind("T=", 0) == 0)
      return;
    if (line == "M30") ended_ = true;
    else if (line == "ROT") turn_ = 0;
    else if (line.rfind("ROT Z=", 0) == 0) turn_ = std::stod(line.substr(6)) * M_PI / 180;
    else if (line.rfind("DELETE(", 0) == 0) out_.log.clear();
    else if (line == "G17 G40 G90 G94 G710") modes_ = true;
    else if (line.rfind("CYCLE978(", 0) == 0) cycle(line);
    else if (line.rfind("WRITE(", 0) == 0) write(line);
    else if (std::regex_match(line, m, std::regex(R"(IF \$AC_MEA\[1\]==([01]) GOTOF (\w+))"))) {
      if (met_ == (m[1] == "1")) out_.alarm = m[2];
    } else if (std::regex_match(line, m, std::regex(R"((R[0-9]+)=(.*))"))) {
      const std::string right = m[2];
      values_[m[1]] = Sum(right, values_).whole();
    } else {
      motion(line);
    }
  }

  void motion(const std::string& line) {
    const bool measures = line.rfind("MEAS=1 G1 ", 0) == 0;
    if (!measures && !std::regex_search(line, std::regex("^G[01] "))) {
      ADD_FAILURE() << "not understood";
      return;
    }
    if (line.find("SUPA") != std::string::npos) {
      at_ = {NAN, NAN, NAN};
      return;
    }
    if (std::regex_search(line, std::regex(" [AC]="))) return;
    EXPECT_TRUE(modes_) << "G90 is not said again behind a cycle";
    EXPECT_EQ(turn_, 0) << "words in a turned frame";
    Vec3 to = at_;
    for (int k = 0; k < 3; ++k) {
      std::smatch m;
      if (std::regex_search(line, m, std::regex(std::string(" ") + "XYZ"[k] + R"(=(-?[0-9]+\.[0-9]+))")))
        to[k] = std::stod(m[1]);
    }
    if (measures && !std::isnan(at_.z())) {
      const bool touches = (to - at_).head<2>().norm() > 0 && to.z() != at_.z();
      const Vec3 from = at_;
      met_ = go(to);
      if (touches && met_) out_.touches.push_back({number_, false, from, to, contact_});
      for (int k = 0; k < 3; ++k) values_[std::string("$AA_MW[") + "XYZ"[k] + "]"] = at_[k];
    } else {
      met_ = false;
      if (!std::isnan(at_.z())) { EXPECT_FALSE(go(to)) << "the ball runs into the part"; }
      at_ = to;
    }
  }

  /// Straight to a place, or to where the signal comes. @returns whether it came; then `contact_` is the true touch.
  bool go(const Vec3& to) {
    const Vec3 from = at_;
    const double length = (to - from).norm();
    at_ = to;
    if (length == 0) return false;
    const Vec3 way = (to - from) / length;
    const auto gap = [&](double s) { return probe_.gap(number_, from + s * way); };
    double low = -1, high = -1;  // a ball that is on the part goes away from it first
    for (int k = 0; k <= 2000 && high < 0; ++k) {
      const double s = length * k / 2000;
      if (gap(s) > 0) low = s;
      else if (low >= 0) high = s;
    }
    if (high < 0) return false;
    for (int k = 0; k < 80; ++k) (gap(0.5 * (low + high)) <= 0 ? high : low) = 0.5 * (low + high);
    const double signal = high + probe_.pretravel_mm;
    if (signal > length) return false;
    contact_ = from + high * way;
    at_ = from + signal * way;
    return true;
  }

  /// CYCLE978(S_MVAR, S_KNUM, S_KNUM1, S_PRNUM, S_SETV, S_DFA, S_TSA, S_MA, S_MD, S_NMSP, S_TNAME, S_DLNUM, S_TZL,
  /// S_DIF, S_TUL, S_TLL, S_TMV, S_K, S_EVNUM, S_MCBIT, _DMODE, _AMODE): the surface is sought from S_DFA ahead of the
  /// setpoint to S_DFA behind it; afterwards the ball's skin stands S_DFA ahead of what was measured.
  void cycle(const std::string& line) {
    std::vector<std::string> p;
    std::string inside = line.substr(9, line.size() - 10);
    EXPECT_EQ(line.back(), ')');
    std::istringstream split(inside + ",");
    for (std::string part; std::getline(split, part, ',');) p.push_back(part);
    ASSERT_EQ(p.size(), 22u);
    EXPECT_EQ(p[0], "0") << "measures alone: no work offset and no tool is changed";
    EXPECT_TRUE(p[1].empty() && p[2].empty());
    EXPECT_EQ(p[20], "1") << "the plane is G17";
    const double setpoint = std::stod(p[4]), path = std::stod(p[5]), safe = std::stod(p[6]);
    const int axis = std::stoi(p[7]) - 1, sense = p[8] == "1" ? 1 : -1;
    ASSERT_TRUE(axis >= 0 && axis < 3 && (p[8] == "1" || p[8] == "2") && p[9] == "1");
    EXPECT_GT(path, 0);
    // A difference beyond the safe area, or beyond the tolerances, would be an alarm ahead of "no signal".
    EXPECT_GT(safe, path);
    EXPECT_LE(path, std::stod(p[14]));
    EXPECT_GE(-path, std::stod(p[15]));
    const Vec3 unit = axis == 2   ? Vec3(0, 0, 1)
                      : axis == 0 ? Vec3(std::cos(turn_), std::sin(turn_), 0)
                                  : Vec3(-std::sin(turn_), std::cos(turn_), 0);
    const double start = unit.dot(at_);
    // Farther off the cycle would go there by itself, nearer it would have to go back.
    EXPECT_NEAR(sense * (setpoint - start), path + probe_.radius_mm, 3e-4);
    const Vec3 from = at_, end = at_ + unit * (setpoint + sense * (path - probe_.radius_mm) - start);
    if (!go(end)) {
      out_.alarm = "61301";
      return;
    }
    out_.touches.push_back({number_, true, from, end, contact_});
    // Calibrated: the radius with which this way to the signal gives the surface.
    const double surface = unit.dot(at_) + sense * (probe_.radius_mm - probe_.pretravel_mm);
    values_["_OVR[0]"] = setpoint;
    values_["_OVR[4]"] = surface;
    values_["_OVR[16]"] = surface - setpoint;
    at_ += unit * (surface - sense * (path + probe_.radius_mm) - unit.dot(at_));
    met_ = modes_ = false;
  }

  void write(const std::string& line) {
    std::smatch m;
    ASSERT_TRUE(std::regex_match(
        line, m, std::regex(R"re(WRITE\(FAULT,"PROBE_RESULTS","([0-9]+) "<<(R\d)<<" "<<(R\d)<<" "<<(R\d)\))re")));
    EXPECT_EQ(std::stoi(m[1]), number_);
    std::ostringstream text;
    text.precision(12);
    text << m[1] << ' ' << values_[m[2]] << ' ' << values_[m[3]] << ' ' << values_[m[4]] << '\n';
    out_.log += text.str();
  }

  std::istringstream in_;
  const SiemensProbe& probe_;
  SiemensProbing out_;
  std::map<std::string, double> values_;
  Vec3 at_ = {NAN, NAN, NAN}, contact_ = Vec3::Zero();
  double turn_ = 0;
  int number_ = 0;
  bool met_ = false, modes_ = false, ended_ = false;
};

}  // namespace

SiemensProbing run_siemens_probing(const std::string& text, const SiemensProbe& probe) {
  return Control(text, probe).run();
}

}  // namespace toothpath::test
