#include "app/report/page/tool_body.h"

#include <cmath>

#include "app/report/svg/html_text.h"
#include "cam/finger/milling.h"
#include "geometry/base/angle.h"

namespace toothpath::page {
namespace {

/// What is above the cutting part, up to the spindle.
void add_shank_and_holder(PageTool& page, const tool::ToolAssembly& tool) {
  const double shank = tool.shank_diameter_mm / 2;
  page.bodies.push_back({"shank", {Vec2(shank, tool.flute_length_mm), Vec2(shank, tool.stick_out_mm)}, false});
  PageToolBody holder{"holder", {}, false};
  double z = tool.stick_out_mm;
  for (const auto& part : tool.holder) {
    holder.profile.emplace_back(part.lower_diameter_mm / 2, z);
    z += part.height_mm;
    holder.profile.emplace_back(part.upper_diameter_mm / 2, z);
  }
  page.bodies.push_back(std::move(holder));
}

}  // namespace

PageTool page_ball_mill(const tool::ToolAssembly& tool) {
  PageTool page;
  page.name = fmt::format("T{} ball {} mm", tool.number, svg::short_number(tool.diameter_mm));
  const double r = tool.radius_mm();
  PageToolBody ball{"ball", {}, true};
  constexpr int kSteps = 12;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = kPi / 2 * i / kSteps;
    ball.profile.emplace_back(r * std::sin(angle), r * (1 - std::cos(angle)));
  }
  page.bodies.push_back(std::move(ball));
  page.bodies.push_back({"flute", {Vec2(r, r), Vec2(r, tool.flute_length_mm)}, true});
  add_shank_and_holder(page, tool);
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
  add_shank_and_holder(page, tool);
  return page;
}

}  // namespace toothpath::page
