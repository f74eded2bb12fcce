// Writers of geometry/mesh/file.h.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>
#include <ostream>
#include <vector>

#include "geometry/mesh/file.h"

namespace toothpath::mesh {
namespace {

static_assert(std::endian::native == std::endian::little, "STL and the raw part of VTP are written in memory order");

using Float3 = std::array<float, 3>;

Float3 rounded(const Vec3& p) {
  return {static_cast<float>(p.x()) + 0.0f, static_cast<float>(p.y()) + 0.0f, static_cast<float>(p.z()) + 0.0f};
}

bool collapsed(const Float3& a, const Float3& b, const Float3& c) { return a == b || b == c || c == a; }

Diagnostic stream_failed(const char* format) {
  return fail_as(DiagnosticKind::file_access, "the {} file could not be written", format);
}

/// Facets go out in blocks; one virtual call a block.
class StlStream {
 public:
  explicit StlStream(std::ostream& out) : out_(out) { block_.reserve(kBlock + kFacet); }

  void header(std::string_view title, std::uint32_t facets) {
    std::array<char, 84> head{};
    std::copy_n(title.begin(), std::min<std::size_t>(title.size(), 80), head.begin());
    std::memcpy(head.data() + 80, &facets, 4);
    out_.write(head.data(), std::ssize(head));
  }
  void facet(const Float3& a, const Float3& b, const Float3& c) {
    const Vec3 p(a[0], a[1], a[2]), n = (Vec3(b[0], b[1], b[2]) - p).cross(Vec3(c[0], c[1], c[2]) - p);
    const double length = n.norm();
    const Float3 normal = length > 0 ? rounded(n / length) : Float3{0, 0, 0};
    std::array<char, kFacet> bytes{};
    std::size_t at = 0;
    for (const Float3* v : {&normal, &a, &b, &c}) {
      std::memcpy(bytes.data() + at, v->data(), 12);
      at += 12;
    }
    block_.insert(block_.end(), bytes.begin(), bytes.end());
    if (block_.size() >= kBlock) flush();
  }
  void flush() {
    out_.write(block_.data(), std::ssize(block_));
    block_.clear();
  }

 private:
  static constexpr std::size_t kFacet = 50, kBlock = kFacet * 4096;
  std::ostream& out_;
  std::vector<char> block_;
};

/// `corners_of(copy)` gives the vertices of a copy in 32-bit numbers.
template <typename Corners>
Result<StlCounts> write_copies(std::ostream& out, const TriangleMesh& mesh, int copies, std::string_view title,
                               Corners corners_of) {
  if (title.starts_with("solid")) return fail("STL title \"{}\" begins with \"solid\", which marks a text file", title);
  if (title.size() > 80) return fail("STL title has {} bytes; the limit is 80", title.size());
  StlCounts counts;
  const auto for_each_facet = [&](auto&& use) {
    for (int k = 0; k < copies; ++k) {
      const std::vector<Float3> v = corners_of(k);
      for (const auto& t : mesh.triangles) use(v[std::size_t(t[0])], v[std::size_t(t[1])], v[std::size_t(t[2])]);
    }
  };
  for_each_facet([&](const Float3& a, const Float3& b, const Float3& c) {
    ++(collapsed(a, b, c) ? counts.collapsed : counts.facets);
  });
  if (counts.facets > std::numeric_limits<std::uint32_t>::max())
    return fail("the mesh has {} facets; a binary STL holds {}", counts.facets,
                std::numeric_limits<std::uint32_t>::max());
  StlStream stl(out);
  stl.header(title, static_cast<std::uint32_t>(counts.facets));
  for_each_facet([&](const Float3& a, const Float3& b, const Float3& c) {
    if (!collapsed(a, b, c)) stl.facet(a, b, c);
  });
  stl.flush();
  if (!out) return stream_failed("STL");
  return counts;
}

}  // namespace

Result<StlCounts> write_stl(std::ostream& out, const ToothMesh& pitch, std::string_view title) {
  return write_copies(out, pitch.mesh, pitch.teeth, title, [&](int k) {
    std::vector<Float3> v(pitch.mesh.vertices.size());
    for (std::size_t j = 0; j < v.size(); ++j) v[j] = rounded(pitch.vertex_of_copy(j, k));
    return v;
  });
}

Result<StlCounts> write_stl(std::ostream& out, const TriangleMesh& mesh, std::string_view title) {
  return write_copies(out, mesh, 1, title, [&](int) {
    std::vector<Float3> v(mesh.vertices.size());
    std::transform(mesh.vertices.begin(), mesh.vertices.end(), v.begin(), rounded);
    return v;
  });
}

Status write_vtp(std::ostream& out, const TriangleMesh& mesh, std::span<const PointField> fields) {
  const std::size_t points = mesh.vertices.size(), cells = mesh.triangles.size();
  for (const PointField& f : fields) {
    if (f.values.size() != points)
      return fail("field \"{}\" has {} values; the mesh has {} vertices", f.name, f.values.size(), points);
    if (f.name.find_first_of("<>&\"\n") != std::string::npos)
      return fail("field name \"{}\" holds a character that XML reserves", f.name);
  }
  std::uint64_t offset = 0;
  const auto array = [&](std::string_view type, std::string_view name, int components, std::size_t bytes) {
    const std::string text = fmt::format(
        "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"appended\" offset=\"{}\"/>\n",
        type, name, components, offset);
    offset += 8 + bytes;
    return text;
  };
  out << "<?xml version=\"1.0\"?>\n"
         "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  "
         "<PolyData>\n"
      << fmt::format(
             "    <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" "
             "NumberOfPolys=\"{}\">\n",
             points, cells)
      << "      <Points>\n"
      << array("Float64", "Points", 3, points * 24) << "      </Points>\n      <PointData>\n";
  for (const PointField& f : fields) out << array("Float64", f.name, 1, points * 8);
  out << "      </PointData>\n      <Polys>\n"
      << array("Int64", "connectivity", 1, cells * 24) << array("Int64", "offsets", 1, cells * 8)
      << "      </Polys>\n    </Piece>\n  </PolyData>\n  <AppendedData encoding=\"raw\">\n_";

  const auto raw = [&](const void* data, std::size_t bytes) {
    const std::uint64_t size = bytes;
    out.write(reinterpret_cast<const char*>(&size), 8);
    out.write(static_cast<const char*>(data), static_cast<std::streamsize>(bytes));
  };
  static_assert(sizeof(Vec3) == 24);
  raw(mesh.vertices.data(), points * 24);
  for (const PointField& f : fields) raw(f.values.data(), points * 8);
  std::vector<std::int64_t> numbers;
  numbers.reserve(3 * cells);
  for (const auto& t : mesh.triangles) numbers.insert(numbers.end(), t.begin(), t.end());
  raw(numbers.data(), cells * 24);
  numbers.resize(cells);
  for (std::size_t k = 0; k < cells; ++k) numbers[k] = static_cast<std::int64_t>(3 * (k + 1));
  raw(numbers.data(), cells * 8);
  out << "\n  </AppendedData>\n</VTKFile>\n";
  if (!out) return stream_failed("VTP");
  return Ok{};
}

}  // namespace toothpath::mesh
