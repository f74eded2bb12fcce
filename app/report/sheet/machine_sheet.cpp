#include "app/report/sheet/machine_sheet.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "app/report/page/study_page.h"
#include "app/report/svg/html_text.h"

namespace toothpath::sheet {
namespace {

std::string number(double value) { return fmt::format("{:g}", value == 0 ? 0.0 : value); }
std::string triple(const Vec3& v) { return fmt::format("{} {} {}", number(v.x()), number(v.y()), number(v.z())); }

const char* tcp_text(machines::TcpMode mode) {
  switch (mode) {
    case machines::TcpMode::none: return "none: the five joints move linearly in a block";
    case machines::TcpMode::angles: return "angles: the control keeps the tip on the chord";
    case machines::TcpMode::vectors:
      return "vectors: the control keeps the tip on the chord and turns the axis in one plane";
  }
  return "";
}

std::string chain_text(const machines::KinematicChain& chain) {
  const machines::Links links(chain);
  std::string text = "work";
  bool linear = false;  // those that follow each other stand together
  for (std::size_t k = 0; k <= links.joints().size(); ++k) {
    if (k == links.bed()) {
      text += " - bed";
      linear = false;
    }
    if (k == links.joints().size()) break;
    const machines::Joint& joint = links.joints()[k];
    text += fmt::format("{}{}", linear && !joint.rotary ? " " : " - ", joint.letter);
    linear = !joint.rotary;
  }
  return text + " - spindle - tool";
}

/// Is this key, a table that holds it, or something in it assumed?
bool assumed(const std::vector<std::string>& keys, const std::string& key) {
  return std::any_of(keys.begin(), keys.end(), [&](const std::string& k) {
    return key == k || key.starts_with(k + ".") || k.starts_with(key + ".");
  });
}

/// The keys of the machine file, a table a row: "axes.A" | "direction, point, sign".
page::PageTable assumed_table(const std::vector<std::string>& keys) {
  page::PageTable table{"Assumed values", {"table", "keys"}, {}, ""};
  for (const auto& key : keys) {
    const auto dot = key.rfind('.');
    const std::string name = dot == std::string::npos ? "" : key.substr(0, dot),
                      last = dot == std::string::npos ? key : key.substr(dot + 1);
    if (!table.rows.empty() && table.rows.back()[0] == name) table.rows.back()[1] += ", " + last;
    else table.rows.push_back({name, last});
  }
  return table;
}

/// What carries a body, what it is and where it stands.
page::PageTable body_table(const machines::Machine& m, const std::vector<BodyBox>& boxes) {
  page::PageTable table{"Bodies", {"body", "on", "shape", "size [mm]", "from", "to", ""}, {}, ""};
  const machines::Links links(m.chain);
  for (std::size_t k = 0; k < m.bodies.size() && k < boxes.size(); ++k) {
    const machines::MachineBody& body = m.bodies[k];
    std::string shape = "box";
    if (const auto* cone = std::get_if<machines::ConeShape>(&body.shape))
      shape = cone->radius_from == cone->radius_to
                  ? fmt::format("cylinder dia {}", number(2 * cone->radius_from))
                  : fmt::format("cone dia {} to {}", number(2 * cone->radius_from), number(2 * cone->radius_to));
    else if (const auto* mesh = std::get_if<machines::MeshShape>(&body.shape))
      shape = "mesh " + std::filesystem::path(mesh->file).filename().string();
    const Vec3 size = boxes[k].high - boxes[k].low;
    table.rows.push_back({body.name, link_name(links, body.link), shape,
                          fmt::format("{} x {} x {}", number(size.x()), number(size.y()), number(size.z())),
                          triple(boxes[k].low), triple(boxes[k].high),
                          assumed(m.assumed_keys, body.key) || assumed(m.assumed_keys, "body") ? "assumed" : ""});
  }
  table.note = table.rows.empty()
                   ? "No bodies are stated: moves of the machine are not checked against each other."
                   : "Bodies stand where they stand with every joint at its zero, the gauge point in the "
                     "origin; size, from and to are those of the box around them.";
  return table;
}

struct Facts {
  page::PageTable general, axes, bodies, guessed;
  std::size_t assumed = 0;
};

Facts facts_of(const machines::Machine& m, const std::vector<BodyBox>& boxes) {
  Facts f;
  const auto mark = [&](const std::string& key) { return assumed(m.assumed_keys, key) ? "assumed" : ""; };
  f.general = {"Machine", {"quantity", "value", "unit", ""}, {}, ""};
  const auto row = [&](const char* name, std::string value, const char* unit, const std::string& key) {
    f.general.rows.push_back({name, std::move(value), unit, mark(key)});
  };
  row("dialect", m.dialect, "", "dialect");
  row("tool centre point control", tcp_text(m.tcp), "", "tcp");
  row("axes at once", fmt::format("{}", m.max_simultaneous_axes), "", "max_simultaneous_axes");
  row("chain", chain_text(m.chain), "", "chain");
  row("spindle", number(m.max_spindle_speed), "1/min", "spindle.max_speed");
  row("cutting feed", number(m.max_cutting_feed), "mm/min", "limits.cutting_feed");
  row("table diameter", number(m.table_diameter_mm), "mm", "limits.table_diameter");
  if (m.table_face_mm) row("table face", "Z " + number(*m.table_face_mm), "mm", "limits.table_face");
  if (m.part_diameter_mm) row("largest part", number(*m.part_diameter_mm), "mm", "limits.part_diameter");
  if (m.max_part_mass_kg) row("heaviest part", number(*m.max_part_mass_kg), "kg", "limits.part_mass");
  row("shortest block", number(m.min_block_ms), "ms", "limits.min_block_ms");
  row("distance kept from limits",
      fmt::format("{} mm, {} deg", number(m.limit_margin.linear_mm), number(degrees(m.limit_margin.rotary_rad))), "",
      "limits");
  if (const auto& check = m.tool_check)
    row("tool setter",
        fmt::format("X {} Y {} Z {}", number(check->position_mm.x()), number(check->position_mm.y()),
                    number(check->position_mm.z())),
        "mm", "tool_check.position");
  row("tool length to", m.post.length_reference == machines::LengthReference::tip ? "tip" : "centre of the ball", "",
      "post.length_reference");

  f.axes = {"Axes", {"axis", "in", "direction", "point [mm]", "sign", "range", "speed", "a positive command"}, {}, ""};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& axis = m.chain.linear[i];
    const std::string letter(1, "XYZ"[i]);
    f.axes.rows.push_back({letter, "", "", "", "", fmt::format("{} .. {} mm", number(axis.min_mm), number(axis.max_mm)),
                           fmt::format("{} mm/min", number(axis.max_speed)),
                           fmt::format("moves the tool to {}+ against the work", letter)});
  }
  for (std::size_t k = 0; k < m.chain.rotary_count(); ++k) {
    const machines::RotaryAxis& axis = m.chain.rotary(k);
    f.axes.rows.push_back(
        {std::string(1, axis.letter), m.chain.in_table(k) ? "table" : "head", triple(axis.direction),
         triple(axis.point_mm), axis.sign > 0 ? "+1, ISO 841" : "-1, reversed",
         axis.rollover ? "rolls over"
                       : fmt::format("{} .. {} deg", number(degrees(axis.min_rad)), number(degrees(axis.max_rad))),
         fmt::format("{} deg/min", number(degrees(axis.max_speed))), positive_turn(m.chain, k)});
  }
  f.axes.note =
      "Point of a table axis: machine coordinates. Of a head axis: from the gauge point, its z is the pivot length.";
  f.bodies = body_table(m, boxes);
  f.guessed = assumed_table(m.assumed_keys);
  f.assumed = m.assumed_keys.size();
  return f;
}

Facts facts_of(const machines::ShaperMachine& m) {
  Facts f;
  const auto mark = [&](const std::string& key) { return assumed(m.assumed_keys, key) ? "assumed" : ""; };
  f.general = {"Gear shaper", {"quantity", "value", "unit", ""}, {}, ""};
  const auto row = [&](const char* name, std::string value, const char* unit, const std::string& key) {
    f.general.rows.push_back({name, std::move(value), unit, mark(key)});
  };
  const auto list = [](const auto& values) {
    std::string text;
    for (const auto& v : values) text += fmt::format("{}{}", text.empty() ? "" : " ", v);
    return text;
  };
  row("dialect", m.dialect, "", "dialect");
  row("double strokes", list(m.stroke_steps), "1/min", "stroke.steps");
  row("longest stroke", number(m.max_stroke_mm), "mm", "stroke.max_length");
  row("relief on the back stroke", number(m.relief_mm), "mm", "stroke.relief");
  row("index constant", fmt::format("{}/{}", m.index_constant.numerator, m.index_constant.denominator), "", "index");
  row("feed constant", fmt::format("{}/{}", m.feed_constant.numerator, m.feed_constant.denominator), "", "feed");
  f.general.note =
      fmt::format("Change gears{}: {} teeth.", assumed(m.assumed_keys, "gears") ? " (assumed)" : "", list(m.gears));
  f.axes = {"Axes", {"axis", "range", "speed", "sign"}, {}, ""};
  for (const auto& [letter, axis] : m.axes) {
    const bool rotary = letter == 'A' || letter == 'C';
    const auto value = [&](double v) { return number(rotary ? degrees(v) : v); };
    f.axes.rows.push_back({std::string(1, letter),
                           fmt::format("{} .. {} {}", value(axis.min), value(axis.max), rotary ? "deg" : "mm"),
                           fmt::format("{} {}", value(axis.max_speed), rotary ? "deg/min" : "mm/min"),
                           rotary ? fmt::format("{:+d}", axis.sign) : ""});
  }
  f.guessed = assumed_table(m.assumed_keys);
  f.assumed = m.assumed_keys.size();
  return f;
}

std::string text_of(const Facts& f, const std::string& name, const std::string& file) {
  std::string out =
      fmt::format("{}  ({})\n\n{}\n{}", name, file, page::table_text(f.general), page::table_text(f.axes));
  for (const auto* table : {&f.general, &f.axes})
    if (!table->note.empty()) out += "\n" + table->note + "\n";
  if (!f.bodies.rows.empty()) out += "\n" + page::table_text(f.bodies);
  if (!f.bodies.note.empty()) out += "\n" + f.bodies.note + "\n";
  if (f.guessed.rows.empty()) return out + "\nNo value is assumed.\n";
  return out + fmt::format("\n{} values are assumed; measure them before a part is cut.\n", f.assumed) +
         page::table_text(f.guessed);
}

std::string page_of(const Facts& f, const std::string& name, const std::string& file, const std::string& drawing) {
  page::StudyPage page;
  page.title = name;
  page.subtitle = file;
  page.good = f.guessed.rows.empty();
  page.verdict = page.good ? "nothing assumed" : fmt::format("{} values assumed", f.assumed);
  page.introduction = {
      "A program is written as if the tool moved (ISO 841). A table therefore turns the other way: the last column of "
      "the axes says what is seen. Run the program of `toothpath machine test` in air before the first part: a wrong "
      "sign or pivot shows there."};
  page.tables = {f.general, f.axes};
  if (!f.bodies.note.empty()) page.tables.push_back(f.bodies);
  if (!f.guessed.rows.empty()) page.tables.push_back(f.guessed);
  std::string html = page::study_page_html(page);
  if (!drawing.empty()) {
    const auto at = html.find("</header>");
    if (at != std::string::npos)
      html.insert(at + 9, fmt::format("\n<figure style='margin:0;text-align:center'>{}</figure>\n", drawing));
  }
  return html;
}

}  // namespace

