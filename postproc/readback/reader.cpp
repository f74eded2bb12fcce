#include "postproc/readback/reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <utility>

#include "geometry/base/angle.h"
#include "postproc/readback/operation_moves.h"
#include "postproc/readback/run_time.h"
#include "postproc/readback/teeth.h"

namespace toothpath::readback {
namespace {

constexpr std::ptrdiff_t kMostLines = 30'000'000;
// A program that ends executes a line once a tooth and flank or so; one that goes on for ever is found by what it has
// executed. Short texts of other work may turn more often.
constexpr std::size_t kBlocksPerLine = 8192, kLeastBlocks = 2'000'000;
constexpr double kRoundedLife = 1 + 1e-3;  // of the minutes of a tool: F is rounded
constexpr double kReadCoincident = 1e-9;   // mm
constexpr double kReadParallel = 1e-12;
constexpr double kSameTip = 1e-9;              // mm: round-off of a turned frame
constexpr float kSameShare = 1e-6F;            // of a block: its length with the round-off of a turned frame
constexpr double kReadTipStep = radians(0.5);  // joints follow a straight tip: looked at in such steps of the rotaries

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

/// Compares the teeth of a program as they are executed.
class CopyCheck {
 public:
  CopyCheck(const std::map<int, OperationMoves>& counts, const NcControl& control, const joints::Setup& setup,
            int teeth, int index_sign)
      : counts_(counts), control_(control), setup_(setup), teeth_(teeth), sign_(index_sign) {
    result_.copies = true;
    for (const auto& [op, c] : counts) {
      if (op < 0) continue;
      const auto z = static_cast<std::size_t>(teeth);
      if (c.teeth() == 0 || c.teeth() % z != 0)
        differ(0, fmt::format("operation {}: {} moves are not {} equal teeth", op, c.teeth(), teeth));
      else state_[op].per_tooth = c.teeth() / z;
      for (const auto& piece : c.pieces)
        if (const std::size_t per_tooth = state_[op].per_tooth; per_tooth > 0 && piece.teeth() % per_tooth != 0)
          differ(0, fmt::format("operation {}: {} moves are no whole number of teeth", op, piece.teeth()));
    }
    if (index_sign == 0 && teeth > 1) differ(0, "the gear axis is not the axis of the rotary that carries the work");
  }

  void operator()(const ExecutedMove& m) {
    if (m.operation < 0) return;
    State& s = state_[m.operation];
    const OperationMoves& c = counts_.at(m.operation);
    const std::size_t i = s.seen++;
    while (s.piece + 1 < c.pieces.size() && i >= c.pieces[s.piece + 1].first) {
      s.before += c.pieces[s.piece].teeth();
      ++s.piece;
    }
    const OperationMoves::Piece& piece = c.pieces[s.piece];
    if (i < piece.begin() || i >= piece.end()) {
      if (i < c.lead()) s.kept.push_back(m);
      return;
    }
    if (!result_.copies) return;
    const std::size_t n = s.before + i - piece.begin();
    const std::size_t copy = n / s.per_tooth, position = n % s.per_tooth;
    if (i == piece.begin()) s.tool = m.tool;
    if (copy == 0) {
      if (position == 0) s.turns.push_back(0);
      s.kept.push_back(m);
      return;
    }
    if (position == 0) {
      s.commanded = 0;
      s.turn_known = false;
    }
    s.commanded = static_cast<std::uint8_t>(s.commanded | m.commanded);
    if (copy == 1 && s.piece == 0 && m.rapid && s.kept.size() == c.lead() + s.per_tooth + position)
      s.kept.push_back(m);  // link to the second
    const ExecutedMove first = s.kept[c.lead() + position];
    compare(m, s, first);
  }

  /// It may still be that they are.
  [[nodiscard]] bool open() const { return result_.copies; }

  TurnedCopies finish() {
    for (auto& [op, s] : state_) {
      std::vector<bool> met(static_cast<std::size_t>(teeth_), false);
      for (const int k : s.turns) {
        if (result_.copies && met[static_cast<std::size_t>(k)])
          differ(0, fmt::format("operation {}: tooth {} twice", op, k));
        met[static_cast<std::size_t>(k)] = true;
      }
      result_.operations.push_back({op, s.per_tooth, s.turns, {}});
      std::size_t copies = 0;
      for (const auto& piece : counts_.at(op).pieces) {
        result_.operations.back().pieces.push_back({piece.begin(), copies, piece.lead});
        copies += s.per_tooth > 0 ? piece.teeth() / s.per_tooth : 0;
      }
    }
    return result_;
  }
  std::vector<ExecutedMove> take(int operation) { return std::move(state_[operation].kept); }

