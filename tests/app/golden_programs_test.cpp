// The programs of the samples in every dialect, byte for byte as they stand in tests/golden/samples: each sample's gear
// and tools with a coarse form of its operations. Long programs are kept folded: the middle as a count of lines and a
// hash. Every program is also read back and compared with its path. TOOTHPATH_WRITE_GOLDEN=1 writes the files anew: a
// deliberate act, to be explained in the commit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "app/job/file.h"
#include "app/process/bevel/files.h"
#include "app/process/face/body.h"
#include "app/process/face/shaper_setup.h"
#include "app/process/gear_of_job.h"
#include "app/process/proof_limits.h"
#include "cam/analytic/gouge_check.h"
#include "cam/finger/check.h"
#include "cam/finger/milling.h"
#include "cam/plan/milling.h"
#include "geometry/face_gear/part.h"
#include "postproc/controls/of_machine.h"
#include "postproc/readback/conditions.h"
#include "postproc/readback/program_hash.h"
#include "postproc/readback/reader.h"
#include "postproc/shaper/control.h"
#include "postproc/shaper/program.h"
#include "postproc/text/writer.h"
#include "tests/support/files.h"

namespace toothpath {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kWholeBytes = 60000;  // a longer program is folded
constexpr std::size_t kHeadLines = 300, kTailLines = 100;
constexpr std::uintmax_t kLargestFile = 300'000, kLargestSum = 3'000'000;
const fs::path kGolden = fs::path(TOOTHPATH_SOURCE_DIR) / "tests/golden/samples";

/// What is coarser than in the sample: operations that are kept, their steps [mm].
struct Coarse {
  const char* sample;
  std::vector<std::size_t> operations;
  double step_down, step_over, scallop, ridge;
  int fanuc_decimals;  ///< 3: IS-B, 4: IS-C where the part is too large for three
};
void PrintTo(const Coarse& c, std::ostream* out) { *out << c.sample; }

struct Form {
  const char* file;
  const char* dialect;
  machines::TcpMode tcp;
};
constexpr Form kForms[] = {{"linuxcnc.ngc", "linuxcnc", machines::TcpMode::none},
                           {"fanuc.nc", "fanuc", machines::TcpMode::none},
                           {"fanuc_tcp.nc", "fanuc", machines::TcpMode::angles},
                           {"siemens.mpf", "siemens", machines::TcpMode::angles},
                           {"heidenhain.h.txt", "heidenhain", machines::TcpMode::angles},
                           {"cutter_location.apt", "apt", machines::TcpMode::vectors},
                           {"mitsubishi_m80.nc", "mitsubishi_m80", machines::TcpMode::none}};

job::Job job_of(const std::string& sample) {
  auto read = job::read_job_file(std::string(TOOTHPATH_SOURCE_DIR) + "/samples/" + sample + ".toml");
  if (const auto* errors = read.refused()) {
    ADD_FAILURE() << errors->front().text();
    return {};
  }
  return std::move(read).value();
}

job::Job coarse_job(const Coarse& c) {
  job::Job job = job_of(c.sample);
  std::vector<path::MillingOperation> kept;
  for (const std::size_t i : c.operations) {
    path::MillingOperation o = job.operations.at(i);
    o.step_down_mm = c.step_down;
    o.step_over_mm = c.step_over;
    o.scallop_mm = c.scallop;
    if (c.ridge > 0) o.ridge_mm = c.ridge;
    o.chord_tolerance_mm = 0.01;
    kept.push_back(o);
  }
  job.operations = kept;
  job.verify.gouge_tolerance_mm = 0.02;
  return job;
}

/// A gear's checked paths, and what the post needs beside them.
struct Planned {
  std::vector<proof::CheckedClPath> checked;
  std::vector<path::ClPath> paths;
  joints::ClearanceBody body;
  int teeth = 0;
  std::string error;
};

Planned plan_face(const job::Job& job) {
  Planned out;
  auto made = process::make_face_gear(job);
  if (const auto* errors = made.refused()) return out.error = errors->front().text(), out;
  const face_gear::FaceGear& gear = made.value();
  const analytic::GearDistance part(face_gear::part_of(gear), ball::reach_of(job.tools));
  const proof::ProofLimits limits = process::proof_limits(job, 1);
  plan::Options options;
  options.limits = limits;
  auto planned = plan::plan_milling(part, job.tools, job.operations, options);
  if (const auto* refusal = planned.refused()) return out.error = refusal->diagnostic.message, out;
  out.paths = planned.value().paths;
  const analytic::GougeCheck gouge(part, job.tools, {limits, gear.blank_top()});
  for (const auto& path : out.paths) {
    auto passed = gouge.check_path(path);
    if (!passed) return out.error = passed.error().message, out;
    out.checked.push_back(std::move(*passed));
  }
  out.body = face::body_of(gear).links;
  out.teeth = gear.parameters().teeth;
  return out;
}

Planned plan_bevel(const job::Job& job) {
  Planned out;
  auto made = process::make_bevel_gear(job);
  if (const auto* errors = made.refused()) return out.error = errors->front().text(), out;
  const bevel_gear::BevelGear& gear = made.value();
  const proof::ProofLimits limits = process::proof_limits(job);
  const finger::FingerGougeCheck gouge(gear, job.tools, job.operations, limits);
  for (std::size_t i = 0; i < job.operations.size(); ++i) {
    const auto& o = job.operations[i];
    auto plan = finger::plan_finger_operation(gear, job.tools[static_cast<std::size_t>(o.tool)], o, static_cast<int>(i),
                                              limits);
    if (!plan) return out.error = plan.error().message, out;
    auto passed = gouge.approve(plan->path);
    if (!passed) return out.error = passed.error().message, out;
    out.paths.push_back(plan->path);
    out.checked.push_back(std::move(*passed));
  }
  out.body = bevel::clearance_body(gear);
  out.teeth = gear.parameters().teeth;
  return out;
}

/// The sample's machine as if it had this control.
machines::Machine machine_with(const machines::Machine& of_sample, const Form& form, int fanuc_decimals) {
  machines::Machine m = of_sample;
  const bool own = m.dialect == form.dialect;
  m.dialect = form.dialect;
  m.tcp = form.tcp;
  m.max_simultaneous_axes = 5;
  if (!own) m.post.linear_decimals = m.post.rotary_decimals = std::nullopt;
  m.post.index_loop = std::nullopt;
  if (m.dialect == "fanuc") m.post.linear_decimals = m.post.rotary_decimals = fanuc_decimals;
  if (m.dialect != "linuxcnc") {
    m.post.tcp_on.clear();
    m.post.tcp_off.clear();
  }
  if (m.dialect == "heidenhain")
    m.post.coolant[machines::Coolant::mist] = {"M7", "M9"};  // the control has no word of its own
  return m;
}

/// A long program with its middle left out: how many lines, and a hash of them.
std::string folded(const std::string& text) {
  if (text.size() <= kWholeBytes) return text;
  std::vector<std::string_view> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at) + 1;
    lines.emplace_back(text.data() + at, end - at);
    at = end;
  }
  if (lines.size() <= kHeadLines + kTailLines) return text;
  std::string out;
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (i < kHeadLines || i + kTailLines >= lines.size()) {
      out += lines[i];
      continue;
    }
    for (const char c : lines[i]) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    if (i + kTailLines + 1 == lines.size())
      out += fmt::format("..... {} lines are left out here, FNV-1a {:016X} .....\n",
                         lines.size() - kHeadLines - kTailLines, hash);
  }
  return out;
}

