#include "tests/fuzz/readers.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>

#include "app/job/file.h"
#include "app/job/measured_file.h"
#include "app/job/measured_points.h"
#include "app/job/measured_setup.h"
#include "app/probing/touch_file.h"
#include "app/proposal/points_gear.h"
#include "app/rexs/gears.h"
#include "app/studies/dhfg.h"
#include "app/studies/errors/head.h"
#include "app/studies/errors/summary.h"
#include "app/studies/trials/dhfg_summary.h"
#include "app/tool_library/tool_library.h"
#include "geometry/base/plain_text.h"
#include "geometry/face_gear/part.h"
#include "geometry/mesh/file.h"
#include "postproc/controls/of_machine.h"
#include "postproc/shaper/control.h"
#include "postproc/shaper/gearbox_proof.h"
#include "tests/postproc/shaper/case.h"
#include "tests/postproc/text/post_forms.h"
#include "tests/support/files.h"
#include "tests/support/inspection_points.h"
#include "tests/support/sample_gears.h"

namespace toothpath::test {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSteps = 20000;  // executed blocks: a loop that a fuzzer makes endless is cut here
constexpr const char* kToml = "0123456789.-=[]\"\n_#";

const fs::path kSource = TOOTHPATH_SOURCE_DIR;

std::vector<std::string> files_of(const fs::path& folder, const std::string& start = "") {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".toml" && entry.path().filename().string().starts_with(start))
      paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> texts;
  for (const auto& path : paths) texts.push_back(file_text(path));
  return texts;
}

/// A refusal has words, in one line that may go to a terminal.
std::string fault_of(const Diagnostic& error) {
  if (error.message.empty()) return "a refusal without words";
  for (const char c : error.text())
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) return "a control character in: " + error.text();
  return "";
}

std::string fault_of(const std::vector<Diagnostic>& errors, bool has_value) {
  if (has_value != errors.empty()) return has_value ? "a value and refusals" : "neither a value nor a refusal";
  for (const Diagnostic& error : errors) {
    if (error.position.file.empty()) return "no file in: " + error.text();
    if (std::string fault = fault_of(error); !fault.empty()) return fault;
  }
  return "";
}

template <typename T>
std::string fault_of(const Result<T>& result) {
  if (result) return "";
  return fault_of({result.error()}, false);
}

ByteReader job_reader() {
  std::vector<std::string> seeds = files_of(kSource / "samples");
  for (auto& text : files_of(kSource / "tests/jobs")) seeds.push_back(std::move(text));
  for (auto& text : files_of(kSource / "tests/bad_jobs")) seeds.push_back(std::move(text));
  return {"job", kToml, std::move(seeds), [](std::string_view bytes) {
            const auto read = job::parse_job(bytes, "job.toml");
            return fault_of(read ? std::vector<Diagnostic>{} : read.error(), read.has_value());
          }};
}

ByteReader machine_reader() {
  return {"machine", kToml, files_of(kSource / "machines/data"), [](std::string_view bytes) {
            const auto read = controls::read_machine_of_text(bytes, "machine.toml");
            return fault_of(read.errors, read.machine.has_value());
          }};
}

ByteReader shaper_machine_reader() {
  auto seeds = files_of(kSource / "machines/data", "shaper_");
  for (auto& text : files_of(kSource / "machines/data", "y514")) seeds.push_back(std::move(text));
  return {"shaper_machine", kToml, std::move(seeds), [](std::string_view bytes) {
            const auto read = shaper::read_shaper_machine_of_text(bytes, "machine.toml");
            return fault_of(read.errors, read.machine.has_value());
          }};
}

/// The measured meridian of a tool, beside a job that names it.
ByteReader meridian_reader() {
  static const TestDir dir;
  static const std::string job = replaced(file_text(kSource / "tests/jobs/dhfg_line.toml"),
                                          "half_angle = ", "meridian = \"m.csv\"\nhalf_angle = ");
  std::vector<std::string> seeds;
  for (const auto& entry : fs::directory_iterator(kSource / "tests/bad_jobs/meridians"))
    seeds.push_back(file_text(entry.path()));
  std::sort(seeds.begin(), seeds.end());
  seeds.emplace_back("t,f\n0,0.5\n1,0.25\n2.5,-0.5\n6,0\n");
  return {"meridian", "0123456789.,-+eE\n", std::move(seeds),
          [](std::string_view bytes) {
            write_file(dir / "m.csv", std::string(bytes));
            const auto read = job::parse_job(job, dir / "job.toml");
            return fault_of(read ? std::vector<Diagnostic>{} : read.error(), read.has_value());
          },
          20};  // each writes a file
}

