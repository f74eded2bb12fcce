// The closed loop: a gear is cut, measured on the inspection grid, and cut again with flanks that answer the
// measurement. The process error is added to what the program on the disk leaves, as read back through the machine's
// kinematics; nothing goes through the correction's formula.
#include <functional>
#include <nlohmann/json.hpp>

#include "app/commands/run.h"
#include "app/job/file.h"
#include "app/job/measured_file.h"
#include "app/job/measured_points.h"
#include "app/process/flow/stages.h"
#include "app/process/gear_of_job.h"
#include "app/process/milled/proof.h"
#include "cam/cut/swept_path.h"
#include "geometry/cylindrical/part.h"
#include "postproc/controls/of_machine.h"
#include "tests/app/program.h"
#include "tests/geometry/inspection/measured_teeth.h"
#include "tests/support/inspection_points.h"

namespace toothpath::test {
namespace {

/// A sample with other numbers and its last operation alone. The roughing has nothing to do with it: one finishing pass
/// from the full stock would be refused by no check of ours.
std::string finished_only(const std::string& sample, const std::vector<std::pair<std::string, std::string>>& changes) {
  std::string text = file_text(kSamples + "/" + sample + ".toml");
  for (const auto& [what, by] : changes) {
    const auto at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    if (at != std::string::npos) text.replace(at, what.size(), by);
  }
  const auto begin = text.find("[[operation]]");
  return text.erase(begin, text.rfind("[[operation]]") - begin);
}

/// The quick spur gear with a short face and fine passes, so that cusps do not hide the error.
std::string quick_job() {
  return finished_only("spur_quick",
                       {{"outer_radius = 65.0", "outer_radius = 61.0"},
                        {"scallop = 0.02\nchord_tolerance = 0.002", "scallop = 0.0003\nchord_tolerance = 0.0003"}});
}
std::string quick_cylindrical_job() {
  return finished_only("cylindrical_spur",
                       {{"from = -10.0\nto = 10.0", "from = -2.0\nto = 2.0"},
                        {"scallop = 0.004\nchord_tolerance = 0.001", "scallop = 0.0003\nchord_tolerance = 0.0003"}});
}

/// 20 um of slope, crowning and twist, another on each side; x along the profile, y along the face, both 0 .. 1 within
/// the grid.
double process_error(int side, double x, double y) {
  const double u = 2 * x - 1, v = 2 * y - 1;
  return side > 0 ? 0.020 * (0.35 * v + 0.4 * u * v - 0.25 * v * v + 0.1 * u * u)
                  : -0.020 * (0.3 * u - 0.4 * v * v * u + 0.3 * v);
}

struct CorrectionCase {
  job::Job job;
  std::optional<face_gear::FaceGear> gear;
};
CorrectionCase read_case(const std::string& file) {
  CorrectionCase c;
  auto job = job::read_job_file(file);
  EXPECT_TRUE(job.has_value());
  c.job = job.value();
  c.gear = process::make_face_gear(c.job).value();
  return c;
}

/// What the program leaves at a point of the nominal flank: least distance to the ball's path less its radius, mm.
class CutFlanks {
 public:
  CutFlanks(const job::Job& job, const tooth_space::ToothedSolid& gear, const std::string& program)
      : far_(gear.measured_on_one_tooth ? gear.pitch() : 0) {
    const auto machine = process::load_machine(job).value();
    const auto control = controls::control_of(machine, *job.setup, job.tools);
    EXPECT_TRUE(control);
    const int teeth = gear.teeth;
    const auto read =
        readback::read_back(program, "program.ngc", *control, machine, *job.setup, {.teeth = teeth, .keep_all = false});
    EXPECT_TRUE(read) << read.error().text();
    const double R = job.tools[std::size_t(job.operations.back().tool)].radius_mm();
    std::vector<cut::BallMove> moves;
    for (const auto& trace : read->operations) {
      const auto motions =
          readback::tool_motions(trace, read->copies, *control, machine, *job.setup, teeth, {1e-5, 1e-5});
      EXPECT_TRUE(motions);
      for (const auto& m : *motions)
        if (!m.rapid && m.tooth == 0) moves.push_back({m.tip_from + R * m.axis_from, m.tip_to + R * m.axis_to});
    }
    EXPECT_GT(moves.size(), 1000u);
    swept_ = std::make_unique<cut::SweptPath>(std::move(moves), R);
  }
  [[nodiscard]] double at(const inspection::InspectionPoint& p) const {
    return swept_->excess(p.side > 0 ? p.p : turned(p.p, far_), 1.0);
  }

