#include "cam/analytic/gouge_check.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "cam/analytic/body_sweep.h"
#include "cam/analytic/cutter_sweep.h"
#include "cam/analytic/profile_sweep.h"
#include "cam/path/motion_blend.h"
#include "cam/path/motions.h"
#include "cam/proof/gouge_merge.h"
#include "cam/proof/rapid_clearance.h"
#include "geometry/base/work_share.h"

namespace toothpath::analytic {
namespace {

constexpr std::size_t kChunk =
    64;  // motions that one thread checks one after another; the same on any number of threads
constexpr std::size_t kSampled =
    16;  // of so many chunks one goes ahead: what it finds the others need not follow closely
constexpr std::size_t kTogether = 1024 * kChunk;  // that wait for all threads
constexpr std::size_t kWave = 256;                // chunks behind which a path that is refused is followed no farther
constexpr double kBodyLook = 0.3;  // mm: gaps of shank and holder are followed this far beyond the clearance
constexpr double kAhead =
    0.4;  // mm: and this much farther where a body is looked at anew, so that later motions need not
constexpr double kContact = 0.005;  // mm: smaller gaps of shank and holder are followed to proof_mm
constexpr double kGapStep = 0.02;   // mm: to which the least gap is told
// Of proof_mm, to which the motions are followed that others are like: of a ball by distances, of a convex body.
constexpr double kBallModel = 0.25, kProfileModel = 0.5;

proof::WorstPlace place_of(const NearestPlace& q, const path::ToolMotion& m, double depth, tool::Body body) {
  proof::WorstPlace w;
  w.depth_mm = depth;
  w.body = body;
  w.patch = q.patch;
  w.operation = m.operation;
  w.tooth = m.tooth;
  w.zone = q.zone;
  w.line = m.line;
  w.radius_mm = std::hypot(q.foot.x(), q.foot.y());
  w.height_mm = q.foot.z();
  w.point = q.foot;
  return w;
}

proof::WorstPlace place_of(const SweptGap& gap, const path::ToolMotion& m, tool::Body body) {
  NearestPlace q;
  q.zone = gap.zone;
  q.patch = gap.patch;
  q.foot = gap.place;
  return place_of(q, m, -gap.measured_mm, body);
}

/// The blank below a height, as a ring about the axis.
proof::RapidObstacle obstacle_of(const tooth_space::ToothedPart& part, double height) {
  const tooth_space::Chart& chart = part.chart();
  double from = INFINITY, to = -INFINITY;
  for (int zone = 0; zone < part.zones(); ++zone) {
    from = std::min(from, part.space(zone).outline().s_from);
    to = std::max(to, part.space(zone).outline().s_to);
  }
  proof::RapidObstacle out;
  out.outer_radius_mm = std::max(chart.r(from, height), chart.r(to, height));
  if (chart.sine == 0) {
    out.inner_radius_mm = from;
    out.top_mm = height;
    return out;
  }
  // Down to the axis: the end surfaces are cones about it.
  out.top_mm = std::max(chart.z(from, height), -from / chart.sine);
  out.bottom_mm = std::min(chart.z(to, height), -to / chart.sine);
  if (chart.cosine != 0) out.roof = proof::Roof(chart, height);
  return out;
}

double arm_of(const tool::Frustum& f) { return std::hypot(f.to, std::max(f.radius_from, f.radius_to)); }

/// How far the parts of a tool reach from its tip: those of the cutter as its sweep tells them apart, then shank and
/// holder.
std::vector<double> arms_of(const tool::ProofTool& tool) {
  std::vector<double> arms;
  if (tool.ball_mill) {
    const double R = tool.ball_mill->radius_mm();
    arms = {R, std::hypot(tool.ball_mill->flute_length_mm, R)};  // the ball goes where its centre goes
  } else {
    for (const auto& shape : tool.cutting) arms.push_back(std::hypot(shape.core.to + shape.round, shape.widest()));
  }
  for (const auto& f : tool.bodies) arms.push_back(arm_of(f));
  return arms;
}

/// Motions that follow one another, checked by one thread.
class Chunk {
 public:
  /// @param model  others are like these: every motion is followed closely
  /// @param elsewhere  what was found before in other motions; none: nothing was
  Chunk(const GearDistance& part, const std::vector<tool::ProofTool>& tools, const GougeCheckOptions& options,
        bool model, const proof::GougeResult* elsewhere = nullptr)
      : part_(part),
        tools_(tools),
        o_(options),
        model_(model),
        elsewhere_(elsewhere),
        out_(proof::no_motion_yet(options.limits.clearance_mm)) {
    out_.clearance_followed_mm = options.limits.clearance_mm + kBodyLook;
  }

