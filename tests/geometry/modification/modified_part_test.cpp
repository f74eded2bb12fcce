// Flanks of any gear that a drawing moves along their normals: what is gone is what the words say, pieces stay one
// smooth sheet, derivatives are exact and enclosures hold.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>

#include "geometry/cylindrical/part.h"
#include "geometry/tooth_space/limits.h"
#include "geometry/tooth_space/modified_form.h"
#include "geometry/tooth_space/modified_part.h"
#include "tests/geometry/cylindrical/samples.h"
#include "tests/geometry/flank_grid/samples.h"
#include "tests/geometry/spiral_bevel/samples.h"
#include "tests/geometry/straight_bevel/samples.h"
#include "tests/support/random.h"

namespace toothpath::test {
namespace {

using modification::Kind;
using modification::Modification;
using tooth_space::PatchPoint;
using tooth_space::Piece;
using tooth_space::ToothSpace;
using Part = std::shared_ptr<const tooth_space::ToothedPart>;

Modification of(Kind kind, double amount, double length = 0) {
  Modification m;
  m.kind = kind;
  m.amount_mm = amount;
  m.length_mm = length;
  return m;
}

std::vector<Modification> many() {
  auto slope = of(Kind::helix_angle_slope, 0.012);
  slope.flanks = modification::Flanks::right;
  auto end = of(Kind::end_relief, 0.015, 3);
  end.ends = modification::Ends::outer;
  return {of(Kind::tip_relief, 0.02, 1.2), of(Kind::profile_crowning, 0.01), of(Kind::lead_crowning, 0.008), slope, end,
          of(Kind::root_relief, 0.01, 0.8)};
}

/// By the words of docs/modifications.md. @param y  share of the depth;  @param x  share of the face, from the inner
/// end
double words(int side, double y, double x, double depth, double face) {
  const auto relief = [](double C, double L, double t) { return t < L ? C * (L - t) * (L - t) / (L * L) : 0; };
  double sum = relief(0.02, 1.2, y * depth) + relief(0.01, 0.8, (1 - y) * depth) + relief(0.015, 3, (1 - x) * face);
  sum += 0.01 * (2 * y - 1) * (2 * y - 1) + 0.008 * (2 * x - 1) * (2 * x - 1);
  if (side > 0) sum += 0.012 * x;
  return sum;
}

struct ModifiedCase {
  const char* name;
  Part plain, modified;
};
const std::vector<ModifiedCase>& cases() {
  static const std::vector<ModifiedCase> kCases = [] {
    std::vector<ModifiedCase> out;
    const auto add = [&](const char* name, Part plain) {
      auto modified = tooth_space::modified_part(plain, many());
      out.push_back({name, plain, std::move(modified).value()});
    };
    add("spur", cylindrical::part_of(made(shifted_spur())));
    add("left helical", cylindrical::part_of(made(left_helical())));
    add("double helical", cylindrical::part_of(made(double_helical_pinion())));
    add("straight bevel", straight_bevel::part_of(straight_bevel::StraightBevelGear::make(khk_pinion()).value()));
    for (const auto& [name, settings] :
         {std::pair("spiral bevel", nasa_gear()), {"spiral pinion", nasa_pinion()}, {"Formate", formate_wheel()}})
      add(name, spiral_bevel::part_of(spiral_bevel::SpiralBevelGear::make(settings).value()));
    add("spur by points",
        flank_grid::part_of(flank_grid::FlankGridGear::make(sampled(shifted_spur(), {9, 9, 1.2})).value()));
    add("bevel by points",
        flank_grid::part_of(flank_grid::FlankGridGear::make(sampled(khk_pinion(), {9, 9, 0.75})).value()));
    return out;
  }();
  return kCases;
}

/// Random places of all moved pieces of a case, down to their borders.
void everywhere(const ModifiedCase& c, int count,
                const std::function<void(const ToothSpace&, const ToothSpace&, Piece, double, double, double)>& see) {
  Random random(7);
  for (int zone = 0; zone < c.plain->zones(); ++zone) {
    const ToothSpace &plain = c.plain->space(zone), &modified = c.modified->space(zone);
    const auto& ring = plain.outline();
    for (const Piece piece : {Piece::flank_plus, Piece::fillet_plus, Piece::fillet_minus, Piece::flank_minus})
      for (int k = 0; k < count; ++k) {
        const double s = random(ring.s_from, ring.s_to);
        auto b = plain.borders(piece);
        if (is_flank(piece)) (side_of(piece) > 0 ? b.from : b.to) = plain.tip_edge(side_of(piece), s)->u;
        const double u = random(std::min(b.from, b.to), std::max(b.from, b.to));
        const auto v = tooth_space::v_at(plain, piece, u, s);
        ASSERT_TRUE(v) << c.name;
        see(plain, modified, piece, u, *v, s);
      }
  }
}

TEST(ModifiedPart, WhatIsGoneIsWhatTheWordsSay) {
  for (const ModifiedCase& c : cases())
    everywhere(
        c, 60, [&](const ToothSpace& plain, const ToothSpace& modified, Piece piece, double u, double v, double s) {
          const auto p = plain.at(piece, u, v), q = modified.at(piece, u, v);
          ASSERT_TRUE(p && q);
          if (!is_flank(piece)) return;
          const int side = side_of(piece);
          // The depth of the flank here and in the middle, from its fillet line.
          const auto& ring = plain.outline();
          const auto b = plain.borders(piece);
          const auto depth = [&](double at) {
            return plain.tip(at) - ring.chart.up(tooth_space::place_at(plain, piece, side > 0 ? b.to : b.from, at)->p);
          };
          const double middle = depth(0.5 * (ring.s_from + ring.s_to)), face = ring.s_to - ring.s_from;
          const double x = ring.sign < 0 ? (ring.s_to - s) / face : (s - ring.s_from) / face;
          const double y = (plain.tip(s) - ring.chart.up(p->p)) / depth(s);
          EXPECT_LT((p->p - words(side, y, x, middle, face) * p->n - q->p).norm(), 1e-9)
              << c.name << " " << to_string(piece);
        });
}

TEST(ModifiedPart, PiecesStayOneSmoothSheet) {
  for (const ModifiedCase& c : cases())
    for (int zone = 0; zone < c.plain->zones(); ++zone) {
      const ToothSpace &plain = c.plain->space(zone), &modified = c.modified->space(zone);
      const auto& ring = plain.outline();
      for (const double share : {0.0, 0.3, 1.0})
        for (const int side : {1, -1}) {
          const double s = ring.s_from + share * (ring.s_to - ring.s_from);
          const Piece flank = tooth_space::flank_of(side), fillet = tooth_space::fillet_of(side);
          const auto f = plain.borders(flank), w = plain.borders(fillet), r = plain.borders(Piece::root);
          const auto at = [&](Piece piece, double u) {
            return *modified.at(piece, u, *tooth_space::v_at(plain, piece, u, s));
          };
          const auto joined = [&](const PatchPoint& a, const PatchPoint& b) {
            EXPECT_LT((a.p - b.p).norm(), 1e-9) << c.name << " " << side;
            EXPECT_LT((a.n - b.n).norm(), 1e-6) << c.name << " " << side;
          };
          joined(at(flank, side > 0 ? f.to : f.from), at(fillet, side > 0 ? w.from : w.to));
          joined(at(fillet, side > 0 ? w.to : w.from), at(Piece::root, side > 0 ? r.from : r.to));
        }
    }
}

TEST(ModifiedPart, DerivativesAreExactAndFeetLieUnderTheirPlaces) {
  Random random(3);
  for (const ModifiedCase& c : cases())
    everywhere(c, 25, [&](const ToothSpace&, const ToothSpace& space, Piece piece, double u, double v, double) {
      const double e = 1e-5;
      const auto q = *space.at(piece, u, v);
      const auto difference = [&](auto take, double du, double dv) {
        return Vec3((take(*space.at(piece, u + du, v + dv)) - take(*space.at(piece, u - du, v - dv))) / (2 * e));
      };
      const auto place = [](const PatchPoint& x) { return x.p; };
      const auto normal = [](const PatchPoint& x) { return x.n; };
      EXPECT_LT((q.pu - difference(place, e, 0)).norm(), 1e-6 * (1 + q.pu.norm())) << c.name << " " << to_string(piece);
      EXPECT_LT((q.pv - difference(place, 0, e)).norm(), 1e-6 * (1 + q.pv.norm())) << c.name << " " << to_string(piece);
      // The second derivative of a relief jumps where it begins.
      EXPECT_LT((q.nu - difference(normal, e, 0)).norm(), 0.03 * (1 + q.nu.norm()))
          << c.name << " " << to_string(piece);
      EXPECT_LT((q.nv - difference(normal, 0, e)).norm(), 0.03 * (1 + q.nv.norm()))
          << c.name << " " << to_string(piece);
      EXPECT_NEAR(q.n.dot(q.pu), 0, 1e-12 * q.pu.norm());
      EXPECT_NEAR(q.n.dot(q.pv), 0, 1e-12 * q.pv.norm());
      const double off = random(0, 0.3);
      const auto foot = space.foot(piece, q.p + off * q.n, u + 0.003, v + 0.05);
      ASSERT_TRUE(foot) << c.name << " " << to_string(piece);
      EXPECT_NEAR(foot->distance, off, 1e-11);
      EXPECT_LT((foot->at.p - q.p).norm(), 1e-9);
    });
}

TEST(ModifiedPart, EnclosuresHold) {
  for (const ModifiedCase& c : cases()) {
    Random random(5);
    double widest = 0;
    everywhere(c, 40, [&](const ToothSpace& plain, const ToothSpace& space, Piece piece, double u, double v, double) {
      const auto b = plain.borders(piece);
      const double span =
          is_flank(piece) ? std::abs((side_of(piece) > 0 ? b.to : b.from) - u) + 1e-3 : std::abs(b.to - b.from);
      const double hu = 0.02 * span, hv = 0.2, e = 1e-5 * span;
      const tooth_space::PatchFrame frame{Vec2(u, v), Vec2(0.8, 0.1), Vec2(-0.05 * span, 1.2)};
      const auto jet = space.enclosure(piece, frame, hu, hv), before = plain.enclosure(piece, frame, hu, hv);
      ASSERT_TRUE(jet && before);
      const Vec2 ab(random(-hu, hu), random(-hv, hv)), da(e, 0);
      const auto at = [&](const Vec2& x) {
        const Vec2 uv = frame.uv(x);
        return *space.at(piece, uv.x(), uv.y());
      };
      const auto along_a = [&](const PatchPoint& q) {
        return Vec3(q.pu * frame.along_a.x() + q.pv * frame.along_a.y());
      };
      const auto q = at(ab);
      const Vec3 first = along_a(q), second = (along_a(at(ab + da)) - along_a(at(ab - da))) / (2 * e);
      for (std::size_t k = 0; k < 3; ++k) {
        const auto held = [&](const Interval& x, double value, double slack) {
          EXPECT_TRUE(x.low - slack <= value && value <= x.high + slack)
              << c.name << " " << to_string(piece) << " " << value << " in " << x.low << " .. " << x.high;
        };
        held(jet->place[k], q.p[int(k)], 1e-13);
        held(jet->first[0][k], first[int(k)], 1e-11);
        held(jet->second[0][k], second[int(k)], 1e-5 / (span * span));
        const double plain_width = before->second[0][k].radius();
        // A box over the place where a relief begins holds its bend and none: 2 C/L^2 is 0.03 1/mm. Of flanks that are
        // straight along the frame that is all there is.
        const double size = second.norm() + 0.03 * first.squaredNorm() + plain_width;
        widest = std::max(widest, (jet->second[0][k].radius() - plain_width) / size);
      }
    });
    // Of the size of what is bounded: boxes of a flank stay as good as those of the plain one.
    std::printf("%s: second derivatives are wider by %.3f of their size\n", c.name, widest);
    EXPECT_LT(widest, 0.5) << c.name;
  }
}

// What a relief takes, also of the land; and what is no small offset is refused.
TEST(ModifiedPart, FormTellsWhatIsTakenAndRefusesWhatIsNoOffset) {
  const Part plain = cases()[0].plain;
  const auto with = [&](const Modification& m) { return tooth_space::modified_part(plain, {m}); };
  auto relieved = with(of(Kind::tip_relief, 0.03, 1.5));
  ASSERT_FALSE(relieved.refused());
  const auto form = tooth_space::modified_form(plain->space(0), (*relieved)->space(0));
  EXPECT_NEAR(form.removed_mm.value, 0.03, 1e-9);
  EXPECT_LT(form.land_mm.value, form.plain_land_mm - 0.05);
  EXPECT_FALSE(tooth_space::refused(form, 0));
  EXPECT_NE(tooth_space::narrow_land(form, 0, form.plain_land_mm - 0.01), "");
  auto steep = with(of(Kind::tip_relief, 0.3, 1.0));
  ASSERT_FALSE(steep.refused());
  const auto turned = tooth_space::refused(tooth_space::modified_form(plain->space(0), (*steep)->space(0)), 0);
  ASSERT_TRUE(turned);
  EXPECT_EQ(turned->key, "modification");
  EXPECT_NE(turned->diagnostic.message.find("turn the normal of flank "), std::string::npos);
  auto deep = with(of(Kind::tip_relief, 0.7, 3.0));
  ASSERT_TRUE(deep.refused());
  EXPECT_EQ(deep.refused()->key, "modification[0].amount");
  // Nothing is taken: the space itself.
  auto none = with(of(Kind::lead_crowning, 0));
  ASSERT_FALSE(none.refused());
  EXPECT_EQ(&(*none)->space(0), &plain->space(0));
}

// A smooth error of the flanks, measured on a grid: the part that answers it stands off by as much, the other way.
TEST(ModifiedPart, CorrectionsAnswerWhatWasMeasured) {
  for (const ModifiedCase& c : cases()) {
    const auto error = [](double y, double x) { return 0.02 + 0.01 * y * x - 0.015 * x * x; };
    tooth_space::Corrections corrections;
    for (int zone = 0; zone < c.plain->zones(); ++zone) {
      const auto on = tooth_space::flank_rectangle(c.plain->space(zone), 1)->on;
      std::vector<modification::FlankDeviation> points;
      for (int row = 0; row < 7; ++row)
        for (int column = 0; column < 11; ++column) {
          const double y = 0.95 - 0.9 * row / 6, x = 0.05 + 0.9 * column / 10;
          points.push_back({row, column, y, on.from_mm + x * on.face(), error(y, x)});
        }
      const auto fit = modification::FlankCorrection::fit(points, 1);
      ASSERT_TRUE(fit);
      corrections.push_back(std::make_shared<modification::RingCorrection>(modification::RingCorrection{*fit, *fit}));
    }
    const auto aimed = tooth_space::modified_part(c.plain, {}, corrections).value();
    const ModifiedCase answered{c.name, c.plain, aimed};
    everywhere(answered, 30,
               [&](const ToothSpace& plain, const ToothSpace& space, Piece piece, double u, double v, double) {
                 if (!is_flank(piece)) return;
                 const auto flank = tooth_space::flank_rectangle(plain, side_of(piece));
                 const auto p = *plain.at(piece, u, v), q = *space.at(piece, u, v);
                 const Vec2 place = flank->share_at(plain, p.p);
                 const double x = (place.x() - flank->on.from_mm) / flank->on.face();
                 if (std::abs(place.y() - 0.5) > 0.45 || std::abs(x - 0.5) > 0.45) return;  // tangents there
                 EXPECT_NEAR((q.p - p.p).dot(p.n), -error(place.y(), x), 1e-9) << c.name;
               });
  }
}

}  // namespace
}  // namespace toothpath::test
