#include "app/report/sheet/dry_run_sheet.h"

#include <cmath>

#include "app/report/page/study_page.h"
#include "app/report/sheet/machine_sheet.h"
#include "postproc/self_test/dials.h"

namespace toothpath::sheet {
namespace {

using Kind = self_test::DialSight::Kind;

std::vector<std::string> what_to_do(const machines::Machine& machine, std::span<const DryRunPart> parts) {
  const self_test::SelfTest& test = parts.front().test;
  const Vec3& p = test.point_mm;
  std::vector<std::string> out = {
      fmt::format("The spindle does not turn. A test bar of {:g} mm (gauge line to the tip) is tool 1; its length must "
                  "stand in the tool table. The work offset G54 is X {:g} Y {:g} Z {:g} in machine coordinates: the "
                  "tip of the bar stands there at every station, as seen from the table.",
                  test.tool_length_mm, p.x(), p.y(), p.z()),
      "1. Set the offset and the length, remove part and fixture, feed override at zero. 2. Start; open the override "
      "slowly. The program stops at every station. 3. At station 1 bring dials on the table to the tip, along X, Y and "
      "Z of the table, and set them to zero. With one dial run the program three times. 4. At every further station "
      "the dials turn with the table: read them."};
  if (test.lifts)
    out.emplace_back(
        "Between two stations the bar goes up to the top of Z, the rotaries turn, and it comes down upon the dials "
        "along Z: stop it by the override above them, and look first.");
  if (parts.size() > 1) out.push_back(fmt::format("Run {} first, then {}.", parts[0].program, parts[1].program));
  for (const auto& key : machine.assumed_keys) out.push_back("Assumed and not measured: " + key);
  return out;
}

/// What each program proves, and what none of them can.
std::vector<std::string> what_is_proven(const machines::Machine& machine, std::span<const DryRunPart> parts) {
  const DryRunPart& joints = parts.front();
  std::vector<std::string> out = {fmt::format(
      "{} proves the machine file. TCP is off, every axis goes where the file says, and dials that stay at zero say "
      "that "
      "senses, pivots and centres are those of the machine. Read back from the text: the tip leaves the point by at "
      "most "
      "{:.4f} mm. Seen with dials of {:g} mm: {}. A reading that grows with one axis alone belongs to its place.",
      joints.program, joints.proof.worst_mm, self_test::kDialStep_mm, dry_run_sight(machine, joints))};
  for (const DryRunPart& part : parts.subspan(1))
    out.push_back(fmt::format(
        "{} proves the data of the control, not the machine file: TCP is on, its text is the point and angles (at most "
        "{:.4f} mm off it), and the control keeps the tip there by what it knows itself. Dials that stay at zero in {} "
        "and "
        "move here say that the TCP data of the control are wrong.",
        part.program, part.proof.worst_mm, joints.program));
  out.emplace_back(
      "Only the eye proves the rest: that TCP is off or on as said (the display of the control), that each axis turns "
      "the way that the table below says, travels and speeds of the axes, diameter of the table, where the tool is "
      "changed, and what no station shows.");
  return out;
}

std::string cell(const self_test::DialSight& sight, std::size_t station) {
  const double v = sight.at[station];
  if (!std::isfinite(v) || (sight.kind == Kind::sense && v < self_test::kDialStep_mm)) return "-";
  return fmt::format("{:.3f}", v);
}

page::PageTable sights_table(const machines::Machine& machine, const DryRunPart& part) {
  const auto sights = self_test::dial_sights(part.test, machine.chain);
  page::PageTable table{
      "What a station shows, " + part.program,
      {"station", "axes"},
      {},
      fmt::format("Sense: what the dial that moves most shows where the axis turns the other way. Else "
                  "the least error that moves a dial by {:g} mm in whatever direction it lies. -: "
                  "the station does not show it.",
                  self_test::kDialStep_mm)};
  for (const auto& sight : sights)
    table.columns.push_back(
        fmt::format("{}, {}{}", sight.what, sight.kind == Kind::sense ? "" : "from ", sight.unit()));
  for (std::size_t s = 0; s < part.test.stations.size(); ++s) {
    table.rows.push_back({fmt::format("{}", s + 1), part.test.stations[s].remark});
    for (const auto& sight : sights) table.rows.back().push_back(cell(sight, s));
  }
  return table;
}

page::PageTable readings_table(const DryRunPart& part) {
  page::PageTable table{
      "Stations, " + part.program,
      {"station", "axes", "text mm", "dial X mm", "dial Y mm", "dial Z mm", "direction right"},
      {},
      "Text: what the dials show by the rounding of the words. The last four columns are filled in at "
      "the machine."};
  for (std::size_t s = 0; s < part.test.stations.size(); ++s)
    table.rows.push_back({fmt::format("{}", s + 1), part.test.stations[s].remark,
                          fmt::format("{:.4f}", part.proof.readings_mm[s].cwiseAbs().maxCoeff()), "", "", "", ""});
  return table;
}

}  // namespace

std::string dry_run_sight(const machines::Machine& machine, const DryRunPart& part) {
  std::string seen, unseen;
  for (const auto& sight : self_test::dial_sights(part.test, machine.chain)) {
    const double least = sight.least();
    const bool sense = sight.kind == Kind::sense,
               shows = sense ? least > self_test::kDialStep_mm : std::isfinite(least);
    std::string& list = shows ? seen : unseen;
    list += (list.empty() ? "" : ", ") + sight.what;
    if (shows) list += sense ? fmt::format(" ({:.1f} mm)", least) : fmt::format(" from {:.3f} {}", least, sight.unit());
  }
  return seen + (unseen.empty() ? "" : "; not seen: " + unseen);
}

std::string dry_run_page(const machines::Machine& machine, std::span<const DryRunPart> parts) {
  page::StudyPage page;
  page.title = machine.name + ": dry run of signs and pivots";
  for (const DryRunPart& part : parts) page.subtitle += part.program + ", ";
  page.subtitle += machine.file;
  page.good = machine.assumed_keys.empty();
  page.verdict = page.good ? "nothing assumed" : fmt::format("{} values assumed", machine.assumed_keys.size());
  page.introduction = what_to_do(machine, parts);
  for (auto& text : what_is_proven(machine, parts)) page.introduction.push_back(std::move(text));
  page::PageTable senses{"What a positive command turns", {"axis", "seen"}, {}, ""};
  for (std::size_t k = 0; k < machine.chain.rotary_count(); ++k)
    senses.rows.push_back({std::string(1, machine.chain.rotary(k).letter), positive_turn(machine.chain, k)});
  page.tables = {senses};
  for (const DryRunPart& part : parts) page.tables.push_back(readings_table(part));
  page.tables.push_back(sights_table(machine, parts.front()));
  return study_page_html(page);
}

}  // namespace toothpath::sheet