  /// @param known  of the tool's parts, a depth that each cannot exceed; empty: nothing is known
  /// @param proven  takes the depths that are proven now; empty: not asked for
  void check(const path::ToolMotion& m, int tool, std::span<const double> known = {}, std::span<double> proven = {}) {
    ++out_.motions;
    if (m.rapid && !rapid_is_clear(m, tools_[std::size_t(tool)])) return;  // refused, whatever it cuts
    if (tool != tool_) take(tool);
    const KnownDepths of_cutter{known, good_};
    const auto cut = ball_ ? ball_->check(m, of_cutter) : profile_->check(m, of_cutter);
    const auto bounds = ball_ ? ball_->part_bounds() : profile_->part_bounds();
    if (!proven.empty()) std::copy(bounds.begin(), bounds.end(), proven.begin());
    if (cut.measured_mm > out_.measured_mm) {
      out_.measured_mm = cut.measured_mm;
      note_deepest(out_, place_of(cut.deepest, m, cut.measured_mm, cut.body));
    }
    if (cut.bound_mm > out_.bound_mm) {
      out_.bound_mm = cut.bound_mm;
      out_.bound_line = m.line;
    }
    if (const double depth = std::max(cut.measured_mm, cut.bound_mm); depth > o_.limits.gouge_mm)
      add_worst(out_, place_of(cut.deepest, m, depth, cut.body));
    for (std::size_t k = 0, n = bounds.size(); k < bodies_.size(); ++k, ++n) {
      const double gap = clearance(bodies_[k], m, n < known.size() ? -known[n] : -INFINITY);
      if (!proven.empty()) proven[n] = -gap;
    }
  }

  [[nodiscard]] const proof::GougeResult& so_far() const { return out_; }
  proof::GougeResult finish() {
    take(-1);
    return std::move(out_);
  }

 private:
  struct Body {
    tool::Frustum frustum;
    bool known = false;
    Vec3 tip = Vec3::Zero(), axis = Vec3::UnitZ();  // where it was looked at last,
    double gap = 0;                                 // and its proven gap there
  };

  void take(int tool) {
    if (ball_) out_.distance_queries += ball_->queries();
    if (profile_) out_.distance_queries += profile_->queries();
    ball_.reset();
    profile_.reset();
    bodies_.clear();
    tool_ = tool;
    if (tool < 0) return;
    const auto& taken = tools_[std::size_t(tool)];
    const auto proof_mm = [&](double of_model) { return (model_ ? of_model : 1) * o_.limits.proof_mm; };
    if (taken.ball_mill) begin(ball_.emplace(part_, *taken.ball_mill, proof_mm(kBallModel), o_.limits.gouge_mm), 1);
    else begin(profile_.emplace(part_, taken, proof_mm(kProfileModel), o_.limits.gouge_mm), 0.5);
    for (const auto& f : taken.bodies) bodies_.push_back({f, false, Vec3::Zero(), Vec3::UnitZ(), 0});
  }

  /// Does it stay outside the blank? If not, that is noted.
  bool rapid_is_clear(const path::ToolMotion& m, const tool::ProofTool& tool) {
    const proof::RapidObstacle blank = obstacle_of(part_.part(), o_.rapid_height_mm);
    const auto proof =
        tool.ball_mill ? proof::prove_rapid(m, *tool.ball_mill, blank) : proof::prove_rapid(m, tool, blank);
    if (proof.clear) return true;
    out_.rapids_clear = false;
    NearestPlace there;
    there.patch = "blank";
    there.foot = proof.tip;
    add_worst(out_, place_of(there, m, 0, tool::Body::any));
    return false;
  }

  /// @param share  of the proof's leeway by which the sweep lets bounds stand above the deepest place found
  template <typename Sweep>
  void begin(Sweep& sweep, double share) {
    if (model_) sweep.each_by_itself();
    if (!elsewhere_) return;
    sweep.expect(elsewhere_->measured_mm);
    good_ = std::clamp(elsewhere_->measured_mm + share * o_.limits.proof_mm, 0.0, o_.limits.gouge_mm);
  }

