#include "app/process/program_report.h"

#include <algorithm>

#include "app/process/gear_of_job.h"
#include "app/report/machine_moves.h"
#include "geometry/base/angle.h"
#include "geometry/base/hash.h"
#include "machines/toml/regular_file.h"
#include "postproc/controls/of_machine.h"
#include "postproc/controls/registry.h"
#include "postproc/joints/clearance.h"
#include "postproc/joints/time.h"
#include "postproc/joints/tooth_order.h"
#include "postproc/text/clamps.h"
#include "postproc/text/lines.h"
#include "postproc/text/tool_checks.h"
#include "postproc/text/writer.h"
#include "postproc/tool_life/change.h"

namespace toothpath::process {
namespace {

constexpr std::size_t kMostBytes = std::size_t(1) << 30;
constexpr std::size_t kMostParts = 999;
constexpr double kLeastAxisBlend = 0.0001;  // deg: the last digit of a tolerance of the rotaries
constexpr double kMostAxisBlend = 0.01;     // deg, where the contour tolerance is a share of what is left
constexpr double kRoughingShare = 0.02;     // of an allowance: a fifth of it may go, most of that to the plan
constexpr double kContourDigits = 1e4;      // of a tolerance: 0.1 um
constexpr double kBlendShare = 0.15;        // of the gouge tolerance that the control may round corners by unasked

/// The words of `pole`, in the order of PoleOption.
constexpr const char* kPoleWords[] = {"error", "tilt", "hold", "through", "slow", "retract"};

/// All changes of the tool, the first tool included.
double tool_changes(const joints::AxisProgram& program) {
  int changes = 0, before = -1;
  for (const joints::AxisOperation& o : program.operations) {
    changes += o.tool_number != before ? 1 : 0;
    before = o.tool_number;
  }
  return changes;
}

/// What checks of the tools trust the machine and its control with.
void note_check_trust(report::RunReport& report, const job::Job& job, const machines::Machine& machine) {
  const controls::Control* control = controls::find(machine.dialect);
  if (job.program.text.checks == text::ToolChecks::none || !machine.tool_check || control == nullptr) return;
  const bool own = !machine.tool_check->lines.empty();
  report.warnings.push_back(fmt::format(
      "{}, tool_check: it is trusted that the lines move no rotary, go straight down to the setter from {:g} mm above "
      "it and straight up, and stop the program where a tool is broken{}{}",
      job.machine.file, machine.tool_check->clearance_mm, own ? "" : "; ", own ? "" : control->words.check_trust));
}

double shown(const joints::AxisRange& axis, double value) { return axis.rotary ? degrees(value) : value; }

}  // namespace

report::RunReport report_of(const std::string& command, const job::Job& job, const machines::Machine& machine,
                            const std::vector<std::string>& gear_warnings) {
  report::RunReport report;
  report.command = command;
  report.job_name = job.name;
  report.job_file = job.file;
  report.machine_name = machine.name;
  report.machine_file = job.machine.file;
  report.dialect = machine.dialect;
  report.gouge_tolerance_mm = job.verify.gouge_tolerance_mm;
  // First, because the head of a program has few lines.
  for (const std::string& zero : controls::trusted_zeros(machine, job.program.tilted_planes))
    report.assumed.push_back(fmt::format("{}: {}", job.machine.file, zero));
  if (machine.assumed)
    for (const auto& key : machine.assumed_keys) report.assumed.push_back(fmt::format("{}: {}", job.machine.file, key));
  if (const controls::Control* control = controls::find(machine.dialect);
      control && !control->words.corner_flow.empty() && machine.post.corner_tolerance_mm)
    report.assumed.push_back(fmt::format("{}: post.corner_tolerance = {:g} mm, what {} leaves of corners",
                                         job.machine.file, *machine.post.corner_tolerance_mm,
                                         control->words.corner_flow));
  if (!machine.post.smoothing_on.empty() && machine.post.smoothing_tolerance_mm)
    report.assumed.push_back(fmt::format("{}: post.smoothing_tolerance = {:g} mm, what \"{}\" leaves of the path",
                                         job.machine.file, *machine.post.smoothing_tolerance_mm,
                                         machine.post.smoothing_on.front()));
  if (!machine.post.smoothing_on.empty() && machine.post.smoothing_axis_tolerance_rad)
    report.assumed.push_back(fmt::format("{}: post.smoothing_axis_tolerance = {:g} deg", job.machine.file,
                                         degrees(*machine.post.smoothing_axis_tolerance_rad)));
  if (const auto dialect = controls::dialect_of(machine); dialect && dialect->blend && !dialect->contour_trust.empty())
    report.assumed.push_back(fmt::format("{}: contour deviation = {}", job.machine.file, dialect->contour_trust));
  if (const controls::Control* control = controls::find(machine.dialect);
      control && job.program.tilted_planes && machine.chain.rotary_count() == 2)
    report.assumed.push_back(fmt::format(
        "{}: program.tilted_planes: {}", job.file,
        text::expanded(control->words.planes.assumed, {{"axis", std::string(1, machine.chain.rotary(1).letter)}})
            .value_or(control->words.planes.assumed)));
  report.warnings = job.warnings;
  report.warnings.insert(report.warnings.end(), gear_warnings.begin(), gear_warnings.end());
  note_check_trust(report, job, machine);
  return report;
}

void note_axis_program(report::RunReport& report, const job::Job& job, const machines::Machine& machine,
                       std::span<const path::ClPath* const> paths, const joints::AxisProgram& program) {
  report.axes = program.ranges;
  report.tool_uses = program.tool_uses;
  for (const joints::AxisOperation& op : program.operations) {
    const int checks = int{op.check_ahead} + int{op.check_behind};
    if (checks == 0) continue;
    const auto same = std::find_if(report.tool_checks.begin(), report.tool_checks.end(),
                                   [&](const report::ToolCheckUse& use) { return use.tool == op.tool_number; });
    if (same != report.tool_checks.end()) same->checks += checks;
    else report.tool_checks.push_back({op.tool_number, checks, op.check_tolerance_mm});
  }
  if (machine.post.index_loop.value_or(false) && !program.loop && program.teeth > 1 && *program.no_loop != 0) {
    const SourcePosition at = machine.where("post.index_loop");
    report.warnings.push_back(
        fmt::format("{}:{}:{}: post.index_loop = true is not followed, every tooth is written out: {}", at.file,
                    at.line, at.column, program.no_loop));
  }
  const bool timed = program.has_acceleration;
  report.has_acceleration = timed;
  report.feed_minutes = timed ? program.accelerated.feed : program.feed_minutes;
  report.total_minutes = timed ? program.accelerated.feed + program.accelerated.rapid : program.minutes;
  report.total_minutes += program.clamp_minutes + program.check_minutes;
  report.time_model = program.time_model;
  if (machine.tool_change_min) {
    report.tool_change_minutes = tool_changes(program) * *machine.tool_change_min;
    report.total_minutes += *report.tool_change_minutes;
  }
  if (job.setup && program.offer)
    report.travel_room = report::TravelRoom{*program.offer, job.setup->origin_mm + program.offer->shift_mm,
                                            job.setup->work_offset_at_mm + program.offer->shift_mm};
  if (program.pole_passages > 0)
    report.poles = report::PolesReport{program.pole_passages, kPoleWords[static_cast<std::size_t>(machine.post.pole)],
                                       program.pole_axis_rad, program.pole_tip_mm};
  report.block_times = report::block_times_of(program);
  for (const joints::AxisOperation& o : program.operations) {
    const auto& asked = job.operations[static_cast<std::size_t>(o.operation)];
    report::OperationReport operation{
        o.operation,
        o.type,
        o.tool_number,
        asked.speed_rpm,
        asked.feed_mm_min,
        0,
        timed ? o.accelerated.feed : o.feed_minutes,
        (timed ? o.accelerated.rapid : o.rapid_minutes) + o.clamp_minutes + o.check_minutes};
    if (o.end_place >= 0) operation.places = {o.first_place, o.end_place};
    operation.share = double(o.places(program.teeth)) / program.teeth;
    for (const path::ClPath* path : paths)
      if (path->operation == o.operation) operation.cl_points += path->records.size();
    report.operations.push_back(operation);
  }
}

void note_proof(report::RunReport& report, const ProgramProof& proof) {
  if (proof.swept) report.gouge = proof.gouge;
  report.excess = proof.excess;
  report.finished = proof.finished;
  report.findings = proof.findings;
  if (!proof.directions.empty()) report.directions = proof.directions;
  report.reasons = proof.reasons;
  report.warnings.insert(report.warnings.end(), proof.warnings.begin(), proof.warnings.end());
  report.conditions = proof.conditions;
  report.hash = proof.hash;
  report.machine_moves = proof.machine_moves;
  report.would_help = report::help_for(proof.machine_moves);
}

std::vector<const path::ClPath*> paths_to_meet(const joints::AxisProgram& program,
                                               std::span<const path::ClPath* const> paths) {
  if (program.followed.empty()) return {paths.begin(), paths.end()};
  std::vector<const path::ClPath*> followed;
  for (const path::ClPath& path : program.followed) followed.push_back(&path);
  return followed;
}

namespace {

/// They are in the text.
void release_later_teeth(joints::AxisProgram& program) {
  for (joints::AxisOperation& operation : program.operations)
    for (std::size_t n = 1; n < operation.teeth.size(); ++n) {
      operation.teeth[n].release();
      operation.teeth[n].packed = {};
    }
}

/// Of the largest tool: a lean moves the centre of its ball by no more than a corner does.
double largest_radius(const job::Job& job) {
  double radius = 0;
  for (const auto& tool : job.tools) radius = std::max(radius, tool.radius_mm());
  return radius;
}

/// What a rotary may be off beside a tip that is off by so much, deg; nothing: no tool has a ball to say.
std::optional<double> lean_beside(double corner_mm, double most_deg, const job::Job& job) {
  const double radius = largest_radius(job);
  if (!(radius > 0)) return std::nullopt;
  return std::max(kLeastAxisBlend, std::min(most_deg, degrees(corner_mm / (2 * radius))));
}

text::NcHeader header_of(const PostRequest& request, const std::vector<std::string>& assumed) {
  text::NcHeader header;
  header.job_name = request.title;
  header.machine_name = request.machine.name;
  header.assumed = assumed;
  header.coolant = request.job.coolant;
  header.program_number = program_number(request.job);
  header.wishes = request.job.program.text;
  header.blank = request.blank;
  if (!request.blank) header.no_blank = "NO BLANK FOR THE GRAPHICS: THE GEAR AXIS IS NOT Z OF THE WORK OFFSET";
  header.blend_mm = request.contour_mm.value_or(narrow_contour(request));
  header.contour_granted = request.contour_mm.has_value();
  const double most = header.contour_granted ? kMostAxisBlend : header.blend_axis_deg;
  header.blend_axis_deg = lean_beside(header.blend_mm, most, request.job).value_or(header.blend_axis_deg);
  return header;
}

/// What the text grants at corners; more where a later operation takes what they leave and the request says so.
void note_corners(joints::AxisProgram& program, const text::NcDialect& dialect, const text::NcHeader& header,
                  const PostRequest& request) {
  for (joints::AxisOperation& op : program.operations) {
    const double allowance = request.job.operations[static_cast<std::size_t>(op.operation)].allowance_mm;
    const double mm = std::floor(kRoughingShare * allowance * kContourDigits) / kContourDigits;
    if (request.wide_roughing && dialect.blend && mm > header.blend_mm)
      op.wide_corners = {mm, lean_beside(mm, kMostAxisBlend, request.job).value_or(header.blend_axis_deg)};
  }
  text::note_corners(program, dialect, header);
}

/// The job states a contour tolerance that its control has no word for.
std::optional<Diagnostic> no_contour_word(const job::Job& job, const text::NcDialect& dialect) {
  if (!job.program.contour_tolerance_mm || dialect.blend) return std::nullopt;
  return located(job, "program.contour_tolerance",
                 fail("contour_tolerance: the text of \"{}\" says none{}", dialect.name,
                      dialect.takes_smoothing || !dialect.corner_flow.empty()
                          ? "; post.corner_tolerance and post.smoothing_* of the machine file state what it leaves"
                          : ""));
}

/// What clamps and checks of the tools take, and where the checks stand.
void note_text_times(joints::AxisProgram& program, const job::Job& job, const text::NcDialect& dialect) {
  note_clamp_times(program, dialect, job.program.text.stops == text::Stops::teeth);
  std::map<int, double> tolerance_mm;
  for (const tool::ToolAssembly& tool : job.tools)
    if (tool.check_tolerance_mm > 0) tolerance_mm[tool.number] = tool.check_tolerance_mm;
  note_tool_checks(program, dialect, job.program.text, tolerance_mm);
}

/// Programs that hold a part each, written and read back: numbers and names behind those of the whole program.
Result<std::vector<PostedPart>> post_parts(joints::AxisProgram& whole, const text::NcDialect& dialect,
                                           text::NcHeader header, int first_number, const PostRequest& request,
                                           app::OutputDir& output) {
  const job::Job& job = request.job;
  std::vector<PostedPart> posted;
  const std::optional<int>& teeth = job.program.teeth_per_program;
  if (!teeth && !job.program.split_operations) return posted;
  const int last_number = static_cast<int>(job::kProgramNumber.high);
  const char* key = teeth ? "program.teeth_per_program" : "program.split";
  const std::vector<joints::ProgramPart> parts = joints::parts_of(whole, teeth.value_or(request.teeth));
  if (parts.size() > kMostParts)
    return located(job, key, fail("{} programs, {} at most: more teeth in each", parts.size(), kMostParts));
  const joints::PartMaker maker(whole);
  header.program_number = first_number;
  const std::size_t digits = std::to_string(parts.size()).size();
  for (const joints::ProgramPart& part : parts) {
    joints::AxisProgram program = maker.make(part);
    estimate_times(program, request.machine);
    note_text_times(program, job, dialect);
    header.name_end = fmt::format("_{:0{}}", part.number, digits);
    if (has_program_number(dialect) && header.program_number > last_number)
      return located(job, key,
                     fail("part {} of {} would be program O{}, above O{}: a smaller program.number, or more "
                          "teeth in each part",
                          part.number, part.count, header.program_number, last_number));
    auto text = text::write_nc(program, dialect, header);
    if (!text) return located(job, key, text.error());
    PostedPart out{part,
                   "program" + header.name_end + dialect.extension,
                   text::name_on_control(dialect, header),
                   {},
                   text->blocks,
                   {},
                   0,
                   0};
    const bool timed = program.has_acceleration;
    out.feed_minutes = timed ? program.accelerated.feed : program.feed_minutes;
    out.total_minutes = (timed ? program.accelerated.feed + program.accelerated.rapid : program.minutes) +
                        program.clamp_minutes + program.check_minutes;
    for (const joints::AxisOperation& op : program.operations)
      if (out.tools.empty() || out.tools.back() != op.tool_number) out.tools.push_back(op.tool_number);
    if (request.machine.tool_change_min)
      out.total_minutes += double(out.tools.size()) * *request.machine.tool_change_min;
    header.program_number += text->numbers;
    if (const auto written = output.write(out.file, text->text); !written) return written.error();
    auto bytes = output.read_back(out.file);
    if (!bytes) return bytes.error();
    out.text = std::move(bytes.value());
    posted.push_back(std::move(out));
  }
  return posted;
}

/// Sisters go on where tools are used up. @returns the first tool that does not last
std::optional<Diagnostic> change_tools(const job::Job& job, const machines::Machine& machine,
                                       joints::AxisProgram& program) {
  std::vector<tool_life::LastingTool> tools;
  for (const tool::ToolAssembly& tool : job.tools)
    if (tool.life_min > 0 && tool.sister_of == 0) tools.push_back({tool.number, tool.life_min, tool.sisters});
  if (tools.empty()) return std::nullopt;
  const std::size_t before = program.operations.size();
  for (const tool_life::Shortage& shortage : tool_life::change_tools(program, tools))
    for (std::size_t k = 0; k < job.tools.size(); ++k)
      if (job.tools[k].number == shortage.tool)
        return located(
            job, fmt::format("tool[{}].{}", k, shortage.one_tooth || job.tools[k].sisters.empty() ? "life" : "sisters"),
            fail("{}", shortage.text));
  if (program.operations.size() != before) estimate_times(program, machine);
  return std::nullopt;
}

double counted(const joints::AxisProgram& program, const text::NcDialect& dialect, const text::NcHeader& header,
               double radius) {
  return text::granted_blend_mm(program, dialect, header) + radius * text::granted_blend_rad(program, dialect, header);
}

/// The dialect of a request whose program was written, and its header with this tolerance.
std::pair<text::NcDialect, text::NcHeader> words_with(PostRequest request, const std::optional<double>& contour_mm) {
  request.contour_mm = contour_mm;
  auto dialect = controls::dialect_of(request.machine);
  return {dialect ? std::move(*dialect) : text::NcDialect{}, header_of(request, {})};
}

}  // namespace

std::optional<Diagnostic> no_room_over_part(const job::Job& job, const machines::Machine& machine,
                                            const joints::ClearanceBody& body) {
  const auto dialect = controls::dialect_of(machine);
  if (!dialect || job.operations.empty() || !job.setup) return std::nullopt;
  joints::AxisOptions options = controls::axis_options(*dialect, machine);
  if (job.program.tilted_planes) options.tilted_planes = job.where("program.tilted_planes");
  const tool::ToolAssembly& tool = job.tools[static_cast<std::size_t>(job.operations.front().tool)];
  const auto room =
      joints::room_at_start(machine, {job.setup->rotation(), job.setup->origin_mm}, body, options, tool.length_mm);
  if (!room || *room >= -1e-9) return std::nullopt;
  const Vec3& at = job.setup->origin_mm;
  return located(
      job, "setup.origin",
      fail(
          "setup.origin = [{:g}, {:g}, {:g}]: the part with {:g} mm of room for links over it is {:.3f} mm higher than "
          "the tip of T{} rises, {:g} mm long, with Z at its top, {:g}: lower the part by so much or more, origin and "
          "work_offset_at alike, or take a shorter tool",
          at.x(), at.y(), at.z(), options.clearance_margin_mm, -*room, tool.number, tool.length_mm,
          machine.chain.linear[2].max_mm));
}

bool takes_contour(const machines::Machine& machine) {
  const auto dialect = controls::dialect_of(machine);
  return dialect && dialect->blend;
}

double narrow_contour(const PostRequest& request) {
  return std::min(text::NcHeader{}.blend_mm, kBlendShare * request.job.verify.gouge_tolerance_mm);
}

double counted_contour(const PostRequest& request, const PostedProgram& posted, double contour_mm) {
  const auto [dialect, header] = words_with(request, contour_mm);
  return counted(posted.axes, dialect, header, largest_radius(request.job));
}

double first_teeth_minutes(const PostRequest& request, const PostedProgram& posted,
                           const std::optional<double>& contour_mm) {
  const auto [dialect, header] = words_with(request, contour_mm);
  joints::AxisProgram program = posted.axes;
  text::note_corners(program, dialect, header);
  estimate_times(program, request.machine);
  return program.accelerated.feed;
}

int program_number(const job::Job& job) {
  constexpr int kFirst = 1000, kStep = 100, kNames = 60;  // room for 1000 sub-programs behind the last
  return job.program.number.value_or(kFirst + kStep * static_cast<int>(fnv1a(job.name) % kNames));
}

Result<PostedProgram> post_program(std::span<const proof::CheckedClPath> paths, const PostRequest& request,
                                   const std::vector<std::string>& assumed, app::OutputDir& output,
                                   app::StageClock& clock) {
  const job::Job& job = request.job;
  const machines::Machine& machine = request.machine;
  const std::optional<joints::ProgramRestart>& restart = request.restart;
  const auto dialect = controls::dialect_of(machine);
  if (!dialect) return located(job, "machine.file", dialect.error());
  if (auto refused = no_contour_word(job, *dialect)) return *refused;
  auto program = clock.run("axis program", [&] {
    joints::AxisOptions options = controls::axis_options(*dialect, machine);
    options.pack_teeth = true;
    if (job.program.tilted_planes) options.tilted_planes = job.where("program.tilted_planes");
    if (job.program.spread_teeth) options.tooth_stride = joints::spread_stride(request.teeth);
    return build_axis_program(paths, job.tools, *job.setup, machine, request.teeth, request.body, options);
  });
  if (!program) return located(job, "setup", program.error());
  PostedProgram posted;
  posted.axes = std::move(program.value());

  const text::NcHeader header = header_of(request, assumed);
  note_corners(posted.axes, *dialect, header, request);
  if (posted.axes.corner_tolerance_mm > 0) estimate_times(posted.axes, machine);
  if (auto lasting = change_tools(job, machine, posted.axes)) return *lasting;
  if (text::divide_for_checks(posted.axes, job.program.text)) estimate_times(posted.axes, machine);
  note_text_times(posted.axes, job, *dialect);
  auto text = clock.run("NC text", [&] { return text::write_nc(posted.axes, *dialect, header); });
  if (!text) return located(job, "machine.file", text.error());
  posted.blocks = text->blocks;
  posted.blend_mm = counted(posted.axes, *dialect, header, largest_radius(job));
  posted.file = "program" + dialect->extension;
  posted.name_on_control = text::name_on_control(*dialect, header);
  std::string whole = std::move(text->text);
  if (!restart) {  // ahead of the program, which is written last
    auto parts = clock.run("NC text", [&] {
      return post_parts(posted.axes, *dialect, header, header.program_number + text->numbers, request, output);
    });
    if (!parts) return parts.error();
    posted.parts = std::move(parts.value());
  }
  if (restart) {
    auto part = joints::program_from(posted.axes, restart->operation, restart->tooth);
    if (!part) return part.error();
    posted.restarted = std::move(part.value());
    estimate_times(*posted.restarted, machine);
    note_text_times(*posted.restarted, job, *dialect);
    text = text::write_nc(*posted.restarted, *dialect, header);
    if (!text) return located(job, "machine.file", text.error());
    posted.blocks = text->blocks;
  }
  if (const auto written = output.write(posted.file, restart ? text->text : whole); !written) return written.error();
  // What is proven is what lies there; the first teeth are all that is asked for later.
  if (!restart) std::string().swap(whole);
  std::string().swap(text->text);
  release_later_teeth(posted.axes);
  if (posted.restarted) release_later_teeth(*posted.restarted);
  auto bytes = output.read_back(posted.file);
  if (!bytes) return bytes.error();
  posted.text = std::move(restart ? whole : bytes.value());
  if (restart) posted.restart_text = std::move(bytes.value());
  return posted;
}

void discard_program(app::OutputDir& output) {
  const auto extensions = controls::program_extensions();
  output.discard_if([&](std::string_view name) {
    return name.starts_with("program") &&
           std::any_of(extensions.begin(), extensions.end(), [&](const std::string& e) { return name.ends_with(e); });
  });
}

Result<std::string> read_program_file(const std::string& path) {
  auto text = toml::read_input_file(path, kMostBytes);
  if (!text) return text;
  const bool first = text->starts_with("schema =");
  const auto begin = first ? 0 : text->find("\nschema =");
  if (begin == std::string::npos) return text;
  const auto line = 1 + std::count(text->begin(), text->begin() + static_cast<std::ptrdiff_t>(begin + 1), '\n');
  return fail_at({path, static_cast<int>(first ? 1 : line), 1},
                 "this is a job or a machine file, not an NC program; `check JOB PROGRAM` takes the job first");
}

std::vector<joints::AxisRange> ranges_of(const readback::ReadBack& read, const machines::Machine& machine) {
  std::vector<joints::AxisRange> out;
  for (std::size_t k = 0; k < 3; ++k)
    out.push_back({"XYZ"[k], false, read.least[k], read.greatest[k], machine.chain.linear[k].min_mm,
                   machine.chain.linear[k].max_mm});
  for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k) {
    const auto& axis = machine.chain.rotary(k);
    out.push_back(
        {axis.letter, true, radians(read.least[3 + k]), radians(read.greatest[3 + k]), axis.min_rad, axis.max_rad});
  }
  return out;
}

