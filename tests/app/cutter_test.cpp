// `cutter`, `forces` and `study trace-model`, run as a user would; the DXF read by a reader of its own.
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/app/program.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;

struct Entity {
  std::string type;
  std::multimap<int, std::string> groups;
  [[nodiscard]] double number(int code) const { return std::stod(groups.find(code)->second); }
};

/// Entities of an R12 file: pairs of lines, code and value.
std::vector<Entity> entities(const std::string& text) {
  std::istringstream in(text);
  std::string code, value;
  std::vector<Entity> list;
  bool inside = false;
  while (std::getline(in, code) && std::getline(in, value)) {
    const int group = std::stoi(code);
    if (group == 2 && value == "ENTITIES") inside = true;
    else if (inside && group == 0 && value == "ENDSEC") inside = false;
    else if (inside && group == 0) list.push_back({value, {}});
    else if (inside && !list.empty()) list.back().groups.emplace(group, value);
  }
  EXPECT_EQ(value, "EOF");
  return list;
}

using Point = std::pair<long, long>;  // nm: joints must agree to that
Point rounded(double x, double y) { return {std::lround(x * 1e6), std::lround(y * 1e6)}; }

TEST(CutterCommand, DesignsDrawsAndJudges) {
  const TestDir dir;
  const std::string out = dir / "out";
  const auto done = run_program({"cutter", kSamples + "/bevel_pinion.toml", "--out", out, "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(names_in(out),
            (std::vector<std::string>{"cutter.csv", "cutter.dxf", "cutter.html", "cutter.json", "cutter.svg"}));
  const Json report = Json::parse(done.out).at("report");
  EXPECT_EQ(report, Json::parse(file_text(out + "/cutter.json")));
  const Json& designed = report.at("mills").at(0);
  EXPECT_TRUE(designed.at("usable").get<bool>());
  EXPECT_TRUE(report.at("mills").at(1).at("usable").get<bool>());  // the job's own mill
  EXPECT_GT(designed.at("conditions").size(), 14u);
  for (const auto& c : designed.at("conditions")) {
    const double value = c.at("value"), limit = c.at("limit");
    EXPECT_EQ(c.at("verdict") == "met", c.at("relation") == ">=" ? value >= limit : value <= limit) << c;
  }

  // The contour closes: every end of every piece is the end of exactly one other.
  std::map<Point, int> ends;
  std::vector<std::pair<double, double>> polyline;
  double radius = 0;
  int arcs = 0, polylines = 0;
  const auto end = [&](double x, double y) { ++ends[rounded(x, y)]; };
  for (const auto& e : entities(file_text(out + "/cutter.dxf"))) {
    if (e.type != "SEQEND" && e.groups.find(8)->second != "CONTOUR") continue;
    if (e.type == "LINE") end(e.number(10), e.number(20)), end(e.number(11), e.number(21));
    if (e.type == "ARC") {
      ++arcs;
      radius = e.number(40);
      for (const int code : {50, 51}) {
        const double a = e.number(code) * std::acos(-1.0) / 180;
        end(e.number(10) + radius * std::cos(a), e.number(20) + radius * std::sin(a));
      }
    }
    if (e.type == "VERTEX") polyline.emplace_back(e.number(10), e.number(20));
    if (e.type == "SEQEND") {
      ++polylines;
      end(polyline.front().first, polyline.front().second), end(polyline.back().first, polyline.back().second);
      if (polylines == 1) {
        EXPECT_NEAR(polyline.back().second, designed.at("D").at(1).get<double>(), 1e-8);
        EXPECT_NEAR(polyline.front().first, designed.at("C").at(0).get<double>() + 5.1, 1e-8);
        EXPECT_EQ(polyline.size(), report.at("dxf").at("involute_vertices").get<std::size_t>());
      }
      polyline.clear();
    }
  }
  EXPECT_EQ(arcs, 2);
  EXPECT_EQ(polylines, 2);
  EXPECT_NEAR(radius, designed.at("tip_radius").get<double>(), 1e-9);
  // Points that differ by one nm through rounding count as one.
  for (const auto& [point, count] : ends) {
    int joined = 0;
    for (long a = -1; a <= 1; ++a)
      for (long b = -1; b <= 1; ++b)
        if (const auto found = ends.find({point.first + a, point.second + b}); found != ends.end())
          joined += found->second;
    EXPECT_EQ(joined, 2) << point.first << ' ' << point.second;
  }
  EXPECT_LE(report.at("dxf").at("chord_error_um").get<double>(), 0.2);

  // The drawing is to scale: the view box in mm over the size in mm is one.
  const std::string svg = file_text(out + "/cutter.svg");
  EXPECT_NE(svg.find("scale 10:1"), std::string::npos);
  EXPECT_EQ(svg.substr(svg.find("width=\"") + 7, 6), svg.substr(svg.find("viewBox=\"0 0 ") + 13, 6));
}

TEST(CutterCommand, AWideMillIsJudgedNotRefused) {
  const TestDir dir;
  std::string job = file_text(kSamples + "/bevel_pinion.toml");
  job.replace(job.find("module = 3.0 "), 12, "module = 3.2");
  write_file(dir / "job.toml", job);
  const auto done = run_program({"cutter", dir / "job.toml", "--out", dir / "out", "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  const Json tool = Json::parse(done.out).at("report").at("mills").at(1);
  EXPECT_FALSE(tool.at("usable").get<bool>());
  EXPECT_NEAR(tool.at("small_end_overcut_um").get<double>(), 157, 2);
  EXPECT_NE(file_text(dir / "out/cutter.html").find("not usable"), std::string::npos);
}

TEST(CutterCommand, RefusesWhatHasNoMill) {
  const TestDir dir;
  const auto face = run_program({"cutter", kSamples + "/spur_quick.toml", "--out", dir / "out"});
  EXPECT_EQ(face.exit_code, 3);
  EXPECT_NE(face.err.find("spur_quick.toml:"), std::string::npos);
  const auto tool = run_program({"cutter", kSamples + "/bevel_pinion.toml", "--tool", "7", "--out", dir / "out"});
  EXPECT_EQ(tool.exit_code, 3);
  EXPECT_TRUE(names_in(dir / "out").empty());
  const auto torque = run_program({"forces", kSamples + "/bevel_pinion.toml", "--out", dir / "out"});
  EXPECT_EQ(torque.exit_code, 3);
  EXPECT_NE(torque.err.find("no torque"), std::string::npos);
}

TEST(ForcesCommand, BothMembersBothSenses) {
  const TestDir dir;
  std::string job = file_text(kSamples + "/bevel_pinion.toml");
  write_file(dir / "job.toml", job + "\n[load]\ntorque = 500.0\n");
  const auto from_job = run_program({"forces", dir / "job.toml", "--out", dir / "out", "--json"});
  ASSERT_EQ(from_job.exit_code, 0) << from_job.err;
  EXPECT_EQ(names_in(dir / "out"), (std::vector<std::string>{"forces.csv", "forces.html", "forces.json"}));
  const auto doubled = run_program({"forces", dir / "job.toml", "--torque", "1000", "--out", dir / "out2", "--json"});
  const Json a = Json::parse(from_job.out).at("report"), b = Json::parse(doubled.out).at("report");
  ASSERT_EQ(a.at("cases").size(), b.at("cases").size());
  EXPECT_EQ(b.at("torque_gear_Nm").get<double>(), 1000);
  EXPECT_NEAR(a.at("balanced_without_groove").get<double>(), 103.312, 6e-4);
  std::map<std::string, std::map<std::string, const Json*>> pairs;
  for (std::size_t i = 0; i < a.at("cases").size(); ++i) {
    const Json &one = a.at("cases")[i], &two = b.at("cases")[i];
    EXPECT_NEAR(two.at("F_a_N").get<double>(), 2 * one.at("F_a_N").get<double>(),
                1e-6);  // linear in the torque, the option wins
    const std::string key = one.at("arrangement").get<std::string>() + one.at("load_sharing").get<std::string>() +
                            one.at("part").get<std::string>() + one.at("loaded_wall").get<std::string>();
    pairs[key][one.at("member").get<std::string>()] = &one;
  }
  // Shaft angle 90 deg: the axial force of one is the radial force of the other.
  for (const auto& [key, members] : pairs) {
    ASSERT_EQ(members.size(), 2u) << key;
    EXPECT_NEAR(members.at("gear")->at("F_a_N").get<double>(), members.at("mate")->at("F_r_N").get<double>(), 1e-6)
        << key;
    EXPECT_NEAR(members.at("gear")->at("F_r_N").get<double>(), members.at("mate")->at("F_a_N").get<double>(), 1e-6)
        << key;
  }
}

TEST(TraceModelStudy, NumbersOfTheSample) {
  const TestDir dir;
  const auto done =
      run_program({"study", "trace-model", kSamples + "/bevel_wheel.toml", "--quick", "--out", dir / "out", "--json"});
  ASSERT_EQ(done.exit_code, 0) << done.err;
  EXPECT_EQ(names_in(dir / "out"),
            (std::vector<std::string>{"trace_model.csv", "trace_model.html", "trace_model.json"}));
  const Json report = Json::parse(done.out).at("report");
  ASSERT_EQ(report.at("walls").size(), 8u);  // two halves, two walls, two models
  double least = 0;
  for (const auto& w : report.at("walls"))
    if (w.at("model") == "S1") least = std::min(least, w.at("least_um").get<double>());
  EXPECT_LT(least, -0.4);
  EXPECT_GT(least, -0.6);
}

}  // namespace
}  // namespace toothpath::test