 private:
  double far_;  ///< from a measured flank of side -1 to that in space 0: of gears measured on one tooth a pitch
  std::unique_ptr<cut::SweptPath> swept_;
};

std::string measured_csv(const std::vector<inspection::InspectionPoint>& grid,
                         const std::function<double(const inspection::InspectionPoint&)>& deviation_mm) {
  const std::string nominal = inspection::inspection_csv(grid);
  std::istringstream in(nominal);
  std::string line, out = "zone,flank,row,column,x,y,z,i,j,k,deviation_um\n";
  std::getline(in, line);
  for (const auto& p : grid) {
    std::getline(in, line);
    out += line + fmt::format(",{:.4f}\n", deviation_mm(p) * 1000);
  }
  return out;
}

/// @param make  the gear of a job
template <typename Make>
void expect_gone_after_one_loop(const std::string& text, const Make& make) {
  const TestDir dir;
  write_file(dir / "job.toml", text);
  commands::RunRequest request;
  request.job_file = dir / "job.toml";
  request.out_dir = dir / "first";
  request.quiet = true;
  const auto first = commands::run_job(request);
  ASSERT_EQ(first.exit_code, app::ExitCode::ok) << to_text(first.errors);
  const job::Job job = job::read_job_file(dir / "job.toml").value();
  const auto gear = make(job).value();
  const tooth_space::ToothedSolid solid = drawn_solid(gear);
  const CutFlanks before(job, solid, file_text(dir / "first/program.ngc"));

  const auto grid_of_rows = [&](int rows, int columns) { return *inspection::inspection_grid(solid, {rows, columns}); };
  const auto grid = grid_of_rows(5, 9);
  const auto share = [](const inspection::InspectionPoint& p, int rows, int columns) {
    return process_error(p.side, double(p.row) / (rows - 1), double(p.column) / (columns - 1));
  };
  double worst = 0;
  const std::string csv = measured_csv(grid, [&](const inspection::InspectionPoint& p) {
    const double d = before.at(p) + share(p, 5, 9);
    worst = std::max(worst, std::abs(d));
    return d;
  });
  EXPECT_GT(worst, 0.012);
  write_file(dir / "measured.csv", csv);

  request.out_dir = dir / "second";
  request.measured.files = {dir / "measured.csv"};
  const auto second = commands::run_job(request);
  ASSERT_EQ(second.exit_code, app::ExitCode::ok) << to_text(second.errors);
  const auto report = nlohmann::json::parse(second.report_json);
  EXPECT_TRUE(report["verified"]);
  EXPECT_EQ(report["command"], "correct");
  for (const auto& flank : report["correction"]) EXPECT_LT(flank["residual_max_um"], 0.4);
  for (const char* name : {"program.ngc", "cl.csv", "report.html", "setup.html", "gear.stl", "tooth.vtp",
                           "inspection.csv", "limits.json", "correction.json"})
    EXPECT_GT(file_text(dir / "second" + std::string("/") + name).size(), 100u) << name;

  const std::string program = file_text(dir / "second/program.ngc");
  const CutFlanks after(job, solid, program);
  for (const auto& [rows, columns] : {std::pair{5, 9}, std::pair{13, 25}}) {
    double left = 0;
    for (const auto& p : grid_of_rows(rows, columns))
      left = std::max(left, std::abs(after.at(p) + share(p, rows, columns)));
    std::printf("  %2d x %2d points: %.3f um before, %.3f um after one correction\n", rows, columns, worst * 1000,
                left * 1000);
    EXPECT_LT(left, 0.0005);
  }

  // The same program against the nominal flanks is a gouge; against the measured ones it is proven.
  EXPECT_EQ(run_program({"check", dir / "job.toml", dir / "second/program.ngc", "--out", dir / "nominal"}).exit_code,
            1);
  EXPECT_EQ(run_program({"check", dir / "job.toml", dir / "second/program.ngc", "--measured", dir / "measured.csv",
                         "--out", dir / "again"})
                .exit_code,
            0);
}

TEST(Correction, TwentyMicrometresAreGoneAfterOneLoop) {
  expect_gone_after_one_loop(quick_job(), process::make_face_gear);
}
TEST(Correction, TwentyMicrometresOfACylindricalGearAreGoneAfterOneLoop) {
  expect_gone_after_one_loop(quick_cylindrical_job(), process::make_cylindrical_gear);
}

TEST(Correction, WrongFilesAreRefusedAtTheirPlaceAndNothingIsWritten) {
  const TestDir dir;
  write_file(dir / "job.toml", quick_job());
  const CorrectionCase c = read_case(dir / "job.toml");
  const auto grid = grid_of(*c.gear, 5, 9);
  const std::string good = measured_csv(
      grid, [](const inspection::InspectionPoint& p) { return process_error(p.side, p.row / 4.0, p.column / 8.0); });
  ASSERT_TRUE(job::parse_measured(good, "m.csv", *c.gear));
  const auto lines = [&] {
    std::vector<std::string> out;
    std::istringstream in(good);
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
  }();
  const auto joined = [](const std::vector<std::string>& list) {
    std::string out;
    for (const auto& l : list) out += l + "\n";
    return out;
  };
  const auto scaled = [&](double place, double deviation) {
    std::vector<inspection::InspectionPoint> other = grid;
    for (auto& p : other) p.p *= place;
    return measured_csv(other, [&](const inspection::InspectionPoint& p) {
      return deviation * process_error(p.side, p.row / 4.0, p.column / 8.0);
    });
  };
  const auto edited = [&](const std::function<void(std::vector<std::string>&)>& edit) {
    auto copy = lines;
    edit(copy);
    return joined(copy);
  };
  struct Wrong {
    std::string text, message;
  };
  const std::vector<Wrong> cases = {
      {"", "m.csv:1:1: error: no measured point; one line for each point of inspection.csv is needed"},
      {inspection::inspection_csv(grid),
       "m.csv:1:1: error: the header is \"zone,flank,row,column,x,y,z,i,j,k\", must be "
       "\"zone,flank,row,column,x,y,z,i,j,k,deviation_um\""},
      {scaled(1 / 25.4, 1),
       "m.csv:2:9: error: x, y, z are those of the inspection grid, but 25.4 times too small: in inch; mm are needed"},
      {scaled(25.4, 1),
       "m.csv:2:9: error: x, y, z are those of the inspection grid, but 25.4 times too large: an inch file was "
       "multiplied twice; mm are needed"},
      {scaled(1e-3, 1),
       "m.csv:2:9: error: x, y, z are those of the inspection grid, but 1000 times too small: in m; mm are needed"},
      {scaled(1000, 1),
       "m.csv:2:9: error: x, y, z are those of the inspection grid, but 1000 times too large: in um; mm are needed"},
      {scaled(1, 1e-3), "deviation_um reaches 0.0"},
      {scaled(1, 1000),
       "exceeds 500 um: is it in nm (1000 times) or in millionths of an inch (39.37 times)? More than 500 um is no "
       "correction"},
      {edited([](auto& l) { l.erase(l.begin() + 7); }),
       "m.csv:90:1: error: wrong grid: zone 0, flank 1, row 0, column 6 is missing of 5 rows x 9 columns"},
      {edited([](auto& l) {
         std::erase_if(l, [](const std::string& s) { return s.rfind("0,1,4,", 0) == 0 || s.rfind("0,-1,4,", 0) == 0; });
       }),
       "error: wrong grid: inspection rows = 4 is outside 5 .. 1000"},
      {edited([](auto& l) { l.push_back(l[3]); }),
       "m.csv:92:1: error: zone 0, flank 1, row 0, column 2 stands in line 4 already"},
      {edited([](auto& l) { l[5] += ",1"; }),
       "m.csv:6:1: error: 12 columns, must be 11: zone,flank,row,column,x,y,z,i,j,k,deviation_um"},
      {edited([](auto& l) { l[5].replace(l[5].rfind(','), 9, ",nan"); }), "\"nan\" is no finite number"},
      {edited([](auto& l) { l[5].replace(0, 3, "0,2"); }), "m.csv:6:3: error: flank = 2 must be 1 or -1"},
      {edited([](auto& l) { l[5].replace(0, 1, "1"); }), "error: zone = 1, the gear has zones 0 .. 0"},
      {edited([](auto& l) {
         std::swap(l[5], l[6]);
         l[5].replace(0, 7, "0,1,0,4");
         l[6].replace(0, 7, "0,1,0,5");
       }),
       "m.csv:6:9: error: zone 0, flank 1, row 0, column 4 lies"},
  };
  // What a spreadsheet saves is the same grid.
  const auto saved = [&](const std::string& separator, bool quotes, bool commas) {
    std::string out = quotes ? "\"" : "";
    for (const char letter : good) {
      if (letter == ',') out += quotes ? "\"" + separator + "\"" : separator;
      else if (letter == '\n') out += quotes ? "\"\n\"" : "\n";
      else out += letter == '.' && commas ? ',' : letter;
    }
    return quotes ? out.substr(0, out.size() - 1) : out;
  };
  const auto plain = job::parse_measured(good, "m.csv", *c.gear);
  for (const std::string& text :
       {saved(",", true, false), saved(",", true, true), saved(";", false, false), saved(";", false, true),
        saved(";", true, true), saved("\t", false, true), saved("  ", false, false), saved(" ", false, true),
        "sep=;\n" + saved(";", false, true), saved(";", false, true) + ";;;;;;;;;;\n",
        replaced_all(saved(";", false, true), "\n", ";;\n")}) {
    ASSERT_TRUE(job::looks_like_grid(text)) << text.substr(0, 80);
    const auto read = job::parse_measured(text, "m.csv", *c.gear);
    ASSERT_TRUE(read) << text.substr(0, 80) << read.error().text();
    EXPECT_EQ(read->deviation_mm, plain->deviation_mm);
  }
  for (const auto& wrong : cases) {
    const auto read = job::parse_measured(wrong.text, "m.csv", *c.gear);
    ASSERT_FALSE(read) << wrong.message;
    EXPECT_NE(read.error().text().find(wrong.message), std::string::npos) << read.error().text();
  }
  // From the command: exit code 3, the message, no file.
  write_file(dir / "inch.csv", cases[2].text);
  const auto refused = run_program({"correct", dir / "job.toml", "--measured", dir / "inch.csv", "--out", dir / "out"});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_EQ(refused.err, (dir / "inch.csv") + cases[2].message.substr(5) + "\n");
  EXPECT_TRUE(names_in(dir / "out").empty());
  const auto absent = run_program({"correct", dir / "job.toml", "--measured", dir / "none.csv", "--out", dir / "out"});
  EXPECT_EQ(absent.exit_code, 4);
  EXPECT_EQ(run_program({"correct", dir / "job.toml", "--out", dir / "out"}).exit_code, 2);
}

TEST(Correction, ARefusalOfMeasuredFlanksNamesTheMeasurement) {
  const TestDir dir;
  write_file(dir / "job.toml", R"(schema = 1
name = "near the undercut"
verify = {gouge_tolerance = 0.003}
[gear]
type = "face_gear"
teeth = 40
module = 1.5
module_plane = "transverse"
pressure_angle = 20.0
shaper_teeth = 20
shaper_tip_radius = 0.45
zone = [{helix_angle = 0.0, inner_radius = 29.5, outer_radius = 32.5}]
[machine]
file = "xyzac_large"
[setup]
origin = [12.0, -7.0, -40.0]
axis = "up"
work_offset = "G54"
work_offset_at = [12.0, -7.0, -40.0]
[[tool]]
number = 1
type = "ball_end_mill"
diameter = 0.8
flute_length = 4.5
shank_diameter = 0.75
length = 70.0
holder = [[10.0, 10.0, 40.0]]
stick_out = 14.0
[[operation]]
type = "finishing"
tool = 1
speed = 20000
feed = 400.0
scallop = 0.02
chord_tolerance = 0.002
)");
  const CorrectionCase c = read_case(dir / "job.toml");
  write_file(dir / "bent.csv", measured_csv(grid_of(*c.gear, 5, 9), [](const inspection::InspectionPoint& p) {
               return 0.1 * std::pow(p.row / 2.0 - 1, 2);  // 100 um of crowning along the profile
             }));
  const auto run = run_program({"correct", dir / "job.toml", "--measured", dir / "bent.csv", "--out", dir / "out"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(
      run.err.find("bent.csv: the flanks compensated for it cannot be cut, the nominal ones can: it deviates by up to "
                   "100.00 um"),
      std::string::npos)
      << run.err;
}

/// What a measuring machine hands out of `teeth` teeth: the grid with the process error, every tooth off its place.
std::vector<SeenPoint> measured_teeth(const face_gear::FaceGear& gear,
                                      const std::vector<inspection::InspectionPoint>& grid, int teeth, double ball) {
  PlantedErrors errors;
  Random random(29);
  for (int k = 0; k < teeth; ++k) errors.index.push_back(random(-0.01, 0.01));
  double mean = 0;
  for (const double off : errors.index) mean += off / teeth;
  for (double& off : errors.index) off -= mean;
  errors.shape = [](const auto& p) { return 0.2 * process_error(p.side, p.row / 4.0, p.column / 8.0); };
  return seen(grid, teeth_of(teeth), gear.pitch(), gear.rings()[0].surface.M2, errors, ball);
}

std::string dmis_of(const std::vector<SeenPoint>& points) {
  std::string text = "DMISMN/'results',05.2\nUNITS/MM,ANGDEC\n";
  for (std::size_t k = 0; k < points.size(); ++k)
    text += fmt::format("FA(P{})=FEAT/POINT,CART,{:.6f},{:.6f},{:.6f},$\n{:.8f},{:.8f},{:.8f}\n", k, points[k].p.x(),
                        points[k].p.y(), points[k].p.z(), points[k].n.x(), points[k].n.y(), points[k].n.z());
  return text + "ENDFIL\n";
}

std::string plain_of(const std::vector<SeenPoint>& points, bool normals) {
  std::string text = "# measured\n";
  for (const auto& s : points) {
    text += fmt::format("{:.6f} {:.6f} {:.6f}", s.p.x(), s.p.y(), s.p.z());
    if (normals) text += fmt::format(" {:.8f} {:.8f} {:.8f}", s.n.x(), s.n.y(), s.n.z());
    text += "\n";
  }
  return text;
}

TEST(Correction, PointsOfManyTeethGiveTheSameTargetAsTheGrid) {
  const TestDir dir;
  write_file(dir / "job.toml", quick_job());
  const CorrectionCase c = read_case(dir / "job.toml");
  const auto grid = grid_of(*c.gear, 5, 9);
  write_file(dir / "grid.csv", measured_csv(grid, [](const inspection::InspectionPoint& p) {
               return 0.2 * process_error(p.side, p.row / 4.0, p.column / 8.0);
             }));
  write_file(dir / "surface.dmo", dmis_of(measured_teeth(*c.gear, grid, 60, 0)));
  write_file(dir / "surface.txt", plain_of(measured_teeth(*c.gear, grid, 60, 0), false));
  write_file(dir / "centres.txt", plain_of(measured_teeth(*c.gear, grid, 60, 0.5), true));
  const auto of_grid = job::correct_gear(*c.gear, {{dir / "grid.csv"}, {}});
  ASSERT_TRUE(of_grid) << of_grid.error().text();
  struct File {
    std::string name;
    std::optional<double> ball;
  };
  for (const File& file : {File{"surface.dmo", {}}, File{"surface.txt", {}}, File{"centres.txt", 1.0}}) {
    const auto of_points = job::correct_gear(*c.gear, {{dir / file.name}, file.ball});
    ASSERT_TRUE(of_points) << of_points.error().text();
    double worst = 0;
    for (const auto& p : grid)
      worst = std::max(worst, std::abs(of_points->fit.rings[0]->side(p.side).at(p.theta, radius(p.p)).value -
                                       of_grid->fit.rings[0]->side(p.side).at(p.theta, radius(p.p)).value));
    std::printf("  %s: the target is that of the grid within %.4f um; F_p %.3f um\n", file.name.c_str(), worst * 1000,
                of_points->fit.index.pitch.at(0).total_mm * 1000);
    EXPECT_LT(worst, 2e-5);
    ASSERT_EQ(of_points->fit.index.pitch.size(), 2u);
    EXPECT_TRUE(of_points->fit.index.pitch[0].complete);
    EXPECT_GT(of_points->fit.index.pitch[0].total_mm, 0.015);
  }
  // Two files one after the other add up, grids and points alike.
  const auto both = job::correct_gear(*c.gear, {{dir / "grid.csv", dir / "surface.dmo"}, {}});
  ASSERT_TRUE(both);
  double worst = 0;
  for (const auto& p : grid)
    worst = std::max(worst, std::abs(both->fit.rings[0]->side(p.side).at(p.theta, radius(p.p)).value -
                                     2 * of_grid->fit.rings[0]->side(p.side).at(p.theta, radius(p.p)).value));
  EXPECT_LT(worst, 2e-5);
  EXPECT_EQ(both->fit.flanks.size(), 4u);
  // Centres taken for the surface, and the other way round.
  const auto centres = job::correct_gear(*c.gear, {{dir / "centres.txt"}, {}});
  ASSERT_FALSE(centres);
  EXPECT_NE(centres.error().text().find("are they the centres of a ball of that radius?"), std::string::npos)
      << centres.error().text();
  EXPECT_FALSE(job::correct_gear(*c.gear, {{dir / "surface.txt"}, 1.2}));
  const auto ball = job::correct_gear(*c.gear, {{dir / "grid.csv"}, 1.0});
  ASSERT_FALSE(ball);
  EXPECT_NE(ball.error().text().find("an inspection grid holds deviations"), std::string::npos);
}

TEST(Correction, ARunAnswersPointsAndTellsPitchAndRunOut) {
  const TestDir dir;
  write_file(dir / "job.toml", file_text(kSamples + "/spur_quick.toml"));
  const CorrectionCase c = read_case(dir / "job.toml");
  const auto grid = grid_of(*c.gear, 5, 9);
  write_file(dir / "r.dmo", dmis_of(measured_teeth(*c.gear, grid, 60, 0)));
  const auto run =
      run_program({"correct", dir / "job.toml", "--measured", dir / "r.dmo", "--json", "--out", dir / "out"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto report = nlohmann::json::parse(run.out)["report"];
  ASSERT_EQ(report["pitch"].size(), 2u);
  EXPECT_EQ(report["pitch"][0]["teeth"], 60);
  EXPECT_EQ(report["run_out"].size(), 1u);
  EXPECT_EQ(report["correction"][0]["teeth"], 60);
  EXPECT_EQ(report["correction"][0]["file"], dir / "r.dmo");
  const auto refused = run_program(
      {"correct", dir / "job.toml", "--measured", dir / "r.dmo", "--ball-diameter", "0", "--out", dir / "out"});
  EXPECT_EQ(refused.exit_code, 2);
}

/// A cylindrical gear, a point at every place of the inspection grid of all of its teeth: a bow on every flank, and
/// teeth that stand off by what an eccentric fixture leaves.
TEST(Correction, PointsOfACylindricalGearTellItsShapeItsPitchAndItsRunOut) {
  const TestDir dir;
  const job::Job job = job::read_job_file(kSamples + "/cylindrical_spur.toml").value();
  const auto gear = cylindrical::CylindricalGear::make(std::get<cylindrical::CylindricalParameters>(job.gear)).value();
  const auto grid = inspection::inspection_grid(drawn_solid(gear)).value();
  std::string text = "x y z i j k\n";
  for (int tooth = 0; tooth < gear.parameters().teeth; ++tooth)
    for (const auto& p : grid) {
      const double turn = tooth * drawn_solid(gear).pitch(), across = (p.column - 4) / 4.0,
                   off = 0.006 * across * across + 0.003 * std::sin(turn);
      const Vec3 x = turned(Vec3(p.p + off * p.n), turn), n = turned(p.n, turn);
      text += fmt::format("{:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", x.x(), x.y(), x.z(), n.x(), n.y(), n.z());
    }
  write_file(dir / "points.txt", text);
  app::Progress progress(true);
  app::StageClock clock(progress);
  const auto made = flow::make_gear(job, {{dir / "points.txt"}}, clock);
  ASSERT_TRUE(made) << to_text(made.error());
  const process::Correction& correction = made.value().correction.value();
  ASSERT_EQ(correction.rows.size(), 2U);
  for (const auto& row : correction.rows) {
    EXPECT_EQ(row.teeth, 24);
    EXPECT_LT(row.fit.residual_max_mm, 5e-5);
  }
  ASSERT_EQ(correction.index.pitch.size(), 2U);
  for (const auto& pitch : correction.index.pitch) {
    EXPECT_TRUE(pitch.complete);
    EXPECT_NEAR(pitch.total_mm, 0.006 * std::hypot(1, std::tan(radians(20))), 3e-4);  // along the arc
  }
  ASSERT_EQ(correction.index.run_out.size(), 1U);
  EXPECT_GT(correction.index.run_out.front().run_out_mm, 0.006 / std::sin(radians(35)));
}

}  // namespace
}  // namespace toothpath::test
