// One entry of a zip archive: .tools of Fusion is one with a JSON text in it.
// Source: PKWARE, .ZIP File Format Specification (APPNOTE), 4.3; RFC 1951 by zlib.
#include <zlib.h>

#include <algorithm>
#include <cstdint>

#include "app/tool_library/formats.h"

namespace toothpath::tool_library {
namespace {

constexpr std::size_t kEndBytes = 22, kEntryBytes = 46, kLocalBytes = 30;
constexpr std::uint32_t kEndMark = 0x06054b50, kEntryMark = 0x02014b50, kLocalMark = 0x04034b50;

/// Little-endian numbers; 0 beyond the end, which no mark and no length is taken for.
class Bytes {
 public:
  explicit Bytes(std::string_view all) : all_(all) {}
  [[nodiscard]] std::uint32_t number(std::size_t at, std::size_t count) const {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < count && at + k < all_.size(); ++k)
      value |= std::uint32_t(static_cast<unsigned char>(all_[at + k])) << (8 * k);
    return value;
  }
  [[nodiscard]] std::string_view part(std::size_t at, std::size_t count) const {
    return at <= all_.size() && count <= all_.size() - at ? all_.substr(at, count) : std::string_view();
  }
  [[nodiscard]] std::size_t size() const { return all_.size(); }

 private:
  std::string_view all_;
};

Result<std::string> inflated(std::string_view packed, std::size_t size, const std::string& path) {
  std::string out(size, '\0');
  z_stream stream{};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // zlib does not write there
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) return fail_at({path, 0, 0}, "the archive cannot be unpacked");
  const int ended = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  if (ended != Z_STREAM_END || stream.total_out != size) return fail_at({path, 0, 0}, "the archive is damaged");
  return out;
}

}  // namespace

Result<std::string> unzipped(const std::string& text, std::string_view ending, const std::string& path) {
  const Bytes bytes(text);
  const SourcePosition at{path, 0, 0};
  std::size_t end = bytes.size() >= kEndBytes ? bytes.size() - kEndBytes : 0;
  while (end > 0 && bytes.number(end, 4) != kEndMark) --end;
  if (bytes.number(end, 4) != kEndMark) return fail_at(at, "this is no zip archive");
  std::size_t entry = bytes.number(end + 16, 4);
  for (std::uint32_t left = bytes.number(end + 10, 2); left > 0; --left) {
    if (bytes.number(entry, 4) != kEntryMark) return fail_at(at, "the archive is damaged");
    const std::size_t name_size = bytes.number(entry + 28, 2);
    const std::uint32_t method = bytes.number(entry + 10, 2), packed_size = bytes.number(entry + 20, 4),
                        size = bytes.number(entry + 24, 4);
    if (bytes.part(entry + kEntryBytes, name_size).ends_with(ending)) {
      const std::size_t local = bytes.number(entry + 42, 4);
      if (bytes.number(local, 4) != kLocalMark) return fail_at(at, "the archive is damaged");
      if (size > kMostToolBytes) return fail_at(at, "is longer than {} bytes unpacked", kMostToolBytes);
      const std::string_view packed =
          bytes.part(local + kLocalBytes + bytes.number(local + 26, 2) + bytes.number(local + 28, 2), packed_size);
      if (packed.size() != packed_size) return fail_at(at, "the archive is damaged");
      if (method == 0) return std::string(packed);
      if (method == 8) return inflated(packed, size, path);
      return fail_at(at, "the archive is packed by method {}, must be 8 (deflate) or 0", method);
    }
    entry += kEntryBytes + name_size + bytes.number(entry + 30, 2) + bytes.number(entry + 32, 2);
  }
  return fail_at(at, "the archive has no file that ends with \"{}\"", ending);
}

}  // namespace toothpath::tool_library