/// A grid of removals, beside a job that names it; what was read is laid on a flank.
ByteReader grid_reader() {
  static const TestDir dir;
  static const std::string job =
      file_text(kSource / "samples/spur_quick.toml") + "\n[[gear.modification]]\nkind = \"grid\"\nfile = \"g.csv\"\n";
  std::string seed = "along,depth,removal\n";
  for (int k = 0; k < 12; ++k) seed += fmt::format("{},{},0.0{}\n", 60 + 1.25 * (k % 4), k / 4 * 1.5, k);
  return {"modification_grid",
          "0123456789.,-+eE\n",
          {seed},
          [](std::string_view bytes) {
            write_file(dir / "g.csv", std::string(bytes));
            const auto read = job::parse_job(job, dir / "job.toml");
            if (!read) return fault_of(read.error(), false);
            const auto& all = std::get<face_gear::FaceGearParameters>(read.value().gear).modifications;
            const modification::Rectangle on{4, 60, 65};
            if (const auto refused = modification::refused(all, 0, on)) return fault_of(refused->diagnostic);
            const modification::Field field(all, 1, 0, on);
            for (const double depth : {0.0, 1.7, 4.0})
              if (!std::isfinite(field.removal(depth, 62.3))) return std::string("a removal that is no number");
            return std::string();
          },
          20};  // each writes a file
}

ByteReader touches_reader() {
  return {"touches",
          "0123456789.,;-+eETXYZ# \t\n",
          {"# T X Y Z\n1 10.5 -3.25 40\n2;1.5e1;0;40.001\r\nT3 X1 Y2 Z3\n", "1,2,3,4\n"},
          [](std::string_view bytes) { return fault_of(probing::parse_touches(bytes, "touches.txt")); }};
}

/// Shards of both studies in a directory of their own, merged and summed up.
ByteReader shards_reader() {
  static const TestDir dir;
  trials::StudyFacts facts{"small", true, true, 5, true, {25, 26, 27}, {4, 5, 6}, {0.3, 0.4, 0.5},
                           5e5,     0.65, 1e4,  3, 1};
  trials::StudyFound found = room_for(facts);
  for (std::size_t k = 0; k < found.trials.size(); ++k) found.trials[k].levels = trials::l9_trials()[k];
  std::string dhfg = trials::head_of(facts, "k").line + "\n";
  for (int k = 0; k < count_of(facts); ++k) dhfg += sample_line(facts, k, found) + "\n";
  const std::string cost =
      R"("shift_um":1,"rms_um":0.5,"deepest_um":1.0,"left_um":2,"gouge_um":1,"gouge_bound_um":1.1,"within":true)";
  std::string costs = R"({"study":"machine-errors","version":1,"key":"k","samples":4,"seed":1,"job":"j","machine":"m",)"
                      R"("teeth":60,"verified":true,"nominal":{)" +
                      cost +
                      R"(},"errors":[{"error":"A.pivot","size":5,"unit":"um","source":"s","meaning":"x"}]})"
                      "\n";
  for (int k = 0; k < 4; ++k)
    costs += fmt::format(R"({{"sample":{},"error":"{}","tooth":3,"magnitude":1.5,{}}})", k,
                         k % 2 == 0 ? "A.pivot" : errors::kAll, cost) +
             "\n";
  return {"shards",
          "{}[]\":,.+-0123456789etruefals\n",
          {dhfg, costs},
          [](std::string_view bytes) {
            write_file(dir / "samples.1of1.jsonl", std::string(bytes));
            const auto merged = samples::merge(dir.path());
            if (!merged) return fault_of(merged);
            if (merged->head.study == errors::kStudy) return fault_of(errors::summary_of(*merged));
            if (merged->head.study != trials::kDhfg) return std::string();
            const auto study = trials::study_of(*merged);
            if (study) (void)summary_of(study->facts, study->found);
            return fault_of(study);
          },
          20};  // each writes a file
}

