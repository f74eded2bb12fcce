// Jobs that nobody chose: texts of random face gears and bevel gears. Many are possible, some are not: undercut,
// pointed, a cutter too wide.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "geometry/base/angle.h"
#include "tests/support/random.h"

namespace toothpath::test {

inline double logarithmic(Random& random, double low, double high) {
  return std::exp(random(std::log(low), std::log(high)));
}

inline constexpr const char* kRandomJobSetup = R"([machine]
file = "xyzac_large.toml"
[setup]
origin = [3.0, -2.0, {}]
axis = "{}"
work_offset = "G54"
work_offset_at = [3.0, -2.0, 0.0]
)";

inline std::string zone_text(double helix, double inner, double width) {
  return fmt::format("[[gear.zone]]\nhelix_angle = {:.3f}\ninner_radius = {:.4f}\nouter_radius = {:.4f}\n", helix,
                     inner, inner + width);
}

/// Short rings, most of them spur-like; one or two of them; the ball from half as large as the fillet to wider than it;
/// cusps of 1 to 20 um.
inline std::string random_face_job(Random& random) {
  const int teeth = 24 + int(random.index(100)), shaper = std::max(16, int(teeth * random(0.18, 0.45)));
  const double m = logarithmic(random, 0.8, 3), helix = random(0, 1) < 0.7 ? random(-1, 1) : random(-25, 25),
               shaft = random(0, 1) < 0.6 ? 90 : random(75, 105);
  const double rho = random(0.15, 0.28) * m, width = random(0.5, 2) * m, ball = random(0.5, 1.3) * rho;
  const double gear_ratio = double(shaper) / teeth;
  const double middle = 0.5 * m * teeth * (1 + gear_ratio * std::cos(radians(shaft))) / std::sin(radians(shaft));
  const bool two = random(0, 1) < 0.4;
  const double inner = middle + random(0, 1) * m - (two ? width : 0.5 * width),
               scallop = std::min(logarithmic(random, 0.001, 0.02), 0.1 * ball);
  std::string text = fmt::format(
      "schema = 1\nname = \"random\"\n[gear]\ntype = \"face_gear\"\nteeth = {}\nmodule = {:.4f}\nmodule_plane = "
      "\"transverse\"\n"
      "pressure_angle = {:.2f}\naddendum_coefficient = {}\nshaft_angle = {:.2f}\nreference_radius = "
      "{:.4f}\nshaper_teeth = {}\n"
      "shaper_tip_radius = {:.4f}\n",
      teeth, m, random(19, 25), random(0, 1) < 0.5 ? 0.8 : 1.0, shaft, middle, shaper, rho);
  text += zone_text(helix, inner, width);
  if (two)
    text += zone_text(-helix, inner + width + 4.4 * ball + m, width) +
            fmt::format("[stock]\ngroove_depth = {:.3f}\n", 3 * m);
  text += fmt::format(kRandomJobSetup, "120.0", "up");
  text += fmt::format(
      "[[tool]]\nnumber = 1\ntype = \"ball_end_mill\"\ndiameter = {:.4f}\nflute_length = {:.4f}\nshank_diameter = "
      "{:.4f}\nlength = 90.0\n"
      "holder = [[10.0, 10.0, 40.0]]\nstick_out = {:.3f}\n",
      2 * ball, 3.5 * m + 4, 1.9 * ball, 8 * m + 10);
  return text + fmt::format(
                    "[[operation]]\ntype = \"finishing\"\ntool = 1\nspeed = 20000\nfeed = 500.0\nscallop = "
                    "{:.6f}\nchord_tolerance = {:.6f}\nclimb = {}\n"
                    "[verify]\ngouge_tolerance = 0.005\n",
                    scallop, logarithmic(random, 0.0003, 0.004), random(0, 1) < 0.5);
}

/// The sample's pinion in other sizes, angles and tolerances.
inline std::string random_bevel_job(Random& random) {
  const double s = random(0.7, 1.4);
  const int mate = 34 + int(random.index(10));
  const double outer = 0.5 * 6 * s * std::hypot(18, mate);
  std::string text = fmt::format(
      "schema = 1\nname = \"random\"\n[gear]\ntype = \"equal_base_circle_bevel_gear\"\nteeth = 18\nmate_teeth = "
      "{}\nshaft_angle = 90.0\n"
      "outer_transverse_module = {:.4f}\npressure_angle = {:.3f}\nouter_spiral_angle = {:.3f}\nface_width = "
      "{:.4f}\nform = \"herringbone\"\n"
      "hand = \"{}\"\napex_cone_distance = {:.4f}\nrelief_half_width = {:.4f}\naddendum = {:.4f}\ndedendum = "
      "{:.4f}\nbacklash = {}\n",
      mate, 6 * s, random(19.5, 20.5), random(28, 31), 34 * s, random(0, 1) < 0.5 ? "left" : "right",
      outer - random(17, 19) * s, 3.3 * s, 4.1 * s, 5.1 * s, random(0, 1) < 0.5 ? 0.0 : 0.03);
  text += fmt::format(kRandomJobSetup, "260.0", "down");
  text += fmt::format(
      "[[tool]]\nnumber = 1\ntype = \"finger_mill\"\nmodule = {:.4f}\ntip_radius = {:.4f}\nrack_depth = "
      "{:.4f}\nprofile_height = {:.4f}\nlength = 130.0\n"
      "shank_diameter = {:.3f}\nholder = [[32.0, 32.0, 40.0]]\nstick_out = {:.3f}\nteeth = 2\n",
      random(2.9, 3.0) * s, 0.9 * s, 4.1 * s, 4.8 * s, 10 * s, 30 + 12 * s);
  return text + fmt::format(
                    "[[operation]]\ntype = \"finger_roughing\"\ntool = 1\nspeed = 4000\nfeed = 300.0\nridge = {:.3f}\n"
                    "[[operation]]\ntype = \"finger_finishing\"\ntool = 1\nspeed = 5000\nfeed = 250.0\nchord_tolerance "
                    "= {:.5f}\n[verify]\ngouge_tolerance = {:.4f}\n",
                    random(0.2, 0.6), logarithmic(random, 0.0004, 0.003), random(0.002, 0.006));
}

}  // namespace toothpath::test
