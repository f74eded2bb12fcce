#include "app/process/scene_place.h"

#include <algorithm>
#include <cmath>

#include "cam/clearance/solid_gap.h"

namespace toothpath::process {
namespace {

constexpr double kInch_mm = 25.4, kMetre_mm = 1000;
constexpr double kSag_mm = 0.02;     // of the facets of the gear: GearProcess::solid()
constexpr double kApart_mm = 0.25;   // places of the gear that are asked whether they lie in the stock
constexpr double kTouch_mm = 1;      // parts of one set-up stand so close to each other
constexpr double kSmallShare = 0.4;  // of the reach of the gear: a file in inches has less than that of ten times it
constexpr double kFarDiameters = 5;  // of the gear: what stands farther off holds nothing
constexpr double kGapAsked_mm = 1e5;

struct Box {
  Vec3 low = Vec3::Constant(INFINITY), high = Vec3::Constant(-INFINITY);
  double reach = 0;  ///< farthest corner from the origin of W
};

Box box_of(const mesh::TriangleMesh& mesh) {
  Box box;
  for (const Vec3& v : mesh.vertices) {
    box.low = box.low.cwiseMin(v);
    box.high = box.high.cwiseMax(v);
    box.reach = std::max(box.reach, v.norm());
  }
  return box;
}

std::string text_of(const Vec3& low, const Vec3& high) {
  return fmt::format("X {:.6g} to {:.6g}, Y {:.6g} to {:.6g}, Z {:.6g} to {:.6g} mm", low.x(), high.x(), low.y(),
                     high.y(), low.z(), high.z());
}

std::string place_text(const Vec3& p) { return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", p.x(), p.y(), p.z()); }

Diagnostic refusal(const std::string& file, std::string why) {
  return {DiagnosticKind::refused_input, {file, 0, 0}, std::move(why)};
}

/// Would the box hold the gear if its numbers were these units?
std::string unit_hint(const Box& box, const Box& gear) {
  for (const auto& [unit, name] : {std::pair(kInch_mm, "inches"), {kMetre_mm, "metres"}})
    if (((box.low * unit).array() <= gear.low.array() + kTouch_mm).all() &&
        ((box.high * unit).array() >= gear.high.array() - kTouch_mm).all())
      return fmt::format("; in {} it would hold it: mesh files are read as mm", name);
  return {};
}

class Placing {
 public:
  Placing(Scene& scene, const FinishedGear& gear, double clearance)
      : scene_(scene), gear_(gear), solid_(gear.mesh), box_(box_of(gear.mesh)), most_out_(clearance + kSag_mm) {}

  Status run() {
    scene_.fixture_places = places_of(scene_.fixture_files, scene_.fixture);
    scene_.stock_places = places_of(scene_.stock_files, scene_.stock);
    if (!scene_.stock.empty()) {
      if (auto s = stock_holds_the_teeth(); !s) return s;
      if (auto s = no_hole_in_the_teeth(); !s) return s;
    }
    if (auto s = no_fixture_in_the_teeth(); !s) return s;
    return fixtures_belong_here();
  }

 private:
  [[nodiscard]] std::vector<report::MeshInScene> places_of(const std::vector<std::string>& files,
                                                           const std::vector<SceneMesh>& meshes) const {
    std::vector<report::MeshInScene> out;
    for (std::size_t k = 0; k < meshes.size(); ++k) {
      const Box box = box_of(meshes[k].mesh);
      out.push_back(
          {files[k], meshes[k].mesh.triangles.size(), box.low, box.high,
           clearance::surface_gap({gear_.mesh, solid_}, {meshes[k].mesh, *meshes[k].distance}, kGapAsked_mm)});
    }
    return out;
  }

  [[nodiscard]] Status stock_holds_the_teeth() const {
    std::vector<const clearance::MeshDistance*> stock;
    for (const auto& m : scene_.stock) stock.push_back(m.distance.get());
    const auto worst = clearance::farthest_outside(gear_.mesh, gear_.teeth, stock, kApart_mm);
    if (worst.out_mm <= most_out_) return Ok{};
    Box all;
    for (const auto& place : scene_.stock_places) {
      all.low = all.low.cwiseMin(place.low);
      all.high = all.high.cwiseMax(place.high);
    }
    return refusal(scene_.stock_files.front(),
                   fmt::format("the finished gear reaches {:.3f} mm out of the stock at {}, {:.3f} mm is the most; the "
                               "stock has {}, the gear {}{}",
                               worst.out_mm, place_text(worst.place), most_out_, text_of(all.low, all.high),
                               text_of(box_.low, box_.high), unit_hint(all, box_)));
  }

  /// A cavity shows no place of the gear outside: its own corners lie within the gear.
  [[nodiscard]] Status no_hole_in_the_teeth() const {
    const clearance::MeshDistance* gear[] = {&solid_};
    for (std::size_t k = 0; k < scene_.stock.size(); ++k) {
      std::vector<const clearance::MeshDistance*> others;
      for (std::size_t i = 0; i < scene_.stock.size(); ++i)
        if (i != k) others.push_back(scene_.stock[i].distance.get());
      for (const Vec3& v : scene_.stock[k].mesh.vertices) {
        if (!gear_.above_roots(v)) continue;
        const double depth = -clearance::signed_distance(v, gear, kGapAsked_mm);
        if (depth > most_out_ && clearance::signed_distance(v, others, 0) > most_out_)
          return refusal(scene_.stock_files[k],
                         fmt::format("the stock has a hole in the teeth of the finished gear at {}, {:.3f} mm below "
                                     "their surface",
                                     place_text(v), depth));
      }
    }
    return Ok{};
  }

  /// What lies wholly in a tooth no tool can meet, and is no fixture.
  [[nodiscard]] Status no_fixture_in_the_teeth() const {
    const clearance::MeshDistance* gear[] = {&solid_};
    for (std::size_t k = 0; k < scene_.fixture.size(); ++k)
      for (const Vec3& v : scene_.fixture[k].mesh.vertices) {
        if (!gear_.above_roots(v)) continue;
        const double depth = -clearance::signed_distance(v, gear, kGapAsked_mm);
        if (depth > kSag_mm)
          return refusal(scene_.fixture_files[k],
                         fmt::format("the fixture lies in the teeth of the finished gear at {}, {:.3f} mm below their "
                                     "surface; a fixture stands beside the gear, in its frame, in mm",
                                     place_text(v), depth));
      }
    return Ok{};
  }

  /// Empty: its size and place are those of a fixture.
  [[nodiscard]] std::string doubt(const SceneMesh& mesh, double to_gear) const {
    const double reach = box_of(mesh.mesh).reach;
    const double diameter = (box_.high - box_.low).head<2>().maxCoeff();
    if (reach < kSmallShare * box_.reach)
      return fmt::format(
          "the fixture lies within {:.4g} mm of the origin of the gear frame, the gear reaches {:.4g} "
          "mm, and it touches nothing: in inches it would reach {:.1f} mm, in metres {:.0f} mm; mesh "
          "files are read as mm. Where it is right, give what it is fixed to with --fixture, too",
          reach, box_.reach, kInch_mm * reach, kMetre_mm * reach);
    if (to_gear > kFarDiameters * diameter)
      return fmt::format(
          "the fixture stands {:.1f} mm from the finished gear, more than {:g} times its diameter of "
          "{:.1f} mm, and touches nothing; it has {}, in mm and in the gear frame. Where it is right, "
          "give what it is fixed to with --fixture, too",
          to_gear, kFarDiameters, diameter, text_of(box_of(mesh.mesh).low, box_of(mesh.mesh).high));
    return {};
  }

  [[nodiscard]] static bool touch(const SceneMesh& a, const SceneMesh& b) {
    return clearance::surface_gap({a.mesh, *a.distance}, {b.mesh, *b.distance}, 2 * kTouch_mm) <= kTouch_mm;
  }

  /// What raises a doubt is taken where it touches gear or stock, or a fixture that is taken.
  [[nodiscard]] Status fixtures_belong_here() const {
    std::vector<std::size_t> doubtful;
    std::vector<const SceneMesh*> taken;
    for (const auto& m : scene_.stock) taken.push_back(&m);
    for (std::size_t k = 0; k < scene_.fixture.size(); ++k) {
      const double to_gear = scene_.fixture_places[k].to_gear_mm;
      if (to_gear > kTouch_mm && !doubt(scene_.fixture[k], to_gear).empty()) doubtful.push_back(k);
      else taken.push_back(&scene_.fixture[k]);
    }
    for (std::size_t i = 0; i < taken.size(); ++i)  // grows: chains of parts
      std::erase_if(doubtful, [&](std::size_t k) {
        const bool stands = touch(scene_.fixture[k], *taken[i]);
        if (stands) taken.push_back(&scene_.fixture[k]);
        return stands;
      });
    if (doubtful.empty()) return Ok{};
    const std::size_t k = doubtful.front();
    return refusal(scene_.fixture_files[k], doubt(scene_.fixture[k], scene_.fixture_places[k].to_gear_mm));
  }

  Scene& scene_;
  const FinishedGear& gear_;
  clearance::MeshDistance solid_;
  Box box_;
  double most_out_;
};

}  // namespace

Status place_scene(Scene& scene, const FinishedGear& gear, double clearance_mm) {
  return Placing(scene, gear, clearance_mm).run();
}

}  // namespace toothpath::process
