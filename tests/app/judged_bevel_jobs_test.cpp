// Random bevel gears in turn in every form of output, judged by what shares nothing with the program: own reading of
// the text, own kinematics of the machine, and the solid finger mill along the paths that define the walls. The mill
// may cut into nothing, must have been wherever a wall is, and must leave no higher ridges than asked. Faults that are
// planted into the motions must be seen with their size.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "app/job/file.h"
#include "tests/app/judged.h"
#include "tests/app/refusals.h"
#include "tests/support/brute_force_bevel_gear.h"
#include "tests/support/random_jobs.h"

namespace toothpath::test {
namespace {

constexpr double kBevelSlack = 1e-4;  // mm: of the judge itself
constexpr int kProfilePlaces = 7, kWallPoints = 160, kRootPoints = 120, kOtherTeeth = 40;

/// Words with three digits behind the point; the other controls have four and more.
bool is_coarse(const std::string& control) { return control == "fanuc" || control == "haas"; }

/// Other teeth, angles and proportions than those of `random_bevel_job`: one hand or two, every side of the limits.
/// @param least_chord  of the finishing: chord + 1.5 um must be proven, which words of three decimals do not leave room
/// for
std::string random_judged_bevel_job(Random& random, double least_chord) {
  bevel_gear::BevelGearParameters p;
  p.teeth = 14 + int(random.index(26));
  p.mate_teeth = std::max(12, int(p.teeth * random(0.7, 2.6)));
  const double shaft = random(0, 1) < 0.7 ? 90 : random(70, 110), m = logarithmic(random, 2, 6), alpha = random(18, 23),
               spiral = random(18, 36);
  p.shaft_angle_rad = radians(shaft);
  p.outer_transverse_module_mm = m;
  p.pressure_angle_rad = radians(alpha);
  p.outer_spiral_angle_rad = radians(spiral);
  p.form = random(0, 1) < 0.65 ? bevel_gear::BevelForm::herringbone : bevel_gear::BevelForm::single;
  p.hand = random(0, 1) < 0.5 ? 1 : -1;
  p.backlash_mm = random(0, 1) < 0.5 ? 0 : 0.01 * m;
  p.addendum_mm = p.dedendum_mm = 1;
  p.face_width_mm = 1;
  const double outer = BruteForceBevelGear(p, {1, 0.1, 1, 1}).outer();
  p.face_width_mm = std::min(random(0.2, 0.3) * outer, random(6, 11) * m);
  p.apex_cone_distance_mm = outer - random(0.42, 0.58) * p.face_width_mm;
  const BruteForceBevelGear shape(p, {1, 0.1, 1, 1});
  p.addendum_mm = random(0.85, 1.02) * shape.normal_module(outer - p.face_width_mm / 2);
  p.dedendum_mm = random(1.15, 1.3) * p.addendum_mm;
  FingerMill mill{random(0.88, 1.0) * shape.normal_module(shape.inner()), 0.01, p.addendum_mm,
                  random(1.08, 1.2) * p.addendum_mm};
  const auto tips = BruteForceBevelGear(p, mill).mill().largest_tip_radii();
  mill.tip_radius = random(0.3, 1.03) * std::max(0.02, std::min(tips[0], tips[1]));
  const BruteForceBevelGear gear(p, mill);
  const bool two = p.form == bevel_gear::BevelForm::herringbone;
  std::string text = fmt::format(
      "schema = 1\nname = \"random\"\n[gear]\ntype = \"equal_base_circle_bevel_gear\"\nteeth = {}\nmate_teeth = {}\n"
      "shaft_angle = {:.3f}\nouter_transverse_module = {:.4f}\npressure_angle = {:.3f}\nouter_spiral_angle = {:.3f}\n"
      "face_width = {:.4f}\nform = \"{}\"\nhand = \"{}\"\napex_cone_distance = {:.4f}\naddendum = {:.4f}\n"
      "dedendum = {:.4f}\nbacklash = {:.4f}\n",
      p.teeth, p.mate_teeth, shaft, m, alpha, spiral, p.face_width_mm, two ? "herringbone" : "single",
      p.hand > 0 ? "right" : "left", p.apex_cone_distance_mm, p.addendum_mm, p.dedendum_mm, p.backlash_mm);
  if (two) text += fmt::format("relief_half_width = {:.4f}\n", random(0.98, 1.25) * gear.corner_reach());
  text += fmt::format(kRandomJobSetup, "260.0", "down");
  text += fmt::format(
      "[[tool]]\nnumber = 1\ntype = \"finger_mill\"\nmodule = {:.5f}\ntip_radius = {:.5f}\nrack_depth = {:.4f}\n"
      "profile_height = {:.4f}\nlength = 130.0\nshank_diameter = {:.3f}\nholder = [[32.0, 32.0, 40.0]]\n"
      "stick_out = {:.3f}\nteeth = 2\n",
      mill.module, mill.tip_radius, mill.rack_depth, mill.profile_height, 2.1 * gear.mill().largest_radius(),
      30 + 4 * m);
  return text + fmt::format(
                    "[[operation]]\ntype = \"finger_roughing\"\ntool = 1\nspeed = 4000\nfeed = 300.0\nridge = {:.3f}\n"
                    "[[operation]]\ntype = \"finger_finishing\"\ntool = 1\nspeed = 5000\nfeed = 250.0\nchord_tolerance "
                    "= {:.5f}\n[verify]\ngouge_tolerance = {:.4f}\n",
                    random(0.1, 0.3) * p.dedendum_mm, logarithmic(random, least_chord, 0.003), random(0.003, 0.006));
}

/// A motion and the tooth space in which it is.
struct SpaceMove {
  MachineMove move;
  int space = 0;  ///< -1: beside the blank, where turns of the tool and links are
};

struct Deepest {
  double depth = -1e9;  ///< positive: into what must remain
  int line = 0;
  Vec3 normal = Vec3::Zero();  ///< out of the mill there, frame of the gear
};

class BevelJudge {
 public:
  BevelJudge(const job::Job& job, const std::string& program, const std::string& machine)
      : gear_(*job.bevel_gear(), mill_of(job.tools.front())),
        dedendum_(job.bevel_gear()->dedendum_mm),
        addendum_(job.bevel_gear()->addendum_mm),
        length_(job.tools.front().length_mm),
        path_(program, machine, {{3, -2, 260}, true, {{3, -2, 0}, {0, length_}}}) {
    for (const MachineMove& move : path_.moves())
      if (!move.rapid) cuts_.push_back({move, near_teeth(move) ? space_of(move) : -1});
    for (const SpaceMove& cut : cuts_)
      if (cut.space >= 0 && first_space_ < 0) first_space_ = cut.space;
  }
  [[nodiscard]] const std::vector<std::string>& faults() const { return path_.faults(); }
  [[nodiscard]] const std::vector<SpaceMove>& cuts() const { return cuts_; }
  [[nodiscard]] const BruteForceBevelGear& gear() const { return gear_; }
  [[nodiscard]] int first_space() const { return first_space_; }
  [[nodiscard]] std::vector<const SpaceMove*> in_space(int space) const {
    std::vector<const SpaceMove*> out;
    for (const auto& c : cuts_)
      if (c.space == space) out.push_back(&c);
    return out;
  }
  /// Moves the record between a cut and the next one, as a wrong word would.
  void move_record(std::size_t cut, const Vec3& by) {
    const auto shift = [&](PlainJoints& joints, Vec3& tip) {
      const Vec3 there = path_.in_table(by);
      path_.machine().bring_tip(joints, path_.machine().place(joints, length_).tip + there, length_);
      tip += there;
    };
    shift(cuts_[cut].move.to, cuts_[cut].move.tip_to);
    shift(cuts_[cut + 1].move.from, cuts_[cut + 1].move.tip_from);
  }

