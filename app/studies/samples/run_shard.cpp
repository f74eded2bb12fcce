#include "app/studies/samples/run_shard.h"

#include <algorithm>

#include "geometry/base/hash.h"
#include "geometry/base/work_share.h"
#include "machines/toml/regular_file.h"

namespace toothpath::samples {
namespace {

constexpr std::size_t kMostInput = std::size_t(1) << 30;

}  // namespace

std::string key_of(const std::vector<std::string>& parts) {
  Sha256 hash;
  for (const std::string& part : parts) hash.add(part);
  for (const std::string& path : inputs_read())
    if (const auto text = toml::read_input_file(path, kMostInput)) hash.add(sha256_hex(*text));
  return hash.hex();
}

std::string RanShard::summary() const {
  return fmt::format("{} samples in {}, {} of them new\n", samples, path, fresh);
}

Result<RanShard> run_shard(const std::string& directory, const Shard& shard, const Head& head,
                           const std::function<Result<std::string>(int)>& line) {
  auto file = SampleFile::open(directory, shard, head);
  if (!file) return file.error();
  std::vector<int> wanted;
  for (int k = 0; k < head.samples; ++k)
    if (shard.has(k) && !file->has(k)) wanted.push_back(k);
  WorkShare share{double(std::max<std::size_t>(1, wanted.size()))};
  for (const int k : wanted) {
    const auto text = [&] {
      const WorkShare sample(share, 1);
      return line(k);
    }();
    if (!text) return text.error();
    if (const auto added = file->add(k, *text); !added) return added.error();
  }
  return RanShard{file->path(), file->size(), wanted.size()};
}

}  // namespace toothpath::samples
