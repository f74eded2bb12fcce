// The report for people: one self-contained HTML page with a 3D view of the tooth space, plots and tables.
//
// The page opens from disk, loads nothing and needs a browser with WebGL2 for the 3D view only; plots and tables are
// plain SVG and HTML. All points are in the gear frame, tooth space 0. Fields left empty leave their part of the page
// out.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/report/page/machine_scene.h"
#include "app/report/section.h"
#include "app/report/svg/chart.h"
#include "cam/path/cl_path.h"
#include "cam/proof/verification.h"
#include "geometry/base/result.h"
#include "geometry/base/vec.h"

namespace toothpath::page {

/// A number at the top of the page.
struct KeyFigure {
  enum class State { plain, good, bad };
  std::string name;   ///< "worst gouge"
  std::string value;  ///< "0.42", formatted by the caller
  std::string unit;   ///< "um", may be empty
  std::string note;   ///< "bound 0.91, tolerance 2.00", may be empty
  State state = State::plain;
};

/// A body of revolution of a tool assembly.
struct PageToolBody {
  std::string name;           ///< "ball", "flute", "shank", "holder": as in WorstPlace::body
  std::vector<Vec2> profile;  ///< (radius, height above the tip) [mm], from the tip side upwards
  bool cutting = false;       ///< drawn opaque; the others are translucent
};

struct PageTool {
  std::string name;  ///< "T1 ball 2.0 mm"
  std::vector<PageToolBody> bodies;
};

/// The path of one operation. Tool and operation numbers come from the ClPath.
struct PagePath {
  path::ClPath cl;
  std::vector<int> nc_lines;  ///< line of the NC program for every record, 0 where unknown; may be empty
};

/// Consecutive lines of the NC program.
struct NcExcerpt {
  int first_line = 1;
  std::vector<std::string> lines;
};

struct PageTable {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  ///< cells that read as numbers are set right-aligned
  std::string note;                            ///< may be empty
};

/// Everything the page shows.
struct ReportPage {
  std::string title;     ///< job name
  std::string subtitle;  ///< one line: gear, machine, program version; may be empty
  bool verified = false;
  std::string verdict;               ///< report::verdict_text
  std::string unfinished;            ///< what a verified program leaves out of its ball's reach; empty: nothing
  std::vector<std::string> reasons;  ///< why the program is not verified
  std::vector<std::string> warnings;
  std::vector<std::string> assumed;  ///< values that the job did not give
  std::vector<KeyFigure> figures;
  std::vector<std::pair<std::string, std::string>> summary;  ///< name and value

  std::vector<proof::SurfaceGrid> surface;
  std::vector<PagePath> paths;          ///< in the job's order; the names of operations are taken from here
  std::optional<MachineScene> machine;  ///< the gear on its machine
  std::vector<PageTool> tools;          ///< in the job's order: ClPath::tool is an index into this list

  std::optional<proof::GougeResult> gouge;  ///< its `worst` places become markers
  double gouge_tolerance_mm = 0;
  std::string nc_file;             ///< name of the program, "program.ngc"; empty where none was written
  std::vector<NcExcerpt> listing;  ///< ascending, without overlap; see nc_excerpts()

  std::vector<proof::ExcessResult> excess;  ///< one histogram an operation
  std::optional<proof::ExcessResult> finished;
  std::vector<proof::LedgerEntry> ledger;
  std::vector<proof::DirectionChoice> directions;
  std::optional<svg::HistogramChart> block_times;  ///< how long the cutting blocks take
  std::vector<svg::LineChart> motion;  ///< axis positions, speeds and feed over time; any length, thinned by the writer
  std::vector<svg::LineChart> gear_limits;     ///< where the flanks of the gear end
  std::vector<svg::LineChart> work_precision;  ///< from the study, when there is one
  std::string contact;  ///< body of the section on contact with the pinion, finished markup; may be empty
  std::vector<std::pair<std::string, double>> stage_seconds;
  std::vector<report::Section> sections;  ///< those with an id; a section of the page each
  std::vector<PageTable> tables;
};

/// Lines of `program` within `around` lines of any of `lines` (counted from 1; 0 and lines beyond the end are ignored),
/// joined where they touch. CR at line ends is dropped.
[[nodiscard]] std::vector<NcExcerpt> nc_excerpts(std::string_view program, const std::vector<int>& lines,
                                                 int around = 8);

/// The page as one HTML text (UTF-8). Same input, same bytes. Fails where lengths contradict each other: a grid whose
/// points, normals or fields are not rows x columns, a tool index without a tool, line numbers not one a record, a
/// point that is not finite.
[[nodiscard]] Result<std::string> render_report_page(const ReportPage& page);

/// Renders and writes `file`; on failure no file of that name is left behind.
[[nodiscard]] Status write_report_page(const ReportPage& page, const std::filesystem::path& file);

}  // namespace toothpath::page
