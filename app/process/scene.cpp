#include "app/process/scene.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/base/angle.h"
#include "geometry/mesh/file.h"
#include "postproc/controls/of_machine.h"

namespace toothpath::process {
namespace {

constexpr std::size_t kChunk = std::size_t(1) << 15;  // moves that are held at a time
constexpr std::size_t kGroup = 32;                    // motions that are looked at together first
constexpr double kTip = 1e-4, kAxis = 2e-6;           // mm, rad: motions of feeds; rapids are cut 50 times coarser
constexpr std::size_t kMostRows = 20;

Status load(const std::vector<std::string>& files, double turn, std::vector<SceneMesh>& out) {
  for (const auto& file : files) {
    auto mesh = mesh::load_mesh(file);
    if (!mesh) return mesh.error();
    if (turn != 0)
      for (Vec3& v : mesh->vertices) v = turned(v, turn);
    auto distance = std::make_unique<clearance::MeshDistance>(*mesh);
    out.push_back({std::move(*mesh), std::move(distance)});
  }
  return Ok{};
}

/// Motions that are judged together.
struct Group {
  std::size_t from = 0, to = 0;
  bool rapid = false;
  std::optional<clearance::Withdrawal> withdrawal;
};

/// Follows the program move by move.
class SceneWalk {
 public:
  SceneWalk(const Scene& scene, const job::Job& job, const machines::Machine& machine,
            const readback::NcControl& control, const readback::ReadBack& read, const SceneGear& gear)
      : job_(job), machine_(machine), control_(control), read_(read), gear_(gear), clearance_(gear.clearance_mm) {
    for (const auto& m : scene.fixture) fixture_.push_back(m.distance.get());
    for (const auto& m : scene.stock) stock_.push_back(m.distance.get());
    if (!fixture_.empty()) verdicts_.push_back(verdict("fixture", scene.fixture_places));
    if (!stock_.empty()) verdicts_.push_back(verdict("stock", scene.stock_places));
  }

  void operator()(readback::ExecutedMove m) {
    if (error_) return;
    if (!moves_.empty() &&
        (m.tool != moves_.back().tool || m.operation != moves_.back().operation || moves_.size() >= kChunk))
      flush();
    if (moves_.empty() && last_) {  // a new tool starts where the spindle stands
      moves_.push_back(*last_);
      moves_.back().tool = m.tool;
      moves_.back().operation = m.operation;
    }
    label(m);
    last_ = m;
    moves_.push_back(m);
  }
  Result<std::vector<report::SceneVerdict>> finish() {
    flush();
    if (error_) return *error_;
    for (auto& v : verdicts_) {
      v.unjudged = unjudged_;
      std::stable_sort(
          v.worst.begin(), v.worst.end(),
          [](const clearance::MeshMeeting& a, const clearance::MeshMeeting& b) { return a.gap_mm < b.gap_mm; });
      if (v.worst.size() > kMostRows) v.worst.resize(kMostRows);
    }
    return std::move(verdicts_);
  }

 private:
  [[nodiscard]] report::SceneVerdict verdict(const char* name, const std::vector<report::MeshInScene>& meshes) const {
    report::SceneVerdict v;
    v.name = name;
    v.meshes = meshes;
    v.required_mm = clearance_;
    v.look_mm = clearance_ + options_.look_mm;
    return v;
  }
  /// The tooth of a move, where the program's teeth are turned copies.
  void label(readback::ExecutedMove& m) {
    const std::size_t i = seen_[m.operation]++;
    if (!read_.copies.copies || m.tooth >= 0) return;
    for (const auto& op : read_.copies.operations)
      for (const auto& trace : read_.operations)
        if (op.operation == m.operation && trace.operation == m.operation && op.moves_per_tooth > 0 &&
            !op.turns.empty())
          m.tooth = std::int16_t(op.turn_of(i));
  }
  /// The tooth nearest to a tip, counted from that of the operation's first cut.
  [[nodiscard]] int nearest_tooth(const path::ToolMotion& m) {
    const double azimuth = gear_.azimuth(m.tip_to);
    if (!m.rapid) first_cut_.emplace(m.operation, azimuth);
    const auto first = first_cut_.find(m.operation);
    if (first == first_cut_.end()) return 0;
    const int k = int(std::lround((azimuth - first->second) / (2 * kPi) * gear_.teeth)) % gear_.teeth;
    return k < 0 ? k + gear_.teeth : k;
  }

