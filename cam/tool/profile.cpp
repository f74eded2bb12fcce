#include "cam/tool/profile.h"

#include "cam/tool/cutters.h"
#include "geometry/base/angle.h"

namespace toothpath::tool {
namespace {

constexpr double kSharp = 1e-9;     // rad: by which a tangent may turn back at a joint of a convex meridian
constexpr double kMostError = 0.1;  // of the ball's radius, in a measured meridian
constexpr double kMostSlope = 0.1;  // mm/mm, of a measured error: a side 5.7 deg off

/// Inclination of a piece's tangent at a place: pi/2 runs straight outwards, 0 along the axis, -pi/2 straight inwards.
double inclination(const MeridianPiece& piece, const Vec2& at) {
  const Vec2 n = piece_normal<double>(piece, at);
  return std::atan2(-n[0], n[1]);
}

/// Enclosing corners of a bulging arc: the crossings of evenly spaced tangents.
std::vector<Vec2> tangent_corners(const MeridianPiece& piece, double sag_mm) {
  const auto c = circle_of<double>(piece);
  const double half = std::acos(std::clamp(c.chord_at / c.R, -1.0, 1.0)), most = std::acos(1 / (1 + sag_mm / c.R));
  const int n = std::max(1, int(std::ceil(half / most)));
  const double middle = std::atan2(c.out[1], c.out[0]), step = half / n, out = c.R / std::cos(step);
  std::vector<Vec2> corners{piece.from};
  for (int k = 0; k < n; ++k) {
    const double angle = middle + half - (2 * k + 1) * step;  // from the lower end on the angle falls
    corners.emplace_back(c.centre + out * Vec2(std::cos(angle), std::sin(angle)));
  }
  corners.push_back(piece.to);
  return corners;
}

/// Points of a hollow arc: its chords enclose it.
std::vector<Vec2> chord_points(const MeridianPiece& piece, double sag_mm) {
  const auto c = circle_of<double>(piece);
  const double half = std::acos(std::clamp(c.chord_at / c.R, -1.0, 1.0)),
               most = std::acos(std::max(-1.0, 1 - sag_mm / c.R));
  const int n = std::max(1, int(std::ceil(half / most)));
  const double middle = std::atan2(c.out[1], c.out[0]);
  std::vector<Vec2> points{piece.from};
  for (int k = 1; k < n; ++k) {
    const double angle = middle - half + 2 * half * k / n;
    points.emplace_back(c.centre + c.R * Vec2(std::cos(angle), std::sin(angle)));
  }
  points.push_back(piece.to);
  return points;
}

/// Reads cutter data into pieces; notes every reason to refuse.
class Maker {
 public:
  explicit Maker(const CutterData& d) : d_(d), r_0_(d.diameter_mm / 2) {}

  void check() {
    positive("diameter", d_.diameter_mm);
    positive("flute_length", d_.flute_length_mm);
    positive("shank_diameter", d_.shank_diameter_mm);
    const bool leaned =
        d_.shape == CutterShape::tapered_ball || (d_.shape == CutterShape::barrel && d_.half_angle_rad != 0);
    if (leaned && !(d_.half_angle_rad > 0 && d_.half_angle_rad < kPi / 4))
      refuse("half_angle",
             "half_angle = {:.4f} deg: the angle between the axis and the side lies above 0 and below 45 deg",
             degrees(d_.half_angle_rad));
    if (d_.shape == CutterShape::bull_nose && !(d_.corner_radius_mm > 0 && d_.corner_radius_mm <= r_0_))
      refuse("corner_radius", "corner_radius = {:.4f} mm: it is above 0 and no more than {:.4f} mm, half the diameter",
             d_.corner_radius_mm, r_0_);
    if (d_.shape == CutterShape::barrel && !(d_.meridian_radius_mm < 0 || d_.meridian_radius_mm > r_0_))
      refuse("meridian_radius",
             "meridian_radius = {:.4f} mm: a bulging side needs more than the ball's radius {:.4f} mm",
             d_.meridian_radius_mm, r_0_);
    if (!refusals.empty()) return;  // what follows divides by these
    lengths();
    table();
  }

