#include "app/studies/errors/summary.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "app/report/page/study_page.h"
#include "app/report/svg/plot.h"
#include "app/studies/errors/head.h"
#include "app/studies/samples/shape.h"
#include "geometry/base/json_text.h"

namespace toothpath::errors {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMost = 1e12;  // um, urad

/// One row of the table: an error alone, or all together.
struct Row {
  std::string name, unit, source, meaning;
  double size = 0;
  std::vector<double> magnitude = {}, shift_um = {};
  double deepest_um = -INFINITY, left_um = -INFINITY;
  std::size_t within = 0;

  [[nodiscard]] double mean() const {
    double sum = 0;
    for (const double s : shift_um) sum += s;
    return sum / double(shift_um.size());
  }
  /// The least shift that 95 % of the samples do not exceed.
  [[nodiscard]] double most_of() const {
    std::vector<double> sorted = shift_um;
    std::sort(sorted.begin(), sorted.end());
    return sorted[std::size_t(std::ceil(0.95 * double(sorted.size()))) - 1];
  }
  [[nodiscard]] double largest() const { return *std::max_element(shift_um.begin(), shift_um.end()); }
  /// Least squares through zero: um of the flank for one um, or for ten urad, of the error.
  [[nodiscard]] double slope() const {
    double products = 0, squares = 0;
    for (std::size_t k = 0; k < shift_um.size(); ++k) {
      products += shift_um[k] * magnitude[k];
      squares += magnitude[k] * magnitude[k];
    }
    return squares == 0 ? 0 : products / squares * (unit == "um" ? 1 : 10);
  }
  [[nodiscard]] bool alone() const { return !unit.empty(); }
};

std::string number(double value, const char* format) { return fmt::format(fmt::runtime(format), value); }

Diagnostic refused(const SourcePosition& place, const std::string& fault) {
  return fail_at(place, "{}: study machine-errors does not write this; take the file away and run its shard again",
                 fault);
}

/// The first number of a cost or a size that no flank has; empty: none.
std::string beyond(const Json& numbers) {
  for (const auto& [key, value] : numbers.items())
    if (value.is_number() && std::abs(value.get<double>()) > kMost)
      return fmt::format("\"{}\" = {:g} is beyond {:g}", key, value.get<double>(), kMost);
  return {};
}

Status check_head(const Json& head, const SourcePosition& place) {
  const Json model{{"key", ""},
                   {"samples", 0},
                   {"seed", 0},
                   {"job", ""},
                   {"machine", ""},
                   {"teeth", 0},
                   {"verified", false},
                   {"nominal", json_of(Cost())},
                   {"errors", json_of(std::vector{Error()})}};
  std::string fault = samples::shape_fault(model, head, "");
  if (fault.empty()) fault = beyond(head["nominal"]);
  if (fault.empty() && head["teeth"] < 1) fault = "\"teeth\" is not above 0";
  for (std::size_t k = 0; fault.empty() && k < head["errors"].size(); ++k) {
    const Json& error = head["errors"][k];
    fault = beyond(error);
    if (fault.empty() && error["size"] <= 0) fault = fmt::format("\"errors[{}].size\" is not above 0", k);
  }
  return fault.empty() ? Status(Ok{}) : refused(place, fault);
}

Result<std::vector<Row>> rows_of(const Json& head, const samples::Merged& merged) {
  std::vector<Row> rows;
  for (const auto& e : head["errors"]) rows.push_back({e["error"], e["unit"], e["source"], e["meaning"], e["size"]});
  rows.push_back({kAll, "", "", "every error at once", 0});
  Json model{{"error", ""}, {"magnitude", 0.0}};
  model.update(json_of(Cost()));
  std::optional<Diagnostic> misnamed;
  for (std::size_t k = 0; k < merged.lines.size(); ++k) {
    const auto& [text, place] = merged.lines[k];
    const Json sample = Json::parse(text, nullptr, false);
    Row& row = rows[k % rows.size()];
    std::string fault = samples::shape_fault(model, sample, "");
    if (fault.empty()) fault = beyond(sample);
    if (!fault.empty()) return refused(place, fault);
    if (!misnamed && sample["error"] != row.name)
      misnamed = refused(place, fmt::format("\"error\" of sample {} is not \"{}\"", k, row.name));
    row.magnitude.push_back(sample["magnitude"]);
    row.shift_um.push_back(sample["shift_um"]);
    row.deepest_um = std::max(row.deepest_um, sample["deepest_um"].get<double>());
    row.left_um = std::max(row.left_um, sample["left_um"].get<double>());
    row.within += sample["within"].get<bool>() ? 1 : 0;
  }
  if (misnamed) return *misnamed;
  for (const Row& row : rows)
    if (row.shift_um.empty())
      return refused(merged.head_place,
                     fmt::format("\"samples\" = {} leaves {} without one", merged.head.samples, row.name));
  return rows;
}

page::PageTable table_of(const std::vector<Row>& rows) {
  page::PageTable table{"Errors",
                        {"error", "size", "unit", "samples", "mean_um", "95_percent_um", "largest_um", "um_per",
                         "deepest_um", "left_um", "within", "size_from", "meaning"},
                        {},
                        "size: standard deviation. um_per: um of the flank for one um, or for 10 urad (urad/rad), of "
                        "the error, by least squares. deepest, left: of all samples of the row."};
  for (const Row& row : rows)
    table.rows.push_back({row.name, row.alone() ? number(row.size, "{:g}") : "", row.unit,
                          std::to_string(row.shift_um.size()), number(row.mean(), "{:.3f}"),
                          number(row.most_of(), "{:.3f}"), number(row.largest(), "{:.3f}"),
                          row.alone() ? number(row.slope(), "{:.4f}") : "", number(row.deepest_um, "{:.3f}"),
                          number(row.left_um, "{:.3f}"), fmt::format("{}/{}", row.within, row.shift_um.size()),
                          row.source, row.meaning});
  return table;
}

Json json_of(const Json& head, const std::vector<Row>& rows) {
  Json json{{"schema", 1}, {"command", "study machine-errors"}};
  for (const char* key : {"key", "samples", "seed", "job", "machine", "teeth", "verified", "nominal"})
    json[key] = head.at(key);
  json["rows"] = Json::array();
  for (const Row& row : rows)
    json["rows"].push_back({{"error", row.name},
                            {"size", row.alone() ? Json(row.size) : Json()},
                            {"unit", row.unit},
                            {"source", row.source},
                            {"samples", row.shift_um.size()},
                            {"mean_um", row.mean()},
                            {"most_of_um", row.most_of()},
                            {"largest_um", row.largest()},
                            {"um_per", row.alone() ? Json(row.slope()) : Json()},
                            {"deepest_um", row.deepest_um},
                            {"left_um", row.left_um},
                            {"within", row.within}});
  return json;
}

/// What all errors together come to.
std::string together(const Row& all) {
  return fmt::format(
      "all errors together: 95 % of the flanks within {:.1f} um of the nominal machine's, {} of {} samples keep the "
      "limits of the job",
      all.most_of(), all.within, all.shift_um.size());
}

/// The last column of a table by itself, and the table without it.
std::vector<page::PageTable> last_apart(page::PageTable table, const std::string& title) {
  page::PageTable last{title, {table.columns.front(), table.columns.back()}, {}, ""};
  table.columns.pop_back();
  for (auto& row : table.rows) {
    if (!row.back().empty()) last.rows.push_back({row.front(), row.back()});
    row.pop_back();
  }
  return {std::move(table), std::move(last)};
}

page::StudyPage page_of(const Json& head, const std::vector<Row>& rows, const page::PageTable& table) {
  const Json& nominal = head.at("nominal");
  page::StudyPage page;
  page.title = "Errors of the machine: " + head.at("job").get<std::string>();
  page.subtitle = fmt::format("{}, {} samples, seed {}", head.at("machine").get<std::string>(),
                              head.at("samples").get<int>(), head.at("seed").get<int>());
  page.good = rows.back().within == rows.back().shift_um.size();
  page.verdict = fmt::format("{} of {} within the limits", rows.back().within, rows.back().shift_um.size());
  page.introduction = {
      "The program of the job was read back as always: the control knows the machine by its file. The joints of its "
      "moves then went through a machine with errors, and the proof of the gear judged where the tool truly was. Every "
      "sample draws its errors and one tooth space. mean, 95 % and largest are of the greatest change of a point of "
      "that space's flanks against the machine without errors; deepest and left are cut surface against nominal flank.",
      fmt::format("Without errors: deepest {:.3f} um, left {:.3f} um, gouge {:.3f} um found and {:.3f} um proven.{}",
                  nominal.at("deepest_um").get<double>(), nominal.at("left_um").get<double>(),
                  nominal.at("gouge_um").get<double>(), nominal.at("gouge_bound_um").get<double>(),
                  head.at("verified").get<bool>() ? "" : " This program is not verified."),
      "What is taken as touched off: with all rotaries at their zeros the tip of every tool truly stands at the origin "
      "of the part where the control believes it there, and the part is straight on the true table. An error shows by "
      "what it does from there on: turning, travelling, and a tool that changed since.",
      "A size is the standard deviation of a normal distribution: of each of the two components across an axis (pivot, "
      "tilt), of the amplitude of a wave, of each tool by itself. Sizes from \"assumed\" are typical of a machine in "
      "order and nobody measured them here: state your own with --error NAME=SIZE. Zero and scale of the rotary that "
      "indexes the teeth are left out: the blank has no teeth yet, and a full turn closes."};
  page.introduction.insert(page.introduction.begin(), "With " + together(rows.back()) + ".");
  std::vector<std::pair<std::string, double>> bars;
  for (const Row& row : rows) bars.emplace_back(row.name, row.most_of());
  page.figures.push_back({"What each error costs", svg::svg_bars(bars, "95 % of the flanks change by less than [um]"),
                          "One bar an error, each alone at its size; the last all together."});
  page.tables = last_apart(table, "What the errors are");
  return page;
}

}  // namespace

Result<Summary> summary_of(const samples::Merged& samples) {
  const Json head = Json::parse(samples.head.line, nullptr, false);
  if (const auto fits = check_head(head, samples.head_place); !fits) return fits.error();
  const auto rows = rows_of(head, samples);
  if (!rows) return rows.error();
  const page::PageTable table = table_of(*rows);
  Summary out;
  out.json = json_text(json_of(head, *rows), 2) + "\n";
  const page::StudyPage page = page_of(head, *rows, table);
  out.files = {{kSummaryFiles[0], page::table_csv(table)},
               {kSummaryFiles[1], out.json},
               {kSummaryFiles[2], page::study_page_html(page)}};
  out.text = page::table_text(page.tables.front()) + together(rows->back()) + "\n";
  return out;
}

}  // namespace toothpath::errors