 private:
  struct State {
    std::size_t per_tooth = 0, seen = 0;
    std::size_t piece = 0, before = 0;  // that the moves are in, moves of teeth ahead of it
    int tool = 0;                       // of the piece
    std::uint8_t commanded = 0;         // axes with a word since this copy began
    bool turn_known = false;
    int turn = 0;  // of this copy, whole index steps, not reduced
    std::vector<int> turns;
    std::vector<ExecutedMove> kept;
  };

  void compare(const ExecutedMove& m, State& s, const ExecutedMove& first) {
    // An axis without a word so far still stands where the tooth before left it; nothing is cut like that.
    const auto set = [&](std::size_t a) { return control_.letters[a] == 0 || (s.commanded & (1U << a)) != 0; };
    if (m.commanded != first.commanded) return differ(m.line, "other axes are named than in the first tooth");
    for (std::size_t a = 0; a < 5; ++a) {
      if (!m.rapid && !set(a))
        return differ(m.line, fmt::format("the tooth cuts before it has set {}", control_.letters[a]));
      if (a == 3 || !set(a) || (m.tcp && a < 3)) continue;
      if (!same(m.joints[a], first.joints[a], control_.chain || m.plane))
        return differ(m.line, fmt::format("{} = {} where the first tooth has {}", control_.letters[a], m.joints[a],
                                          first.joints[a]));
    }
    const double pitch = 360.0 / teeth_;
    const double turned = sign_ * (m.joints[3] - first.joints[3]);
    if (set(3) && !s.turn_known) {
      s.turn_known = true;
      const int k = static_cast<int>(std::lround(turned / pitch));
      s.turn = k;
      s.turns.push_back(((k % teeth_) + teeth_) % teeth_);
    }
    if (!set(3)) return;
    const double error = std::abs(turned - s.turn * 360.0 / teeth_);
    result_.worst_shift_deg = std::max(result_.worst_shift_deg, error);
    if (!(error <= control_.rotary_rounding_deg * (1 + 1e-6) + 1e-9))
      return differ(m.line, fmt::format("{} is turned by {} deg where {} * 360 / {} is expected", control_.letters[3],
                                        turned, s.turn, teeth_));
    // By the turn that is meant, or by that of the rotary, whose error stands in worst_shift_deg.
    const auto off = [&](double deg) { return (m.tip - turned_tip(first.tip, deg)).norm(); };
    if (m.tcp != first.tcp || (m.tcp && off(s.turn * 360.0 / teeth_) > kSameTip && off(turned) > kSameTip))
      return differ(m.line, "the tip is not that of the first tooth, turned");
    if (m.blend_mm != first.blend_mm || m.blend_axis_rad != first.blend_axis_rad ||
        m.corner_path_mm != first.corner_path_mm || std::abs(m.corner_share - first.corner_share) > kSameShare)
      return differ(m.line, "the control may leave corners otherwise than in the first tooth");
    if (m.rapid != first.rapid || m.tool != s.tool) return differ(m.line, "rapid and feed or tool differ");
    if (!m.rapid && std::abs(m.minutes - first.minutes) > 1e-9 * first.minutes + 1e-12)
      return differ(m.line, fmt::format("block takes {} min where the first tooth has {}", m.minutes, first.minutes));
  }
  /// Without TCP bit for bit; with it the joints behind a cut follow from a turned tip, and in a tilted plane from the
  /// turned plane, with their round-off.
  static bool same(double a, double b, bool follows) {
    return same_bits(a, b) || (follows && std::abs(a - b) <= kSameTip);
  }
  /// A point of the table, turned about the gear axis.
  Vec3 turned_tip(const Vec3& p, double deg) const {
    const Vec3 axis = setup_.rotation().col(2);
    return setup_.origin_mm + Eigen::AngleAxisd(radians(deg), axis) * (p - setup_.origin_mm);
  }
  void differ(int line, std::string what) {
    if (!result_.copies) return;
    result_.copies = false;
    result_.line = line;
    result_.difference = std::move(what);
  }

