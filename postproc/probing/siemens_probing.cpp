// Siemens. A way along Z or across it is the X, Y or Z of a frame that turns about Z, and CYCLE978 measures along it:
// it takes the calibrated radius off and leaves the coordinate of the surface, the text puts the nominal radius on
// again. A flank is touched aslant. MEAS=1 deletes the rest of such a way when the probe switches; $AC_MEA says whether
// it did, $AA_MW where.
#include <cmath>
#include <optional>

#include "geometry/base/angle.h"
#include "postproc/probing/probing_text.h"

namespace toothpath::probing {
namespace {

constexpr double kNever = 0.01;  // mm, beyond the way that is measured: a safe area and tolerances that are not left
constexpr double kAlong = 1e-5;  // rad, of a way from its axis: a rotary's last digit is 2e-6, the text's one 5e-5 mm

/// A length, four decimals.
std::string number(double mm) { return word('X', mm).substr(1); }

/// "X=.." as Siemens may write every word.
std::string assigned(const Vec3& place, int from, int count) {
  std::string out;
  for (int k = from; k < count; ++k) out += (k > from ? " " : "") + fmt::format("{}={}", "XYZ"[k], number(place[k]));
  return out;
}

/// The axis of a frame along which a touch goes.
struct Measured {
  int axis = 0;              ///< 0 to 2: X Y Z
  int sense = 1;             ///< of the way in it
  double turn_deg = 0;       ///< of the frame about Z
  Vec3 unit = Vec3::Zero();  ///< of the axis, work offset
};

std::optional<Measured> measured_along(const ProbeTouch& touch) {
  const Vec3 way = (touch.past - touch.start).normalized();
  for (int k = 0; k < 3; ++k)
    if (const int sense = way[k] < 0 ? -1 : 1; (way - sense * Vec3::Unit(k)).norm() < kAlong)
      return Measured{k, sense, 0, Vec3::Unit(k)};
  if (std::abs(way.z()) >= kAlong) return {};
  const double turn = std::atan2(way.y(), way.x());
  return Measured{0, 1, degrees(turn), {std::cos(turn), std::sin(turn), 0}};
}

class Writer {
 public:
  explicit Writer(const ProbeProgram& program)
      : program_(program), top_(fmt::format("G0 SUPA D0 Z={}", number(program.top_mm))) {}

  std::string text() && {
    head();
    for (std::size_t k = 0; k < program_.touches.size(); ++k) touch(program_.touches[k], coming_to(program_, k));
    add(top_);
    add("M30");
    for (const char* line : {"ON_THE_WAY:", "SETAL(65001,\"THE PROBE MET SOMETHING ON ITS WAY\")", "M30"}) add(line);
    if (meas_)
      for (const char* line : {"NOTHING_MET:", "SETAL(65002,\"THE PROBE MET NOTHING\")", "M30"}) add(line);
    return std::move(out_);
  }

 private:
  void add(const std::string& line) { out_ += line + "\n"; }
  std::string feed(double value) const { return fmt::format(" F{}", number(value)); }

  void head() {
    for (const auto& line : header(program_)) add("; " + line);
    bool cycles = false;
    for (const ProbeTouch& touch : program_.touches) cycles = cycles || measured_along(touch);
    if (cycles) {
      add("; CYCLE978 MEASURES WITH FIELD 1 OF THE CALIBRATION DATA AND THE FEED OF THE CALIBRATION");
      add(fmt::format("; IT TAKES THE CALIBRATED RADIUS OFF: THE LOG HAS THE CENTRE OF A BALL OF {:.4f} MM",
                      program_.ball_diameter_mm));
    }
    add("DEF INT FAULT");
    add(kModes);
    add("TRAFOOF");
    add("ROT");
    add("COMPOF");
    add(program_.work_offset);
    add(top_);
    add(fmt::format("T=\"T{}\"", program_.tool));
    add("M6");
    turn(program_.touches.front());
    add("DELETE(FAULT,\"PROBE_RESULTS\")");
  }
  void turn(const ProbeTouch& touch) {
    add(top_);
    std::string rotaries;
    for (const auto& [letter, angle] : touch.rotaries)
      rotaries += fmt::format(" {}={}", letter, word(letter, angle).substr(1));
    if (!rotaries.empty()) add("G0" + rotaries);
    add("D1");
  }
  void guarded(const std::string& where) {
    add("MEAS=1 G1 " + where + feed(program_.guarded_feed));
    add("STOPRE");
    add("IF $AC_MEA[1]==1 GOTOF ON_THE_WAY");
  }

