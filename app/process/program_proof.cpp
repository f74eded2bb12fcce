#include "app/process/program_proof.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "app/process/program_report.h"
#include "app/process/proof_limits.h"
#include "app/process/tooth_copies.h"
#include "app/report/machine_moves.h"
#include "geometry/base/angle.h"
#include "geometry/base/work_share.h"
#include "postproc/controls/of_machine.h"

namespace toothpath::process {
namespace {

/// Of the gouge tolerance that may go into teeth which are not quite the first one: roundings of words of two teeth,
/// with room.
constexpr double kCopyShare = 0.25;

/// Of the gouge tolerance, mm.
double copy_tolerance(const job::Job& job) { return kCopyShare * job.verify.gouge_tolerance_mm; }

constexpr double kSameBlank = 6e-4;  // mm: three digits are printed

/// What is wrong with the blank of the graphics; empty: nothing.
std::string other_blank(const joints::GraphicsBlank& asked, const joints::GraphicsBlank& seen) {
  const std::tuple<const char*, double, double> sizes[] = {{"radius", seen.radius_mm, asked.radius_mm},
                                                           {"radius of the bore", seen.bore_mm, asked.bore_mm},
                                                           {"bottom", seen.bottom_mm, asked.bottom_mm},
                                                           {"top", seen.top_mm, asked.top_mm}};
  for (const auto& [name, value, limit] : sizes)
    if (!(std::abs(value - limit) <= kSameBlank))
      return fmt::format(
          "the blank of the graphics has the {} {:.3f} mm, that of the job {:.3f} mm: the graphics show "
          "another part, nothing is cut by it",
          name, value, limit);
  return {};
}

void note_worn_out(ProgramProof& out, const std::map<int, double>& life) {
  for (const auto& worn : out.read.worn_out)
    out.warnings.push_back(
        fmt::format("line {}: T{} has cut for its life of {:g} min there, in the whole program it cuts "
                    "for {:.4g} min: a sister, or a new one, between two teeth before that",
                    worn.line, worn.tool, life.at(worn.tool), out.read.cutting_minutes.at(worn.tool)));
}

/// Where the axes go farthest, with the lines.
class Farthest {
 public:
  void add(const readback::ExecutedMove& m) {
    for (std::size_t a = 0; a < 5; ++a) {  // NaN (not yet known) passes neither comparison
      if (m.joints[a] < low_[a].first) low_[a] = {m.joints[a], m.line};
      if (m.joints[a] > high_[a].first) high_[a] = {m.joints[a], m.line};
    }
  }
  /// Do the linear axes keep their travels so far?
  [[nodiscard]] bool within(const machines::Machine& machine) const {
    for (std::size_t a = 0; a < 3; ++a)
      if (low_[a].first < machine.chain.linear[a].min_mm || high_[a].first > machine.chain.linear[a].max_mm)
        return false;
    return true;
  }
  /// Travels that are left. Between the ends of a block, where a tip is followed, no line is told.
  void judge(const readback::ReadBack& read, const machines::Machine& machine,
             std::vector<std::string>& reasons) const {
    const std::vector<joints::AxisRange> axes = ranges_of(read, machine);
    for (std::size_t a = 0; a < axes.size(); ++a)
      for (const bool low : {true, false}) {
        joints::AxisRange one = axes[a];
        (low ? one.upper_limit : one.lower_limit) = low ? INFINITY : -INFINITY;
        const std::size_t told = reasons.size();
        judge_travels({&one, 1}, reasons);
        const auto& [value, line] = low ? low_[a] : high_[a];
        if (reasons.size() > told && value == (low ? read.least[a] : read.greatest[a]))
          reasons.back() += fmt::format(", line {}", line);
      }
  }

