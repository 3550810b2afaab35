#include "server/mvn/file/ip_fragments.h"

#include <algorithm>
#include <cstring>

#include "core/system/check.h"

namespace kinescope::mvn {

IpFragments::Partials::iterator IpFragments::Find(const IpPacket& piece) {
  return std::find_if(partials_.begin(), partials_.end(), [&piece](const Partial& partial) {
    const IpPacket& head = partial.head;
    return head.fragment.id == piece.fragment.id && head.protocol == piece.protocol &&
           head.from == piece.from && head.to == piece.to;
  });
}

void IpFragments::DropOld(std::int64_t now_nanos) {
  while (!partials_.empty() && now_nanos - partials_.front().since_nanos > kPatienceNanos) {
    partials_.pop_front();
    ++lost_;
  }
}

std::optional<IpPacket> IpFragments::Add(const IpPacket& piece, std::int64_t now_nanos) {
  KINESCOPE_CHECK(!piece.fragment.IsWhole());
  DropOld(now_nanos);
  const std::size_t begin = piece.fragment.offset;
  const std::size_t end = begin + piece.payload.size();
  const bool is_last = !piece.fragment.more_follow;
  // Only the last fragment may end between two units.
  if (end > kMaxBytes || piece.payload.empty() || (!is_last && end % kUnit != 0)) {
    ++lost_;
    return std::nullopt;
  }
  auto partial = Find(piece);
  if (partial == partials_.end()) {
    if (partials_.size() == kMaxAtOnce) {
      partials_.pop_front();
      ++lost_;
    }
    partial = partials_.emplace(partials_.end());
    partial->head = piece;
    partial->head.payload = {};
    partial->since_nanos = now_nanos;
  }
  if (is_last) partial->size = std::max(end, partial->size.value_or(end));
  if (partial->bytes.size() < end) partial->bytes.resize(end);
  std::memcpy(partial->bytes.data() + begin, piece.payload.data(), piece.payload.size());
  for (std::size_t unit = begin / kUnit; unit * kUnit < end; ++unit) partial->units.set(unit);
  if (!partial->size) return std::nullopt;
  if (partial->bytes.size() > *partial->size) {  // a fragment beyond the last one
    partials_.erase(partial);
    ++lost_;
    return std::nullopt;
  }
  if (partial->units.count() < (*partial->size + kUnit - 1) / kUnit) return std::nullopt;

  whole_ = std::move(*partial);
  partials_.erase(partial);
  whole_.head.fragment = {};
  whole_.head.payload = whole_.bytes;
  return whole_.head;
}

void IpFragments::Clear() {
  lost_ += partials_.size();
  partials_.clear();
}

}  // namespace kinescope::mvn
