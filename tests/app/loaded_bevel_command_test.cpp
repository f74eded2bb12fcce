// `contact` of bevel pairs with walls as cut or measured, friction and root stress, run as a user would.
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/app/contact_run.h"

namespace toothpath::test {
namespace {

const std::string kWheel = kSamples + "/bevel_wheel.toml";

/// The sample pinion with these keys of a load and of a gear.
std::string pinion_job(const TestDir& dir, const std::string& load, const std::string& modification = "") {
  return changed_sample(
      dir, "bevel_pinion.toml", "[machine]",
      modification + "[contact.load]\ntorque = 200\npositions = 1\nrow_teeth = 3\n" + load + "\n\n[machine]");
}
Json pair_of(const std::string& job, const std::string& out, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"contact", job, "--mate", kWheel, "--out", out};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto run = run_program(arguments);
  if (run.exit_code != 0) throw std::runtime_error(run.err);
  return Json::parse(file_text(out + "/contact.json"));
}
const Json& wall_of(const Json& report, const char* surface, const char* wall) {
  for (const Json& w : report.at("walls"))
    if (w.at("surface") == surface && w.at("wall") == wall) return w;
  throw std::invalid_argument("no such wall");
}
const Json& flank_of(const Json& report, const char* surface, int side) {
  for (const Json& f : report.at("loaded").at("flanks"))
    if (f.at("surface") == surface && f.at("side") == side) return f;
  throw std::invalid_argument("no such flank");
}

/// Cells of inspection.csv of a job, a line each.
std::vector<std::vector<std::string>> inspection_of(const TestDir& dir, const std::string& job) {
  const auto run = run_program({"surface", job, "--out", dir / "surface"});
  if (run.exit_code != 0) throw std::runtime_error(run.err);
  std::istringstream in(file_text(dir / "surface/inspection.csv"));
  std::vector<std::vector<std::string>> out;
  for (std::string line; std::getline(in, line);) {
    out.emplace_back();
    std::istringstream words(line);
    for (std::string cell; std::getline(words, cell, ',');) out.back().push_back(cell);
  }
  return out;
}
const std::string kCrowning = "[[gear.modification]]\nkind = \"lead_crowning\"\namount = 0.03\n\n";

/// The walls of the crowned pinion as a measuring machine finds them at the points of the plain one, once for all
/// tests.
const std::string& measured_crowning() {
  static const std::string text = [] {
    const TestDir plain, crowned;
    const auto asked = inspection_of(plain, pinion_job(plain, "")),
               there = inspection_of(crowned, pinion_job(crowned, "", kCrowning));
    if (asked.size() != there.size()) throw std::runtime_error("grids of two sizes");
    std::string out = "zone,flank,row,column,x,y,z,i,j,k,deviation_um\n";
    for (std::size_t n = 1; n < asked.size(); ++n) {
      double along = 0;
      for (std::size_t k = 4; k < 7; ++k)
        along += (std::stod(there[n].at(k)) - std::stod(asked[n].at(k))) * std::stod(asked[n].at(k + 3));
      for (const auto& cell : asked[n]) out += cell + ",";
      out += std::to_string(along * 1000) + "\n";
    }
    return out;
  }();
  return text;
}

/// A crowning that was measured is rolled and loaded like one that the drawing asks for.
TEST(LoadedBevelCommand, AMeasuredCrowningRollsLikeTheDrawnOne) {
  const TestDir dir, other;
  const std::string plain = pinion_job(dir, "");
  const std::string crowned = pinion_job(other, "", kCrowning);
  write_file(dir / "measured.csv", measured_crowning());
  const Json measured = pair_of(plain, dir / "a", {"--measured", dir / "measured.csv"});
  EXPECT_EQ(measured.at("cut_surface"), "measured");
  const Json drawn = pair_of(crowned, other / "b");
  for (const int side : {1, -1}) {
    const char* name = side > 0 ? "L" : "U";
    const Json &m = wall_of(measured, "cut", name), &d = wall_of(drawn, "exact", name),
               &e = wall_of(measured, "exact", name);
    const auto error = [](const Json& w) { return w.at("transmission_error_um").get<double>(); };
    EXPECT_NEAR(error(m), error(d), 0.05 * error(d)) << name;
    EXPECT_GT(std::abs(error(e) - error(d)), 0.1 * error(d)) << "the crowning is seen: " << name;
    const Json &lm = flank_of(measured, "cut", side), &ld = flank_of(drawn, "exact", side),
               &le = flank_of(measured, "exact", side);
    EXPECT_EQ(lm.at("name"), std::string("wall ") + name + ", measured");
    const auto approach = [](const Json& f) { return f.at("approach_um").at("mean").get<double>(); };
    EXPECT_NEAR(approach(lm), approach(ld), 0.03 * approach(ld)) << name;
    EXPECT_GT(std::abs(approach(le) - approach(ld)), 0.05 * approach(ld)) << name;
  }
  EXPECT_NE(file_text(dir / "a/contact.html").find("L, measured"), std::string::npos);
  EXPECT_NE(file_text(dir / "a/loaded.csv").find("\ncut,-1,0,"), std::string::npos);
  EXPECT_NE(file_text(dir / "a/contact.csv").find(",cut\n"), std::string::npos);
}

/// The walls that the job's mill cuts lie within what is proven to be left on them, so the pair does, too.
TEST(LoadedBevelCommand, ThePairAsCutIsTheDrawnOneWithinWhatIsLeft) {
  const TestDir dir;
  const Json report = pair_of(pinion_job(dir, ""), dir / "a", {"--as-cut"});
  EXPECT_EQ(report.at("cut_surface"), "milled");
  for (const int side : {1, -1}) {
    const char* name = side > 0 ? "L" : "U";
    const Json &cut = wall_of(report, "cut", name), &exact = wall_of(report, "exact", name);
    constexpr double kLeft = 2;  // um: gouge and material left of this job are proven within it
    EXPECT_NEAR(cut.at("transmission_error_um").get<double>(), exact.at("transmission_error_um").get<double>(),
                2 * kLeft);
    EXPECT_NE(cut.at("transmission_error_um"), exact.at("transmission_error_um"));
    const Json &lc = flank_of(report, "cut", side), &le = flank_of(report, "exact", side);
    EXPECT_EQ(lc.at("name"), std::string("wall ") + name + ", as cut");
    EXPECT_NEAR(lc.at("approach_um").at("mean").get<double>(), le.at("approach_um").at("mean").get<double>(),
                2 * kLeft);
    EXPECT_NE(lc.at("approach_um"), le.at("approach_um"));
  }
}

TEST(LoadedBevelCommand, FrictionAndRootStressOnRequest) {
  const TestDir dir;
  const std::string out = dir / "a";
  const auto run =
      run_program({"contact", pinion_job(dir, "friction = 0.1\nroot_stress = true"), "--mate", kWheel, "--out", out});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* words :
       {"friction 0.1 could add +-", "root stress of the wheel", "root stress of the pinion", "cone distance"})
    EXPECT_NE(run.out.find(words), std::string::npos) << run.out;
  const Json report = Json::parse(file_text(out + "/contact.json"));
  for (const Json& flank : report.at("loaded").at("flanks")) {
    const Json& friction = flank.at("friction");
    EXPECT_EQ(friction.at("coefficient"), 0.1);
    EXPECT_GE(friction.at("axial_bound_N").get<double>(), friction.at("axial_N").get<double>());
    EXPECT_LE(friction.at("axial_bound_N").get<double>(), 0.11 * flank.at("normal_N").get<double>());
    for (const char* body : {"gear", "pinion"}) {
      const Json& root = flank.at("root_stress").at(body);
      EXPECT_GT(root.at("stress_MPa").get<double>(), 20) << body;
      EXPECT_LT(root.at("error_MPa").get<double>(), 0.1 * root.at("stress_MPa").get<double>()) << body;
      EXPECT_LT(root.at("height_mm").get<double>(), -4) << body;
      EXPECT_GT(root.at("cone_distance_mm").get<double>(), 80) << body;
    }
  }
  EXPECT_NE(file_text(out + "/loaded.csv").find("friction_axial_N,friction_torque_percent"), std::string::npos);
  EXPECT_NE(file_text(out + "/root_stress.csv").find("exact,1,pinion,"), std::string::npos);
  for (const char* words : {"What friction of 0.1 could add", "Stress at the root", "corner arcs of the mills"})
    EXPECT_NE(file_text(out + "/contact.html").find(words), std::string::npos) << words;
}