  [[nodiscard]] RadiusLaw<double> law() const {
    RadiusLaw<double> law;
    law.r_0 = r_0_;
    law.sin_tau = std::sin(d_.half_angle_rad);
    law.cos_tau = std::cos(d_.half_angle_rad);
    if (d_.shape == CutterShape::barrel) law.R_m = d_.meridian_radius_mm;
    if (d_.meridian) law.error = std::make_shared<MeridianError>(*d_.meridian);
    return law;
  }
  [[nodiscard]] bool has_ball() const { return d_.shape != CutterShape::flat && d_.shape != CutterShape::bull_nose; }
  /// Place of the ball's end and inclination of the side there, then the side at the end of the flutes.
  [[nodiscard]] Vec2 tangent() const {
    return {r_0_ * (1 - std::sin(d_.half_angle_rad)), r_0_ * std::cos(d_.half_angle_rad)};
  }
  /// Radius and inclination at the end of the flutes.
  [[nodiscard]] Vec2 flute_end() const {
    if (!has_ball()) return {r_0_, 0};
    const Vec2 at = tangent();
    const double h = d_.flute_length_mm - at[0], tau = d_.half_angle_rad;
    if (d_.shape != CutterShape::barrel) return {at[1] + h * std::tan(tau), tau};
    const double R = d_.meridian_radius_mm, s = std::sin(tau) - h / R;  // the inclination falls along a bulging arc
    return std::abs(s) < 1 ? Vec2(at[1] + R * (std::sqrt(1 - s * s) - std::cos(tau)), std::asin(s)) : Vec2(NAN, NAN);
  }
  [[nodiscard]] Meridian cutting() const {
    std::vector<MeridianPiece> pieces;
    const double flute = d_.flute_length_mm;
    if (has_ball()) {
      const Vec2 at = tangent();
      pieces.push_back({Vec2::Zero(), at, 1 / r_0_});
      if (flute > at[0])
        pieces.push_back(
            {at, Vec2(flute, flute_end()[0]), d_.shape == CutterShape::barrel ? 1 / d_.meridian_radius_mm : 0});
      return Meridian(std::move(pieces));
    }
    const double corner = d_.shape == CutterShape::bull_nose ? d_.corner_radius_mm : 0;
    if (r_0_ > corner) pieces.push_back({Vec2::Zero(), Vec2(0, r_0_ - corner), 0});
    if (corner > 0) pieces.push_back({Vec2(0, r_0_ - corner), Vec2(corner, r_0_), 1 / corner});
    if (flute > corner) pieces.push_back({Vec2(corner, r_0_), Vec2(flute, r_0_), 0});
    return Meridian(std::move(pieces));
  }
  [[nodiscard]] Meridian shank() const {
    std::vector<MeridianPiece> pieces;
    const double top = d_.holder.empty() ? d_.length_mm : d_.stick_out_mm, R = d_.shank_diameter_mm / 2;
    double h = d_.flute_length_mm;
    const Vec2 end = flute_end();
    if (end[1] > 0 && R > end[0]) {  // the cone goes on
      const double full = h + (R - end[0]) / std::tan(end[1]), to = std::min(full, top);
      if (to > h) pieces.push_back({Vec2(h, end[0]), Vec2(to, end[0] + (to - h) * std::tan(end[1])), 0});
      h = to;
    }
    if (top > h) pieces.push_back({Vec2(h, R), Vec2(top, R), 0});
    return Meridian(std::move(pieces));
  }
  [[nodiscard]] Meridian holder() const {
    std::vector<MeridianPiece> pieces;
    Vec2 at(d_.stick_out_mm, 0);
    for (const auto& s : d_.holder) {
      const Vec2 low(at[0], s.lower_diameter_mm / 2), high(at[0] + s.height_mm, s.upper_diameter_mm / 2);
      if (!pieces.empty() && low[1] != at[1]) pieces.push_back({at, low, 0});
      pieces.push_back({low, high, 0});
      at = high;
    }
    return Meridian(std::move(pieces));
  }

  std::vector<Refusal> refusals;