 private:
  std::array<std::pair<double, int>, 5> low_ = all({INFINITY, 0}), high_ = all({-INFINITY, 0});
  static std::array<std::pair<double, int>, 5> all(std::pair<double, int> v) { return {v, v, v, v, v}; }
};

/// The program's own hash: of one that we wrote a reason where it does not fit, of a text of others a warning.
void note_hash(ProgramProof& out, std::string_view text) {
  out.hash = readback::hash_of_program(text);
  if (!out.hash || out.hash->fits()) return;
  const char* what = out.hash->end_line == 0 ? "there is none at the end: part of the program is missing"
                     : out.hash->ends_agree  ? "the blocks were edited after they were proven"
                                             : "the one at the end is another: two programs were put together";
  (out.others_text ? out.warnings : out.reasons)
      .push_back(fmt::format("line {}: HASH does not fit the text, {}", out.hash->line, what));
}

/// The text as moves of the axes: of teeth that stand one by one those of the first ones.
Result<ProgramProof> read_program(const ProgramText& program, const AskedPaths& asked, const GearCheck& gear,
                                  app::StageClock& clock) {
  const job::Job& job = program.job;
  auto control = controls::control_of(program.machine, *job.setup, job.tools);
  if (!control) return control.error();
  ProgramProof out;
  out.control = std::move(*control);
  const readback::AskedConditions conditions = asked_conditions(job, asked.paths);
  readback::ConditionJudge judge(program.machine, out.control, conditions);
  std::map<int, double> life;
  for (const tool::ToolAssembly& tool : job.tools)
    if (tool.life_min > 0) life.emplace(tool.number, tool.life_min);
  std::map<int, std::string> blanks;  // by their lines: the text is executed more than once
  out.control.blank = [&](const joints::GraphicsBlank& seen, std::int32_t line) {
    if (program.blank)
      if (auto differs = other_blank(*program.blank, seen); !differs.empty())
        blanks.emplace(line, fmt::format("line {}: {}", line, differs));
  };
  Farthest farthest;
  auto read = clock.run("read back", [&] {
    WorkShare share(double(std::count(program.text.begin(), program.text.end(), '\n') + 1));
    int seen = 0;  // lines; those of loops and sub-programs are counted once
    return read_back(program.text, program.file, out.control, program.machine, *job.setup,
                     {.teeth = gear.teeth(),
                      .keep_all = job.verify.all_teeth,
                      .first_teeth = true,
                      .watch =
                          [&](const readback::ExecutedMove& m) {
                            judge.add(m);
                            if (m.line > seen) share.add(m.line - std::exchange(seen, m.line));
                            farthest.add(m);  // what goes for hundreds of metres is not followed
                            if (program.moves && farthest.within(program.machine)) program.moves->add(m);
                            if (program.watch) program.watch(m);
                          },
                      .life_min = life});
  });
  out.control.blank = nullptr;
  if (!read) return read.error();
  out.read = std::move(read.value());
  out.conditions = judge.finish();
  out.reasons = out.conditions.reasons;
  const std::size_t before = out.reasons.size();
  farthest.judge(out.read, program.machine, out.reasons);
  out.others_text = asked.paths.empty();
  out.swept = out.reasons.size() == before || !out.others_text;  // along a path that is known it goes nowhere far
  if (program.moves && out.swept) {
    out.machine_moves = clock.run("machine moves", [&] { return program.moves->finish(); });
    for (std::string& reason : report::reasons_of(program.machine, out.machine_moves))
      out.reasons.push_back(std::move(reason));
  }
  out.warnings = out.conditions.warnings;
  note_worn_out(out, life);
  for (auto& [line, warning] : blanks) out.warnings.push_back(std::move(warning));
  note_hash(out, program.text);
  return out;
}

/// Of a pitch: a cut in the next tooth space comes farther than this from the middle of its own, one that is made there
/// does not. In between are the lands.
constexpr double kInSpace = 0.6;

/// Does the tip lie about the tooth space with this number?
bool in_space(const GearCheck& gear, const Vec3& tip, int number) {
  return number >= 0 && number < gear.teeth() &&
         std::abs(std::remainder(gear.pitches_from_space_0(tip) - number, gear.teeth())) <= kInSpace;
}

/// Motions of a text of others belong to the spaces in which they cut; what the text says counts where the tip may lie
/// there. @param copies  the first tooth of an operation that turned copies follow: the copy in space 0 is taken, by
/// where most of its cuts are
void place_in_spaces(const GearCheck& gear, bool copies, std::span<path::ToolMotion> motions) {
  const int teeth = gear.teeth();
  const auto counted = [&](int space) { return ((space % teeth) + teeth) % teeth; };
  const auto space = [&](const path::ToolMotion& m) {
    const Vec3 middle = 0.5 * (m.tip_from + m.tip_to);
    return in_space(gear, middle, m.tooth) ? m.tooth : counted(int(std::lround(gear.pitches_from_space_0(middle))));
  };
  std::map<int, std::size_t> shifts;
  for (path::ToolMotion& m : motions)
    if (!copies) m.tooth = space(m);
    else if (!m.rapid) ++shifts[counted(space(m) - m.tooth)];
  if (shifts.empty()) return;
  const int shift = std::max_element(shifts.begin(), shifts.end(), [](const auto& a, const auto& b) {
                      return a.second < b.second;
                    })->first;
  const Mat3 back = Eigen::AngleAxisd(-2 * kPi * shift / teeth, Vec3::UnitZ()).toRotationMatrix();
  if (shift == 0) return;
  for (path::ToolMotion& m : motions)
    for (Vec3* v : {&m.tip_from, &m.tip_to, &m.axis_from, &m.axis_to}) *v = back * *v;
}

readback::Followed follower(const ProgramText& program, const readback::NcControl& control, const GearCheck& gear) {
  return {
      control, program.machine, *program.job.setup, gear.teeth(), {gear.motion_tolerance(), gear.motion_tolerance()}};
}

/// The operation is one of the job.
Status operation_exists(const ProgramText& program, const readback::OperationTrace& trace) {
  const auto count = static_cast<int>(program.job.operations.size());
  if (trace.operation < count) return Ok{};
  return fail_at({program.file, trace.moves.empty() ? 0 : trace.moves.front().line, 0},
                 "operation {}: the job has the operations 0 to {}", trace.operation, count - 1);
}

Diagnostic in_file(Diagnostic error, const std::string& file) {
  if (error.position.file.empty()) error.position.file = file;
  return error;
}

/// By its name; what stands ahead of it where a tool is changed has none. -1: no move is named.
int tooth_of(const readback::OperationTrace& trace) {
  for (std::size_t k = trace.before; k < trace.moves.size(); ++k)
    if (trace.moves[k].tooth >= 0) return trace.moves[k].tooth;
  return -1;
}

/// One tooth of a program whose teeth are followed one by one.
struct Tooth {
  readback::OperationTrace trace;
  bool first = false;
  readback::Followed::Moves wanted = readback::Followed::Moves::all;
  std::vector<path::ToolMotion> motions;
  Status followed = Ok{};
};

/// The teeth of a program, made of its text; some at a time, on all threads.
template <typename Made>
class EachTooth {
 public:
  using Make = std::function<Made(Tooth&)>;
  using Take = std::function<void(Tooth&, Made&)>;
  /// @param make  for several teeth at once;  @param take  gets them in the order of the program
  EachTooth(const ProgramText& program, const readback::NcControl& control, const GearCheck& gear, Make make, Take take)
      : program_(program), control_(control), by_(follower(program, control, gear)), make_(make), take_(take) {}

