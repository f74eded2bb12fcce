#include "app/process/milled/unreached.h"

#include <fmt/format.h>

#include <cmath>

#include "app/base/units.h"

namespace toothpath::milled {
namespace {

/// "27.3 %"; what is more than nothing is never told as 0.0.
std::string share_text(const proof::UnreachedResult& unreached) {
  const double percent = 100 * unreached.share;
  return percent < 0.1 ? "< 0.1 %" : fmt::format("{:.1f} %", percent);
}

/// Rounded down: a ball of the diameter told does reach.
std::string largest_ball_text(const proof::UnreachedResult& unreached) {
  if (unreached.largest_ball_mm <= 0) return "no ball reaches all of it: the fillet has a sharp corner";
  return fmt::format("the largest ball that reaches all of it has {:.3f} mm",
                     std::floor(unreached.largest_ball_mm * 1000) / 1000);
}

void add_details(const proof::UnreachedResult& u, report::Finding& finding) {
  finding.details = {{"points", u.points}, {"max_height_um", app::um(u.max_height_mm)}};
  if (u.ball_mm <= 0) return;  // what was left is told only where an operation finishes
  const auto detail = [&](const char* name, report::Finding::Detail value) {
    finding.details.emplace_back(name, std::move(value));
  };
  detail("ball_mm", u.ball_mm);
  detail("limit_um", app::um(u.limit_mm));
  detail("share_percent", 100 * u.share);
  detail("height_um", app::um(u.height_mm));
  detail("largest_ball_mm", u.left() ? report::Finding::Detail(u.largest_ball_mm) : report::Finding::Detail(nullptr));
  detail("active_flank", u.active ? report::Finding::Detail(std::string(to_string(u.active->patch)))
                                  : report::Finding::Detail(nullptr));
  if (!u.active) return;
  detail("active_flank_height_um", app::um(u.active->height_mm));
  detail("active_flank_zone", std::size_t(u.active->zone));
  detail("active_flank_radius", u.active->radius_mm);
  detail("active_flank_z", u.active->z_mm);
}

}  // namespace

report::Finding unreached_of(const proof::UnreachedResult& unreached) {
  report::Finding finding;
  finding.key = "unreached";
  add_details(unreached, finding);
  if (!unreached.left()) return finding;
  finding.label = "surface not reached";
  finding.text = share_text(unreached);
  finding.note = fmt::format("up to {:.3f} mm high; {}", unreached.height_mm, largest_ball_text(unreached));
  finding.state = report::Finding::State::bad;
  finding.unfinished = fmt::format(
      "{} of the finished surface is out of reach of the ball of {:g} mm and stays up to {:.3f} mm high; {}",
      share_text(unreached), unreached.ball_mm, unreached.height_mm, largest_ball_text(unreached));
  return finding;
}

void judge_unreached(const proof::UnreachedResult& unreached, std::optional<double> limit_mm,
                     std::vector<std::string>& reasons) {
  if (const auto& a = unreached.active)
    reasons.push_back(
        fmt::format("unreached: the ball of {:g} mm does not reach the active flank: {:.4f} mm stay on {}, zone {}, r "
                    "{:.3f} mm, z {:.3f} mm, limit {:.4f} mm; {}",
                    unreached.ball_mm, a->height_mm, a->patch, a->zone, a->radius_mm, a->z_mm, unreached.limit_mm,
                    largest_ball_text(unreached)));
  if (limit_mm && unreached.height_mm > *limit_mm)
    reasons.push_back(fmt::format(
        "unreached: {:.4f} mm stay out of reach of the ball of {:g} mm, limit {:.4f} mm ([verify] unreached); {}",
        unreached.height_mm, unreached.ball_mm, *limit_mm, largest_ball_text(unreached)));
}

}  // namespace toothpath::milled