  /// The gap that is proven. @param known  it is no less than this
  double clearance(Body& body, const path::ToolMotion& m, double known) {
    const double enough = out_.clearance_followed_mm, arm = arm_of(body.frustum);
    if (known >= o_.limits.clearance_mm && elsewhere_ && known >= std::min(enough, elsewhere_->clearance_mm)) {
      out_.clearance_mm = std::min({out_.clearance_mm, known, enough});
      return known;
    }
    if (body.known) {
      const auto away = [&](const Vec3& tip, const Vec3& axis) {
        return (tip - body.tip).norm() + arm * (axis - body.axis).norm();
      };
      const double left =
          body.gap - std::max(away(m.tip_from, m.axis_from), away(m.tip_to, m.axis_to)) - path::line_slack(m, arm, 1);
      if (left >= o_.limits.clearance_mm && left >= std::min(enough, out_.clearance_measured_mm - kGapStep)) {
        out_.clearance_mm = std::min({out_.clearance_mm, left, enough});
        out_.clearance_measured_mm = std::min(out_.clearance_measured_mm, enough);
        return left;
      }
    }
    SweptGapOptions look;
    look.enough_mm = enough + kAhead;
    look.contact_mm = kContact;
    look.contact_proof_mm = o_.limits.proof_mm;
    look.proof_mm = 0.5 * kGapStep;
    look.asked_mm = o_.limits.clearance_mm;
    const auto gap = swept_gap(part_, body.frustum, m, look);
    body = {body.frustum, true, m.tip_to, m.axis_to, gap.proven_mm};
    out_.clearance_measured_mm = std::min({out_.clearance_measured_mm, gap.measured_mm, enough});
    if (gap.proven_mm < out_.clearance_mm) out_.closest = place_of(gap, m, body.frustum.body);
    out_.clearance_mm = std::min({out_.clearance_mm, gap.proven_mm, enough});
    if (gap.proven_mm < o_.limits.clearance_mm) add_worst(out_, place_of(gap, m, body.frustum.body));
    return gap.proven_mm;
  }

  const GearDistance& part_;
  const std::vector<tool::ProofTool>& tools_;
  const GougeCheckOptions& o_;
  bool model_;
  const proof::GougeResult* elsewhere_;
  double good_ = 0;  // a depth at which a motion need not be looked at
  proof::GougeResult out_;
  int tool_ = -1;
  std::optional<CutterSweep> ball_;  // one of the two
  std::optional<ProfileSweep> profile_;
  std::vector<Body> bodies_;
};

}  // namespace

GougeCheck::GougeCheck(const GearDistance& part, const std::vector<tool::ToolAssembly>& tools,
                       GougeCheckOptions options)
    : GougeCheck(part, tool::proof_tools(tools), options) {}

GougeCheck::GougeCheck(const GearDistance& part, std::vector<tool::ProofTool> tools, GougeCheckOptions options)
    : part_(part), tools_(std::move(tools)), options_(options) {}

proof::GougeResult GougeCheck::check(const std::vector<path::ToolMotion>& motions,
                                     const std::vector<int>& tool_of_operation,
                                     std::span<const proof::LikeMotion> likes) const {
  const WorkShare all{double(motions.size())};
  GougeStream stream(*this, tool_of_operation, !likes.empty());
  auto like = likes.begin();
  for (std::size_t k = 0; k < motions.size(); ++k) {
    if (like != likes.end() && like->motion == k) ++like;
    else stream.own(motions[k], likes.empty() ? std::nullopt : std::optional(std::uint32_t(k)));
  }
  for (const proof::LikeMotion& as : likes) stream.like(motions[as.motion], as);
  return stream.finish();
}

/// What is proven of motions by themselves, part by part of their tools, for those that are like them.
class GougeStream::Proven {
 public:
  explicit Proven(std::size_t parts) : parts_(parts) {}
  /// Room for one motion more. @returns its place
  std::size_t add(std::uint32_t number) {
    numbers_.push_back(number);
    depth_.resize(depth_.size() + parts_, INFINITY);
    return numbers_.size() - 1;
  }
  [[nodiscard]] std::span<double> place(std::size_t n) { return std::span(depth_).subspan(n * parts_, parts_); }
  /// Depths that the parts of a motion that is like others cannot exceed.
  void of(const proof::LikeMotion& like, const std::vector<double>& arms, std::vector<double>& known) const {
    const auto first =
        std::size_t(std::lower_bound(numbers_.begin(), numbers_.end(), like.like_first) - numbers_.begin());
    known.assign(arms.size(), -INFINITY);
    for (std::size_t n = first; n < numbers_.size() && numbers_[n] < like.like_last; ++n)
      for (std::size_t k = 0; k < arms.size(); ++k) known[k] = std::max(known[k], depth_[n * parts_ + k]);
    for (std::size_t k = 0; k < arms.size(); ++k) known[k] += like.away(arms[k]);
  }