ByteReader study_reader() {
  auto seeds = files_of(kSource / "samples/studies");
  seeds.emplace_back(
      "schema = 1\nname = \"small\"\n[study]\nmodule = 5.0\npinion_teeth = [25, 26, 27]\n"
      "ratio = [4, 5, 6]\nhelix_angle = [20.0, 22.0, 24.0]\n");
  return {"study", kToml, std::move(seeds), [](std::string_view bytes) {
            const auto read = studies::parse_dhfg_study(bytes, "study.toml");
            return fault_of(read ? std::vector<Diagnostic>{} : read.error(), read.has_value());
          }};
}

ByteReader measured_reader() {
  static const face_gear::FaceGear gear = made(spur_parameters());
  const auto grid = inspection::inspection_grid(drawn_solid(gear), {5, 9});
  std::istringstream in(inspection::inspection_csv(*grid));
  std::string line, csv = "zone,flank,row,column,x,y,z,i,j,k,deviation_um\n";
  std::getline(in, line);
  while (std::getline(in, line)) csv += line + ",1.5\n";
  return {"measured", "0123456789.,-+eE\n", {csv}, [](std::string_view bytes) {
            return fault_of(job::parse_measured(bytes, "measured.csv", gear));
          }};
}

/// Results of measuring machines; every point is sought on the flanks of a gear.
std::vector<ByteReader> measured_points_readers() {
  static const face_gear::FaceGear gear = made(spur_parameters());
  const auto grid = inspection::inspection_grid(drawn_solid(gear), {5, 9});
  std::string plain = "# x y z i j k\n", saved = "Point;X [mm];Y [mm];Z [mm]\n",
              dmis = "UNITS/MM,ANGDEC\nFA(C)=FEAT/GSURF\nPTDATA/CART,1,2,3\n";
  for (const auto& p : *grid) {
    plain += fmt::format("{:.4f} {:.4f} {:.4f} {:.6f} {:.6f} {:.6f}\n", p.p.x(), p.p.y(), p.p.z(), p.n.x(), p.n.y(),
                         p.n.z());
    std::string row = fmt::format("\"P 1\";{:.4f};{:.4f};{:.4f}\n", p.p.x(), p.p.y(), p.p.z());
    std::replace(row.begin(), row.end(), '.', ',');
    saved += row;
    dmis += fmt::format("FA(P)=FEAT/POINT,CART,{:.4f},{:.4f},{:.4f},$\n{:.6f},{:.6f},{:.6f}\n", p.p.x(), p.p.y(),
                        p.p.z(), p.n.x(), p.n.y(), p.n.z());
  }
  const auto read = [](std::string_view bytes) {
    const auto text = plain_text(std::string(bytes), "measured.txt");
    return text ? fault_of(job::parse_measured_points(*text, "measured.txt", drawn_solid(gear), 0)) : fault_of(text);
  };
  return {{"measured_plain", "0123456789.,;-+eE \"\t\r\n[]PXYZmin", {plain, saved}, read},
          {"measured_dmis", "0123456789.,-+$()=/FACRTPOLEU \n", {dmis}, read},
          {"measured_setup",
           kToml,
           {"[measured]\norigin = [1, -2.5, 3e1] # mm\nclocking = 0.01\ntouches = 16\n"},
           [](std::string_view bytes) { return fault_of(job::parse_measured_setup(bytes, "part.toml")); }}};
}