  void flush() {
    if (moves_.size() < 2) return moves_.clear();
    const std::vector<clearance::MeshBody>* tool = nullptr;
    for (std::size_t k = 0; k < job_.tools.size(); ++k)
      if (job_.tools[k].number == moves_.back().tool && !gear_.bodies[k].empty()) tool = &gear_.bodies[k];
    for (std::size_t k = 1; k < moves_.size(); ++k) unjudged_ += tool == nullptr || !moves_[k].known;
    if (tool == nullptr) {
      withdrawal_.reset();
      return moves_.clear();
    }
    readback::OperationTrace trace;
    trace.operation = moves_.back().operation;
    trace.tool = moves_.back().tool;
    const bool named = moves_.back().tooth >= 0;
    trace.moves = std::move(moves_);
    moves_ = {};
    auto motions = readback::tool_motions(trace, {}, control_, machine_, *job_.setup, gear_.teeth, {kTip, kAxis});
    if (!motions) {
      error_ = motions.error();
      return;
    }
    if (!named)
      for (auto& m : *motions) m.tooth = nearest_tooth(m);
    judge(*motions, *tool);
  }

  void judge(const std::vector<path::ToolMotion>& motions, const std::vector<clearance::MeshBody>& tool) {
    std::vector<Group> groups;
    for (std::size_t k = 0; k < motions.size(); ++k) {
      const path::ToolMotion& m = motions[k];
      if (m.rapid && withdrawal_ && !clearance::draws_back(m, *withdrawal_)) withdrawal_.reset();
      const bool back = m.rapid && withdrawal_.has_value();
      const bool joins = !groups.empty() && k - groups.back().from < kGroup && groups.back().rapid == m.rapid &&
                         groups.back().withdrawal.has_value() == back && m.tooth == motions[k - 1].tooth &&
                         (m.tip_from - motions[k - 1].tip_to).norm() < 1e-6;
      if (!joins) groups.push_back({k, k, m.rapid, back ? withdrawal_ : std::nullopt});
      groups.back().to = k + 1;
      if (!m.rapid) withdrawal_ = clearance::Withdrawal{m.tip_to, m.axis_to};
    }
    for (auto& v : verdicts_) {
      std::vector<std::optional<clearance::MeshMeeting>> found(groups.size());
      const bool stock = v.name == "stock";
      const clearance::MeshClearance check(stock ? stock_ : fixture_, options_);
      tbb::parallel_for(std::size_t(0), groups.size(), [&](std::size_t k) {
        const Group& g = groups[k];
        found[k] = check.nearest(std::span(motions).subspan(g.from, g.to - g.from), tool, rule(g, stock),
                                 stock ? g.withdrawal : std::nullopt);
      });
      for (std::size_t k = 0; k < groups.size(); ++k) note(v, found[k], rule(groups[k], stock));
      v.motions += motions.size();
    }
  }
  [[nodiscard]] clearance::MeshRule rule(const Group& g, bool stock) const {
    if (!stock) return {clearance_, clearance_};
    if (!g.rapid) return {0, 0, false, true};
    if (g.withdrawal) return {0, 0};
    return {clearance_, clearance_};
  }
  static void note(report::SceneVerdict& v, const std::optional<clearance::MeshMeeting>& found,
                   const clearance::MeshRule& rule) {
    if (!found) return;
    const double required = tool::cuts(found->body) ? rule.cutter_mm : rule.others_mm;
    if (!v.nearest || found->gap_mm < v.nearest->gap_mm) v.nearest = found;
    if (found->gap_mm > 0 && found->gap_mm >= required) return;
    ++v.failed;
    const auto same = std::find_if(v.worst.begin(), v.worst.end(), [&](const clearance::MeshMeeting& w) {
      return w.line == found->line && w.tooth == found->tooth && w.operation == found->operation &&
             w.body == found->body;
    });
    if (same != v.worst.end()) {
      if (found->gap_mm < same->gap_mm) *same = *found;
      return;
    }
    if (v.worst.size() < 50 * kMostRows) v.worst.push_back(*found);
  }

