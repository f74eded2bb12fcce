#include <cstring>

#include "postproc/joints/program.h"

namespace toothpath::joints {
namespace {

// The first byte of a block: its kind and what differs from the usual; the second: which words differ from those of the
// block before, and the ruler.
constexpr unsigned kKinds = 0x0F, kForced = 0x10, kTip = 0x20, kMinutes = 0x40, kFeedAndAxis = 0x80;

std::uint64_t folded(std::int64_t v) { return (std::uint64_t(v) << 1) ^ std::uint64_t(v >> 63); }
std::int64_t unfolded(std::uint64_t v) { return std::int64_t(v >> 1) ^ -std::int64_t(v & 1); }

class Bytes {
 public:
  explicit Bytes(std::vector<unsigned char>& out) : out_(out) {}
  void byte(unsigned v) { out_.push_back(static_cast<unsigned char>(v)); }
  void number(std::int64_t v) {
    for (std::uint64_t u = folded(v);; u >>= 7) {
      byte(unsigned(u & 0x7F) | (u > 0x7F ? 0x80U : 0U));
      if (u <= 0x7F) return;
    }
  }
  void real(double v) {
    unsigned char raw[sizeof v];
    std::memcpy(raw, &v, sizeof v);
    out_.insert(out_.end(), raw, raw + sizeof v);
  }

 private:
  std::vector<unsigned char>& out_;
};

class BytesRead {
 public:
  explicit BytesRead(const std::vector<unsigned char>& in) : at_(in.data()) {}
  unsigned byte() { return *at_++; }
  std::int64_t number() {
    std::uint64_t u = 0;
    for (unsigned shift = 0;; shift += 7) {
      const unsigned b = byte();
      u |= std::uint64_t(b & 0x7FU) << shift;
      if (b < 0x80U) return unfolded(u);
    }
  }
  double real() {
    double v = 0;
    std::memcpy(&v, at_, sizeof v);
    at_ += sizeof v;
    return v;
  }

 private:
  const unsigned char* at_;
};

/// Modulo 2^64, so that they undo each other for all words.
std::int64_t difference(std::int64_t a, std::int64_t b) { return std::int64_t(std::uint64_t(a) - std::uint64_t(b)); }
std::int64_t sum(std::int64_t a, std::int64_t b) { return std::int64_t(std::uint64_t(a) + std::uint64_t(b)); }

}  // namespace

void PackedBlocks::pack(const std::vector<AxisBlock>& blocks) {
  std::vector<unsigned char> bytes;
  bytes.reserve(20 * blocks.size());
  Bytes out(bytes);
  AxisBlock before;
  for (const AxisBlock& b : blocks) {
    const bool more = b.per_minute != 0 || b.axis != Vec3(Vec3::UnitZ());
    out.byte(unsigned(b.kind) | (b.forced ? kForced : 0U) | (b.tip ? kTip : 0U) | (b.minutes != 0 ? kMinutes : 0U) |
             (more ? kFeedAndAxis : 0U));
    unsigned words = unsigned(b.ruler) << 5;
    for (std::size_t a = 0; a < 5; ++a) words |= b.words[a] != before.words[a] ? 1U << a : 0U;
    out.byte(words);
    for (std::size_t a = 0; a < 5; ++a)
      if (b.words[a] != before.words[a]) out.number(difference(b.words[a], before.words[a]));
    out.number(std::int64_t(b.record) - before.record);
    if (b.minutes != 0) out.real(b.minutes);
    if (more) out.real(b.per_minute);
    for (int i = 0; more && i < 3; ++i) out.real(b.axis[i]);
    before = b;
  }
  bytes.shrink_to_fit();
  bytes_ = std::move(bytes);
  count_ = blocks.size();
}

void PackedBlocks::unpack(std::vector<AxisBlock>& blocks) const {
  blocks.clear();
  blocks.reserve(count_);
  BytesRead in(bytes_);
  AxisBlock b;
  for (std::size_t n = 0; n < count_; ++n) {
    const unsigned kind = in.byte(), words = in.byte();
    b.kind = BlockKind(kind & kKinds);
    b.forced = (kind & kForced) != 0;
    b.tip = (kind & kTip) != 0;
    b.ruler = std::uint8_t(words >> 5);
    for (std::size_t a = 0; a < 5; ++a)
      if ((words & (1U << a)) != 0) b.words[a] = sum(b.words[a], in.number());
    b.record += std::int32_t(in.number());
    b.minutes = (kind & kMinutes) != 0 ? in.real() : 0;
    b.per_minute = (kind & kFeedAndAxis) != 0 ? in.real() : 0;
    b.axis = Vec3::UnitZ();
    for (int i = 0; (kind & kFeedAndAxis) != 0 && i < 3; ++i) b.axis[i] = in.real();
    blocks.push_back(b);
  }
}

void ToothBlocks::pack() {
  packed.pack(blocks);
  release();
}

void ToothBlocks::release() { std::vector<AxisBlock>().swap(blocks); }

void ToothBlocks::unpack() {
  if (packed.empty()) return;
  packed.unpack(blocks);
  packed = {};
}

const std::vector<AxisBlock>& ToothBlocks::all(std::vector<AxisBlock>& room) const {
  if (packed.empty()) return blocks;
  packed.unpack(room);
  return room;
}

}  // namespace toothpath::joints
