// The Python module `toothpath`: jobs are run, and their gears asked, from Python. What it returns is converted here
// and nowhere else; nothing is calculated.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>
#include <tbb/global_control.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>

#include "app/commands/run.h"
#include "app/job/file.h"
#include "app/process/flow/registry.h"
#include "geometry/base/inputs_read.h"

namespace toothpath::python {
namespace {

namespace py = pybind11;
using namespace pybind11::literals;
using Numbers = py::array_t<double>;

py::object from_json(const std::string& text) { return py::module_::import("json").attr("loads")(text); }

/// Raises the Python exception of these refusals: its text holds them all, `diagnostics` each as (file, line, column,
/// message).
[[noreturn]] void raise(const std::vector<Diagnostic>& errors) {
  const bool file = !errors.empty() && errors.front().kind == DiagnosticKind::file_access;
  const py::object type = py::module_::import("toothpath").attr(file ? "FileAccessError" : "RefusedError");
  std::string text = to_text(errors);
  while (text.ends_with('\n')) text.pop_back();
  const py::object error = type(py::bytes(text).attr("decode")("utf-8", "replace"));
  py::list list;
  for (const Diagnostic& d : errors)
    list.append(py::make_tuple(d.position.file, d.position.line, d.position.column, d.message));
  error.attr("diagnostics") = list;
  PyErr_SetObject(type.ptr(), error.ptr());
  throw py::error_already_set();
}

template <typename T>
T value_or_raise(Expected<T, std::vector<Diagnostic>> made) {
  if (auto* errors = made.refused()) raise(*errors);
  return std::move(made).value();
}
template <typename T>
T value_or_raise(Result<T> made) {
  if (auto* error = made.refused()) raise({*error});
  return std::move(made).value();
}

/// (rows, columns, 3) of row-major points.
Numbers array_of(const std::vector<Vec3>& points, int rows, int columns) {
  Numbers out({rows, columns, 3});
  auto to = out.mutable_unchecked<3>();
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      for (int k = 0; k < 3; ++k) to(r, c, k) = points[static_cast<std::size_t>(r * columns + c)][k];
  return out;
}

template <typename Cell>
Numbers array_of(const std::vector<Cell>& cells, int rows, int columns) {
  Numbers out({rows, columns});
  auto to = out.mutable_unchecked<2>();
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) to(r, c) = static_cast<double>(cells[static_cast<std::size_t>(r * columns + c)]);
  return out;
}

/// Points of one flank, or of a patch of the cut surface.
struct Grid {
  int zone = 0, rows = 0, columns = 0;
  py::object side;
  Numbers points, normals;
};

/// A side as files call it: a number, or the letter of a wall.
py::object side_of(const inspection::FlankNames& names, int side) {
  const std::string word = side > 0 ? names.plus : names.minus;
  return word == std::to_string(side) ? py::object(py::int_(side)) : py::object(py::str(word));
}

std::vector<Grid> grids_of(const process::InspectedFlanks& flanks) {
  const auto& [rows, columns, margin] = flanks.grid;
  const std::size_t count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  std::vector<Grid> out;
  for (std::size_t first = 0; first + count <= flanks.points.size(); first += count) {
    std::vector<Vec3> p, n;
    for (std::size_t k = first; k < first + count; ++k) {
      p.push_back(flanks.points[k].p);
      n.push_back(flanks.points[k].n);
    }
    out.push_back({flanks.points[first].zone, rows, columns, side_of(flanks.names, flanks.points[first].side),
                   array_of(p, rows, columns), array_of(n, rows, columns)});
  }
  return out;
}

/// A value as a job file says it, on one line.
std::string toml_of(const py::handle& value) {
  const auto joined = [](const auto& items, const char* open, const char* close, const auto& text) {
    std::string out;
    for (const auto& item : items) out += (out.empty() ? "" : ", ") + text(item);
    return open + out + close;
  };
  const auto said = [](const py::handle& text) {
    return py::module_::import("json").attr("dumps")(text, "ensure_ascii"_a = false).cast<std::string>();
  };
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (PyIndex_Check(value.ptr()))
    return py::repr(py::int_(py::reinterpret_borrow<py::object>(value))).cast<std::string>();
  if (py::isinstance<py::float_>(value)) return py::repr(py::float_(value.cast<double>())).cast<std::string>();
  if (py::isinstance<py::str>(value)) return said(value);
  if (py::isinstance<py::dict>(value))
    return joined(value.cast<py::dict>(), "{", "}",
                  [&](const auto& entry) { return said(py::str(entry.first)) + " = " + toml_of(entry.second); });
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value))
    return joined(value.cast<py::sequence>(), "[", "]", [](const auto& item) { return toml_of(item); });
  throw py::type_error(fmt::format("a job holds text, numbers, truth values, lists and dicts, not {}",
                                   py::repr(py::type::of(value)).cast<std::string>()));
}