 private:
  std::size_t parts_;
  std::vector<std::uint32_t> numbers_;
  std::vector<double> depth_;
};

struct GougeStream::Waiting {
  path::ToolMotion motion;
  std::optional<std::size_t> place;  ///< of its depths
  proof::LikeMotion as;
};

GougeStream::GougeStream(const GougeCheck& check, const std::vector<int>& tool_of_operation, bool likes_follow)
    : check_(check),
      tool_of_operation_(tool_of_operation),
      likes_follow_(likes_follow),
      out_(proof::no_motion_yet(check.options_.limits.clearance_mm)) {
  std::size_t parts = 0;
  for (const auto& tool : check.tools_) parts = std::max(parts, arms_.emplace_back(arms_of(tool)).size());
  proven_ = std::make_unique<Proven>(parts);
}
GougeStream::~GougeStream() = default;

void GougeStream::own(const path::ToolMotion& motion, std::optional<std::uint32_t> number) {
  Waiting& waits = waiting_.emplace_back(Waiting{motion, {}, {}});
  if (number && likes_follow_) waits.place = proven_->add(*number);
  if (waiting_.size() == kTogether) work();
}

void GougeStream::like(const path::ToolMotion& motion, const proof::LikeMotion& as) {
  if (!before_likes_) {
    work();
    before_likes_ = out_;
  }
  waiting_.push_back({motion, {}, as});
  if (waiting_.size() == kTogether) work();
}

proof::GougeResult GougeStream::finish() {
  work();
  out_.sampled_patches = check_.part_.unproven();
  out_.patches = check_.part_.bounded();
  return std::move(out_);
}

void GougeStream::work() {
  if (waiting_.empty()) return;
  std::vector<proof::GougeResult> chunks((waiting_.size() + kChunk - 1) / kChunk);
  WorkShare share(double(chunks.size()), double(waiting_.size()));
  const auto look = [&](std::size_t n, const proof::GougeResult& elsewhere) {
    Chunk chunk(check_.part_, check_.tools_, check_.options_, likes_follow_ && !before_likes_, &elsewhere);
    std::vector<double> known;
    for (std::size_t k = n * kChunk; k < std::min(waiting_.size(), (n + 1) * kChunk); ++k) {
      const Waiting& w = waiting_[k];
      const int tool = tool_of_operation_[std::size_t(w.motion.operation)];
      if (before_likes_) {
        proven_->of(w.as, arms_[std::size_t(tool)], known);
        chunk.check(w.motion, tool, known);
      } else {
        chunk.check(w.motion, tool, {}, w.place ? proven_->place(*w.place) : std::span<double>());
      }
    }
    chunks[n] = chunk.finish();
    share.add();
  };
  const proof::GougeResult& before = before_likes_ ? *before_likes_ : out_;
  const std::size_t samples = (chunks.size() + kSampled - 1) / kSampled;
  tbb::parallel_for(std::size_t(0), samples, [&](std::size_t n) { look(n * kSampled, before); });
  proof::GougeResult ahead = before;
  for (std::size_t n = 0; n < samples; ++n)
    ahead.measured_mm = std::max(ahead.measured_mm, chunks[n * kSampled].measured_mm);
  tbb::parallel_for(std::size_t(0), chunks.size(), [&](std::size_t n) {
    if (n % kSampled != 0) look(n, ahead);
  });
  for (const auto& chunk : chunks) proof::add_result(out_, chunk);
  waiting_.clear();
}

bool GougeCheck::passes(const proof::GougeResult& r) const {
  return r.bound_mm <= options_.limits.gouge_mm && r.measured_mm <= options_.limits.gouge_mm &&
         r.clearance_mm >= options_.limits.clearance_mm && r.rapids_clear;
}

std::vector<path::ToolMotion> GougeCheck::motions_of(const path::ClPath& path) {
  return toothpath::path::motions_of(path);
}

/// The motions of one tool in their order, all of those beside the first that is refused left out: a path that is wrong
/// in many places costs no more than one that is right. What passes is followed no closer than it takes to see that.
proof::GougeResult GougeCheck::until_fault(const std::vector<path::ToolMotion>& motions, std::size_t tool) const {
  const std::size_t count = (motions.size() + kChunk - 1) / kChunk;
  const WorkShare all{double(motions.size())};
  auto accepted = proof::no_motion_yet(options_.limits.clearance_mm);
  accepted.measured_mm = options_.limits.gouge_mm;
  auto out = proof::no_motion_yet(options_.limits.clearance_mm);
  for (std::size_t from = 0; from < count && passes(out); from += kWave) {
    std::vector<proof::GougeResult> wave(std::min(kWave, count - from));
    WorkShare share(double(wave.size()), double(wave.size() * kChunk));
    tbb::parallel_for(std::size_t(0), wave.size(), [&](std::size_t n) {
      Chunk chunk(part_, tools_, options_, false, &accepted);
      const std::size_t begin = (from + n) * kChunk, end = std::min(motions.size(), begin + kChunk);
      for (std::size_t k = begin; k < end && passes(chunk.so_far()); ++k) chunk.check(motions[k], int(tool));
      wave[n] = chunk.finish();
      share.add();
    });
    for (const auto& chunk : wave) proof::add_result(out, chunk);
  }
  return out;
}

Result<proof::CheckedClPath> GougeCheck::check_path(path::ClPath path) const {
  const auto r = until_fault(path::motions_of(path), std::size_t(path.tool));
  if (passes(r)) return proof::CheckedClPath(std::move(path));
  if (!r.worst.empty()) {
    const auto& w = r.worst.front();
    if (w.body == tool::Body::any)
      return fail_as(DiagnosticKind::verification,
                     "operation {} ({}): the rapid to CL record {} runs through the blank", path.operation,
                     path.operation_type, w.line);
    if (!cuts(w.body))
      return fail_as(
          DiagnosticKind::verification,
          "operation {} ({}), CL record {}: the {} of tool {} comes within {:.4f} mm of the teeth at radius "
          "{:.3f}, height {:.3f}; the clearance is {:.4f}{}",
          path.operation, path.operation_type, w.line, w.body, tools_[std::size_t(path.tool)].number, -w.depth_mm,
          w.radius_mm, w.height_mm, options_.limits.clearance_mm,
          -w.depth_mm < options_.limits.clearance_mm ? "" : fmt::format(", of which {:.4f} is proven", r.clearance_mm));
    if (r.measured_mm <= options_.limits.gouge_mm)
      return fail_as(DiagnosticKind::verification,
                     "operation {} ({}), CL record {}: the {} was found to cut {:.4f} mm, but it is not proven that "
                     "it cuts less than {:.4f} mm, into {} of zone {} at radius {:.3f}, height {:.3f}; the gouge "
                     "tolerance is {:.4f}; a ball or corner as wide as the fillet touches all along it: a narrower one "
                     "is followed closely",
                     path.operation, path.operation_type, w.line, w.body, r.measured_mm, w.depth_mm, w.patch, w.zone,
                     w.radius_mm, w.height_mm, options_.limits.gouge_mm);
    return fail_as(DiagnosticKind::verification,
                   "operation {} ({}), CL record {}: the {} cuts {:.4f} mm (bound) into {} of zone {} at radius "
                   "{:.3f}, height {:.3f}; the gouge tolerance is {:.4f}",
                   path.operation, path.operation_type, w.line, w.body, w.depth_mm, w.patch, w.zone, w.radius_mm,
                   w.height_mm, options_.limits.gouge_mm);
  }
  return fail_as(DiagnosticKind::verification, "operation {} ({}) is not proven free of gouges", path.operation,
                 path.operation_type);
}

}  // namespace toothpath::analytic
