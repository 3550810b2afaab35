#include "render/vtk/floor_cache.h"

#include <algorithm>
#include <utility>

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

SharedPixels FloorCache::Find(const Key& key) {
  ++now_;
  ForgetOld();
  auto found = std::find_if(entries_.begin(), entries_.end(),
                            [&](const Entry& entry) { return entry.key == key; });
  if (found == entries_.end()) {
    entries_.push_back({key, now_, 0, nullptr});
    return nullptr;
  }
  found->used_before = found->used;
  found->used = now_;
  return found->rgba;
}

SharedPixels FloorCache::Keep(const Key& key, const Tile& tile, const Image& image) {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.key == key; });
  if (found == entries_.end() || found->used_before == 0 || found->rgba != nullptr) return nullptr;
  if (!MakeRoom(BytesOf(tile), found->used_before)) return nullptr;
  auto pixels = std::make_shared<std::vector<std::uint8_t>>();
  pixels->reserve(BytesOf(tile));
  for (int row = 0; row < tile.height; ++row) {
    const auto from = image.rgba.begin() + OffsetOf(tile, row, image);
    pixels->insert(pixels->end(), from, from + static_cast<std::ptrdiff_t>(RowBytes(tile)));
  }
  bytes_ += pixels->size();
  return found->rgba = std::move(pixels);
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
      if (entry.rgba == nullptr || entry.used >= since) continue;
      if (oldest == nullptr || entry.used < oldest->used) oldest = &entry;
    }
    if (oldest == nullptr) return false;
    Drop(*oldest);
  }
  return true;
}

void FloorCache::Drop(Entry& entry) {
  if (entry.rgba != nullptr) bytes_ -= entry.rgba->size();
  entry.rgba = nullptr;
}

void CopyFloor(const std::vector<std::uint8_t>& floor, const Tile& tile, const Tile& part,
               Image& image) {
  for (int row = 0; row < part.height; ++row) {
    const auto from =
        floor.begin() +
        4 * (static_cast<std::ptrdiff_t>(part.y - tile.y + row) * tile.width + part.x - tile.x);
    std::copy_n(from, RowBytes(part), image.rgba.begin() + OffsetOf(part, row, image));
  }
}

}  // namespace kinescope::render