  /// @param wanted  of a later tooth
  Status run(const readback::ReadBack& read, const std::function<readback::Followed::Moves(int)>& wanted) {
    const auto walked =
        readback::walk_teeth(program_.text, program_.file, control_, read, [&](readback::OperationTrace&& trace) {
          if (!status_) return;
          if (status_ = operation_exists(program_, trace); !status_) return;
          const bool first = trace.before == 0;
          if (first) finish();  // the others are compared with it
          moves_ += trace.moves.size();
          const auto moves = first ? readback::Followed::Moves::all : wanted(tooth_of(trace));
          teeth_.push_back({std::move(trace), first, moves, {}});
          if (first || moves_ >= most_moves_) finish();
        });
    if (!walked) return walked;
    finish();
    return status_;
  }

 private:
  void finish() {
    std::vector<Made> made(teeth_.size());
    tbb::parallel_for(std::size_t(0), teeth_.size(), [&](std::size_t n) {
      Tooth& tooth = teeth_[n];
      readback::Followed by = by_;
      by.moves = tooth.wanted;
      tooth.followed = readback::add_tool_motions(tooth.trace, {}, by, tooth.motions);
      if (tooth.followed) made[n] = make_(tooth);
    });
    std::size_t motions = 0;
    for (std::size_t n = 0; n < teeth_.size() && status_; ++n) {
      motions += teeth_[n].motions.size();
      if (!teeth_[n].followed) status_ = in_file(teeth_[n].followed.error(), program_.file);
      else take_(teeth_[n], made[n]);
    }
    // Turns of the rotaries become many motions.
    if (motions > 0) most_moves_ = std::max<std::size_t>(1, kTogether * moves_ / motions);
    teeth_.clear();
    moves_ = 0;
  }

