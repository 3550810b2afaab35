#include "render/vtk/floor_cache.h"

#include <algorithm>

#include "core/system/check.h"

namespace kinescope::render {
namespace {

std::size_t RowBytes(const Tile& tile) { return 4 * static_cast<std::size_t>(tile.width); }

std::size_t BytesOf(const Tile& tile) {
  return RowBytes(tile) * static_cast<std::size_t>(tile.height);
}

std::ptrdiff_t OffsetOf(const Tile& tile, int row, const Image& image) {
  return 4 * (static_cast<std::ptrdiff_t>(tile.y + row) * image.width + tile.x);
}

}  // namespace

bool FloorCache::Find(const Key& key, const Tile& tile, Image& image) {
  ++now_;
  ForgetOld();
  auto found = std::find_if(entries_.begin(), entries_.end(),
                            [&](const Entry& entry) { return entry.key == key; });
  if (found == entries_.end()) {
    entries_.push_back({key, now_, 0, {}});
    return false;
  }
  found->used_before = found->used;
  found->used = now_;
  if (found->rgba.empty()) return false;
  KINESCOPE_CHECK(found->rgba.size() == BytesOf(tile));
  const auto row_bytes = static_cast<std::ptrdiff_t>(RowBytes(tile));
  for (int row = 0; row < tile.height; ++row) {
    const auto from = found->rgba.begin() + row * row_bytes;
    std::copy(from, from + row_bytes, image.rgba.begin() + OffsetOf(tile, row, image));
  }
  return true;
}

void FloorCache::Keep(const Key& key, const Tile& tile, const Image& image) {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.key == key; });
  if (found == entries_.end() || found->used_before == 0 || !found->rgba.empty()) return;
  if (!MakeRoom(BytesOf(tile), found->used_before)) return;
  found->rgba.reserve(BytesOf(tile));
  for (int row = 0; row < tile.height; ++row) {
    const auto from = image.rgba.begin() + OffsetOf(tile, row, image);
    found->rgba.insert(found->rgba.end(), from, from + static_cast<std::ptrdiff_t>(RowBytes(tile)));
  }
  bytes_ += found->rgba.size();
}

void FloorCache::ForgetOld() {
  const auto is_old = [&](const Entry& entry) { return now_ - entry.used > kLongest; };
  for (Entry& entry : entries_) {
    if (is_old(entry)) Drop(entry);
  }
  entries_.erase(std::remove_if(entries_.begin(), entries_.end(), is_old), entries_.end());
}

// @return whether there is room for `bytes` more, without floors that were used after `since`.
bool FloorCache::MakeRoom(std::size_t bytes, std::uint64_t since) {
  const auto has_room = [&] { return bytes_ + bytes <= most_bytes_; };
  while (!has_room()) {
    Entry* oldest = nullptr;
    for (Entry& entry : entries_) {
      if (entry.rgba.empty() || entry.used >= since) continue;
      if (oldest == nullptr || entry.used < oldest->used) oldest = &entry;
    }
    if (oldest == nullptr) return false;
    Drop(*oldest);
  }
  return true;
}

void FloorCache::Drop(Entry& entry) {
  bytes_ -= entry.rgba.size();
  entry.rgba = {};
}

}  // namespace kinescope::render
