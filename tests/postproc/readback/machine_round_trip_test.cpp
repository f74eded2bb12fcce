// Every milling machine that is shipped, in every way that its dialect can be posted: CL -> text -> reader -> forward
// kinematics
// -> CL, within the rounding of the words.
#include <gtest/gtest.h>

#include <filesystem>

#include "machines/machine_file.h"
#include "tests/postproc/readback/nc_case.h"
#include "tests/postproc/restart/tooth_comparison.h"

namespace toothpath {
namespace {

using namespace test;
namespace fs = std::filesystem;

constexpr joints::ClearanceBody kSmallBody{.radius_mm = 32, .z_min_mm = -12, .z_max_mm = 2};
constexpr double kLength = 60;

std::vector<tool::ToolAssembly> short_tool() {
  tool::ToolAssembly t;
  t.number = 1;
  t.diameter_mm = 2;
  t.length_mm = kLength;
  return {t};
}

/// A pass across a small face, the tool leaning by `lean`; its azimuth turns by `swing` along the pass.
path::ClPath small_path(double lean, double swing) {
  path::ClPath path;
  path.operation_type = "finishing";
  path.spindle_rpm = 8000;
  for (int pass = 0; pass < 2; ++pass) {
    const auto tip = [&](double t) { return Vec3(20 + 8 * t, 0.6 * std::sin(3 * t) + 0.4 * pass, -2 + 0.5 * t * t); };
    const auto axis = [&](double t) { return leaning(lean, 0.4 + 0.1 * pass + swing * t); };
    path.records.push_back({tip(0) + 6 * axis(0), axis(0), 0, path::MoveKind::rapid, 0, pass});
    path.records.push_back({tip(0), axis(0), 300, path::MoveKind::engage, 0, pass});
    for (int i = 1; i <= 12; ++i)
      path.records.push_back({tip(i / 12.0), axis(i / 12.0), 500, path::MoveKind::feed, 0, pass});
    path.records.push_back({tip(1) + 6 * axis(1), axis(1), 300, path::MoveKind::retract, 0, pass});
  }
  path.records.push_back(path.records.back());
  path.records.back().kind = path::MoveKind::rapid;
  return path;
}

struct Post {
  std::string file;
  machines::TcpMode tcp;
  double swing;
  bool expand;
  [[nodiscard]] std::string name() const {
    std::string n = file.substr(0, file.find('.')) + (tcp == machines::TcpMode::none     ? "_joints"
                                                      : tcp == machines::TcpMode::angles ? "_angles"
                                                                                         : "_vectors");
    return n + (swing != 0 ? "_moving" : "_fixed") + (expand ? "_teeth" : "");
  }
};
void PrintTo(const Post& p, std::ostream* out) { *out << p.name(); }

machines::Machine machine_of(const Post& p) {
  auto reading = machines::read_machine_file(std::string(TOOTHPATH_SOURCE_DIR) + "/machines/data/" + p.file);
  EXPECT_TRUE(reading.machine) << p.file;
  machines::Machine m = *reading.machine;
  m.tcp = p.tcp;
  m.max_simultaneous_axes = 5;
  return m;
}

/// What the machine files ask for, and everything else that their dialects can do.
std::vector<Post> posts() {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(std::string(TOOTHPATH_SOURCE_DIR) + "/machines/data")) {
    const auto file = machines::open_machine_file(entry.path().string());
    if (file && file->kind == machines::MachineKind::five_axis) files.push_back(entry.path().filename().string());
  }
  std::sort(files.begin(), files.end());
  std::vector<Post> out;
  for (const auto& f : files) {
    const auto reading = machines::read_machine_file(std::string(TOOTHPATH_SOURCE_DIR) + "/machines/data/" + f);
    for (const machines::TcpMode tcp :
         {machines::TcpMode::none, machines::TcpMode::angles, machines::TcpMode::vectors}) {
      machines::Machine m = *reading.machine;
      m.tcp = tcp;
      const auto dialect = controls::dialect_of(m);
      if (!dialect || (dialect->write != nullptr && tcp != machines::TcpMode::vectors)) continue;
      for (const double swing : {0.0, 0.5}) {
        if (swing != 0 && tcp == machines::TcpMode::none && !dialect->inverse_time)
          continue;  // refused: see HeidenhainNeedsTcp
        for (const bool expand : {false, true}) out.push_back({f, tcp, swing, expand});
      }
    }
  }
  return out;
}

toothpath::joints::Setup setup_of(const machines::Machine& m) {
  toothpath::joints::Setup s;
  if (!m.chain.table.empty()) s.origin_mm = m.chain.table[0].point_mm;
  s.origin_mm.z() = m.chain.linear[2].max_mm - kLength - 100;
  s.work_offset_at_mm = Vec3(s.origin_mm.x(), s.origin_mm.y(), s.origin_mm.z() - 3);
  return s;
}

class MachineRoundTrip : public testing::TestWithParam<Post> {};
INSTANTIATE_TEST_SUITE_P(Shipped, MachineRoundTrip, testing::ValuesIn(posts()),
                         [](const auto& post) { return post.param.name(); });

TEST_P(MachineRoundTrip, MeetsEveryRecordWithinTheRounding) {
  const Post& p = GetParam();
  const machines::Machine m = machine_of(p);
  const toothpath::joints::Setup setup = setup_of(m);
  const int teeth = 5;
  const auto dialect = controls::dialect_of(m);
  ASSERT_TRUE(dialect) << dialect.error().message;
  joints::AxisOptions options = axis_options(*dialect, m);
  options.expand_teeth = options.expand_teeth || p.expand;
  const path::ClPath path = small_path(0.3, p.swing);
  const auto program =
      joints::AxisProgramTestAccess::build(std::vector{path}, short_tool(), setup, m, teeth, kSmallBody, options);
  ASSERT_TRUE(program) << program.error().message;
  text::NcHeader header;
  header.job_name = "round trip";
  header.coolant = machines::Coolant::flood;
  const auto text = text::write_nc(*program, *dialect, header);
  ASSERT_TRUE(text) << text.error().message;

  const auto control = controls::control_of(m, setup, short_tool());
  ASSERT_TRUE(control);
  const auto back = readback::read_back(text->text, "p", *control, m, setup, {.teeth = teeth});
  ASSERT_TRUE(back) << back.error().text() << "\n" << text->text.substr(0, 3000);
  if (program->loop) { EXPECT_TRUE(back->copies.copies) << back->copies.line << ": " << back->copies.difference; }
  ASSERT_EQ(back->operations.size(), 1u);
  const auto motions =
      readback::tool_motions(back->operations[0], back->copies, *control, m, setup, teeth, {1e-4, 1e-4});
  ASSERT_TRUE(motions) << motions.error().message;
  const auto rapids = readback::check_rapids(back->operations[0], *control, m, setup, kSmallBody);
  EXPECT_TRUE(rapids) << (rapids ? "" : rapids.error().message);

  const double bound = program->rounding_bound_mm + program->chord_bound_mm;
  const std::vector<const path::ClPath*> list = {&path};
  const auto met = readback::compare_with_cl(*motions, list, bound + 1e-4, 2e-3);
  EXPECT_TRUE(met.complete) << met.message;
  EXPECT_LE(met.worst_mm, program->rounding_bound_mm + 2e-9);
  EXPECT_LE(met.worst_axis_rad, 2 * radians(std::pow(10.0, -dialect->format.rotary_decimals)) + 1e-8);
  EXPECT_LE(met.worst_extra_mm, 1.05 * bound + 1e-6);
  EXPECT_LT(met.fastest_ratio, 1.02);
  // A block that may not be shorter, or an axis, can rule; never the other way.
  EXPECT_GT(back->feed_minutes, 0.99 * program->feed_minutes);
  EXPECT_LT(back->feed_minutes, 1.35 * program->feed_minutes);
  // Every tooth is there.
  std::vector<bool> seen(teeth, false);
  if (back->copies.copies)
    for (const int k : back->copies.operations[0].turns) seen[static_cast<std::size_t>(k)] = true;
  else
    for (const auto& motion : *motions) seen[static_cast<std::size_t>(motion.tooth)] = true;
  EXPECT_EQ(std::count(seen.begin(), seen.end(), true), teeth);
}

// Written-out teeth with TCP: each is the turned path, to the rounding.
TEST(TcpTeeth, EveryToothIsTheTurnedPath) {
  for (const char* file :
       {"fanuc_ac.toml", "siemens_ac.toml", "head_head_ca.toml", "xyzac_trt.toml", "apt_free.toml"}) {
    const Post post{file, std::string(file) == "apt_free.toml" ? machines::TcpMode::vectors : machines::TcpMode::angles,
                    0.4, true};
    const machines::Machine m = machine_of(post);
    const auto setup = setup_of(m);
    const auto dialect = controls::dialect_of(m);
    ASSERT_TRUE(dialect);
    joints::AxisOptions options = axis_options(*dialect, m);
    options.expand_teeth = true;
    const path::ClPath path = small_path(0.3, 0.4);
    const auto program =
        joints::AxisProgramTestAccess::build(std::vector{path}, short_tool(), setup, m, 4, kSmallBody, options);
    ASSERT_TRUE(program) << program.error().message;
    const auto text = text::write_nc(*program, *dialect, {});
    ASSERT_TRUE(text);
    const auto control = controls::control_of(m, setup, short_tool());
    const auto back = readback::read_back(text->text, "p", *control, m, setup, {.teeth = 4, .keep_all = true});
    ASSERT_TRUE(back) << back.error().text();
    const auto motions = readback::tool_motions(back->operations[0], back->copies, *control, m, setup, 4, {1e-4, 1e-4});
    for (int k = 0; k < 4; ++k) {
      const auto met = compare_tooth(*motions, k, 4, path, program->rounding_bound_mm + 1e-6, 1e-3);
      EXPECT_TRUE(met.complete) << file << " tooth " << k << ": " << met.message;
    }
  }
}

// The joint form of a control without inverse time: refused where a rotary moves in a cut, with what is supported.
TEST(HeidenhainNeedsTcp, ForRotariesThatMoveInACut) {
  const machines::Machine m = machine_of({"heidenhain_ac.toml", machines::TcpMode::none, 0.5, false});
  const auto dialect = controls::dialect_of(m);
  const auto program = joints::AxisProgramTestAccess::build(std::vector{small_path(0.3, 0.5)}, short_tool(),
                                                            setup_of(m), m, 3, kSmallBody, axis_options(*dialect, m));
  ASSERT_TRUE(program);
  const auto text = text::write_nc(*program, *dialect, {});
  ASSERT_FALSE(text);
  EXPECT_NE(text.error().message.find("heidenhain has no inverse time feed for it: tcp = \"angles\" is supported"),
            std::string::npos)
      << text.error().message;
}

// Planted faults: one word of a program changed, and the comparison must see it.
TEST(PlantedFaultOfEveryDialect, IsSeen) {
  for (const auto& p : posts()) {
    if (p.expand || p.swing == 0 || p.tcp == machines::TcpMode::none) continue;
    const machines::Machine m = machine_of(p);
    const auto setup = setup_of(m);
    const auto dialect = controls::dialect_of(m);
    const path::ClPath path = small_path(0.3, p.swing);
    const auto program = joints::AxisProgramTestAccess::build(std::vector{path}, short_tool(), setup, m, 3, kSmallBody,
                                                              axis_options(*dialect, m));
    ASSERT_TRUE(program);
    std::string text = text::write_nc(*program, *dialect, {})->text;
    // The last digit but one of an X word in the middle of the first tooth.
    std::size_t at = text.find("TOOTH 1");
    if (at == std::string::npos) at = text.size() * 2 / 3;
    const std::string mark = p.file == "apt_free.toml" ? "\nGOTO/" : "X";
    // (APT: before the link between the passes, which may lead anywhere.)
    const std::size_t tenths = p.file == "apt_free.toml" ? 3 : 5;
    at = text.rfind(mark, (at * tenths + text.find("OP 0") * (10 - tenths)) / 10) + mark.size();
    const std::size_t point = text.find('.', at);
    ASSERT_NE(point, std::string::npos);
    text[point + 2] = text[point + 2] == '9' ? '1' : static_cast<char>(text[point + 2] + 1);
    const auto control = controls::control_of(m, setup, short_tool());
    const auto back = readback::read_back(text, "p", *control, m, setup, {.teeth = 3});
    if (!back) continue;  // refused: seen as well
    const auto motions = readback::tool_motions(back->operations[0], back->copies, *control, m, setup, 3, {1e-4, 1e-4});
    const std::vector<const path::ClPath*> list = {&path};
    const auto met =
        readback::compare_with_cl(*motions, list, program->rounding_bound_mm + program->chord_bound_mm + 1e-4, 2e-3);
    EXPECT_TRUE(!met.complete || !back->copies.copies) << p.name();
    EXPECT_FALSE(met.complete && met.worst_mm <= program->rounding_bound_mm && met.worst_extra_mm <= 5e-3) << p.name();
  }
}

}  // namespace
}  // namespace toothpath