  /// The motions to look at: all of the first space; of the others those that are no turned copies of them to within
  /// the last digits, and some of the rest.
  [[nodiscard]] std::vector<const SpaceMove*> to_judge(std::uint64_t seed) const {
    const auto first = in_space(first_space_);
    std::vector<const SpaceMove*> out = first;
    std::vector<const SpaceMove*> copies;
    const int count = int(std::lround(2 * kPi / gear_.pitch()));
    for (int space = -1; space < count; ++space) {
      if (space == first_space_) continue;
      const auto here = in_space(space);
      for (std::size_t k = 0; k < here.size(); ++k)
        (space >= 0 && here.size() == first.size() && is_copy(*here[k], *first[k]) ? copies : out).push_back(here[k]);
    }
    Random random(seed);
    for (int k = 0; k < kOtherTeeth && !copies.empty(); ++k) out.push_back(copies[random.index(copies.size())]);
    return out;
  }

  /// Deepest place of the mill, thickened by `more`, at a moment of a motion.
  [[nodiscard]] Deepest deepest_at(const MachineMove& move, double t, double more = 0) const {
    const ToolPlace at = path_.at(move, t);
    const Vec3 a = at.axis.unitOrthogonal(), b = at.axis.cross(a);
    Deepest out;
    out.line = move.line;
    for (const auto& place : profile()) {
      const auto point = [&](double turn) -> Vec3 {
        const Vec3 side = std::cos(turn) * a + std::sin(turn) * b;
        return at.tip + (place.x + dedendum_ + more * place.normal_x) * at.axis +
               (place.rho + more * place.normal_rho) * side;
      };
      const auto shallow = [&](double turn) { return -gear_.depth(point(turn)); };
      // From the middle of the space outwards: two sides, each with its place of contact.
      std::array<double, 12> coarse{};
      for (std::size_t k = 0; k < coarse.size(); ++k)
        coarse[k] = -gear_.depth(point(double(k) * kPi / 6), -0.25 - more);
      for (std::size_t k = 0; k < coarse.size(); ++k) {
        const double before = coarse[(k + 11) % 12], after = coarse[(k + 1) % 12];
        if (coarse[k] > before || coarse[k] > after || coarse[k] > 0.12 * place.rho + 0.02) continue;
        double turn = 0;
        const double found = -least_of(shallow, (double(k) - 1) * kPi / 6, (double(k) + 1) * kPi / 6, 5, &turn);
        if (found <= out.depth) continue;
        out.depth = found;
        out.normal = place.normal_x * at.axis + place.normal_rho * (std::cos(turn) * a + std::sin(turn) * b);
      }
    }
    return out;
  }
  /// Over motions, at their ends and middles.
  [[nodiscard]] Deepest deepest(const std::vector<const SpaceMove*>& moves, double more = 0) const {
    Deepest out;
    for (const SpaceMove* m : moves)
      for (const double t : {0.5, 1.0})
        if (const Deepest here = deepest_at(m->move, t, more); here.depth > out.depth) out = here;
    return out;
  }
  /// How far the flat tip is below the root cone, at most.
  [[nodiscard]] double below_root(const std::vector<const SpaceMove*>& moves) const {
    double most = -1e9;
    for (const SpaceMove* m : moves)
      for (const double t : {0.5, 1.0}) {
        const Vec3 tip = path_.at(m->move, t).tip;
        const double ell = gear_.ell_of(tip);
        if (ell > gear_.inner() && ell < gear_.outer()) most = std::max(most, -dedendum_ - gear_.height_of(tip));
      }
    return most;
  }