void expect_golden(const fs::path& file, const std::string& text) {
  if (std::getenv("TOOTHPATH_WRITE_GOLDEN") != nullptr) {
    fs::create_directories(file.parent_path());
    test::write_file(file, text);
  }
  ASSERT_TRUE(fs::exists(file)) << file;
  const std::string stored = test::file_text(file);
  if (stored == text) return;
  std::istringstream a(stored), b(text);
  std::string old_line, new_line;
  int n = 0;
  do {
    ++n;
    if (!std::getline(a, old_line)) old_line = "(end)";
    if (!std::getline(b, new_line)) new_line = "(end)";
  } while (old_line == new_line && old_line != "(end)");
  ADD_FAILURE() << file << " differs first in line " << n << "\n  stored: " << old_line << "\n  now:    " << new_line;
}

/// What a check of the text finds of feeds, speeds, tools and coolant, knowing nothing but the job: nothing.
void expect_conditions_kept(const std::string& text, const readback::NcControl& control, const job::Job& job,
                            const machines::Machine& m) {
  const readback::AskedConditions asked = process::asked_conditions(job);
  readback::ConditionJudge judge(m, control, asked);
  ASSERT_TRUE(readback::execute_nc(text, "p", control, [&](const readback::ExecutedMove& move) { judge.add(move); }));
  const readback::ConditionsFound found = judge.finish();
  for (const auto* list : {&found.reasons, &found.warnings})
    for (const std::string& said : *list) ADD_FAILURE() << said;
  const auto hash = readback::hash_of_program(text);
  ASSERT_TRUE(hash && hash->fits());
  EXPECT_NE(text.find(fmt::format(" BLOCKS {}", hash->blocks)), std::string::npos);
  EXPECT_GE(readback::count_blocks(text), hash->blocks);
}