/// Files of tools of other programs: a library of FreeCAD names bits, which lie beside it undamaged.
std::vector<ByteReader> tool_library_readers() {
  static const TestDir dir;
  const std::string bit =
      R"({"version": 2, "name": "6mm Ball", "shape": "ballend.fcstd", "attribute": {"Flutes": "2"},)"
      R"( "parameter": {"CuttingEdgeHeight": "12.0 mm", "Diameter": "0.25 in", "ShankDiameter": "6.0 mm"}})";
  write_file(dir / "ball.fctb", bit);
  const std::vector<std::pair<const char*, std::string>> formats = {
      {"tbl", "; tools\nT1 P1 D6.000000 Z+121.500000 ;ball\n\nT12 P12 X+0.1 Z-33.2 D4\r\n"},
      {"json",
       R"({"data": [{"type": "ball end mill", "description": "6", "unit": "inches", "post-process": {"number": 4},)"
       R"( "geometry": {"DC": 6, "LCF": 12, "LB": 40, "SFDM": 6, "NOF": 2}, "holder": {"unit": "inches", "gaugeLength": 80, "segments":)"
       R"( [{"height": 20, "lower-diameter": 24, "upper-diameter": 28}]}}, {"type": "tapered mill", "unit":)"
       R"( "millimeters", "geometry": {"DC": 1.4427, "RE": 0.79375, "TA": 5.5}}]})"},
      {"fctb", bit},
      {"fctl", R"({"version": 1, "tools": [{"nr": 3, "path": "ball.fctb"}]})"}};
  std::vector<ByteReader> readers;
  for (const auto& [ending, seed] : formats)
    readers.push_back({std::string("tools_") + ending,
                       "{}[]\":,.+-0123456789 TPDZmin\n",
                       {seed},
                       [path = dir / (std::string("t.") + ending)](std::string_view bytes) {
                         return fault_of(tool_library::read_tool_library_text(std::string(bytes), path));
                       }});
  return readers;
}

/// REXS files, and what becomes of every gear in them.
ByteReader rexs_reader() {
  static constexpr rexs::Said kSaid{true, true, {}, {}};
  return {"rexs",
          "0123456789.-<>\"/= acdefgimnrtu",
          {file_text(kSource / "tests/rexs/bevel_pair.rexs"), file_text(kSource / "tests/rexs/cylinders.rexs")},
          [](std::string_view bytes) {
            const auto file = rexs::parse_rexs(bytes, "g.rexs");
            if (!file) return fault_of(file);
            for (const rexs::Component* gear : rexs::gears_of(*file)) {
              const auto made = rexs::gear_of(*file, *gear, gear->type == "bevel_gear" ? kSaid : rexs::Said{});
              if (auto fault = fault_of(made ? std::vector<Diagnostic>{} : made.error().errors, made.has_value());
                  !fault.empty())
                return fault;
            }
            return std::string();
          }};
}

/// Points of a gear in any order, put onto their grids.
ByteReader loose_points_reader() {
  static const TestDir dir;
  const std::string named = file_text(kSource / "samples/flank_grid_spur.csv");
  std::string plain = "x y z i j k\n";
  std::istringstream lines(named.substr(named.find('\n') + 1));
  for (std::string line; std::getline(lines, line);)
    plain += line.substr(line.find(',', line.find(',', line.find(',') + 1) + 1) + 1) + "\n";
  return {"loose_points",
          "0123456789.,;-+eE\n",
          {named, plain},
          [](std::string_view bytes) {
            write_file(dir / "p.txt", std::string(bytes));
            return fault_of(proposal::read_points(dir / "p.txt", {}));
          },
          20};  // each writes a file
}

std::string box_stl() {
  mesh::TriangleMesh box;
  for (int k = 0; k < 8; ++k) box.vertices.emplace_back(k & 1 ? 20 : 0, k & 2 ? 30 : 0, k & 4 ? 40 : 0);
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  std::ostringstream out;
  (void)mesh::write_stl(out, box, "box").has_value();
  return out.str();
}

ByteReader mesh_reader(const std::string& name, const std::string& file, const std::string& letters,
                       std::vector<std::string> seeds, int cost) {
  return {name, letters, std::move(seeds),
          [file](std::string_view bytes) {
            const auto mesh = mesh::parse_mesh(bytes, file);
            if (!mesh && mesh.error().message.find("is damaged") != std::string::npos)
              return "only the library saw it: " + mesh.error().text();
            return fault_of(mesh);
          },
          cost};
}