  /// Least distance of a place of the first space to the mill on all its motions: what stands there, or minus how deep
  /// it was cut.
  [[nodiscard]] double left_at(const Vec3& p, const std::vector<const SpaceMove*>& moves) const {
    double least = 1e9;
    for (const SpaceMove* m : moves) {
      const Vec3 a = path_.at(m->move, 0).tip, b = path_.at(m->move, 1).tip;
      if (((a + b) / 2 - p).norm() - (a - b).norm() / 2 > 3 * (dedendum_ + addendum_) + least) continue;
      const auto distance = [&](double t) {
        const ToolPlace at = path_.at(m->move, t);
        const Vec3 from = p - at.tip;
        return gear_.mill().clearance(from.dot(at.axis) - dedendum_, from.cross(at.axis).norm());
      };
      least = std::min(least, least_of(distance, 0, 1, 3));
    }
    return least;
  }
  /// Most that stands on the walls of the first space, and where it is cut deepest.
  [[nodiscard]] std::array<double, 2> walls(const std::vector<const SpaceMove*>& moves, std::uint64_t seed) const {
    Random random(seed);
    double most = -1e9, least = 1e9;
    for (int k = 0; k < kWallPoints;) {
      const double ell = random(gear_.inner(), gear_.outer()), height = random(-0.8 * dedendum_, addendum_);
      if (gear_.in_groove(ell)) continue;
      const double left =
          left_at(turned(gear_.place(ell, gear_.wall(k % 2 ? 1 : -1, ell, height), height), moves), moves);
      most = std::max(most, left);
      least = std::min(least, left);
      ++k;
    }
    return {most, least};
  }
  /// Most that stands above a height over the root, anywhere between the walls.
  [[nodiscard]] double ridges(const std::vector<const SpaceMove*>& moves, double ridge, std::uint64_t seed) const {
    Random random(seed);
    double most = -1e9;
    for (int k = 0; k < kRootPoints;) {
      const double ell = random(gear_.inner(), gear_.outer());
      if (gear_.in_groove(ell)) continue;
      const auto room = gear_.room(ell);
      const Vec3 p = gear_.place(ell, room[0] + random(0, 1) * (room[1] - room[0]), ridge - dedendum_);
      most = std::max(most, left_at(turned(p, moves), moves));
      ++k;
    }
    return most;
  }

