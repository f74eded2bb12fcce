#include "machines/toml/input_text.h"

#include "geometry/base/plain_text.h"
#include "machines/toml/regular_file.h"

namespace toothpath::toml {

Result<std::string> read_input_text(const std::string& path, std::size_t max_bytes) {
  auto bytes = read_input_file(path, max_bytes);
  if (!bytes) return bytes.error();
  return plain_text(std::move(*bytes), path);
}

}  // namespace toothpath::toml
