#include "app/report/sheet/data_sheet.h"

#include <cmath>

#include "app/report/sheet/sheet_html.h"
#include "geometry/base/angle.h"

namespace toothpath::sheet {
namespace {

DataRow row(std::string_view symbol, std::string_view what, std::string value) {
  return {std::string(symbol), std::string(what), std::move(value)};
}

}  // namespace

DataRow data_number(std::string_view symbol, std::string_view what, double value) {
  return row(symbol, what, fmt::format("{:.6g}", value == 0 ? 0.0 : value));
}
DataRow data_length(std::string_view symbol, std::string_view what, double mm) {
  return row(symbol, what, fmt::format("{:.4f} mm", std::abs(mm) < 5e-5 ? 0.0 : mm));
}
DataRow data_angle(std::string_view symbol, std::string_view what, double rad) {
  return row(symbol, what, fmt::format("{:.5f} deg", std::abs(degrees(rad)) < 5e-6 ? 0.0 : degrees(rad)));
}
DataRow data_helix(std::string_view symbol, std::string_view what, double rad, std::string_view without) {
  const std::string angle = fmt::format("{:.5f}", std::abs(degrees(rad)));
  if (angle == "0.00000") return row(symbol, what, fmt::format("0 deg, {}", without));
  return row(symbol, what, fmt::format("{} deg, {} hand", angle, rad > 0 ? "right" : "left"));
}

std::string data_sheet_html(const DataSheet& data) {
  Sheet sheet;
  const std::string title = svg::html_escape(data.job_name);
  sheet.raw(
      fmt::format("<!DOCTYPE html>\n<html lang=en><head><meta charset=utf-8><meta name=viewport "
                  "content='width=device-width'><title>Gear data: "
                  "{}</title><style>{}</style></head><body>\n<h1>Gear data: {}</h1>\n<p>{}</p>\n",
                  title, kSheetStyle, title, svg::html_escape(data.words)));
  for (const DataGroup& group : data.groups) {
    sheet.heading(group.title);
    sheet.begin_table({"symbol", "quantity", "value"});
    for (const DataRow& r : group.rows) sheet.row({r.symbol, r.what, r.value});
    sheet.end_table();
  }
  for (const std::string& note : data.notes) sheet.raw(fmt::format("<p class=small>{}</p>\n", svg::html_escape(note)));
  sheet.raw(fmt::format("<p class=small>Job {}. Lengths in mm, angles in deg.</p>\n", svg::html_escape(data.job_file)));
  return std::move(sheet).finish();
}

}  // namespace toothpath::sheet