/// Measured files that are none of this gear are refused where they are wrong.
TEST(LoadedBevelCommand, RefusesMeasuredFilesThatDoNotFit) {
  const TestDir dir;
  const std::string plain = pinion_job(dir, ""), good = measured_crowning();
  const auto refused = [&](const std::string& text, const std::string& words, std::vector<std::string> more = {}) {
    write_file(dir / "bad.csv", text);
    std::vector<std::string> arguments = {"contact",    plain,           "--mate", kWheel,
                                          "--measured", dir / "bad.csv", "--out",  dir / "b"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto run = run_program(arguments);
    EXPECT_EQ(run.exit_code, 3) << words;
    EXPECT_NE(run.err.find("bad.csv:"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  };
  refused("1 2 3\n4 5 6\n", "files of points are not put on this gear");
  refused(good.substr(0, good.rfind('\n', good.size() / 2) + 1), "is missing of");
  refused("zone,flank,row,column,x,y,z,i,j,k,deviation_um\n0,L,0,0,1,2,3,0,0,1,5\n", "at least 5 x 9 are needed");
  refused(good, "a ball's diameter is for files of points", {"--ball-diameter", "3"});
  std::string moved = good;
  const auto line = moved.find("0,L,0,0,");
  moved.insert(line + 8, "1");
  refused(moved, "mm off the nominal point");
}

}  // namespace
}  // namespace toothpath::test