 private:
  template <typename... Args>
  void refuse(const char* key, fmt::format_string<Args...> text, Args&&... args) {
    refusals.push_back({key, fail(text, std::forward<Args>(args)...)});
  }
  void positive(const char* key, double value) {
    if (!(value > 0 && value < INFINITY)) refuse(key, "{} = {:.4f} mm: it is above 0", key, value);
  }
  void lengths() {
    const double needed = d_.shape == CutterShape::bull_nose ? d_.corner_radius_mm : has_ball() ? r_0_ : 0;
    if (d_.flute_length_mm < needed)
      refuse("flute_length", "flute_length = {:.4f} mm is below {:.4f} mm, the height of the rounded end",
             d_.flute_length_mm, needed);
    else if (const Vec2 end = flute_end(); !(end[1] >= 0))
      refuse("meridian_radius",
             "meridian_radius = {:.4f} mm: the side is widest below the end of the flutes at {:.4f} mm; it must not "
             "narrow",
             d_.meridian_radius_mm, d_.flute_length_mm);
    else if (end[1] > 0 && d_.shank_diameter_mm < 2 * end[0])
      refuse("shank_diameter",
             "shank_diameter = {:.4f} mm is thinner than the end of the flutes, {:.4f} mm: a tapered mill is ground "
             "from its shank",
             d_.shank_diameter_mm, 2 * end[0]);
    const double top = d_.holder.empty() ? d_.length_mm : d_.stick_out_mm;
    if (!(top >= d_.flute_length_mm && top < INFINITY))
      refuse(d_.holder.empty() ? "length" : "stick_out", "{} = {:.4f} mm is below the flute_length {:.4f} mm",
             d_.holder.empty() ? "length" : "stick_out", top, d_.flute_length_mm);
    for (const auto& s : d_.holder)
      if (!(s.height_mm > 0 && s.lower_diameter_mm > 0 && s.upper_diameter_mm > 0 &&
            s.height_mm + s.lower_diameter_mm + s.upper_diameter_mm < INFINITY))
        refuse("holder", "a holder segment [{}, {}, {}] mm: diameters and height are above 0", s.lower_diameter_mm,
               s.upper_diameter_mm, s.height_mm);
  }
  void table() {
    if (!d_.meridian) return;
    const auto& m = *d_.meridian;
    if (!has_ball()) return refuse("meridian", "a measured meridian is for mills with a ball end");
    if (m.t.size() < 2 || m.t.size() != m.f.size())
      return refuse("meridian", "a measured meridian needs two points at least, {} given", m.t.size());
    if (!(m.t.front() <= 0))
      return refuse("meridian",
                    "the measured meridian begins at t = {:.4f} mm; it must begin at the centre of the ball, t = 0",
                    m.t.front());
    for (std::size_t k = 0; k < m.t.size(); ++k) {
      if (!std::isfinite(m.t[k]) || !std::isfinite(m.f[k]))
        return refuse("meridian", "point {} of the measured meridian: t and f are finite numbers", k + 1);
      if (k > 0 && !(m.t[k] > m.t[k - 1]))
        return refuse("meridian",
                      "point {} of the measured meridian: t = {:.4f} mm is not above {:.4f} mm, that of the point "
                      "before: heights ascend",
                      k + 1, m.t[k], m.t[k - 1]);
      if (std::abs(m.f[k]) > kMostError * r_0_)
        return refuse("meridian",
                      "the measured error {:.2f} um at t = {:.4f} mm exceeds {:.2f} um, a tenth of the ball's radius: "
                      "is it in micrometres?",
                      1e3 * m.f[k], m.t[k], 1e3 * kMostError * r_0_);
      if (k > 0 && std::abs(m.f[k] - m.f[k - 1]) > kMostSlope * (m.t[k] - m.t[k - 1]))
        return refuse("meridian",
                      "the measured error changes by {:.2f} um from t = {:.4f} to {:.4f} mm, at most {:.2f} um can be "
                      "the form of a mill: smooth the measurement, or is t not in millimetres?",
                      1e3 * (m.f[k] - m.f[k - 1]), m.t[k - 1], m.t[k], 1e3 * kMostSlope * (m.t[k] - m.t[k - 1]));
    }
  }