  static constexpr std::size_t kTogether = 65536;  // motions that are held at a time, about
  const ProgramText& program_;
  const readback::NcControl& control_;
  const readback::Followed by_;
  Make make_;
  Take take_;
  std::vector<Tooth> teeth_;
  std::size_t moves_ = 0, most_moves_ = 4096;
  Status status_ = Ok{};
};

/// All that was kept, as one list.
Status follow_whole(const ProgramText& program, GearCheck& gear, ProgramProof& proof, std::vector<std::string>& rapids,
                    app::StageClock& clock) {
  std::size_t moves = 0;
  for (const readback::OperationTrace& trace : proof.read.operations) moves += trace.moves.size();
  proof.motions.reserve(moves);
  const readback::Followed by = follower(program, proof.control, gear);
  for (const readback::OperationTrace& trace : proof.read.operations) {
    if (auto known = operation_exists(program, trace); !known) return known;
    const std::size_t before = proof.motions.size();
    const Status followed =
        clock.run("read back", [&] { return add_tool_motions(trace, proof.read.copies, by, proof.motions); });
    if (!followed) return in_file(followed.error(), program.file);
    if (const auto clear = gear.rapids_clear(trace, proof.control); !clear) rapids.push_back(clear.error().message);
    if (proof.others_text)
      place_in_spaces(gear, proof.read.copies.copies && trace.kept_teeth == 1,
                      std::span(proof.motions).subspan(before));
    gear.meet(trace, std::span(proof.motions).subspan(before), proof.control);
  }
  // Teeth that are kept although they are copies are followed beside their first one: each is proven, at little cost.
  if (proof.read.copies.copies) {
    if (program.job.verify.all_teeth)
      clock.run("compare the teeth", [&] { proof.likes = like_motions(proof.motions, gear.teeth()); });
    return Ok{};
  }
  keep_first_teeth(proof.read);  // what else there is to say of them is in the motions
  const auto tolerance = program.job.verify.all_teeth ? std::nullopt : std::optional(copy_tolerance(program.job));
  clock.run("compare the teeth", [&] {
    proof.other_teeth = cuts_of_other_teeth(proof.motions, gear.teeth(), tolerance,
                                            [&](const path::ToolMotion& m) { return gear.may_cut(m); });
  });
  // Teeth that are written out one by one: what is the first tooth again, turned, need not be proven again.
  clock.run("compare the teeth", [&] {
    if (tolerance) proof.motions = without_copies(std::move(proof.motions), gear.teeth(), *tolerance);
    proof.likes = like_motions(proof.motions, gear.teeth());
  });
  return Ok{};
}

/// Teeth that stand one by one, none held but the first of every operation, and tooth space 0.
class TeethOneByOne {
 public:
  TeethOneByOne(const ProgramText& program, GearCheck& gear, ProgramProof& proof)
      : program_(program),
        gear_(gear),
        proof_(proof),
        teeth_(gear.teeth(), program.job.verify.all_teeth ? std::nullopt : std::optional(copy_tolerance(program.job)),
               [&gear](const path::ToolMotion& m) { return gear.may_cut(m); }) {}