  const std::map<int, OperationMoves>& counts_;
  const NcControl& control_;
  const joints::Setup& setup_;
  int teeth_, sign_;
  std::map<int, State> state_;
  TurnedCopies result_;
};

/// Collects the moves that stand in no trace of an operation, with the moves that they start from.
class Between {
 public:
  /// @param trails  of operations: kept by no trace where the teeth are copies
  Between(const std::map<int, OperationMoves>& counts, bool trails) : counts_(counts), trails_(trails) {}

  void operator()(const ExecutedMove& m) {
    const OperationMoves& c = counts_.at(m.operation);
    const std::size_t i = seen_[m.operation]++;
    // Of copies the first tooth of the first piece is kept: what another piece does ahead of its first cut is its own.
    const bool taken_up = trails_ && m.operation >= 0 && i >= c.pieces.front().end();
    if (m.operation != before_.operation || m.piece != before_.piece) cuts_ = false;
    cuts_ = cuts_ || !m.rapid;
    const auto in_teeth = [&](const OperationMoves::Piece& p) { return i >= p.begin() && i < p.end(); };
    const bool outside =
        m.operation < 0 || i == 0 || (taken_up && (!cuts_ || std::none_of(c.pieces.begin(), c.pieces.end(), in_teeth)));
    if (!outside) {
      open_ = false;
    } else {
      if (!open_ || made_.back().operation != m.operation || made_.back().tool != m.tool) begin(m);
      made_.back().moves.push_back(m);
    }
    before_ = m;
  }
  std::vector<OperationTrace> take() { return std::move(made_); }

 private:
  /// With the tool of the stretch: it is changed where the gauge line stands.
  void begin(const ExecutedMove& m) {
    OperationTrace t;
    t.operation = m.operation;
    t.tool = m.tool;
    t.moves.push_back(before_);
    t.moves.front().tool = m.tool;
    made_.push_back(std::move(t));
    open_ = true;
  }

  const std::map<int, OperationMoves>& counts_;
  bool trails_, open_ = false;
  bool cuts_ = false;  ///< the piece has cut
  std::map<int, std::size_t> seen_;
  ExecutedMove before_;
  std::vector<OperationTrace> made_;
};

/// +1, -1: word of the index rotary per turn of the gear; 0: the gear is not turned about its own axis.
int index_sign(const machines::Machine& machine, const joints::Setup& setup) {
  if (machine.chain.table.empty()) return 0;
  const machines::RotaryAxis& c = machine.chain.table[0];
  const Vec3 g = setup.rotation().col(2);
  if (c.direction.cross(g).norm() > kReadParallel) return 0;
  if ((setup.origin_mm - c.point_mm).cross(c.direction).norm() > kReadCoincident) return 0;
  return c.direction.dot(g) > 0 ? c.sign : -c.sign;
}

}  // namespace

void follow_tip(const ExecutedMove& from, const ExecutedMove& to, const NcControl& control,
                const machines::KinematicChain& chain, const std::function<void(const std::array<double, 5>&)>& sink) {
  const auto length = control.tool_length_mm.find(to.tool);
  const double turn = radians(std::abs(to.joints[3] - from.joints[3]) + std::abs(to.joints[4] - from.joints[4]));
  if (turn == 0 || length == control.tool_length_mm.end() || !std::isfinite(turn)) return;
  const auto& j = from.joints;
  const Vec3 start =
      from.tcp ? from.tip
               : chain.forward({Vec3(j[0], j[1], j[2]), {radians(j[3]), radians(j[4])}}, length->second).tip_mm;
  const int n = static_cast<int>(std::min(1e5, std::ceil(turn / kReadTipStep))) + 3;
  for (int i = 1; i < n; ++i) {
    const double t = static_cast<double>(i) / n;
    const double r0 = (1 - t) * j[3] + t * to.joints[3], r1 = (1 - t) * j[4] + t * to.joints[4];
    const Vec3 x = chain.linear_for((1 - t) * start + t * to.tip, {radians(r0), radians(r1)}, length->second).linear_mm;
    sink({x.x(), x.y(), x.z(), r0, r1});
  }
}

std::string too_many_blocks(std::size_t limit) {
  return fmt::format("more than {} executed blocks, the most for a program of this length: a loop without end", limit);
}

namespace {

/// Marks and ends of lines that no control reads as an editor does.
Status plain_lines(std::string_view text, const std::string& file) {
  for (const std::string_view mark : {"\xef\xbb\xbf", "\xff\xfe", "\xfe\xff"})
    if (text.starts_with(mark))
      return fail_at({file, 1, 1}, "a byte order mark begins the text: save it as plain ASCII, without it");
  for (std::size_t cr = text.find('\r'); cr != std::string_view::npos; cr = text.find('\r', cr + 1))
    if (cr + 1 < text.size() && text[cr + 1] != '\n')
      return fail_at({file, 1 + static_cast<int>(std::count(text.begin(), text.begin() + std::ptrdiff_t(cr), '\n')),
                      static_cast<int>(cr - (text.rfind('\n', cr) + 1)) + 1},
                     "the line ends with CR alone: save it with LF or CR LF at the ends of lines");
  return Ok{};
}

}  // namespace

Status execute_nc(std::string_view text, const std::string& file, const NcControl& control, const MoveSink& sink) {
  if (control.execute == nullptr) return fail("a control without a reader: its programs cannot be read back");
  if (auto bad = plain_lines(text, file); !bad) return bad;
  const auto lines = std::count(text.begin(), text.end(), '\n');
  if (lines > kMostLines) return fail_at({file, 0, 0}, "the program has {} lines, more than {}", lines, kMostLines);
  NcControl bounded = control;
  bounded.max_steps =
      std::min(control.max_steps, std::max(kLeastBlocks, kBlocksPerLine * static_cast<std::size_t>(lines)));
  return control.execute(text, file, bounded, sink);
}

namespace {

/// Executes a program as often as it takes and keeps what proofs ask for.
class ReadBackRun {
 public:
  ReadBackRun(std::string_view text, const std::string& file, const NcControl& control,
              const machines::Machine& machine)
      : text_(text), file_(file), control_(control), machine_(machine) {
    result_.least.fill(std::numeric_limits<double>::infinity());
    result_.greatest.fill(-std::numeric_limits<double>::infinity());
  }

