// A gear from a file of points in any order: in the forms in which measuring machines and spreadsheets save it, with
// its unit, and as the points file of a job again.
#include "app/proposal/points_gear.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "app/job/flank_points.h"
#include "tests/app/proposed_job.h"
#include "tests/support/files.h"

namespace toothpath::test {
namespace {

const std::filesystem::path kTree = TOOTHPATH_SOURCE_DIR;
const std::string kGrid = kTree / "samples/flank_grid_spur.csv";

job::FlankPoints grid() { return job::parse_flank_points(file_text(kGrid), kGrid).value(); }

/// Lines `name x y z i j k` or without normals, shuffled.
std::string listed(const std::string& header, char separator, bool commas, bool names, bool normals, double unit = 1) {
  const job::FlankPoints points = grid();
  std::vector<std::string> lines;
  for (const auto* g : {&points.plus, &points.minus})
    for (std::size_t k = 0; k < g->place.size(); ++k) {
      std::string line = names ? fmt::format("P{}{}", lines.size(), separator) : "";
      const Vec3 p = g->place[k] / unit;
      line += fmt::format("{:.9f}{}{:.9f}{}{:.9f}", p.x(), separator, p.y(), separator, p.z());
      const Vec3& n = g->normal[k];
      if (normals)
        line += fmt::format("{}{:.9f}{}{:.9f}{}{:.9f}", separator, n.x(), separator, n.y(), separator, n.z());
      if (commas) std::replace(line.begin(), line.end(), '.', ',');
      lines.push_back(line);
    }
  std::mt19937 random(7);
  std::shuffle(lines.begin(), lines.end(), random);
  std::string text = header;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

std::string utf16(const std::string& text) {
  std::string out = "\xff\xfe";
  for (const char c : text) out += c, out += '\0';
  return out;
}

TEST(PointsGear, EveryFormOfAFileGivesTheSameGrid) {
  const TestDir dir;
  const job::FlankPoints wanted = grid();
  const std::string forms[] = {
      listed("Point;X [mm];Y [mm];Z [mm];NX;NY;NZ\n", ';', true, true, true),
      listed("", ' ', false, false, false),
      listed("# measured\nx,y,z,i,j,k\n", ',', false, false, true),
      listed("\"No\"\t\"X\"\t\"Y\"\t\"Z\"\n", '\t', true, true, false),
      utf16(listed("sep=;\nX_mm;Y_mm;Z_mm\n", ';', true, false, false)),
      listed("X [inch] Y [inch] Z [inch]\n", ' ', false, false, false, 25.4),
      file_text(kGrid),
  };
  for (const std::string& text : forms) {
    SCOPED_TRACE(text.substr(0, 40));
    write_file(dir / "p.txt", text);
    const auto read = proposal::read_points(dir / "p.txt", {});
    ASSERT_TRUE(read) << read.error().text();
    for (const int side : {1, -1}) {
      const auto& found = side > 0 ? read->points.plus : read->points.minus;
      const auto& grid = side > 0 ? wanted.plus : wanted.minus;
      ASSERT_EQ(found.rows, grid.rows);
      ASSERT_EQ(found.columns, grid.columns);
      for (std::size_t k = 0; k < grid.place.size(); ++k) EXPECT_LT((found.place[k] - grid.place[k]).norm(), 3e-8);
    }
    // As the points file of a job, to the last digit.
    const auto again =
        job::parse_flank_points(job::flank_points_text({read->points.plus, read->points.minus}), "flanks.csv");
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(again->plus.place, read->points.plus.place);
    EXPECT_EQ(again->minus.normal.size(), read->points.minus.normal.size());
  }
}

TEST(PointsGear, InchesAreAskedForNotGuessed) {
  const TestDir dir;
  const auto read = [&](const std::string& header, double unit, std::optional<double> said) {
    write_file(dir / "p.txt", listed(header, ' ', false, false, true, unit));
    return proposal::read_points(dir / "p.txt", said);
  };
  const auto plain = read("", 1, {}), small = read("", 25.4, {}), said = read("", 25.4, 25.4);
  ASSERT_TRUE(plain && small && said);
  EXPECT_FALSE(proposal::looks_like_inches(*plain, 24));
  EXPECT_FALSE(proposal::looks_like_inches(*said, 24));
  EXPECT_LT((said->points.plus.place[3] - plain->points.plus.place[3]).norm(), 3e-8);
  ASSERT_TRUE(proposal::looks_like_inches(*small, 24));
  EXPECT_NE(proposal::looks_like_inches(*small, 24)->find("states no unit: in mm the module of 24 teeth is 0.1299 mm"),
            std::string::npos)
      << *proposal::looks_like_inches(*small, 24);
  const auto contrary = read("x[mm] y[mm] z[mm] i j k\n", 1, 25.4);
  ASSERT_FALSE(contrary);
  EXPECT_EQ(contrary.error().kind, DiagnosticKind::usage);
  EXPECT_NE(contrary.error().message.find("--points-unit is 25.4 mm, but "), std::string::npos);
}

TEST(PointsGear, AMeridianIsTwoPlaces) {
  for (const char* text : {"[[30.5, -3], [30.5, 3]]", "30.5 -3 30.5 3", "30.5,-3 30.5,3"}) {
    const auto line = proposal::read_meridian("--root", text);
    ASSERT_TRUE(line) << text;
    EXPECT_EQ(line->back(), Vec2(30.5, 3)) << text;
  }
  for (const char* text : {"", "30.5 -3 30.5", "30.5 -3 30.5 3 1", "0 -3 30.5 3", "r z r z"}) {
    const auto line = proposal::read_meridian("--root", text);
    ASSERT_FALSE(line) << text;
    EXPECT_TRUE(line.error().message.starts_with("--root = \"")) << line.error().message;
  }
}

TEST(PointsGear, MislabelledFlanksAndMixedNormalsAreRefused) {
  const TestDir dir;
  std::string swapped = file_text(kGrid);
  for (std::size_t at = 0; (at = swapped.find("\n1,", at)) != std::string::npos; ++at) swapped.replace(at, 3, "\n2,");
  for (std::size_t at = 0; (at = swapped.find("\n-1,", at)) != std::string::npos; ++at) swapped.replace(at, 4, "\n1,");
  for (std::size_t at = 0; (at = swapped.find("\n2,", at)) != std::string::npos; ++at) swapped.replace(at, 3, "\n-1,");
  write_file(dir / "p.csv", swapped);
  const auto read = proposal::read_points(dir / "p.csv", {});
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().text().find("the two are swapped"), std::string::npos) << read.error().text();
  EXPECT_GT(read.error().position.line, 1);
  write_file(dir / "q.txt", "FA(A)=FEAT/GSURF\nPTDATA/CART,1,2,3,1,0,0\nPTDATA/CART,1,2,4\n");
  const auto mixed = proposal::read_points(dir / "q.txt", {});
  ASSERT_FALSE(mixed);
  EXPECT_NE(mixed.error().text().find("q.txt:3:"), std::string::npos) << mixed.error().text();
}

/// The whole way from points to a job, which its reader takes.
TEST(PointsGear, TheJobReadsWhatIsProposed) {
  const TestDir dir;
  write_file(dir / "p.txt", listed("", ' ', false, false, false));
  const auto read = proposal::read_points(dir / "p.txt", {});
  ASSERT_TRUE(read);
  const flank_grid::MeridianProposal meridians(read->points);
  const double fillet = proposal::proposed_fillet_mm(meridians, 24);
  flank_grid::FlankGridParameters p{
      24, "p.txt", read->points.plus, read->points.minus, fillet, meridians.root(fillet), meridians.tip()};
  const auto gear = flank_grid::FlankGridGear::make(p);
  ASSERT_TRUE(gear) << gear.refused()->front().diagnostic.message;
  proposal::Wishes wishes;
  wishes.gear = proposal::Gear::flank_grid;
  wishes.grid = std::make_shared<const flank_grid::FlankGridParameters>(p);
  wishes.points_file = "flanks.csv";
  write_file(dir / "flanks.csv", job::flank_points_text({p.plus, p.minus}));
  const ProposedJob proposed = proposed_job(wishes, dir / "job.toml");
  EXPECT_TRUE(proposed.draft.up);
  EXPECT_NEAR(*proposed.draft.wishes[proposal::Quantity::module], gear.value().module_mm(), 1e-12);
  const auto& taken = std::get<flank_grid::FlankGridParameters>(proposed.job.gear);
  EXPECT_EQ(taken.plus.place, p.plus.place);
  EXPECT_EQ(taken.fillet_radius_mm, fillet);
  EXPECT_LT((taken.tip.back() - p.tip.back()).norm(), 1e-6);
}

}  // namespace
}  // namespace toothpath::test
