// shaper.json has every key of the output's description with values that agree with each other; the sheet says the
// same.
#include <nlohmann/json.hpp>

#include "postproc/shaper/sheet.h"
#include "tests/postproc/shaper/case.h"

namespace toothpath::test {
namespace {

using Json = nlohmann::json;

shaper::ShaperSetup setup_of(const shaper::ShaperWork& w) { return shaper_setup(w, shaper_machine()); }

TEST(ShaperSheet, JsonHasEveryKey) {
  const auto s = setup_of(shaper_work());
  const auto j = Json::parse(shaper::shaper_json(s, shaper::feed_study(s, {0.1})));
  const std::vector<std::pair<std::string, std::vector<std::string>>> keys = {
      {"machine",
       {"name", "file", "stroke_steps", "index_constant", "feed_constant", "gears", "mesh_margin", "relief"}},
      {"cutter", {"teeth", "pitch_diameter"}},
      {"work", {"teeth", "inner_radius", "outer_radius", "depth"}},
      {"offset", {"slide", "reference", "angle_tan", "angle_sin"}},
      {"stroke", {"face", "over_run", "length", "start", "end"}},
      {"speed", {"cutting_speed", "basis", "strokes_wanted", "strokes_set", "speed_mean", "speed_peak"}},
      {"generating", {"ratio", "sense", "cutter_per_stroke", "strokes_per_cutter_turn", "strokes_per_work_turn"}},
      {"infeed", {"depth", "per_stroke", "strokes"}},
      {"index_gears", {"constant", "target", "gears"}},
      {"feed_gears", {"constant", "target", "gears", "circular_feed"}},
      {"time", {"infeed", "generating", "total"}},
      {"program", {"strokes_infeed", "strokes_turn", "strokes_total", "relief"}}};
  for (const auto& [table, inner] : keys) {
    ASSERT_TRUE(j.contains(table)) << table;
    for (const auto& key : inner) EXPECT_TRUE(j[table].contains(key)) << table << "." << key;
  }
  EXPECT_EQ(j["schema"], 1);
  EXPECT_EQ(j["job"], "offset-shaped");
  EXPECT_EQ(j["assumed"], Json::array({"stroke"}));
  EXPECT_EQ(j["generating"]["ratio"], Json::array({25, 88}));
  EXPECT_EQ(j["index_gears"]["target"], Json::array({15, 22}));
  EXPECT_EQ(j["index_gears"]["constant"], Json::array({12, 5}));
  EXPECT_EQ(j["speed"]["strokes_set"], 359);
  EXPECT_NEAR(j["offset"]["angle_tan"].get<double>(), std::atan(15.0 / 147) * 180 / kPi, 1e-12);
  EXPECT_NEAR(j["generating"]["cutter_per_stroke"].get<double>(), 360 * 0.1 / (kPi * 75), 1e-12);
  EXPECT_NEAR(j["time"]["infeed"].get<double>(), 338 / 359.0, 1e-12);
  EXPECT_NEAR(j["time"]["generating"].get<double>(), 8294 / 359.0, 1e-12);
  EXPECT_NEAR(j["time"]["total"].get<double>(), 8632 / 359.0, 1e-12);
  EXPECT_NEAR(j["infeed"]["per_stroke"].get<double>() * j["infeed"]["strokes"].get<int>(), 6.75, 1e-12);
}

TEST(ShaperSheet, PageIsSelfContainedAndMarksWhatIsAssumed) {
  auto w = shaper_work();
  w.job_name = "<script>alert(1)</script> & \"co\"";
  const auto s = setup_of(w);
  const auto page = shaper::shaper_html(s, shaper::feed_study(s, shaper::compared_feeds(s)));
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;"), std::string::npos);
  EXPECT_NE(page.find("size:A4"), std::string::npos);
  // The stroke table of the machine is assumed, its index constant is not.
  EXPECT_NE(page.find("125, 179, 253, 359 <span class=a>assumed</span>"), std::string::npos);
  EXPECT_EQ(page.find("12/5 <span class=a>assumed</span>"), std::string::npos);
  for (const char* text : {"15.0000&nbsp;mm", "21.598&nbsp;mm", "148.733&nbsp;mm", "127.135&nbsp;mm", ">359<", "8294",
                           "24.04", "0.152789", "5.8263", "5.8567", "a&nbsp;=&nbsp;30 &nbsp;b&nbsp;=&nbsp;44"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
  auto machine = shaper_machine();
  machine.assumed_keys.clear();
  EXPECT_EQ(shaper::shaper_html(shaper_setup(w, machine), {}).find("assumed"), std::string::npos);
  // A single key marks its own value only.
  machine.assumed_keys = {"index.constant"};
  const auto one = shaper::shaper_html(shaper_setup(w, machine), {});
  EXPECT_NE(one.find("12/5 <span class=a>assumed</span>"), std::string::npos);
  EXPECT_EQ(one.find("253, 359 <span class=a>assumed</span>"), std::string::npos);
}

}  // namespace
}  // namespace toothpath::test