  Result<ReadBack> run(const joints::Setup& setup, const ReadBackOptions& options) {
    life_ = options.life_min;
    if (auto s = count(options.watch); !s) return s.error();
    if (auto s = one_tooth_fits(options); !s) return s.error();
    CopyCheck check(counts_, control_, setup, options.teeth, index_sign(machine_, setup));
    if (check.open())
      if (auto s = compare(check); !s) return s.error();
    result_.copies = check.finish();
    const bool all = options.keep_all || !result_.copies.copies;
    result_.first_teeth = options.first_teeth && !result_.copies.copies && teeth_.one_by_one();
    if (all) {
      if (auto s = keep_all(options); !s) return s.error();
    } else {
      for (const auto& [op, c] : counts_)
        if (op >= 0) traces_[op].moves = check.take(op);
    }
    for (auto& [op, t] : traces_) {
      if (op < 0) continue;
      t.operation = op;
      t.lead = counts_[op].lead();
      t.kept_teeth = all && !result_.first_teeth ? static_cast<std::size_t>(options.teeth) : 1;
      if (result_.first_teeth) t.tool = last_tool_[op];
      else t.tool = t.moves.empty() ? 0 : t.moves.back().tool;
      for (const ExecutedMove& m : t.moves) note_blend(m);
      result_.operations.push_back(std::move(t));
    }
    return std::move(result_);
  }