std::string positive_turn(const machines::KinematicChain& chain, std::size_t rotary) {
  const machines::RotaryAxis& axis = chain.rotary(rotary);
  const bool table = chain.in_table(rotary);
  const double sense = table ? -axis.sign : axis.sign;  // of the body that turns, about `direction`
  int main = 0;
  axis.direction.cwiseAbs().maxCoeff(&main);
  if (axis.direction.cwiseAbs()[main] < 0.999)
    return fmt::format("turns the {} {}-handed about {}", table ? "table" : "head", sense > 0 ? "right" : "left",
                       triple(axis.direction));
  const bool right = sense * axis.direction[main] > 0;  // right-handed about +X, +Y or +Z
  if (main == 2)
    return fmt::format("turns the {} {} seen from above", table ? "table" : "head",
                       right ? "counter-clockwise" : "clockwise");
  if (table) {
    if (main == 0) return fmt::format("tilts the table, its Y+ side {}", right ? "up" : "down");
    return fmt::format("tilts the table, its X+ side {}", right ? "down" : "up");
  }
  if (main == 0) return fmt::format("swings the tool tip to Y{}", right ? "+" : "-");
  return fmt::format("swings the tool tip to X{}", right ? "-" : "+");
}

std::string link_name(const machines::Links& links, std::size_t link) {
  if (link == links.bed()) return "bed";
  return {links.joints()[link < links.bed() ? link : link - 1].letter};
}

std::string machine_text(const machines::Machine& machine, const std::vector<BodyBox>& boxes) {
  return text_of(facts_of(machine, boxes), machine.name, machine.file);
}
std::string machine_text(const machines::ShaperMachine& machine) {
  return text_of(facts_of(machine), machine.name, machine.file);
}

std::string machine_page(const machines::Machine& machine, const std::vector<BodyBox>& boxes) {
  return page_of(facts_of(machine, boxes), machine.name, machine.file, machine_drawing_svg(machine));
}
std::string machine_page(const machines::ShaperMachine& machine) {
  return page_of(facts_of(machine), machine.name, machine.file, {});
}

}  // namespace toothpath::sheet