/// A dict as a job file, a key a line. What names a schema or a job may be left out.
std::string job_text_of(const py::dict& job) {
  std::string text;
  if (!job.contains("schema")) text += "schema = 1\n";
  if (!job.contains("name")) text += "name = \"gear\"\n";
  for (const auto& [key, value] : job)
    text += fmt::format("{} = {}\n", py::str(key).cast<std::string>(), toml_of(value));
  return text;
}

/// The gear of a job; plans nothing.
class Gear {
 public:
  explicit Gear(const std::filesystem::path& file) : Gear(value_or_raise(job::read_job_file(file.string()))) {}
  explicit Gear(const py::dict& job) : Gear(value_or_raise(job::parse_job(job_text_of(job), "dict"))) {}
  Gear(const Gear&) = delete;  // the gear refers to its job
  Gear& operator=(const Gear&) = delete;

  [[nodiscard]] std::string name() const { return job_.name; }
  [[nodiscard]] std::string type() const { return job_.gear_type(); }
  [[nodiscard]] int teeth() const { return gear_->part().teeth; }
  [[nodiscard]] std::vector<std::string> warnings() const { return gear_->part().warnings; }
  [[nodiscard]] py::object limits() const { return from_json(gear_->limits_json()); }
  [[nodiscard]] std::vector<Grid> flanks(std::optional<int> rows, std::optional<int> columns,
                                         std::optional<double> margin) const {
    return grids_of(value_or_raise(gear_->inspected({rows, columns, margin})));
  }

 private:
  explicit Gear(job::Job job) : job_(std::move(job)), gear_(value_or_raise(flow::make_process(job_))) {}

  job::Job job_;
  std::unique_ptr<process::GearProcess> gear_;
};

/// What a run found out, and where its files are.
struct Report {
  report::RunReport report;
  std::vector<proof::SurfaceGrid> surface;
  std::string json, summary;

  [[nodiscard]] std::optional<double> um(std::optional<double> mm) const {
    return mm ? std::optional(*mm * 1e3) : std::nullopt;
  }
  [[nodiscard]] py::object path_of(const std::string& name) const {
    return py::module_::import("pathlib").attr("Path")(report.directory) / py::str(name);
  }
};

