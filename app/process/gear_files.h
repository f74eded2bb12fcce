// Files that describe a finished gear, as far as they are made in the same way for every kind: meshes as text, and the
// list of what was written.
#pragma once

#include <string>
#include <vector>

#include "app/base/output_dir.h"
#include "geometry/mesh/file.h"

namespace toothpath::process {

/// gear.stl: all copies of the pitch, or the mesh of all teeth; the job's name in its title.
[[nodiscard]] Result<std::string> stl_text(const mesh::ToothMesh& pitch, const std::string& job_name);
[[nodiscard]] Result<std::string> stl_text(const mesh::TriangleMesh& gear, const std::string& job_name);

/// tooth.vtp: the mesh of one pitch with the number of the patch at every vertex.
[[nodiscard]] Result<std::string> vtp_text(const mesh::TriangleMesh& pitch, const std::vector<double>& patches);

/// Files of one output directory; their names join the list.
class GearFiles {
 public:
  GearFiles(app::OutputDir& output, std::vector<std::string>& names) : output_(output), names_(names) {}
  /// The content, or why there is none.
  Status write(const std::string& name, const Result<std::string>& content);

 private:
  app::OutputDir& output_;
  std::vector<std::string>& names_;
};

}  // namespace toothpath::process
