// make_page KIND FILE: writes a synthetic report page for the browser test. KIND: gouged, clean, awkward, large, plots,
// below, machine.
#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "tests/app/page/synthetic_page.h"

int main(int argc, char** argv) {
  using namespace toothpath;
  if (argc != 3) {
    fmt::print(stderr, "usage: make_page gouged|clean|awkward|large|plots|below|machine FILE\n");
    return 2;
  }
  const std::string kind = argv[1];
  test::SyntheticPageOptions options;
  if (kind == "clean") options = {4000, false, true, false, false};
  if (kind == "below") options = {4000, false, false, false, false};
  if (kind == "awkward") options = {2000, true, false, true, true};
  if (kind == "large") options = {300000, true, false, false, true};
  page::ReportPage page = test::synthetic_page(options);
  if (kind == "below")  // the same work, turned by 180 degrees about x
    for (auto& path : page.paths)
      for (auto& record : path.cl.records)
        for (Vec3* v : {&record.tip, &record.axis}) *v = Vec3(v->x(), -v->y(), -v->z());
  if (kind == "below")
    for (auto& grid : page.surface)
      for (auto* points : {&grid.points, &grid.normals})
        for (Vec3& v : *points) v = Vec3(v.x(), -v.y(), -v.z());
  if (kind == "plots") {
    page.surface.clear();
    page.paths.clear();
    page.gouge.reset();
    page.listing.clear();
    page.directions.clear();
  }
  if (kind == "machine") page.machine = test::synthetic_machine();
  const Status status = page::write_report_page(page, argv[2]);
  if (!status) fmt::print(stderr, "{}\n", status.error().text());
  return status ? 0 : 1;
}