std::vector<ByteReader> mesh_readers() {
  const std::string facet =
      "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 20 0 0\nvertex 0 30 1e1\nendloop\nendfacet\n";
  const std::string obj = "v 0 0 0\nv 20 0 0\nv 0 30 0\nv 0 0 40\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  return {mesh_reader("mesh_stl", "a.stl", "0123456789.-+e \n",
                      {box_stl(), "solid a\n" + facet + facet + "endsolid a\n"}, 1),
          mesh_reader("mesh_obj", "a.obj", "0123456789.-+e/ \nvf", {obj, "mtllib a.mtl\no b\n" + obj}, 5)};
}

/// The forms of one dialect; the first byte chooses among them, so that one fuzzer meets all.
ByteReader nc_reader(const std::string& dialect, const std::vector<PostForm>& forms) {
  std::vector<std::string> seeds;
  for (std::size_t k = 0; k < forms.size(); ++k) {
    const auto program = program_of(forms[k], {sample_path(0.3, forms[k].swing, 4)}, 5, 2);
    const auto text = program ? text_of(forms[k], *program) : Result<text::NcText>(program.error());
    if (text) seeds.push_back(std::string(1, char('0' + k)) + text->text);
  }
  EXPECT_FALSE(seeds.empty()) << dialect;
  return {"nc_" + dialect, "GMXYZACFRQLBL=/+#[]()0123456789.-\n", std::move(seeds), [forms](std::string_view bytes) {
            if (bytes.empty()) return std::string();
            const auto chosen = static_cast<unsigned char>(bytes.front() - '0');
            const machines::Machine m = machine_of(forms[chosen % forms.size()]);
            auto control = controls::control_of(m, standing(), tools());
            control->max_steps = kMostSteps;
            return fault_of(readback::read_back(bytes.substr(1), "program.nc", *control, m, standing(), {.teeth = 5}));
          }};
}

std::vector<ByteReader> nc_readers() {
  std::map<std::string, std::vector<PostForm>> by_dialect;
  for (const PostForm& form : post_forms())
    if (by_dialect[form.dialect].size() < 70) by_dialect[form.dialect].push_back(form);
  std::vector<ByteReader> readers;
  for (const auto& [dialect, forms] : by_dialect) readers.push_back(nc_reader(dialect, forms));
  return readers;
}

std::vector<ByteReader> gearbox_readers() {
  std::vector<ByteReader> readers;
  for (const char* dialect : {"fanuc", "siemens"}) {
    auto machine = shaper::read_shaper_machine((kSource / "machines/data/shaper_").string() + dialect + ".toml");
    EXPECT_TRUE(machine.machine) << to_text(machine.errors);
    const auto setup = shaper_setup(shaper_work(), *machine.machine);
    readers.push_back({std::string("gearbox_") + dialect,
                       "GMXYZACFRQ=/+(),0123456789.-\n",
                       {shaper::shaper_program(setup)},
                       [setup](std::string_view bytes) {
                         for (const std::string& fault : shaper::gearbox_program_faults(bytes, setup))
                           if (fault.empty()) return std::string("a fault without words");
                         return std::string();
                       }});
  }
  return readers;
}

std::vector<ByteReader> all_readers() {
  std::vector<ByteReader> readers = {job_reader(),      machine_reader(), shaper_machine_reader(), meridian_reader(),
                                     measured_reader(), grid_reader(),    touches_reader(),        shards_reader(),
                                     study_reader(),    rexs_reader(),    loose_points_reader()};
  for (const auto& group :
       {measured_points_readers(), tool_library_readers(), mesh_readers(), nc_readers(), gearbox_readers()})
    readers.insert(readers.end(), group.begin(), group.end());
  return readers;
}

/// What fuzzers found, each mended: tests/fuzz/found/READER.WHAT joins the seeds.
std::vector<ByteReader> with_findings(std::vector<ByteReader> readers) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(kSource / "tests/fuzz/found")) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  for (const auto& path : paths) {
    const auto reader = std::find_if(readers.begin(), readers.end(),
                                     [&](const ByteReader& r) { return r.name == path.stem().string(); });
    if (reader == readers.end()) ADD_FAILURE() << path << " names no reader";
    else reader->seeds.push_back(file_text(path));
  }
  return readers;
}

}  // namespace

const std::vector<ByteReader>& fuzzed_readers() {
  static const std::vector<ByteReader> readers = with_findings(all_readers());
  return readers;
}

}  // namespace toothpath::test
