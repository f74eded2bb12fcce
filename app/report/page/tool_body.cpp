#include "app/report/page/tool_body.h"

#include <cmath>

#include "app/report/svg/html_text.h"
#include "cam/finger/milling.h"
#include "cam/tool/cutters.h"
#include "geometry/base/angle.h"

namespace toothpath::page {
namespace {

PageToolBody page_body(const tool::Outline& outline) {
  PageToolBody body{to_string(outline.body), {}, tool::cuts(outline.body)};
  for (const Vec2& p : outline.line) body.profile.emplace_back(p[1], p[0]);
  return body;
}

}  // namespace

PageTool page_end_mill(const tool::ToolAssembly& tool) {
  PageTool page;
  page.name = fmt::format("T{} {}", tool.number, tool::cutter_text(tool));
  for (const auto& outline : tool::outline_of(tool)) page.bodies.push_back(page_body(outline));
  return page;
}

PageTool page_finger_mill(const bevel_gear::BevelGear& gear, const tool::ToolAssembly& tool) {
  PageTool page;
  page.name = fmt::format("T{} finger mill m {:g} mm", tool.number, tool.module_mm);
  const auto own = finger::gear_for_finger_mill(gear, tool);
  if (!own) return page;
  const auto& c = own->cutter();
  PageToolBody flute{"flute", {Vec2(0, 0)}, true};
  for (int i = 0; i <= 40; ++i) {
    const auto q = c.at(c.p_A + (c.p_D - c.p_A) * i / 40);
    flute.profile.emplace_back(q.rho, q.x + c.h_f);
  }
  flute.profile.emplace_back(c.rho_D, tool.flute_length_mm);
  page.bodies.push_back(std::move(flute));
  for (const auto& outline : tool::outline_of(tool))
    if (!tool::cuts(outline.body)) page.bodies.push_back(page_body(outline));
  return page;
}

}  // namespace toothpath::page