  /// Every tooth is seen, its rapids against the part and its cuts beside the first one. Does each cut the space that
  /// its name says? If not, nothing else is said.
  Status see(std::vector<std::string>& rapids) {
    if (auto seen = see_all(&TeethOneByOne::met); !seen || !names_hold_) return seen;
    while (!teeth_.settle())
      if (auto seen = see_all(&TeethOneByOne::seen_again); !seen) return seen;
    for (auto& [operation, refusal] : refused_) rapids.push_back(std::move(refusal));
    for (auto& [operation, motions] : kept_) {
      const auto first = teeth_.first_of(operation);
      proof_.motions.insert(proof_.motions.end(), first.begin(), first.end());
      if (teeth_.left_out(0)) std::erase_if(motions, [](const path::ToolMotion& m) { return !m.rapid; });
      proof_.motions.insert(proof_.motions.end(), motions.begin(), motions.end());
    }
    kept_.clear();
    proof_.stated = teeth_.stated();
    proof_.other_teeth = teeth_.other_teeth();
    proof_.likes_follow = teeth_.any_like();
    return Ok{};
  }

  /// A name is a comment: somebody may have lost one, or count the teeth from 1.
  [[nodiscard]] bool names_hold() const { return names_hold_; }

  /// What is to be proven, tooth by tooth.
  Status each(TeethWanted wanted, const ToothSink& sink) const {
    EachTooth<std::vector<proof::LikeMotion>> all(
        program_, proof_.control, gear_,
        [&](Tooth& tooth) { return tooth.first ? std::vector<proof::LikeMotion>() : teeth_.likes(tooth.motions); },
        [&](Tooth& tooth, std::vector<proof::LikeMotion>& likes) {
          if (tooth.first) {  // it stands for others, too
            const auto first = teeth_.first_of(tooth.trace.operation);
            tooth.motions.assign(first.begin(), first.end());
          }
          sink(std::move(tooth.motions), likes, tooth.first);
        });
    using Moves = readback::Followed::Moves;
    return all.run(proof_.read, [&](int tooth) {
      if (teeth_.left_out(tooth)) return Moves::rapids;
      return wanted == TeethWanted::cuts ? Moves::feeds : Moves::all;
    });
  }

 private:
  struct Look {
    Status rapids = Ok{};
    bool named_right = true;
    ToothByTooth::Seen seen;
  };
  [[nodiscard]] bool named_right(const std::vector<path::ToolMotion>& motions) const {
    return std::all_of(motions.begin(), motions.end(), [&](const path::ToolMotion& m) {
      return m.rapid || in_space(gear_, 0.5 * (m.tip_from + m.tip_to), m.tooth) || !gear_.may_cut(m);
    });
  }
  Status see_all(void (TeethOneByOne::*take)(Tooth&, Look&)) {
    const bool anew = take == &TeethOneByOne::met;
    WorkShare share(double(gear_.teeth()) * double(program_.job.operations.size()));
    EachTooth<Look> all(
        program_, proof_.control, gear_,
        [&](Tooth& tooth) {
          Look look;
          if (anew) look.rapids = gear_.rapids_clear(tooth.trace, proof_.control);
          if (anew && proof_.others_text) look.named_right = named_right(tooth.motions);
          if (!tooth.first) look.seen = teeth_.seen(tooth.motions);
          return look;
        },
        [&](Tooth& tooth, Look& look) {
          (this->*take)(tooth, look);
          share.add();
        });
    return all.run(proof_.read, [](int) { return readback::Followed::Moves::all; });
  }
  void met(Tooth& tooth, Look& look) {
    const int operation = tooth.trace.operation;
    if (!look.rapids) refused_.emplace(operation, look.rapids.error().message);
    names_hold_ = names_hold_ && look.named_right;
    gear_.meet(tooth.trace, tooth.motions, proof_.control);
    proof_.tooth_motions += tooth.motions.size();
    if (tooth.first) {
      teeth_.first(tooth.motions);
      kept_.emplace_back(operation, std::vector<path::ToolMotion>());
    } else {
      teeth_.note(look.seen);
      if (tooth_of(tooth.trace) == 0) kept_.back().second = std::move(tooth.motions);
    }
  }
  void seen_again(Tooth& tooth, Look& look) {
    if (!tooth.first) teeth_.note(look.seen);
  }