/// The program meets its path: records to the rounding of the words, rapids clear of the blank.
void expect_round_trip(const std::string& text, const joints::AxisProgram& program, const Planned& planned,
                       const job::Job& job, const machines::Machine& m) {
  const auto control = controls::control_of(m, *job.setup, job.tools);
  ASSERT_TRUE(control);
  const auto back = readback::read_back(text, "p", *control, m, *job.setup, {.teeth = planned.teeth});
  ASSERT_TRUE(back) << back.error().text();
  EXPECT_EQ(back->mixed_rapid, 0);
  expect_conditions_kept(text, *control, job, m);
  std::vector<path::ToolMotion> motions;
  for (const auto& trace : back->operations) {
    const auto part = readback::tool_motions(trace, back->copies, *control, m, *job.setup, planned.teeth, {1e-4, 1e-4});
    ASSERT_TRUE(part) << part.error().text();
    motions.insert(motions.end(), part->begin(), part->end());
    if (job.bevel_gear() != nullptr)
      continue;  // its rapids pass beside the cone, inside that cylinder: judged by the finger check
    const auto clear = readback::check_rapids(trace, *control, m, *job.setup, planned.body);
    EXPECT_TRUE(clear) << (clear ? "" : clear.error().message);
  }
  if (job.bevel_gear() == nullptr)
    for (const auto& stretch : back->between) {
      const auto clear = readback::check_rapids_outside(stretch, *control, m, *job.setup,
                                                        readback::obstacle_of(planned.body), job.tools);
      EXPECT_TRUE(clear) << (clear ? "" : clear.error().message);
    }
  std::vector<const path::ClPath*> list;
  for (const auto& p : planned.paths) list.push_back(&p);
  const double bound = program.rounding_bound_mm + program.chord_bound_mm;
  const auto met = readback::compare_with_cl(motions, list, bound + 2e-4, program.axis_bound_rad + 2e-3);
  EXPECT_TRUE(met.complete) << met.message;
  EXPECT_LE(met.worst_mm, program.rounding_bound_mm + 1e-6);
  EXPECT_LT(met.fastest_ratio, 1.05);
}