Report run(const std::filesystem::path& job, const std::filesystem::path& out, const std::string& restart,
           const std::vector<std::filesystem::path>& measured, std::optional<int> threads) {
  commands::RunRequest request;
  Report made;
  request.quiet = true;
  request.job_file = job.string();
  request.out_dir = out.string();
  request.restart = restart;
  for (const auto& file : measured) request.measured.files.push_back(file.string());
  request.finished = [&made](flow::Run& run) {
    made.report = run.report;
    made.surface = std::move(run.surface);
  };
  if (threads && (*threads < 1 || *threads > 1024))
    throw py::value_error(fmt::format("threads = {} is not from 1 to 1024", *threads));
  commands::CommandOutcome outcome;
  {
    const py::gil_scoped_release others_go_on;
    static std::mutex one_at_a_time;  // a process has one output directory at a time, and one list of inputs
    const std::lock_guard lock(one_at_a_time);
    forget_inputs_read();
    std::optional<tbb::global_control> limit;
    if (threads) limit.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(*threads));
    outcome = commands::run_job(request);
    commands::name_file(outcome.errors, request.job_file);
  }
  if (outcome.report_json.empty()) raise(outcome.errors);
  made.json = std::move(outcome.report_json);
  made.summary = std::move(outcome.summary);
  return made;
}

void add_surface(py::module_& m) {
  py::class_<Grid>(m, "Flank", "Nominal points of one flank of tooth space 0, gear frame, mm.")
      .def_readonly("zone", &Grid::zone, "ring or half, from the inside")
      .def_readonly("side", &Grid::side, "+1 or -1; of bevel gears \"L\" or \"U\"")
      .def_readonly("points", &Grid::points, "(rows, columns, 3): row 0 nearest the fillet, column 0 the gear axis")
      .def_readonly("normals", &Grid::normals, "(rows, columns, 3), unit, out of the material");
  using proof::SurfaceGrid;
  py::class_<SurfaceGrid>(m, "Surface", "A patch of tooth space 0 as the program cuts it, gear frame, mm.")
      .def_readonly("zone", &SurfaceGrid::zone)
      .def_property_readonly("patch", [](const SurfaceGrid& g) { return to_string(g.patch); })
      .def_property_readonly(
          "points", [](const SurfaceGrid& g) { return array_of(g.points, g.rows, g.columns); },
          "(rows, columns, 3) of the exact surface")
      .def_property_readonly(
          "normals", [](const SurfaceGrid& g) { return array_of(g.normals, g.rows, g.columns); },
          "(rows, columns, 3), unit, out of the material")
      .def_property_readonly(
          "deviation_um",
          [](const SurfaceGrid& g) {
            return array_of(g.excess_um.empty() ? std::vector<float>() : g.excess_um.back(),
                            g.excess_um.empty() ? 0 : g.rows, g.columns);
          },
          "(rows, columns) after the last operation: > 0 left, < 0 too deep")
      .def_property_readonly(
          "deviation_um_of_operations",
          [](const SurfaceGrid& g) {
            std::vector<Numbers> out;
            for (const auto& field : g.excess_um) out.push_back(array_of(field, g.rows, g.columns));
            return out;
          },
          "a list of (rows, columns), after each operation")
      .def_property_readonly(
          "reachable",
          [](const SurfaceGrid& g) { return array_of(g.reachable, g.rows, g.columns).attr("astype")("bool"); },
          "(rows, columns), False where the finishing ball cannot come");
}