  void touch(const ProbeTouch& touch, Coming coming) {
    const Vec3 above(touch.start.x(), touch.start.y(), program_.clear_mm);
    add(fmt::format("; TOUCH {} {}", touch.number, touch.remark));
    if (coming == Coming::turned) turn(touch);
    if (coming == Coming::beside) {
      guarded(assigned(above, 0, 2));
    } else {
      add("G0 " + assigned(above, 0, 2));
      guarded(assigned(above, 2, 3));
    }
    guarded(assigned(touch.start, 2, 3));
    if (const auto along = measured_along(touch)) cycle(touch, *along);
    else meas(touch);
    add(fmt::format("WRITE(FAULT,\"PROBE_RESULTS\",\"{} \"<<R1<<\" \"<<R2<<\" \"<<R3)", touch.number));
    add("G1 " + assigned(touch.start, 0, 3) + feed(program_.guarded_feed));
    add("G1 " + assigned(above, 2, 3));
  }
  void meas(const ProbeTouch& touch) {
    meas_ = true;
    add("MEAS=1 G1 " + assigned(touch.past, 0, 3) + feed(program_.feed));
    add("STOPRE");
    add("IF $AC_MEA[1]==0 GOTOF NOTHING_MET");
    for (int k = 0; k < 3; ++k) add(fmt::format("R{}=$AA_MW[{}]", k + 1, "XYZ"[k]));
  }
  /// The probe stands as far from the expected place as it looks behind it: the cycle has no way to go before.
  void cycle(const ProbeTouch& touch, const Measured& along) {
    const double radius = 0.5 * program_.ball_diameter_mm, way = (touch.meets - touch.start).norm();
    // Counted from the place of the words: what their last digit leaves is not logged.
    const double from = along.unit.dot(Vec3((touch.start * 1e4).array().round() / 1e4));
    const double surface = along.unit.dot(touch.meets) + along.sense * radius;
    if (along.turn_deg != 0) add(fmt::format("ROT Z={:.6f}", along.turn_deg));
    const std::string never = number(way + kNever);
    add(fmt::format("CYCLE978(0,,,1,{},{},{},{},{},1,\"\",,0,{},{},-{},,,,,1,1)", number(surface), number(way), never,
                    along.axis + 1, along.sense > 0 ? 1 : 2, never, never, never));
    if (along.turn_deg != 0) add("ROT");
    add(kModes);
    add(fmt::format("R4=_OVR[4]{}{}", along.sense > 0 ? '-' : '+', number(radius)));
    for (int k = 0; k < 3; ++k) {
      const bool whole = along.turn_deg == 0 && k == along.axis;
      const double share = along.unit[k];
      if (whole) add(fmt::format("R{}=R4", k + 1));
      else if (share == 0) add(fmt::format("R{}={}", k + 1, number(touch.start[k])));
      else add(fmt::format("R{}={}+(R4-({:.6f}))*({:.8f})", k + 1, number(touch.start[k]), from, share));
    }
  }

  static constexpr const char* kModes = "G17 G40 G90 G94 G710";
  const ProbeProgram& program_;
  const std::string top_;
  std::string out_;
  bool meas_ = false;
};

}  // namespace

Result<std::string> meas_probing(const ProbeProgram& program) { return Writer(program).text(); }

}  // namespace toothpath::probing