  const job::Job& job_;
  const machines::Machine& machine_;
  const readback::NcControl& control_;
  const readback::ReadBack& read_;
  const SceneGear& gear_;
  double clearance_;
  clearance::MeshClearanceOptions options_;
  std::vector<const clearance::MeshDistance*> fixture_, stock_;
  std::vector<report::SceneVerdict> verdicts_;
  std::vector<readback::ExecutedMove> moves_;
  std::optional<readback::ExecutedMove> last_;
  std::optional<clearance::Withdrawal> withdrawal_;
  std::optional<Diagnostic> error_;
  std::map<int, std::size_t> seen_;
  std::map<int, double> first_cut_;
  std::size_t unjudged_ = 0;
};

std::string where_of(const clearance::MeshMeeting& m) {
  return fmt::format("{}{}, operation {}, tooth {}, line {}", m.body, m.rapid ? " on a rapid" : "", m.operation,
                     m.tooth, m.line);
}

/// A meeting as a row of the table of worst places.
proof::WorstPlace worst_place(const clearance::MeshMeeting& m, const std::string& what) {
  proof::WorstPlace w;
  w.depth_mm = std::isfinite(m.gap_mm) ? -m.gap_mm : 0;
  w.body = m.body;
  w.patch = what;
  w.operation = m.operation;
  w.tooth = m.tooth;
  w.line = m.line;
  w.radius_mm = m.place.head<2>().norm();
  w.height_mm = m.place.z();
  w.point = m.place;
  return w;
}

}  // namespace

Result<Scene> load_scene(const SceneFiles& request, double clocking_rad) {
  Scene scene;
  scene.fixture_files = request.fixture_files;
  scene.stock_files = request.stock_files;
  if (const auto s = load(request.fixture_files, -clocking_rad, scene.fixture); !s) return s.error();
  if (const auto s = load(request.stock_files, 0, scene.stock); !s) return s.error();
  return scene;
}

Result<std::vector<report::SceneVerdict>> check_scene(const Scene& scene, std::string_view text,
                                                      const std::string& file, const job::Job& job,
                                                      const machines::Machine& machine, const readback::ReadBack& read,
                                                      const SceneGear& gear) {
  const auto control = controls::control_of(machine, *job.setup, job.tools);
  if (!control) return control.error();
  SceneWalk walk(scene, job, machine, *control, read, gear);
  if (const auto s = readback::execute_nc(text, file, *control, [&](const readback::ExecutedMove& m) { walk(m); }); !s)
    return s.error();
  auto verdicts = walk.finish();
  if (auto* error = verdicts.refused()) error->position.file = file;
  return verdicts;
}

std::vector<std::string> reasons_of(const std::vector<report::SceneVerdict>& verdicts) {
  std::vector<std::string> out;
  for (const auto& v : verdicts) {
    if (v.clear() || v.worst.empty()) continue;
    const clearance::MeshMeeting& w = v.worst.front();
    if (w.gap_mm <= 0)
      out.push_back(
          fmt::format("{}: {} {} it", v.name, where_of(w), std::isfinite(w.measured_mm) ? "touches" : "is inside"));
    else
      out.push_back(fmt::format("{}: {} comes within {:.4f} mm (proven), the clearance is {:.4f} mm", v.name,
                                where_of(w), w.gap_mm, v.required_mm));
  }
  return out;
}

void add_scene(std::vector<report::SceneVerdict>& verdicts, std::vector<std::string>& reasons,
               proof::GougeResult& gouge, report::RunReport& report) {
  for (auto& reason : reasons_of(verdicts)) reasons.push_back(std::move(reason));
  for (const auto& v : verdicts) {
    for (const auto& m : v.worst) gouge.worst.push_back(worst_place(m, v.name));
    if (v.unjudged > 0)
      report.warnings.push_back(
          fmt::format("{}: {} blocks move from a position that the program does not tell, or without a tool of the "
                      "job; they are not judged",
                      v.name, v.unjudged));
  }
  report.scene = std::move(verdicts);
}

}  // namespace toothpath::process
