#include "app/process/gear_files.h"

#include <algorithm>
#include <sstream>

namespace toothpath::process {
namespace {

constexpr std::size_t kLongestTitle = 80;  // of the format

template <typename Mesh>
Result<std::string> stl_of(const Mesh& mesh, const std::string& job_name) {
  std::string title = "toothpath gear " + job_name;
  title.resize(std::min(title.size(), kLongestTitle));
  std::ostringstream out;
  if (const auto counts = mesh::write_stl(out, mesh, title); !counts) return counts.error();
  return std::move(out).str();
}

}  // namespace

Result<std::string> stl_text(const mesh::ToothMesh& pitch, const std::string& job_name) {
  return stl_of(pitch, job_name);
}
Result<std::string> stl_text(const mesh::TriangleMesh& gear, const std::string& job_name) {
  return stl_of(gear, job_name);
}

Result<std::string> vtp_text(const mesh::TriangleMesh& pitch, const std::vector<double>& patches) {
  const std::vector<mesh::PointField> fields = {{"patch", patches}};
  std::ostringstream out;
  if (const auto written = mesh::write_vtp(out, pitch, fields); !written) return written.error();
  return std::move(out).str();
}

Status GearFiles::write(const std::string& name, const Result<std::string>& content) {
  if (!content) return content.error();
  names_.push_back(name);
  return output_.write(name, *content);
}

}  // namespace toothpath::process
