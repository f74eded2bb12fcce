#include "postproc/shaper/chart.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>

namespace toothpath::shaper {
namespace {

constexpr double kWidth = 170, kHeight = 106, kLeft = 26, kRight = 6, kTop = 6, kBottom = 28;

struct LogScale {
  double low, high, at_low, at_high;
  [[nodiscard]] double operator()(double v) const {
    return at_low + (std::log10(v) - low) / (high - low) * (at_high - at_low);
  }
};

/// From the 1-2-5 step below the least to that above the greatest.
std::vector<double> steps(double least, double greatest) {
  std::vector<double> all;
  for (int decade = int(std::floor(std::log10(least))) - 1; decade <= int(std::ceil(std::log10(greatest))) + 1;
       ++decade)
    for (const double m : {1.0, 2.0, 5.0}) all.push_back(m * std::pow(10, decade));
  const auto first = std::upper_bound(all.begin(), all.end(), least * 1.0001) - 1;
  const auto last = std::lower_bound(all.begin(), all.end(), greatest * 0.9999);
  return {first, last + 1};
}

std::string chart(const std::vector<FeedStudyRow>& rows, double job_feed, const char* x_label,
                  const std::function<double(const FeedStudyRow&)>& x_of) {
  double x_least = INFINITY, x_most = 0, y_least = INFINITY, y_most = 0;
  for (const auto& r : rows) {
    x_least = std::min(x_least, x_of(r));
    x_most = std::max(x_most, x_of(r));
    y_least = std::min(y_least, r.deviation.rms_um);
    y_most = std::max(y_most, r.deviation.max_left_um);
  }
  const auto xs = steps(x_least, x_most), ys = steps(y_least, y_most);
  const LogScale x{std::log10(xs.front()), std::log10(xs.back()), kLeft, kWidth - kRight};
  const LogScale y{std::log10(ys.front()), std::log10(ys.back()), kHeight - kBottom, kTop};
  std::string out = fmt::format(
      "<svg viewBox=\"0 0 {} {}\" style=\"width:49%\" role=\"img\" aria-label=\"deviation over {}\"><g font-size=\"7\" "
      "fill=\"#111\" stroke=\"none\">",
      kWidth, kHeight, x_label);
  for (const double v : xs)
    out += fmt::format(
        "<path d=\"M{0:.1f} {1:.1f}V{2:.1f}\" stroke=\"#ccc\" stroke-width=\".4\"/><text x=\"{0:.1f}\" y=\"{3:.1f}\" "
        "text-anchor=\"middle\">{4:g}</text>",
        x(v), kTop, kHeight - kBottom, kHeight - kBottom + 8, v);
  for (std::size_t k = 0; k < ys.size(); ++k) {
    out += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" stroke=\"#ccc\" stroke-width=\".4\"/>", kLeft, y(ys[k]),
                       kWidth - kRight);
    if (ys.size() <= 7 || k % 3 == ys.size() % 3)
      out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{:g}</text>", kLeft - 2, y(ys[k]) + 2.2,
                         ys[k]);
  }
  out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>",
                     0.5 * (kLeft + kWidth - kRight), kHeight - 12, x_label);
  out += fmt::format(
      "<text transform=\"translate(6 {:.1f}) rotate(-90)\" text-anchor=\"middle\">left on flanks, &#181;m</text>",
      0.5 * (kTop + kHeight - kBottom));
  for (const bool greatest : {true, false}) {
    std::string path;
    std::string dots;
    for (const auto& r : rows) {
      const double px = x(x_of(r)), py = y(greatest ? r.deviation.max_left_um : r.deviation.rms_um);
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", px, py);
      dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.3\" fill=\"{}\"/>", px, py,
                          greatest ? "#005a9c" : "#b35c00");
      if (std::abs(r.circular_feed_mm - job_feed) < 1e-9 * job_feed)
        dots += fmt::format(
            "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.2\" fill=\"none\" stroke=\"#111\" stroke-width=\".7\"/>", px,
            py);
    }
    out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1\"{}/>{}", path,
                       greatest ? "#005a9c" : "#b35c00", greatest ? "" : " stroke-dasharray=\"3 1.5\"", dots);
  }
  out += fmt::format(
      "<g fill=\"#005a9c\"><path d=\"M{0:.1f} {1:.1f}h10\" stroke=\"#005a9c\"/><text x=\"{2:.1f}\" "
      "y=\"{3:.1f}\">max</text></g>",
      kLeft + 2, kHeight - 4.0, kLeft + 14, kHeight - 2.0);
  out += fmt::format(
      "<g fill=\"#b35c00\"><path d=\"M{0:.1f} {1:.1f}h10\" stroke=\"#b35c00\" stroke-dasharray=\"3 1.5\"/><text "
      "x=\"{2:.1f}\" y=\"{3:.1f}\">rms</text></g>",
      kLeft + 36, kHeight - 4.0, kLeft + 48, kHeight - 2.0);
  out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">ring: this job</text>", kLeft + 70, kHeight - 2.0);
  return out + "</g></svg>";
}

}  // namespace

std::string feed_study_charts(const std::vector<FeedStudyRow>& study, double job_feed_mm) {
  std::vector<FeedStudyRow> rows;
  for (const auto& r : study)
    if (r.circular_feed_mm > 0 && r.minutes > 0 && r.deviation.rms_um > 0 && r.deviation.max_left_um > 0)
      rows.push_back(r);
  if (rows.size() < 2) return "";
  return "<div>" +
         chart(rows, job_feed_mm, "circular feed, mm per double stroke",
               [](const FeedStudyRow& r) { return r.circular_feed_mm; }) +
         chart(rows, job_feed_mm, "cutting time, min", [](const FeedStudyRow& r) { return r.minutes; }) + "</div>";
}

}  // namespace toothpath::shaper