 private:
  [[nodiscard]] Vec3 turned(const Vec3& p, const std::vector<const SpaceMove*>& moves) const {
    return Eigen::AngleAxisd(moves.front()->space * gear_.pitch(), Vec3::UnitZ()) * p;
  }
  [[nodiscard]] const std::vector<PlainFingerMill::Place>& profile() const {
    if (profile_.empty()) profile_ = gear_.mill().places(addendum_, kProfilePlaces);
    return profile_;
  }
  [[nodiscard]] bool near_teeth(const MachineMove& move) const {
    const double beside = 3 * gear_.mill().largest_radius();
    for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
      const Vec3 tip = path_.at(move, t).tip;
      const double ell = gear_.ell_of(tip);
      if (gear_.height_of(tip) < addendum_ && ell > gear_.inner() - beside && ell < gear_.outer() + beside) return true;
    }
    return false;
  }
  [[nodiscard]] int space_of(const MachineMove& move) const {
    // Of both ends the one nearer to the middle of the face.
    double azimuth = 0, best = 1e9;
    for (const double t : {0.0, 1.0}) {
      const ToolPlace at = path_.at(move, t);
      const double R = gear_.ell_of(at.tip), off = std::abs(R - 0.5 * (gear_.inner() + gear_.outer()));
      if (off >= best) continue;
      best = off;
      const auto room = gear_.room(R);
      azimuth = std::atan2(at.tip.y(), at.tip.x()) - 0.5 * (room[0] + room[1]);
    }
    const int count = int(std::lround(2 * kPi / gear_.pitch()));
    return (int(std::lround(azimuth / gear_.pitch())) % count + count) % count;
  }
  /// To within the last digits of the words.
  [[nodiscard]] bool is_copy(const SpaceMove& one, const SpaceMove& other) const {
    const bool coarse = is_coarse(path_.machine().control());
    const double of_tip = coarse ? 1.5e-3 : 2e-4, of_turn = coarse ? 2e-5 : 3e-6;
    const Eigen::AngleAxisd turn((other.space - one.space) * gear_.pitch(), Vec3::UnitZ());
    for (const double t : {0.0, 1.0}) {
      const ToolPlace a = path_.at(one.move, t), b = path_.at(other.move, t);
      const double radius = b.tip.head<2>().norm();
      if ((turn * a.tip - b.tip).norm() > of_tip + radius * of_turn || (turn * a.axis - b.axis).norm() > 2 * of_turn)
        return false;
    }
    return true;
  }