  const CutterData& d_;
  double r_0_;
};

}  // namespace

double Meridian::largest_radius() const {
  double widest = 0;
  for (const auto& p : pieces_) {
    widest = std::max({widest, p.from[1], p.to[1]});
    if (p.bend > 0) {
      const auto c = circle_of<double>(p);
      if (c.centre[0] > p.from[0] && c.centre[0] < p.to[0]) widest = std::max(widest, c.centre[1] + c.R);
    }
  }
  return widest;
}

bool Meridian::convex() const {
  double last = kPi / 2;
  for (const auto& p : pieces_) {
    if (p.bend < 0 || inclination(p, p.from) > last + kSharp) return false;
    last = inclination(p, p.to);
  }
  return true;
}

std::vector<Vec2> Meridian::corners() const {
  std::vector<Vec2> out;
  if (!pieces_.empty()) out.push_back(pieces_.front().from);
  for (const auto& p : pieces_) out.push_back(p.to);
  return out;
}

std::vector<Frustum> Meridian::enclosing_frustums(double sag_mm, Body body) const {
  std::vector<Frustum> out;
  for (const auto& p : pieces_) {
    const auto line = p.bend > 0   ? tangent_corners(p, sag_mm)
                      : p.bend < 0 ? chord_points(p, sag_mm)
                                   : std::vector<Vec2>{p.from, p.to};
    for (std::size_t k = 1; k < line.size(); ++k)
      if (line[k][0] > line[k - 1][0]) out.push_back({line[k - 1][0], line[k][0], line[k - 1][1], line[k][1], body});
  }
  return out;
}

CutterData cutter_data(const ToolAssembly& t) {
  CutterData d;
  d.shape = kind_of(t).shape;
  d.diameter_mm = t.diameter_mm;
  d.half_angle_rad = t.half_angle_rad;
  d.corner_radius_mm = t.corner_radius_mm;
  d.meridian = t.meridian;
  d.flute_length_mm = t.flute_length_mm;
  d.shank_diameter_mm = t.shank_diameter_mm;
  d.length_mm = t.length_mm;
  d.stick_out_mm = t.stick_out_mm;
  d.holder = t.holder;
  return d;
}

Meridian shank_of(const ToolAssembly& tool) {
  const CutterData data = cutter_data(tool);
  return Maker(data).shank();
}
Meridian holder_of(const ToolAssembly& tool) {
  const CutterData data = cutter_data(tool);
  return Maker(data).holder();
}

std::variant<Profile, std::vector<Refusal>> Profile::make(const CutterData& data) {
  Maker maker(data);
  maker.check();
  if (!maker.refusals.empty()) return std::move(maker.refusals);
  return unchecked(data);
}

Profile Profile::unchecked(const CutterData& data) {
  const Maker maker(data);
  Profile p;
  p.cutting_ = maker.cutting();
  p.shank_ = maker.shank();
  p.holder_ = maker.holder();
  if (!maker.has_ball()) return p;
  p.half_angle_ = data.half_angle_rad;
  p.law_ = maker.law();
  RadiusLaw<double> nominal = *p.law_;
  nominal.error = nullptr;
  // The ball at t touches at the height r_0 + t - rho rho'; that rises with t.
  const auto touches = [&](double t) { return data.diameter_mm / 2 + t - nominal.rho(t) * nominal.slope(t); };
  double low = 0, high = 2 * data.flute_length_mm;
  for (int k = 0; k < 200 && high - low > 1e-13 * data.flute_length_mm; ++k) {
    const double t = 0.5 * (low + high);
    (touches(t) <= data.flute_length_mm ? low : high) = t;
  }
  p.law_end_ = data.meridian ? std::min(low, data.meridian->t.back()) : low;
  return p;
}

FrustumSlope Profile::cutting_distance(const Vec3& x) const {
  const double r = std::hypot(x.x(), x.y());
  const auto q = cutting_.distance<double>(x.z(), r);
  const Vec3 radial = r > 0 ? Vec3(x.x() / r, x.y() / r, 0) : Vec3::Zero();
  FrustumSlope out{q.distance, q.gradient[1] * radial + Vec3(0, 0, q.gradient[0])};
  if (law_ && law_->error) {
    // The normal through the foot meets the axis at the height of the ball that touches there.
    const Vec2 foot = Vec2(x.z(), r) - q.distance * q.gradient;
    const double t = std::abs(q.gradient[1]) > 0 ? foot[0] - foot[1] * q.gradient[0] / q.gradient[1] - law_->r_0 : 0;
    out.distance -= law_->error->at(std::clamp(t, 0.0, law_end_)).f;
  }
  return out;
}

ProofBodies Profile::proof_bodies(double sag_mm) const {
  ProofBodies out;
  const double grown = law_ && law_->error ? std::max(0.0, law_->error->largest()) : 0;
  auto flute = cutting_;
  if (law_) {
    out.ball_height_mm = law_->r_0;
    out.ball_radius_mm = law_->r_0 + grown;
    flute = Meridian({cutting_.pieces().begin() + 1, cutting_.pieces().end()});
  }
  out.frustums = flute.enclosing_frustums(sag_mm, Body::flute);
  for (auto& f : out.frustums) {
    const double slant = std::hypot(1.0, (f.radius_to - f.radius_from) / (f.to - f.from)) * grown;
    f.radius_from += slant;
    f.radius_to += slant;
  }
  for (const auto& [meridian, body] : {std::pair{&shank_, Body::shank}, std::pair{&holder_, Body::holder}})
    for (const auto& f : meridian->enclosing_frustums(sag_mm, body)) out.frustums.push_back(f);
  return out;
}

}  // namespace toothpath::tool