 private:
  /// First time: times, reach of the joints, moves of every operation, rapids that mix groups of axes.
  Status count(const std::function<void(const ExecutedMove&)>& watch) {
    const auto reach = [this](const std::array<double, 5>& joints) {
      for (std::size_t a = 0; a < 5; ++a) {  // NaN (not yet known) passes neither comparison
        if (joints[a] < result_.least[a]) result_.least[a] = joints[a];
        if (joints[a] > result_.greatest[a]) result_.greatest[a] = joints[a];
      }
    };
    ExecutedMove before;
    result_.corners = control_.corners;
    std::deque<std::pair<int, int>> open;  // tool and line of moves whose time is not known yet
    RunTimer timer(machine_, control_.corners, [&](bool rapid, double minutes) {
      (rapid ? result_.accelerated.rapid : result_.accelerated.feed) += minutes;
      if (life_.empty()) return;
      const auto [tool, line] = open.front();
      open.pop_front();
      const auto life = life_.find(tool);
      if (rapid || life == life_.end()) return;
      double& cut = result_.cutting_minutes[tool];
      const double most = life->second * kRoundedLife;
      if (cut <= most && cut + minutes > most) result_.worn_out.push_back({tool, line});
      cut += minutes;
    });
    Status status = execute_nc(text_, file_, control_, [&](const ExecutedMove& m) {
      ++result_.executed;
      if (watch) watch(m);
      if (!life_.empty()) open.emplace_back(m.tool, m.line);
      timer.add(m);
      if (timing::is_bounded(m.corners) && !m.rapid) result_.corners = m.corners;
      const double minutes = m.minutes + double(m.dwell_min);
      result_.minutes += minutes;
      if (!m.rapid) result_.feed_minutes += minutes;
      if (m.tcp && m.known) follow_tip(before, m, control_, machine_.chain, reach);
      if (!control_.cutter_locations && result_.mixed_rapid == 0 && mixes_axis_groups(before, m))
        result_.mixed_rapid = m.line;
      before = m;
      reach(m.joints);
      counts_[m.operation].add(m);
      teeth_.add(m);
    });
    timer.finish();
    return status;
  }
  /// What is kept at any rate: one tooth with the link to the next, and what stands about the teeth.
  Status one_tooth_fits(const ReadBackOptions& options) const {
    std::size_t kept = 0;
    for (const auto& [op, c] : counts_)
      kept += op < 0 ? c.total : c.total - c.teeth() + 2 * (c.teeth() / static_cast<std::size_t>(options.teeth));
    if (kept <= options.max_kept) return Ok{};
    Diagnostic error =
        fail("{} moves of one tooth and beside the teeth would have to be kept, more than {}", kept, options.max_kept);
    error.position.file = file_;
    return error;
  }
  /// Second time: are the teeth turned copies, and what stands between the operations.
  Status compare(CopyCheck& check) {
    Between between(counts_, true);
    auto s = execute_nc(text_, file_, control_, [&](const ExecutedMove& m) {
      check(m);
      between(m);
    });
    if (!s) return s;
    result_.between = between.take();
    return Ok{};
  }
  /// A time more, where every tooth is kept, or every first one.
  Status keep_all(const ReadBackOptions& options) {
    const std::size_t kept = result_.first_teeth ? teeth_.moves_of_first() : result_.executed;
    if (kept > options.max_kept) {
      Diagnostic error =
          fail("{} moves would have to be kept, more than {}: the teeth are not turned copies of the first one ({})",
               kept, options.max_kept, result_.copies.copies ? "all are asked for" : result_.copies.difference);
      error.position = {file_, result_.copies.line, 0};
      return error;
    }
    if (!result_.first_teeth)
      for (const auto& [op, c] : counts_) traces_[op].moves.reserve(c.total);
    Between gaps(counts_, false);
    auto s = execute_nc(text_, file_, control_, [&](const ExecutedMove& m) {
      gaps(m);
      if (m.operation >= 0) last_tool_[m.operation] = m.tool;
      if (!result_.first_teeth || teeth_.in_first(m)) traces_[m.operation].moves.push_back(m);
      else note_blend(m);
    });
    if (!s) return s;
    result_.between = gaps.take();
    return Ok{};
  }

  void note_blend(const ExecutedMove& m) {
    if (!m.rapid)
      result_.length_off_mm = std::max(result_.length_off_mm, readback::length_off_mm(m, control_.tool_check));
    if (m.rapid) return;
    double& worst = result_.blend_mm[m.operation];
    worst = std::max({worst, double(m.blend_mm), double(m.corner_path_mm)});
  }

  std::string_view text_;
  const std::string& file_;
  const NcControl& control_;
  const machines::Machine& machine_;
  ReadBack result_;
  std::map<int, OperationMoves> counts_;
  NamedTeeth teeth_;
  std::map<int, double> life_;
  std::map<int, int> last_tool_;  ///< of every operation
  std::map<int, OperationTrace> traces_;
};

}  // namespace

void keep_first_teeth(ReadBack& read) {
  for (OperationTrace& trace : read.operations) {
    const auto labelled =
        std::find_if(trace.moves.begin(), trace.moves.end(), [](const auto& m) { return m.tooth >= 0; });
    if (labelled == trace.moves.end()) continue;
    const int first = labelled->tooth, piece = labelled->piece;
    std::erase_if(trace.moves,
                  [&](const ExecutedMove& m) { return m.tooth < 0 ? m.piece != piece : m.tooth != first; });
    trace.moves.shrink_to_fit();
    trace.kept_teeth = 1;
  }
}

Result<ReadBack> read_back(std::string_view text, const std::string& file, const NcControl& control,
                           const machines::Machine& machine, const joints::Setup& setup,
                           const ReadBackOptions& options) {
  return ReadBackRun(text, file, control, machine).run(setup, options);
}

}  // namespace toothpath::readback