  const ProgramText& program_;
  GearCheck& gear_;
  ProgramProof& proof_;
  ToothByTooth teeth_;
  bool names_hold_ = true;
  std::map<int, std::string> refused_;  // of an operation, its first rapid that is not clear
  std::vector<std::pair<int, std::vector<path::ToolMotion>>> kept_;  // operations, with space 0 where it comes later
};

/// The program once more with all of its moves kept, for names that do not hold.
Status keep_whole(const ProgramText& program, const GearCheck& gear, ProgramProof& proof, app::StageClock& clock) {
  auto read = clock.run("read back", [&] {
    return read_back(program.text, program.file, proof.control, program.machine, *program.job.setup,
                     {.teeth = gear.teeth(), .keep_all = program.job.verify.all_teeth});
  });
  if (!read) return read.error();
  proof.read.first_teeth = false;
  proof.read.operations = std::move(read->operations);
  proof.read.between = std::move(read->between);
  return Ok{};
}

/// Only the teeth are proven against the part: nothing may feed ahead of, between or behind them.
void judge_feeds_between(const readback::ReadBack& read, std::vector<std::string>& reasons) {
  for (const readback::OperationTrace& trace : read.between)
    for (std::size_t k = 1; k < trace.moves.size(); ++k)
      if (const readback::ExecutedMove& m = trace.moves[k]; !m.rapid) {
        reasons.push_back(fmt::format("line {}: a feed that belongs to no tooth", m.line));
        return;
      }
}

/// Teeth that an operation does not cut at all, in one reason.
void judge_uncut(const ProgramProof& proof, int operation, std::vector<std::string>& reasons) {
  constexpr std::size_t kNamed = 8;
  std::string teeth;
  std::size_t count = 0;
  const ToothCut* any = nullptr;
  for (const ToothCut& other : proof.other_teeth) {
    if (other.operation != operation || !other.cuts_nothing()) continue;
    any = &other;
    if (++count <= kNamed) teeth += fmt::format("{}{}", count > 1 ? ", " : "", other.tooth);
  }
  if (!any) return;
  if (count > kNamed) teeth += fmt::format(" and {} more", count - kNamed);
  reasons.push_back(
      fmt::format("operation {} does not cut tooth {}: no cut stands there like that of line {} in tooth {}", operation,
                  teeth, any->again.missing->line, any->first_tooth));
}

/// Every operation cuts every tooth; where nobody measures what it leaves, with every cut of its first one.
void judge_cuts_again(const ProgramProof& proof, const ProgramText& program, const GearCheck& gear,
                      std::vector<std::string>& reasons) {
  std::set<int> there;
  for (const readback::OperationTrace& trace : proof.read.operations) there.insert(trace.operation);
  const int first = program.stock_is_stated && !there.empty() ? *there.begin() : 0;
  for (int n = first; n < int(program.job.operations.size()); ++n) {
    if (!there.contains(n)) reasons.push_back(fmt::format("operation {} of the job is not in the program", n));
    judge_uncut(proof, n, reasons);
  }
  std::map<int, std::vector<const ToothCut*>> missing;  // by operation
  for (const ToothCut& other : proof.other_teeth)
    if (other.again.missing && !other.cuts_nothing() && !gear.measures(other.operation))
      missing[other.operation].push_back(&other);
  for (const auto& [operation, teeth] : missing)
    reasons.push_back(fmt::format("operation {}, {}{}", operation, told(*teeth.front()),
                                  teeth.size() > 1 ? fmt::format(" ({} teeth so)", teeth.size()) : ""));
}

void compare(ProgramProof& proof, const AskedPaths& asked, const GearCheck& gear, app::StageClock& clock) {
  const double mm = asked.mm + 2 * gear.motion_tolerance(), rad = asked.rad + 2 * gear.motion_tolerance();
  const readback::ClComparison c = clock.run(
      "compare with the path", [&] { return readback::compare_with_cl(proof.motions, asked.paths, mm, rad); });
  if (!c.complete)
    proof.reasons.push_back(fmt::format("operation {}, record {} is not met by the program: {}", c.missed_operation,
                                        c.missed_record, c.message));
  if (c.worst_extra_mm > mm)
    proof.reasons.push_back(fmt::format("the program leaves the path by {:.4f} mm, limit {:.4f} mm, near line {}",
                                        c.worst_extra_mm, mm, c.line));
  proof.comparison = c;
  proof.path_tolerance_mm = mm;
}

}  // namespace

void with_all_motions(ProgramProof& program,
                      const std::function<void(const std::vector<path::ToolMotion>& motions,
                                               std::span<const proof::LikeMotion> likes)>& work) {
  if (!program.each_tooth) return work(program.motions, program.likes);
  std::vector<path::ToolMotion> all;
  all.reserve(program.tooth_motions);
  std::vector<proof::LikeMotion> alike;
  std::size_t firsts = 0, shift = 0;  // motions of first teeth so far; how much later the last of them stand here
  const Status made = program.each_tooth(TeethWanted::whole, [&](std::vector<path::ToolMotion>&& motions,
                                                                 std::span<const proof::LikeMotion> likes, bool first) {
    if (first) {
      shift = all.size() - firsts;
      firsts += motions.size();
    }
    for (proof::LikeMotion like : likes) {
      like.motion += std::uint32_t(all.size());
      like.like_first += std::uint32_t(shift);
      like.like_last += std::uint32_t(shift);
      alike.push_back(like);
    }
    all.insert(all.end(), motions.begin(), motions.end());
  });
  if (!made) program.reasons.push_back(made.error().message);
  work(all, alike);
}

std::map<int, std::vector<path::ToolMotion>> cuts_of(ProgramProof& program, const std::set<int>& teeth) {
  std::map<int, std::vector<path::ToolMotion>> cuts;
  const auto take = [&](const std::vector<path::ToolMotion>& motions) {
    for (const path::ToolMotion& m : motions)
      if (!m.rapid && teeth.contains(m.tooth)) cuts[m.tooth].push_back(m);
  };
  if (!program.each_tooth) {
    take(program.motions);
  } else if (!teeth.empty()) {
    const Status made = program.each_tooth(TeethWanted::cuts, [&](auto&& motions, auto, bool) { take(motions); });
    if (!made) program.reasons.push_back(made.error().message);
  }
  return cuts;
}

Result<ProgramProof> prove_program(const ProgramText& program, const AskedPaths& asked, GearCheck& gear,
                                   app::StageClock& clock) {
  auto read = read_program(program, asked, gear, clock);
  if (!read) return read.error();
  ProgramProof proof = std::move(read.value());
  if (!proof.swept) {
    proof.warnings.emplace_back(
        "the axes leave their travels: gouge, clearance, rapids and material left were not looked at");
    return proof;
  }
  std::vector<std::string> rapids;
  std::optional<TeethOneByOne> one_by_one;
  if (proof.read.first_teeth) {
    one_by_one.emplace(program, gear, proof);
    const Status seen = clock.run("compare the teeth", [&] { return one_by_one->see(rapids); });
    if (!seen) return seen.error();
    if (!one_by_one->names_hold())
      if (auto kept = keep_whole(program, gear, proof, clock); !kept) return kept.error();
  }
  if (proof.read.first_teeth) {
    proof.each_tooth = [&](TeethWanted wanted, const ToothSink& sink) { return one_by_one->each(wanted, sink); };
  } else {
    if (auto followed = follow_whole(program, gear, proof, rapids, clock); !followed) return followed.error();
    proof.stated = stated_deviation(proof.motions);
  }
  if (proof.read.mixed_rapid > 0)
    proof.reasons.push_back(fmt::format("line {}: a rapid moves more than one group of axes", proof.read.mixed_rapid));
  std::move(rapids.begin(), rapids.end(), std::back_inserter(proof.reasons));
  for (const readback::OperationTrace& trace : proof.read.between)
    if (const auto clear = gear.rapids_clear(trace, proof.control); !clear)
      proof.reasons.push_back(clear.error().message);
  judge_feeds_between(proof.read, proof.reasons);
  judge_cuts_again(proof, program, gear, proof.reasons);
  gear.judge(proof, clock);
  proof.each_tooth = nullptr;
  if (!asked.paths.empty()) compare(proof, asked, gear, clock);
  return proof;
}

}  // namespace toothpath::process
