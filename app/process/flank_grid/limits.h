// What limits a gear by points and its tools: limits.json, a chart for the page, rows of the ledger.
#pragma once

#include <string>
#include <vector>

#include "app/report/svg/chart.h"
#include "cam/proof/verification.h"
#include "geometry/flank_grid/gear.h"

namespace toothpath::flank_grid {

/// limits.json: the limits of both flanks (milled::ring_zone), and how well the points know them.
[[nodiscard]] std::string limits_json(const FlankGridGear& gear);

/// Top land and root land along the teeth.
[[nodiscard]] svg::LineChart limit_chart(const FlankGridGear& gear);

/// How far the points lie apart, how far the flanks go on beyond them, and how far given normals are off.
[[nodiscard]] std::vector<proof::LedgerEntry> point_ledger(const FlankGridGear& gear);

}  // namespace toothpath::flank_grid