class GoldenPrograms : public testing::TestWithParam<Coarse> {};
INSTANTIATE_TEST_SUITE_P(
    Samples, GoldenPrograms,
    testing::Values(Coarse{"dhfg_paper", {0, 3}, 5, 3, 0.08, 0, 4}, Coarse{"dhfg_ball", {0, 3}, 1.2, 0.8, 0.02, 0, 3},
                    Coarse{"offset_milled", {0}, 0, 0, 0.05, 0, 3}, Coarse{"short_tool", {0, 1}, 4, 1.8, 0.3, 0, 3},
                    Coarse{"spur_quick", {0, 1}, 2, 0.9, 0.06, 0, 3}, Coarse{"bevel_pinion", {0, 1}, 0, 0, 0, 1.0, 3},
                    Coarse{"bevel_wheel", {0, 1}, 0, 0, 0, 1.0, 3}, Coarse{"bevel_trunnion", {0, 1}, 0, 0, 0, 0.3, 3}),
    [](const auto& c) { return std::string(c.param.sample); });

TEST_P(GoldenPrograms, ByteForByteAndOnTheirPath) {
  const Coarse& c = GetParam();
  const job::Job job = coarse_job(c);
  ASSERT_TRUE(job.setup);
  const Planned planned = job.bevel_gear() != nullptr ? plan_bevel(job) : plan_face(job);
  ASSERT_EQ(planned.error, "");
  auto loaded = process::load_machine(job);
  ASSERT_TRUE(loaded.has_value()) << loaded.error().front().text();
  for (const Form& form : kForms) {
    SCOPED_TRACE(form.file);
    const machines::Machine m = machine_with(loaded.value(), form, c.fanuc_decimals);
    const auto dialect = controls::dialect_of(m);
    ASSERT_TRUE(dialect) << dialect.error().message;
    const auto program = joints::build_axis_program(planned.checked, job.tools, *job.setup, m, planned.teeth,
                                                    planned.body, controls::axis_options(*dialect, m));
    if (!program) {  // the control cannot do it: why, word for word
      expect_golden(kGolden / c.sample / (std::string(form.file) + ".refused"), program.error().message + "\n");
      continue;
    }
    text::NcHeader header;
    header.job_name = job.name + ", coarse";
    header.machine_name = m.name;
    if (m.assumed) header.assumed = m.assumed_keys;
    header.coolant = job.coolant;
    const auto text = text::write_nc(*program, *dialect, header);
    ASSERT_TRUE(text) << text.error().message;
    expect_golden(kGolden / c.sample / form.file, folded(text->text));
    expect_round_trip(text->text, *program, planned, job, m);
  }
}

// The shaped gear on its three shapers.
TEST(GoldenShaper, ByteForByte) {
  job::Job job = job_of("offset_shaped");
  auto made = process::make_face_gear(job);
  ASSERT_TRUE(made.has_value());
  const std::pair<const char*, const char*> files[] = {
      {"y514.toml", "strokes.ngc"}, {"shaper_siemens.toml", "gearbox.mpf"}, {"shaper_fanuc.toml", "gearbox.nc"}};
  for (const auto& [machine, file] : files) {
    SCOPED_TRACE(file);
    job.machine.file = machine;
    auto planned = face::shaper_setup_of(job, made.value());
    ASSERT_TRUE(planned.has_value()) << planned.error().front().text();
    const shaper::ShaperSetup& setup = planned.value();
    expect_golden(kGolden / "offset_shaped" / file, folded(shaper::shaper_program(setup)));
  }
}

// The folder stays small, and every sample says what to look at.
TEST(GoldenFolder, IsSmallAndExplained) {
  std::uintmax_t sum = 0;
  int samples = 0;
  for (const auto& sample : fs::directory_iterator(kGolden)) {
    if (!sample.is_directory()) continue;
    ++samples;
    const std::string readme = test::file_text(sample.path() / "README.md");
    for (const auto& file : fs::directory_iterator(sample.path())) {
      sum += file.file_size();
      EXPECT_LE(file.file_size(), kLargestFile) << file.path();
      const std::string name = file.path().filename().string();
      if (name != "README.md") {
        EXPECT_NE(readme.find("`" + name + "`"), std::string::npos)
            << sample.path().filename() << "/README.md says nothing of " << name;
      }
    }
  }
  EXPECT_EQ(samples, 9);
  EXPECT_LE(sum, kLargestSum);
}

}  // namespace
}  // namespace toothpath