  BruteForceBevelGear gear_;
  double dedendum_, addendum_, length_;
  JudgedPath path_;
  std::vector<SpaceMove> cuts_;
  int first_space_ = -1;
  mutable std::vector<PlainFingerMill::Place> profile_;
};

/// The judge sees what is wrong, with its size: a thicker mill, one record into the wall, an axis that turns the other
/// way.
void expect_planted_faults_seen(const BevelJudge& good, const job::Job& job, const JudgedRun& run, double gouge,
                                Random& random) {
  std::vector<const SpaceMove*> some;
  const auto first = good.in_space(good.first_space());
  for (std::size_t k = 0; k < first.size(); k += 3) some.push_back(first[k]);
  const double thick = good.deepest(some, 0.02).depth;
  EXPECT_GT(thick, 0.0195);
  EXPECT_LT(thick, 0.0205 + std::max(0.0, gouge));
  // A record of any tooth whose mill touches a wall.
  bool moved = false;
  for (int trial = 0; trial < 400 && !moved; ++trial) {
    const std::size_t cut = random.index(good.cuts().size() - 1);
    const SpaceMove &here = good.cuts()[cut], &next = good.cuts()[cut + 1];
    if (here.space < 0 || next.space != here.space) continue;
    const Deepest before = good.deepest_at(here.move, 1);
    if (before.depth < -1e-3) continue;
    BevelJudge bad = good;
    bad.move_record(cut, 0.005 * before.normal);
    const Deepest after = bad.deepest(bad.to_judge(1));
    EXPECT_GT(after.depth, before.depth + 0.0045) << "line " << here.move.line;
    EXPECT_LT(after.depth, std::max(0.0, gouge) + 0.0065) << "line " << here.move.line;
    EXPECT_TRUE(after.line == here.move.line || after.line == next.move.line) << after.line << " " << here.move.line;
    moved = true;
  }
  EXPECT_TRUE(moved);
  // No machine, no axis.
  if (run.machine_text.find("\"apt\"") != std::string::npos) return;
  std::string wrong = run.machine_text;
  const auto sign = wrong.find("sign = ", wrong.find("[axes.C]"));
  wrong.replace(sign, wrong.find('\n', sign) - sign, run.machine_text[sign + 7] == '-' ? "sign = 1" : "sign = -1");
  const BevelJudge mirrored(job, run.program, wrong);
  some.clear();
  for (std::size_t k = 0; k < mirrored.cuts().size(); k += mirrored.cuts().size() / 150)
    some.push_back(&mirrored.cuts()[k]);
  EXPECT_GT(mirrored.deepest(some).depth, 0.1);
}

/// In turn, from behind those that the face gears have in a check. Joints without inverse time feed cannot turn the
/// blank.
const OutputForm& form_of(int job) {
  std::vector<const OutputForm*> forms;
  for (std::size_t k = 0; k < std::size(kForms); ++k)
    if (const OutputForm& form = kForms[(k + 10) % std::size(kForms)];
        form.control != std::string("heidenhain") || form.tcp != std::string("none"))
      forms.push_back(&form);
  return *forms[std::size_t(job) % forms.size()];
}

/// Judges a program against the gear of its job.
void judge_run(const job::Job& job, const OutputForm& form, const JudgedRun& run, int number, bool plant,
               Random& random) {
  ASSERT_EQ(run.outcome.exit_code, app::ExitCode::ok) << to_text(run.outcome.errors);
  const BevelJudge judge(job, run.program, run.machine_text);
  ASSERT_TRUE(judge.faults().empty()) << judge.faults().front();
  ASSERT_GT(judge.cuts().size(), 100u);
  if (job.bevel_gear()->form == bevel_gear::BevelForm::herringbone) {
    EXPECT_LE(judge.gear().fillet_reach(), job.bevel_gear()->relief_half_width_mm);
  }
  const auto first = judge.in_space(judge.first_space()), looked_at = judge.to_judge(1);
  const Deepest gouge = judge.deepest(looked_at);
  const double root = judge.below_root(looked_at);
  const auto walls = judge.walls(first, 2);
  const auto& operations = job.operations;
  const double bound = run.report["gouge_um"]["bound"].get<double>(),
               most_left = run.report["excess_um"]["finished"]["bound"].get<double>(),
               ridge = judge.ridges(first, operations.front().ridge_mm, 3),
               chord = operations.back().chord_tolerance_mm;
  std::printf(
      "%2d %-22s z %2d, %5zu cuts, %4zu looked at: gouge %.2f um (walls %.2f, root %.2f), proven %.2f, left %.2f um, "
      "proven %.2f, ridge %.2f um above what was asked\n",
      number, form.name().c_str(), job.bevel_gear()->teeth, judge.cuts().size(), looked_at.size(), 1e3 * gouge.depth,
      -1e3 * walls[1], 1e3 * root, bound, 1e3 * walls[0], most_left, 1e3 * ridge);
  EXPECT_LE(std::max({gouge.depth, root, -walls[1]}), 1e-3 * bound + kBevelSlack) << "line " << gouge.line;
  EXPECT_LE(walls[0], std::min(1e-3 * most_left, chord + 1.5e-3) + kBevelSlack);
  EXPECT_LE(ridge, kBevelSlack);
  if (plant) expect_planted_faults_seen(judge, job, run, gouge.depth, random);
}

TEST(JudgedBevelJobs, CutTheGearAndNothingElseInEveryForm) {
  const int jobs = jobs_asked(6);
  int done = 0;
  for (int seed = 0; seed < 10 * jobs && done < jobs; ++seed) {
    Random random{std::uint64_t(9000 + seed)};
    const OutputForm& form = form_of(done);
    const std::string text = on_its_machine(random_judged_bevel_job(random, is_coarse(form.control) ? 0.0015 : 0.0005));
    const auto job = job::parse_job(text, "job.toml");
    ASSERT_TRUE(job) << to_text(job.error()) << text;
    const JudgedRun run = run_judged(text, form, random);
    SCOPED_TRACE(form.name() + "\n" + text + run.machine_text);
    if (run.outcome.exit_code == app::ExitCode::refused) {
      for (const Diagnostic& error : run.outcome.errors)
        EXPECT_TRUE(refused_for_a_reason(error.message, job.value())) << error.text();
      continue;
    }
    judge_run(job.value(), form, run, seed, done % 2 == 0, random);
    if (HasFatalFailure()) return;
    ++done;
  }
  EXPECT_EQ(done, jobs);
}

/// What a finger mill can take off the flanks of a gear, in shares of its tooth and face.
std::string random_modifications(const bevel_gear::BevelGearParameters& p, Random& random) {
  std::string text;
  const double h = p.addendum_mm, face = 0.2 * p.face_width_mm;
  const auto add = [&](const char* kind, double amount, const std::string& more = "") {
    text += fmt::format("[[gear.modification]]\nkind = \"{}\"\namount = {:.5f}\n{}", kind, amount, more);
  };
  const auto flank = [&] {
    const double which = random(0, 3);
    return which < 1 ? std::string() : fmt::format("flank = \"{}\"\n", which < 2 ? "left" : "right");
  };
  add("tip_relief", random(0.002, 0.008) * h, fmt::format("length = {:.4f}\n", random(0.3, 0.8) * h));
  add("root_relief", random(0.001, 0.004) * h,
      fmt::format("length = {:.4f}\nlaw = \"linear\"\n", random(0.3, 0.6) * h));
  add("profile_crowning", random(-0.001, 0.003) * h);
  add("pressure_angle_slope", random(-0.002, 0.002) * h);
  add("lead_crowning", random(0.0005, 0.001) * p.face_width_mm, flank());
  add("helix_angle_slope", random(-0.0005, 0.0005) * p.face_width_mm, flank());
  add("end_relief", random(0.001, 0.004) * h,
      fmt::format("length = {:.4f}\nend = \"{}\"\n{}", random(0.6, 1) * face, random(0, 1) < 0.5 ? "inner" : "outer",
                  flank()));
  return text;
}

/// Modified gears: proven against the modified flank, and of the plain one a part is gone that the judge sees.
TEST(JudgedBevelJobs, CutModifiedGearsAsTheWordsSay) {
  const int jobs = jobs_asked(3);
  int done = 0;
  for (int seed = 0; seed < 10 * jobs && done < jobs; ++seed) {
    Random random{std::uint64_t(9500 + seed)};
    const OutputForm& form = form_of(done);
    std::string text = on_its_machine(random_judged_bevel_job(random, is_coarse(form.control) ? 0.0015 : 0.0005));
    const auto plain = job::parse_job(text, "job.toml");
    ASSERT_TRUE(plain) << to_text(plain.error()) << text;
    replace_once(text, "[machine]", random_modifications(*plain.value().bevel_gear(), random) + "[machine]");
    const auto job = job::parse_job(text, "job.toml");
    ASSERT_TRUE(job) << to_text(job.error()) << text;
    const JudgedRun run = run_judged(text, form, random);
    SCOPED_TRACE(form.name() + "\n" + text + run.machine_text);
    if (run.outcome.exit_code == app::ExitCode::refused) {
      for (const Diagnostic& error : run.outcome.errors)
        EXPECT_TRUE(refused_for_a_reason(error.message, job.value()) ||
                    error.message.find("modification") != std::string::npos)
            << error.text();
      continue;
    }
    judge_run(job.value(), form, run, seed, done == 1, random);
    if (HasFatalFailure()) return;
    const BevelJudge of_plain(plain.value(), run.program, run.machine_text);
    const auto walls = of_plain.walls(of_plain.in_space(of_plain.first_space()), 2);
    std::printf("   of the plain flanks %.1f um are gone\n", -1e3 * walls[1]);
    EXPECT_LT(walls[1], -0.003 * job.value().bevel_gear()->addendum_mm) << "the judge does not see the modifications";
    ++done;
  }
  EXPECT_EQ(done, jobs);
}

}  // namespace
}  // namespace toothpath::test