void judge_travels(std::span<const joints::AxisRange> axes, std::vector<std::string>& reasons) {
  for (const auto& a : axes) {
    if (a.min < a.lower_limit - 1e-9)
      reasons.push_back(
          fmt::format("travel: {} = {:.4f} is below {:.4f}", a.letter, shown(a, a.min), shown(a, a.lower_limit)));
    if (a.max > a.upper_limit + 1e-9)
      reasons.push_back(
          fmt::format("travel: {} = {:.4f} exceeds {:.4f}", a.letter, shown(a, a.max), shown(a, a.upper_limit)));
  }
}

std::string table_of_worst(const proof::GougeResult& gouge) {
  if (gouge.worst.empty()) return {};
  std::string out = "  worst places\n    line  op  tooth  zone  patch        body        r mm      z mm       um\n";
  for (const auto& w : gouge.worst)
    out += fmt::format("    {:5} {:3} {:6} {:5}  {:<12} {:<7} {:9.3f} {:9.3f} {:8.2f}\n", w.line, w.operation, w.tooth,
                       w.zone, w.patch, w.body, w.radius_mm, w.height_mm, w.depth_mm * 1000);
  return out;
}

std::vector<Diagnostic> errors_of(std::span<const std::string> reasons, const std::string& file) {
  std::vector<Diagnostic> errors;
  for (const auto& reason : reasons) {
    Diagnostic error = fail_as(DiagnosticKind::verification, "{}", reason);
    error.position.file = file;
    errors.push_back(std::move(error));
  }
  return errors;
}

void note_verified(report::RunReport& report, const std::string& file, std::string_view text) {
  report.verified = true;
  report.program_file = file;
  report.program_sha256 = sha256_hex(text);
  report.program_bytes = text.size();
  report.files.push_back(file);
}

app::CommandOutcome verdict_of(report::RunReport& report, const std::optional<Diagnostic>& stopped,
                               const std::string& job_file, app::OutputDir& output) {
  app::CommandOutcome outcome;
  if (stopped) {
    report.reasons.push_back(stopped->message);
    outcome.errors.push_back(*stopped);
  } else {
    outcome.errors = errors_of(report.reasons, job_file);
    if (!outcome.errors.empty() && !report.would_help.empty())
      outcome.errors.front().message += fmt::format("; what would help: {}", fmt::join(report.would_help, "; or "));
  }
  if (!report.verified) {
    discard_program(output);
    outcome.exit_code = app::ExitCode::unverified;
  }
  return outcome;
}

}  // namespace toothpath::process