void add_report(py::module_& m) {
  py::class_<Report>(m, "Report", "What a run found out.")
      .def_property_readonly("verified", [](const Report& r) { return r.report.verified; })
      .def_property_readonly("verdict", [](const Report& r) { return report::verdict_text(r.report); })
      .def_property_readonly(
          "reasons", [](const Report& r) { return r.report.reasons; }, "why it is not verified")
      .def_property_readonly(
          "worst_gouge_um",
          [](const Report& r) {
            return r.um(r.report.gouge ? std::optional(r.report.gouge->measured_mm) : std::nullopt);
          },
          "deepest cut that was found; None where the run did not get so far")
      .def_property_readonly(
          "worst_gouge_bound_um",
          [](const Report& r) { return r.um(r.report.gouge ? std::optional(r.report.gouge->bound_mm) : std::nullopt); },
          "nothing is deeper: proven")
      .def_property_readonly(
          "worst_left_um",
          [](const Report& r) {
            return r.um(r.report.finished ? std::optional(r.report.finished->max_mm) : std::nullopt);
          },
          "highest material left on the finished surface")
      .def_property_readonly(
          "worst_left_bound_um",
          [](const Report& r) {
            return r.um(r.report.finished ? std::optional(r.report.finished->bound_mm) : std::nullopt);
          },
          "nothing stands higher: proven")
      .def_property_readonly(
          "cutting_minutes", [](const Report& r) { return r.report.feed_minutes; }, "without rapids")
      .def_property_readonly("total_minutes", [](const Report& r) { return r.report.total_minutes; })
      .def_property_readonly(
          "program",
          [](const Report& r) -> py::object {
            return r.report.program_file.empty() ? py::object(py::none()) : r.path_of(r.report.program_file);
          },
          "path of the NC program; None where it was not proven")
      .def_property_readonly(
          "files",
          [](const Report& r) {
            py::dict out;
            for (const auto& name : r.report.files) out[py::str(name)] = r.path_of(name);
            return out;
          },
          "name to path, of all files of the run")
      .def_property_readonly(
          "json", [](const Report& r) { return from_json(r.json); }, "report.json as a dict")
      .def_property_readonly(
          "summary", [](const Report& r) { return r.summary; }, "the table that the program prints")
      .def_readonly("surface", &Report::surface, "list of Surface: the deviation map")
      .def("__repr__", [](const Report& r) {
        return fmt::format("<toothpath.Report of \"{}\": {}>", r.report.job_name, report::verdict_text(r.report));
      });
}

}  // namespace

PYBIND11_MODULE(toothpath, m) {
  m.doc() =
      "CAM system for gear teeth: jobs run and their gears asked from Python. Lengths in mm unless a name says um.";
  m.attr("__version__") = TOOTHPATH_VERSION;
  const py::exception<std::runtime_error> error(m, "Error");
  py::exception<std::runtime_error>(m, "RefusedError", error.ptr()).attr("__doc__") =
      "The job, or a file that it names, is refused. `diagnostics`: (file, line, column, message) of each finding.";
  py::exception<std::runtime_error>(m, "FileAccessError", error.ptr()).attr("__doc__") =
      "A file cannot be read or written. `diagnostics` as of RefusedError.";
  add_surface(m);
  add_report(m);
  py::class_<Gear>(
      m, "Gear",
      "The gear of a job: a file, or a dict with the same keys, Gear({\"gear\": {\"type\": ..}}); files that "
      "a dict names lie in the current directory. Raises RefusedError or FileAccessError.")
      .def(py::init<const py::dict&>(), "job"_a)
      .def(py::init<const std::filesystem::path&>(), "job"_a)
      .def_property_readonly("name", &Gear::name)
      .def_property_readonly("type", &Gear::type, "as job files say it: \"face_gear\"")
      .def_property_readonly("teeth", &Gear::teeth)
      .def_property_readonly("warnings", &Gear::warnings)
      .def_property_readonly("limits", &Gear::limits, "limits.json as a dict")
      .def(
          "flanks", &Gear::flanks, "rows"_a = py::none(), "columns"_a = py::none(), "margin"_a = py::none(),
          "Exact points and normals of all flanks of tooth space 0, a list of Flank, by zone and side. Without numbers "
          "those of inspection.csv. rows: along the profile, columns: along the face width, margin: part of both that "
          "is "
          "kept clear at each edge.");
  m.def("run", &run, "job"_a, "out"_a, py::kw_only(), "restart"_a = "",
        "measured"_a = std::vector<std::filesystem::path>(), "threads"_a = py::none(),
        "Plans, writes and proves the program of a job file into the folder `out`, as `toothpath run`; with measured "
        "files "
        "as `toothpath correct`. Returns a Report, also of a program that is not verified (then there is none). Raises "
        "RefusedError or FileAccessError. Other Python threads go on meanwhile; Ctrl-C waits for its end.");
}

}  // namespace toothpath::python
