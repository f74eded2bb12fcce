#include "app/studies/errors/real_flanks.h"

#include <algorithm>
#include <cmath>

#include "postproc/controls/of_machine.h"

namespace toothpath::errors {
namespace {

/// Moves of the named tooth, with the two ahead of them and the one behind for their corners.
readback::OperationTrace tooth_of(const readback::OperationTrace& trace, int tooth) {
  readback::OperationTrace out = trace;
  const auto of_tooth = [&](const readback::ExecutedMove& m) { return m.tooth == tooth; };
  const auto first = std::find_if(trace.moves.begin(), trace.moves.end(), of_tooth);
  const auto last = std::find_if(trace.moves.rbegin(), trace.moves.rend(), of_tooth).base();
  const auto ahead = std::min<std::ptrdiff_t>(2, first - trace.moves.begin()),
             behind = std::min<std::ptrdiff_t>(1, trace.moves.end() - last);
  if (first == trace.moves.end()) out.moves.clear();
  else out.moves.assign(first - ahead, last + behind);
  out.before = std::size_t(ahead);
  out.after = out.moves.empty() ? 0 : std::size_t(behind);
  return out;
}

bool teeth_are_named(const readback::OperationTrace& trace) {
  return std::any_of(trace.moves.begin(), trace.moves.end(), [](const auto& m) { return m.tooth > 0; });
}

void turn_about_gear(std::vector<path::ToolMotion>& motions, double angle_rad) {
  const Mat3 r = Eigen::AngleAxisd(angle_rad, Vec3::UnitZ()).toRotationMatrix();
  for (auto& m : motions)
    for (Vec3* v : {&m.tip_from, &m.tip_to, &m.axis_from, &m.axis_to}) *v = r * *v;
}

}  // namespace

/// A gear with its tools, and what judges it.
struct RealFlanks::Judge {
  job::Job job;
  flow::GearToCut gear;
  std::unique_ptr<process::GearMilling> milling;
};

Result<std::unique_ptr<RealFlanks>> RealFlanks::make(flow::Run& run, const proof::ProofLimits& limits,
                                                     const process::FlankGrid& grid) {
  std::unique_ptr<RealFlanks> out(new RealFlanks(run, limits, grid));
  auto control = controls::control_of(run.machine, *run.job.setup, run.job.tools);
  if (!control) return control.error();
  out->control_ = std::move(*control);
  auto read = readback::read_back(run.program_text, "program", out->control_, run.machine, *run.job.setup,
                                  {.teeth = out->teeth()});
  if (!read) return read.error();
  out->read_ = std::move(read.value());
  auto nominal = out->proof({}, 0);
  if (!nominal) return nominal.error();
  out->nominal_points_ = points_of(nominal->surface);
  auto cost = out->cost({}, 0);
  if (!cost) return cost.error();
  out->nominal_ = *cost;
  return out;
}

RealFlanks::Points RealFlanks::points_of(const std::vector<proof::SurfaceGrid>& surface) {
  Points out;
  for (const auto& grid : surface) {
    if (path::region_of(grid.patch) != path::Region::flank || grid.excess_um.empty()) continue;
    const auto& excess = grid.excess_um.back();
    out.excess_um.insert(out.excess_um.end(), excess.begin(), excess.end());
    for (std::size_t k = 0; k < excess.size(); ++k)
      out.counts.push_back(grid.reachable.empty() || grid.reachable[k] != 0);
  }
  return out;
}

Result<RealFlanks::Judge*> RealFlanks::judge_for(const Drawn& drawn) {
  const bool own = drawn.radius_mm.empty();
  std::shared_ptr<Judge>& place = own ? judge_ : other_;
  if (own && place) return place.get();
  auto made = std::make_shared<Judge>();
  made->job = run_.job;
  for (auto& tool : made->job.tools)
    if (const auto found = drawn.radius_mm.find(tool.number); found != drawn.radius_mm.end())
      tool.diameter_mm += 2 * found->second;
  auto gear = flow::make_gear(made->job, {}, run_.clock);
  if (auto* errors = gear.refused()) return errors->front();
  made->gear = std::move(gear).value();
  made->milling = made->gear.process->milling(run_.machine, limits_, grid_, run_.clock);
  place = std::move(made);
  return place.get();
}

Result<std::vector<path::ToolMotion>> RealFlanks::motions(const Drawn& drawn, int tooth) const {
  const joints::Setup& setup = *run_.job.setup;
  const machines::KinematicChain& chain = run_.machine.chain;
  const machines::RealMachine machine(chain, drawn.machine, setup.origin_mm);
  std::map<int, machines::RealMachine::Tool> tools;
  for (const auto& [number, length] : control_.tool_length_mm) {
    const auto longer = drawn.longer_mm.find(number);
    tools[number] = machine.touched_off(length, longer == drawn.longer_mm.end() ? 0 : longer->second);
  }
  const double turn = 2 * kPi * tooth / teeth();
  const bool copies = read_.copies.copies;
  double index = 0;
  if (copies && tooth != 0) {
    const auto rotary = index_rotary(chain, setup);
    if (!rotary) return fail("the teeth are turned copies, and no rotary of the table turns them about the gear axis");
    index = turn * chain.table[0].sign * (chain.table[0].direction.dot(setup.rotation().col(2)) > 0 ? 1 : -1);
  }
  readback::Followed by{control_,
                        run_.machine,
                        setup,
                        teeth(),
                        {judge_->milling->check().motion_tolerance(), judge_->milling->check().motion_tolerance()}};
  by.truly = [&](const machines::Joints& commanded, int number) {
    machines::Joints at = commanded;
    at.rotary_rad[0] += index;
    return machine.forward(at, tools.at(number));
  };
  std::vector<path::ToolMotion> out;
  for (const auto& trace : read_.operations) {
    const bool named = !copies && teeth_are_named(trace);
    const readback::OperationTrace one = named ? tooth_of(trace, tooth) : readback::OperationTrace();
    if (const auto s = add_tool_motions(named ? one : trace, read_.copies, by, out); !s) return s.error();
  }
  if (tooth == 0) return out;
  if (!copies) {
    std::erase_if(out, [&](const auto& m) { return m.tooth != tooth; });
    for (auto& m : out) m.tooth = 0;
  }
  turn_about_gear(out, -turn);
  return out;
}

Result<process::ProgramProof> RealFlanks::proof(const Drawn& drawn, int tooth) {
  if (!judge_)
    if (auto own = judge_for({}); !own) return own.error();
  auto judge = judge_for(drawn);
  if (!judge) return judge.error();
  auto made = motions(drawn, tooth);
  if (!made) return made.error();
  process::ProgramProof proof;
  proof.control = control_;
  proof.motions = std::move(*made);
  proof.stated = process::stated_deviation(proof.motions);
  (*judge)->milling->check().judge(proof, run_.clock);
  return proof;
}

Result<std::vector<proof::SurfaceGrid>> RealFlanks::surface(const Drawn& drawn, int tooth) {
  auto judged = proof(drawn, tooth);
  if (!judged) return judged.error();
  return std::move(judged->surface);
}

Result<Cost> RealFlanks::cost(const Drawn& drawn, int tooth) {
  auto judged = proof(drawn, tooth);
  if (!judged) return judged.error();
  const Points points = points_of(judged->surface);
  if (points.excess_um.size() != nominal_points_.excess_um.size())
    return fail("the flanks have {} points, those of the nominal machine {}", points.excess_um.size(),
                nominal_points_.excess_um.size());
  Cost cost;
  double sum = 0, least = INFINITY, most = -INFINITY;
  std::size_t count = 0;
  for (std::size_t k = 0; k < points.excess_um.size(); ++k) {
    if (!points.counts[k] || !nominal_points_.counts[k]) continue;
    const double excess = points.excess_um[k], change = excess - nominal_points_.excess_um[k];
    cost.shift_um = std::max(cost.shift_um, std::abs(change));
    sum += change * change;
    least = std::min(least, excess);
    most = std::max(most, excess);
    ++count;
  }
  if (count == 0) return fail("no point of the flanks is reached by the finishing tool");
  cost.rms_um = std::sqrt(sum / double(count));
  cost.deepest_um = -least;
  cost.left_um = most;
  cost.gouge_um = judged->gouge.measured_mm * 1000;
  cost.gouge_bound_um = judged->gouge.bound_mm * 1000;
  cost.within = judged->reasons.empty();
  return cost;
}

}  // namespace toothpath::errors
