// [[gear.modification]] and [[contact.modification]]: flank modifications, and the grids that they name.
#include <cmath>
#include <filesystem>
#include <map>

#include "app/job/tables.h"
#include "geometry/inspection/table_text.h"
#include "machines/toml/input_text.h"

namespace toothpath::job {
namespace {

using modification::Ends;
using modification::Flanks;
using modification::Kind;
using modification::Law;

constexpr toml::Range kAmount{-5, 5, " mm"}, kModifiedLength{0, 1000, " mm", true}, kTransition{0.01, 1000, " mm"};
constexpr std::size_t kMostDepths = 400;  // of all grids: every place of a flank costs all of them
constexpr std::size_t kMostModifications = 50, kMostGridBytes = 1u << 20, kMostGridLines = 100;
constexpr std::string_view kGridHeader = "along,depth,removal";

/// The lines of a grid in any order, every depth with every place along the face once.
Result<modification::Grid> parse_grid(const std::string& text, const std::string& path) {
  std::map<double, std::map<double, double>> rows;  // depth, along
  std::map<double, int> places;
  int number = 0;
  for (std::string_view rest = text; !rest.empty();) {
    const auto line = inspection::take_line(rest, number);
    number = line.number;
    if (number == 1) {
      if (!inspection::names_columns(line.text, kGridHeader))
        return fail_at({path, 1, 1}, "the first line must be \"{}\"", kGridHeader);
      continue;
    }
    if (inspection::number_cells(line.text).empty()) continue;
    const auto value = inspection::numbers_of<3>(line.text);
    if (!value) return fail_at({path, number, 1}, "three finite numbers in mm are needed: {}", kGridHeader);
    if (!rows[(*value)[1]].emplace((*value)[0], (*value)[2]).second)
      return fail_at({path, number, 1}, "along = {:g}, depth = {:g} stands there twice", (*value)[0], (*value)[1]);
    ++places[(*value)[0]];
    if (rows.size() > kMostGridLines || places.size() > kMostGridLines)
      return fail_at({path, number, 1}, "the grid has more than {} lines one way", kMostGridLines);
  }
  modification::Grid grid;
  for (const auto& [along, count] : places) grid.along_mm.push_back(along);
  for (const auto& [depth, row] : rows) {
    grid.depth_mm.push_back(depth);
    for (const double along : grid.along_mm) {
      const auto found = row.find(along);
      if (found == row.end())
        return fail_at({path, number, 1}, "along = {:g}, depth = {:g} is missing: every depth needs every place", along,
                       depth);
      grid.removal_mm.push_back(found->second);
    }
  }
  return grid;
}

void read_grid(toml::TableReader& table, const std::string& directory, modification::Modification& m) {
  m.amount_mm = 1;
  const auto name = table.text("file");
  if (!name) return;
  const auto path = (std::filesystem::path(directory) / *name).string();
  const auto text = toml::read_input_text(path, kMostGridBytes);
  if (!text) return table.refuse("file", "file = \"{}\": {}", *name, text.error().message);
  auto grid = parse_grid(*text, path);
  if (!grid) return table.refuse_at(grid.error().position, "{}", grid.error().message);
  m.grid = std::move(*grid);
}

void read_relief(toml::TableReader& table, modification::Modification& m) {
  m.length_mm = table.number("length", kModifiedLength).value_or(1);
  m.law = table.word_or("law", {"linear", "parabolic"}, "parabolic") == "linear" ? Law::linear : Law::parabolic;
  m.transition_mm = table.optional_number("transition", kTransition);
  if (m.transition_mm && m.law == Law::parabolic)
    table.refuse("transition",
                 "transition contradicts law = \"parabolic\": a parabola begins without a kink to be rounded");
  if (m.kind != Kind::end_relief) return;
  const auto end = table.word_or("end", {"both", "inner", "outer"}, "both");
  m.ends = end == "inner" ? Ends::inner : end == "outer" ? Ends::outer : Ends::both;
}

}  // namespace

std::vector<modification::Modification> read_modifications(toml::TableReader& owner, const std::string& directory) {
  std::vector<modification::Modification> out;
  auto tables = owner.tables("modification", {0, kMostModifications});
  if (tables.size() > kMostModifications)
    owner.refuse("modification", "{} modifications exceed the limit {}", tables.size(), kMostModifications);
  std::vector<std::string_view> words;
  for (int k = 0; k < modification::kKinds; ++k) words.emplace_back(to_string(Kind(k)));
  std::size_t depths = 0;
  for (auto& table : tables) {
    modification::Modification m;
    const auto word = table.variant("kind", words);
    if (!word) {
      table.name_misspelt("kind");
      continue;
    }
    while (to_string(m.kind) != *word) m.kind = Kind(int(m.kind) + 1);
    if (m.kind == Kind::grid && depths > kMostDepths) continue;
    if (m.kind == Kind::grid) read_grid(table, directory, m);
    else m.amount_mm = table.number("amount", kAmount).value_or(0);
    if (m.grid) depths += m.grid->depth_mm.size();
    if (depths > kMostDepths)
      table.refuse("file", "the grids have {} depths up to here, which exceeds {}: put several of them into one grid",
                   depths, kMostDepths);
    if (modification::is_relief(m.kind)) read_relief(table, m);
    const auto flank = table.word_or("flank", {"both", "left", "right"}, "both");
    m.flanks = flank == "left" ? Flanks::left : flank == "right" ? Flanks::right : Flanks::both;
    m.zone = table.optional_integer("zone", {0, 1});
    table.finish();
    out.push_back(std::move(m));
  }
  return out;
}

}  // namespace toothpath::job
